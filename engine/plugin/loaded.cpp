// SPDX-License-Identifier: Apache-2.0
#include "plugin/loaded.hpp"

#include "base/file.hpp"
#include "base/version.hpp"
#include "plugin/registry.hpp"
#include "plugin/table_reader.hpp"
#include "plugin/tables.hpp"

#include <algorithm>
#include <iterator>
#include <ranges>

namespace restage::plugin {

namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t most_tables = 256; // per library: an endless query() is a bug in the plugin

void host_log(const RestageHost* host, int level, const char* line) {
    const Host& self = *reinterpret_cast<const Host*>(host);
    const LogLevel as = level >= RESTAGE_LOG_ERROR     ? LogLevel::error
                        : level == RESTAGE_LOG_WARNING ? LogLevel::warning
                                                       : LogLevel::info;
    self.log->write(as, self.id + ": " + (line ? line : ""));
}

const void* host_service(const RestageHost* host, const char* id) {
    const Host& self = *reinterpret_cast<const Host*>(host);
    const std::string_view wanted = id ? id : "";
    if (wanted == RESTAGE_LOG) return &self.log_table;
    const auto found = std::ranges::find(self.services, wanted, &HostService::id);
    return found == self.services.end() ? nullptr : found->table;
}

HostOffer offer_of(const RegistryOptions& options) {
    HostOffer offer{.version = version(), .interfaces = {}, .services = {RESTAGE_LOG}};
    offer.interfaces.assign(known_interfaces().begin(), known_interfaces().end());
    for (const MaterialAdapter& adapter : options.material_adapters)
        offer.interfaces.emplace_back(adapter.interface_id);
    for (const HostService& service : options.services)
        offer.services.emplace_back(service.id);
    return offer;
}

// All tables of an interface.
Result<std::vector<const void*>> query_all(const RestagePlugin& plugin, const char* interface_id,
                                           const std::string& who) {
    std::vector<const void*> found;
    for (std::uint32_t i = 0; const void* table = plugin.query(interface_id, i); ++i) {
        if (i == most_tables) return fail(who + ": provides " + interface_id + " without end");
        found.push_back(table);
    }
    return found;
}

} // namespace

Result<std::unique_ptr<Loaded>> Loaded::open(const fs::path& folder, const Manifest& manifest,
                                             const RegistryOptions& host, Log& log) {
    const std::string file = (folder / "plugin.json").string();
    RESTAGE_CHECK(check_needs(manifest, offer_of(host), file));
    std::error_code code;
    for (const fs::path& needed : manifest.files)
        if (!fs::exists(folder / needed, code))
            return fail(file + ": \"files\": " + (folder / needed).string() + " is missing");
    std::unique_ptr<Loaded> loaded(new Loaded);
    if (!manifest.library.empty()) RESTAGE_CHECK(loaded->open_library(folder, manifest, host.services, log));
    RESTAGE_CHECK(loaded->take_materials(folder, manifest, host.material_adapters, log));
    if (manifest.provides_any("restage.texture")) RESTAGE_CHECK(loaded->take_textures(folder, manifest));
    if (loaded->table_) RESTAGE_CHECK(loaded->take_formats(manifest, (folder / manifest.library).string()));
    return loaded;
}

