// SPDX-License-Identifier: Apache-2.0
#include "plugin/loaded.hpp"

#include "base/file.hpp"
#include "base/version.hpp"
#include "plugin/registry.hpp"
#include "plugin/table_reader.hpp"
#include "plugin/tables.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace restage::plugin {

namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t most_tables = 256; // in one library: an endless query() is a bug of the plugin

void host_log(const RestageHost* host, int level, const char* line) {
    const Host& self = *reinterpret_cast<const Host*>(host);
    const LogLevel as = level >= RESTAGE_LOG_ERROR     ? LogLevel::error
                        : level == RESTAGE_LOG_WARNING ? LogLevel::warning
                                                       : LogLevel::info;
    self.log->write(as, self.id + ": " + (line ? line : ""));
}

const void* host_service(const RestageHost* host, const char* id) {
    return id && std::strcmp(id, RESTAGE_LOG) == 0 ? &reinterpret_cast<const Host*>(host)->log_table : nullptr;
}

// All tables of a kind, judged; or the first one's fault.
template <class Table>
Result<std::vector<const Table*>> query_all(const RestagePlugin& plugin, const char* interface_id,
                                            const fs::path& folder, const std::string& who) {
    std::vector<const Table*> found;
    for (std::uint32_t i = 0; const auto* table = static_cast<const Table*>(plugin.query(interface_id, i)); ++i) {
        if (i == most_tables) return fail(who + ": provides " + interface_id + " without end");
        std::string problem;
        if constexpr (std::is_same_v<Table, RestageMaterial1>)
            problem = check_table(*table, folder);
        else
            problem = check_table(*table);
        if (!problem.empty()) return fail(who + ": " + problem);
        if (std::any_of(found.begin(), found.end(), [&](const Table* other) { return key(*other) == key(*table); }))
            return fail(who + ": provides \"" + std::string(key(*table)) + "\" twice");
        found.push_back(table);
    }
    return found;
}

} // namespace

Result<std::unique_ptr<Loaded>> Loaded::open(const fs::path& folder, const Manifest& manifest, Log& log) {
    const std::string file = (folder / "plugin.json").string();
    if (RESTAGE_ABI < manifest.abi_min)
        return fail(file + ": needs plugin interface " + std::to_string(manifest.abi_min) + ", this program has " +
                    std::to_string(RESTAGE_ABI) + ": the plugin is too new; update the program");
    if (RESTAGE_ABI > manifest.abi_max)
        return fail(file + ": was made for plugin interface " + std::to_string(manifest.abi_max) +
                    ", this program has " + std::to_string(RESTAGE_ABI) + ": the plugin is too old; update the plugin");
    std::error_code code;
    for (const fs::path& needed : manifest.files)
        if (!fs::exists(folder / needed, code))
            return fail(file + ": \"files\": " + (folder / needed).string() + " is missing");
    std::unique_ptr<Loaded> loaded(new Loaded);
    if (manifest.library.empty()) { // no native code: the tables are in the manifest
        RESTAGE_TRY(const std::string text, read_file(folder / "plugin.json"));
        RESTAGE_TRY(const auto described, JsonMaterials::parse(text, file));
        std::vector<const RestageMaterial1*> tables;
        for (const RestageMaterial1& table : described->tables()) {
            if (const std::string problem = check_table(table, folder); !problem.empty())
                return fail(file + ": " + problem);
            tables.push_back(&table);
        }
        std::vector<const RestageEmission1*> emissions;
        for (const RestageEmission1& emission : described->emissions())
            emissions.push_back(&emission);
        RESTAGE_CHECK(loaded->take_materials(tables, emissions, folder, file));
        return loaded;
    }
    RESTAGE_CHECK(loaded->open_library(folder, manifest, log));
    RESTAGE_CHECK(loaded->take_tables(folder, manifest, log));
    return loaded;
}