Result<> Loaded::open_library(const fs::path& folder, const Manifest& manifest, std::span<const HostService> services,
                              Log& log) {
    const fs::path library = folder / manifest.library;
    std::error_code code;
    if (!fs::exists(library, code)) {
        if (!fs::exists(folder / "CMakeLists.txt", code))
            return fail(library.string() +
                        ": the library is missing: the plugin is not built, or not all of it was copied");
        // A source folder: restage_add_plugin() builds elsewhere.
        return fail(
            library.string() +
            ": the library is missing: this folder holds the plugin's sources. Build it there, "
            "'cmake -B build -DCMAKE_PREFIX_PATH=<where Restage is installed> && cmake --build build', and use " +
            (folder / "build/lib/restage/plugins").string());
    }
    // A library may be rebuilt while in use, so a private copy is opened. Denoisers are opened in place, because they
    // load files from their own folder.
    RESTAGE_TRY(library_,
                manifest.provides_any("restage.denoiser") ? Library::open(library) : Library::open_copy(library));
    const auto* table = static_cast<const RestagePlugin*>(library_->symbol(RESTAGE_PLUGIN_SYMBOL));
    if (!table) return fail(library.string() + ": exports no symbol \"" RESTAGE_PLUGIN_SYMBOL "\": not a plugin");
    if (table->abi != RESTAGE_ABI)
        return fail(library.string() + ": was built for plugin interface " + std::to_string(table->abi) +
                    ", this program has " + std::to_string(RESTAGE_ABI) + " (its manifest says otherwise)");
    if (table->size < sizeof(RestagePlugin))
        return fail(library.string() + ": its entry table has " + std::to_string(table->size) + " bytes, " +
                    std::to_string(sizeof(RestagePlugin)) + " are needed: rebuild it with this SDK");
    if (!table->id || manifest.id != table->id)
        return fail(library.string() + ": its id is \"" + (table->id ? table->id : "") + "\", the manifest says \"" +
                    manifest.id + "\"");
    if (!table->version || manifest.version != table->version)
        return fail(library.string() + ": its version is \"" + (table->version ? table->version : "") +
                    "\", the manifest says \"" + manifest.version + "\"");
    if (!table->query) return fail(library.string() + ": has no query function");
    host_ = {.c = {.abi = RESTAGE_ABI, .size = sizeof(RestageHost), .version = version(), .service = host_service},
             .log_table = {.size = sizeof(RestageLog1), .log = host_log},
             .log = &log,
             .id = manifest.id,
             .services = services};
    table_ = table;
    if (table->init && !table->init(&host_.c)) return fail(library.string() + ": its init function reports failure");
    running_ = true;
    return {};
}

Result<> Loaded::take_materials(const fs::path& folder, const Manifest& manifest,
                                std::span<const MaterialAdapter> adapters, Log& log) {
    const std::string who = (folder / (table_ ? manifest.library : fs::path("plugin.json"))).string();
    std::vector<model::Material> declared;
    std::size_t native = 0; // number from the library; they come first
    const auto listed = [&](const char* id) {
        return std::find(manifest.provides.begin(), manifest.provides.end(), id) != manifest.provides.end();
    };
    const auto tables_of = [&](const char* id) -> Result<std::vector<const void*>> {
        if (!table_ || !listed(id)) return std::vector<const void*>();
        return query_all(*table_, id, who);
    };
    for (const MaterialAdapter& adapter : adapters) {
        RESTAGE_TRY(const auto tables, tables_of(adapter.interface_id));
        for (const void* table : tables) {
            auto material = adapter.read(table);
            if (!material) return fail(who + ": " + material.error().message);
            // A type already described by a newer revision.
            if (std::ranges::any_of(declared, [&](const auto& m) { return m.type == material->type; })) {
                if (adapter.interface_id == adapters[0].interface_id)
                    return fail(who + ": provides \"" + material->type + "\" twice");
                continue;
            }
            declared.push_back(std::move(*material));
        }
    }
    native = declared.size();
    const auto of_ours = [&](const std::string& type) -> model::Material* {
        const auto it = std::find_if(declared.begin(), declared.begin() + std::ptrdiff_t(native),
                                     [&](const model::Material& m) { return m.type == type; });
        return it == declared.begin() + std::ptrdiff_t(native) ? nullptr : &*it;
    };
    RESTAGE_TRY(const auto emissions, tables_of(RESTAGE_EMISSION1));
    for (const void* table : emissions) {
        auto emission = read_emission1(*static_cast<const RestageEmission1*>(table));
        if (!emission) return fail(who + ": " + emission.error().message);
        model::Material* its = of_ours(emission->material_type);
        if (!its)
            return fail(who + ": has an emission for \"" + emission->material_type + "\", which it does not provide");
        its->emission = std::move(emission->emission);
    }
    RESTAGE_TRY(const auto readers, tables_of(RESTAGE_TABLE1));
    for (const void* table : readers) {
        auto reader = TableReader::open(*static_cast<const RestageTable1*>(table), manifest.id, log);
        if (!reader) return fail(who + ": " + reader.error().message);
        const model::Material* its = of_ours((*reader)->material_type());
        if (!its || !has_table(*its))
            return fail(who + ": reads tables for \"" + (*reader)->material_type() +
                        "\", which is not one of its materials with a parameter of that type");
        table_readers.push_back(std::move(*reader));
    }
    RESTAGE_TRY(const auto uis, tables_of(RESTAGE_INSPECTOR1));
    for (const void* table : uis) {
        auto inspector = Inspector::read(*static_cast<const RestageInspector1*>(table));
        if (!inspector) return fail(who + ": " + inspector.error().message);
        if (!of_ours(inspector->material_type))
            return fail(who + ": its inspector is for \"" + inspector->material_type + "\", which it does not provide");
        inspectors.push_back(std::move(*inspector));
    }
    if (manifest.has_materials) {
        const std::string file = (folder / "plugin.json").string();
        RESTAGE_TRY(const std::string text, read_file(file));
        RESTAGE_TRY(auto described, parse_materials(text, file));
        std::ranges::move(described, std::back_inserter(declared));
    }
    if (declared.empty())
        return manifest.provides_any("restage.material")
                   ? fail(who + ": provides no restage.material/1, although its manifest declares it")
                   : Result<>();
    RESTAGE_TRY(const auto glsl, read_glsl(folder));
    for (std::size_t i = 0; i < declared.size(); ++i) {
        model::Material& m = declared[i];
        const std::string from = i < native ? who : (folder / "plugin.json").string();
        if (const std::string problem = check_material(m, folder); !problem.empty()) return fail(from + ": " + problem);
        for (const auto& other : materials) {
            if (other->material().type == m.type) return fail(from + ": provides \"" + m.type + "\" twice");
            if (!m.prefix.empty() && m.prefix == other->material().prefix)
                return fail(from + ": material \"" + m.type + "\": the prefix \"" + m.prefix +
                            "\" is already taken by material \"" + other->material().type + "\"");
        }
        const auto reader =
            std::ranges::find_if(table_readers, [&](const auto& r) { return r->material_type() == m.type; });
        if (has_table(m) && reader == table_readers.end())
            return fail(from + ": material \"" + m.type +
                        "\" has a table parameter, but the plugin provides no reader for it: " + RESTAGE_TABLE1 +
                        " is missing");
        materials.push_back(std::make_shared<const MaterialSource>(std::move(m), folder, glsl,
                                                                   reader == table_readers.end() ? nullptr : *reader));
    }
    return {};
}