Result<> Loaded::open_library(const fs::path& folder, const Manifest& manifest, Log& log) {
    const fs::path library = folder / manifest.library;
    std::error_code code;
    if (!fs::exists(library, code)) {
        if (!fs::exists(folder / "CMakeLists.txt", code))
            return fail(library.string() +
                        ": the library is missing: the plugin is not built, or not all of it was copied");
        // Sources: what restage_add_plugin() makes of them lies elsewhere.
        return fail(
            library.string() +
            ": the library is missing: this folder holds the plugin's sources. Build it there, "
            "'cmake -B build -DCMAKE_PREFIX_PATH=<where Restage is installed> && cmake --build build', and use " +
            (folder / "build/lib/restage/plugins").string());
    }
    // A material's library may be built anew while it is in use; what is open is then a copy of the one before.
    RESTAGE_TRY(library_, manifest.kind == Kind::material ? Library::open_copy(library) : Library::open(library));
    const auto* table = static_cast<const RestagePlugin*>(library_->symbol(RESTAGE_PLUGIN_SYMBOL));
    if (!table) return fail(library.string() + ": exports no symbol \"" RESTAGE_PLUGIN_SYMBOL "\": this is no plugin");
    if (table->abi != RESTAGE_ABI)
        return fail(library.string() + ": was built for plugin interface " + std::to_string(table->abi) +
                    ", this program has " + std::to_string(RESTAGE_ABI) + " (its manifest says otherwise)");
    if (table->size < sizeof(RestagePlugin))
        return fail(library.string() + ": its entry table has " + std::to_string(table->size) + " bytes, " +
                    std::to_string(sizeof(RestagePlugin)) + " are needed: rebuild it with this SDK");
    if (!table->id || manifest.id != table->id)
        return fail(library.string() + ": says its id is \"" + (table->id ? table->id : "") +
                    "\", the manifest says \"" + manifest.id + "\"");
    if (!table->version || manifest.version != table->version)
        return fail(library.string() + ": says its version is \"" + (table->version ? table->version : "") +
                    "\", the manifest says \"" + manifest.version + "\"");
    if (!table->query) return fail(library.string() + ": has no query function");
    host_ = {.c = {.abi = RESTAGE_ABI, .size = sizeof(RestageHost), .version = version(), .service = host_service},
             .log_table = {.size = sizeof(RestageLog1), .log = host_log},
             .log = &log,
             .id = manifest.id};
    table_ = table;
    if (table->init && !table->init(&host_.c)) return fail(library.string() + ": its init function reports failure");
    running_ = true;
    return {};
}

Result<> Loaded::take_tables(const fs::path& folder, const Manifest& manifest, Log& log) {
    const std::string library = (folder / manifest.library).string();
    const auto missing = [&](const char* interface_id) {
        return fail(library + ": provides no " + interface_id + ", though its kind is " + to_string(manifest.kind));
    };
    switch (manifest.kind) {
        case Kind::material: {
            RESTAGE_TRY(const auto found, query_all<RestageMaterial1>(*table_, RESTAGE_MATERIAL1, folder, library));
            if (found.empty()) return missing(RESTAGE_MATERIAL1);
            RESTAGE_TRY(const auto readers, query_all<RestageTable1>(*table_, RESTAGE_TABLE1, folder, library));
            RESTAGE_CHECK(take_table_readers(found, readers, manifest, log, library));
            RESTAGE_TRY(const auto emissions, query_all<RestageEmission1>(*table_, RESTAGE_EMISSION1, folder, library));
            RESTAGE_CHECK(take_materials(found, emissions, folder, library));
            RESTAGE_TRY(inspectors, query_all<RestageInspector1>(*table_, RESTAGE_INSPECTOR1, folder, library));
            for (const RestageInspector1* i : inspectors)
                if (std::none_of(materials.begin(), materials.end(),
                                 [&](const auto& m) { return key(m->table()) == key(*i); }))
                    return fail(library + ": its inspector is for \"" + i->type + "\", which it does not provide");
            return {};
        }
        case Kind::importer: {
            RESTAGE_TRY(importers, query_all<RestageImporter1>(*table_, RESTAGE_IMPORTER1, folder, library));
            if (importers.empty()) return missing(RESTAGE_IMPORTER1);
            return {};
        }
        case Kind::exporter: {
            RESTAGE_TRY(exporters, query_all<RestageExporter1>(*table_, RESTAGE_EXPORTER1, folder, library));
            if (exporters.empty()) return missing(RESTAGE_EXPORTER1);
            return {};
        }
        case Kind::denoiser: {
            RESTAGE_TRY(denoisers, query_all<RestageDenoiser1>(*table_, RESTAGE_DENOISER1, folder, library));
            if (denoisers.empty()) return missing(RESTAGE_DENOISER1);
            return {};
        }
    }
    return {};
}