Result<> Loaded::take_textures(const fs::path& folder, const Manifest& manifest) {
    const std::string file = (folder / "plugin.json").string(), library = (folder / manifest.library).string();
    std::vector<DeclaredTexture> declared;
    if (table_ && std::ranges::find(manifest.provides, RESTAGE_TEXTURE1) != manifest.provides.end()) {
        RESTAGE_TRY(const auto tables, query_all(*table_, RESTAGE_TEXTURE1, library));
        for (const void* table : tables) {
            auto texture = read_texture1(*static_cast<const RestageTexture1*>(table));
            if (!texture) return fail(library + ": " + texture.error().message);
            declared.push_back(std::move(*texture));
        }
    }
    const std::size_t native = declared.size();
    RESTAGE_TRY(const std::string text, read_file(file));
    RESTAGE_TRY(auto described, parse_textures(text, file));
    for (model::Texture& t : described)
        declared.push_back({std::move(t)});
    if (declared.empty()) return fail(file + ": provides no restage.texture/1, though \"provides\" lists it");
    RESTAGE_TRY(const auto glsl, read_glsl(folder));
    for (std::size_t i = 0; i < declared.size(); ++i) {
        auto& [texture, eval] = declared[i];
        const std::string& from = i < native ? library : file;
        if (const std::string problem = check_texture(texture, folder); !problem.empty())
            return fail(from + ": " + problem);
        const auto taken = [&](std::string_view kind, std::string_view type) {
            return fail(from + ": texture \"" + texture.type + "\": the prefix \"" + texture.prefix +
                        "\" is already taken by " + std::string(kind) + " \"" + std::string(type) + "\"");
        };
        for (const auto& other : textures) {
            if (other->texture().type == texture.type) return fail(from + ": provides \"" + texture.type + "\" twice");
            if (other->texture().prefix == texture.prefix) return taken("texture", other->texture().type);
        }
        for (const auto& other : materials)
            if (other->material().prefix == texture.prefix) return taken("material", other->material().type);
        textures.push_back(std::make_shared<const TextureSource>(std::move(texture), folder, glsl, eval));
    }
    return {};
}

Result<> Loaded::take_formats(const Manifest& manifest, const std::string& who) {
    const auto take = [&]<class Table>(const char* id, const Table*, auto& list, auto&& read) -> Result<> {
        if (std::ranges::find(manifest.provides, id) == manifest.provides.end()) return {};
        RESTAGE_TRY(const auto tables, query_all(*table_, id, who));
        if (tables.empty()) return fail(who + ": provides no " + id + ", although its manifest declares it");
        for (const void* table : tables) {
            auto item = read(static_cast<const Table*>(table));
            if (!item) return fail(who + ": " + item.error().message);
            const auto name = [](const auto& i) -> decltype(auto) {
                if constexpr (requires { i.declared; })
                    return key(i.declared);
                else
                    return key(i);
            };
            for (const auto& other : list)
                if (name(other) == name(*item))
                    return fail(who + ": provides \"" + std::string(name(*item)) + "\" twice");
            list.push_back(std::move(*item));
        }
        return {};
    };
    const auto take_table = [&]<class Declared, class Native>(const char* id, std::deque<Table<Declared, Native>>& list,
                                                              auto&& read, auto&& check) {
        return take(id, static_cast<const Native*>(nullptr), list,
                    [&](const Native* native) -> Result<Table<Declared, Native>> {
                        RESTAGE_TRY(auto declared, read(*native));
                        if (const std::string problem = check(declared); !problem.empty()) return fail(problem);
                        return Table<Declared, Native>{std::move(declared), native};
                    });
    };
    RESTAGE_CHECK(take_table(RESTAGE_IMPORTER1, importers, read_importer1, check_importer));
    RESTAGE_CHECK(take_table(RESTAGE_EXPORTER1, exporters, read_exporter1, check_exporter));
    RESTAGE_CHECK(take_table(RESTAGE_ACTION1, actions, read_action1, check_action));
    RESTAGE_CHECK(take_table(RESTAGE_PANEL1, panels, read_panel1, check_panel));
    RESTAGE_CHECK(take_table(RESTAGE_SKY1, skies, read_sky1, check_sky));
    return take(RESTAGE_DENOISER1, static_cast<const RestageDenoiser1*>(nullptr), denoisers,
                [](const RestageDenoiser1* t) -> Result<Denoiser> {
                    RESTAGE_TRY(auto declared, Denoiser::read(*t));
                    if (!is_type_name(declared.type) || declared.label.empty())
                        return fail("a denoiser without a proper type name or label");
                    return declared;
                });
}

Loaded::~Loaded() {
    for (const auto& reader : table_readers)
        reader->close();
    if (running_ && table_->shutdown) table_->shutdown();
}

} // namespace restage::plugin