Result<> Loaded::take_materials(std::span<const RestageMaterial1* const> tables,
                                std::span<const RestageEmission1* const> emissions, const fs::path& folder,
                                const std::string& who) {
    RESTAGE_TRY(const auto glsl, read_glsl(folder));
    for (const RestageEmission1* emission : emissions) {
        const auto its = std::find_if(tables.begin(), tables.end(),
                                      [&](const RestageMaterial1* m) { return key(*m) == key(*emission); });
        if (its == tables.end())
            return fail(who + ": has an emission of \"" + emission->type + "\", which it does not provide");
        if (const std::string problem = check_emission(*emission, **its); !problem.empty())
            return fail(who + ": " + problem);
    }
    for (const RestageMaterial1* table : tables) {
        for (const auto& other : materials) {
            if (key(other->table()) == key(*table))
                return fail(who + ": provides \"" + std::string(key(*table)) + "\" twice");
            if (table->prefix && other->table().prefix && !std::strcmp(table->prefix, other->table().prefix))
                return fail(who + ": material \"" + table->type + "\": the prefix \"" + table->prefix +
                            "\" is already taken by material \"" + other->table().type + "\"");
        }
        const auto reader = std::find_if(table_readers.begin(), table_readers.end(),
                                         [&](const auto& r) { return r->material_type() == key(*table); });
        const auto emission = std::find_if(emissions.begin(), emissions.end(),
                                           [&](const RestageEmission1* e) { return key(*e) == key(*table); });
        materials.push_back(std::make_shared<const MaterialSource>(*table, folder, glsl,
                                                                   reader == table_readers.end() ? nullptr : *reader,
                                                                   emission == emissions.end() ? nullptr : *emission));
    }
    return {};
}

Result<> Loaded::take_table_readers(std::span<const RestageMaterial1* const> tables,
                                    std::span<const RestageTable1* const> readers, const Manifest& manifest, Log& log,
                                    const std::string& who) {
    for (const RestageTable1* reader : readers) {
        const auto its = std::find_if(tables.begin(), tables.end(),
                                      [&](const RestageMaterial1* m) { return key(*m) == key(*reader); });
        if (its == tables.end() || !has_table(**its))
            return fail(who + ": reads tables for \"" + reader->type +
                        "\", which is no material of it with a parameter of that type");
        table_readers.push_back(std::make_shared<TableReader>(*reader, manifest.id, log));
    }
    for (const RestageMaterial1* m : tables)
        if (has_table(*m) &&
            std::none_of(readers.begin(), readers.end(), [&](const RestageTable1* r) { return key(*r) == key(*m); }))
            return fail(who + ": material \"" + m->type +
                        "\" has a table as a parameter, and nothing reads it: " + RESTAGE_TABLE1 + " is missing");
    return {};
}

Loaded::~Loaded() {
    for (const auto& reader : table_readers)
        reader->close();
    if (running_ && table_->shutdown) table_->shutdown();
}

} // namespace restage::plugin
