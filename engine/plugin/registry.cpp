// SPDX-License-Identifier: Apache-2.0
// Finding, judging and loading. Order of the questions: manifest, id taken, abi range, files there, library opens,
// entry symbol, entry abi and size, id and version as promised, init, tables.
#include "plugin/registry.hpp"

#include "base/file.hpp"
#include "plugin/library.hpp"
#include "plugin/tables.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <set>

namespace restage::plugin {

namespace fs = std::filesystem;

namespace {

constexpr int deepest_folder = 3;              // lib/restage/plugins/<kinds>/<name>, and one for a vendor
constexpr std::uint32_t most_tables = 256;     // in one library: an endless query() is a bug of the plugin

struct Host { // one per plugin, so that its log lines carry its name
    RestageHost c; // first: a RestageHost* of ours is a Host*
    RestageLog1 log_table;
    Log* log;
    const Entry* entry;
};

void host_log(const RestageHost* host, int level, const char* line) {
    const Host& self = *reinterpret_cast<const Host*>(host);
    const LogLevel as = level >= RESTAGE_LOG_ERROR     ? LogLevel::error
                        : level == RESTAGE_LOG_WARNING ? LogLevel::warning
                                                       : LogLevel::info;
    self.log->write(as, self.entry->manifest.id + ": " + (line ? line : ""));
}

const void* host_service(const RestageHost* host, const char* id) {
    return id && std::strcmp(id, RESTAGE_LOG) == 0 ? &reinterpret_cast<const Host*>(host)->log_table : nullptr;
}

template <class Table>
std::string_view key(const Table& table) {
    if constexpr (std::is_same_v<Table, RestageMaterial1> || std::is_same_v<Table, RestageDenoiser1>)
        return table.type;
    else
        return table.format;
}

template <class Table>
const Provided<Table>* find_in(const std::vector<Provided<Table>>& list, std::string_view name) {
    const auto it = std::find_if(list.begin(), list.end(), [&](const auto& p) { return key(*p.table) == name; });
    return it == list.end() ? nullptr : &*it;
}

bool has_manifest(const fs::path& folder) {
    std::error_code code;
    return fs::is_regular_file(folder / "plugin.json", code);
}

// Folders with a manifest, in order of their paths; a plugin's own folders are not searched.
void find_folders(const fs::path& folder, int depth, std::vector<fs::path>& out) {
    if (has_manifest(folder)) {
        out.push_back(folder);
        return;
    }
    if (depth == 0) return;
    std::error_code code;
    std::set<fs::path> below;
    for (fs::directory_iterator it(folder, fs::directory_options::skip_permission_denied, code), end;
         !code && it != end; it.increment(code)) {
        std::error_code ignored;
        if (it->is_directory(ignored)) below.insert(it->path());
    }
    for (const fs::path& f : below)
        find_folders(f, depth - 1, out);
}

} // namespace

struct Registry::Plugin {
    Entry entry;
    Host host{};
    std::optional<Library> library;
    const RestagePlugin* table = nullptr;
    bool running = false; // init succeeded: shutdown is due

    ~Plugin() {
        if (running && table->shutdown) table->shutdown();
    }
};

Registry::Registry(Log& log) : log_(log) {}

Registry::~Registry() {
    while (!plugins_.empty())
        plugins_.pop_back();
}

std::vector<SearchPath> Registry::default_paths(fs::path prefix) {
    std::vector<SearchPath> paths;
    if (const auto user = user_data_dir()) paths.push_back({*user / "plugins", false});
#if defined(_WIN32)
    constexpr char separator = ';';
#else
    constexpr char separator = ':';
#endif
    if (const char* variable = std::getenv("RESTAGE_PLUGIN_PATH")) {
        std::string_view rest = variable;
        while (!rest.empty()) {
            const std::size_t end = std::min(rest.find(separator), rest.size());
            if (end > 0) paths.push_back({fs::path(std::string(rest.substr(0, end))), true});
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
    }
    if (const auto here = executable_dir(); prefix.empty() && here) prefix = here->parent_path();
    if (!prefix.empty()) paths.push_back({prefix / "lib" / "restage" / "plugins", false});
    return paths;
}

void Registry::scan(std::span<const SearchPath> paths) {
    for (const SearchPath& path : paths) {
        std::error_code code;
        if (!fs::is_directory(path.folder, code)) {
            if (path.required) log_.warning("plugin folder " + path.folder.string() + " does not exist");
            continue;
        }
        std::vector<fs::path> folders;
        find_folders(path.folder, deepest_folder, folders);
        for (const fs::path& folder : folders)
            add(fs::absolute(folder, code).lexically_normal());
    }
    const auto by_key = [](const auto& a, const auto& b) { return key(*a.table) < key(*b.table); };
    std::sort(materials_.begin(), materials_.end(), by_key);
    std::sort(importers_.begin(), importers_.end(), by_key);
    std::sort(exporters_.begin(), exporters_.end(), by_key);
    std::sort(denoisers_.begin(), denoisers_.end(), by_key);
}

void Registry::add(const fs::path& folder) {
    if (std::any_of(plugins_.begin(), plugins_.end(), [&](const auto& p) { return p->entry.folder == folder; }))
        return; // two search paths lead here
    auto plugin = std::make_unique<Plugin>();
    Entry& entry = plugin->entry;
    entry.folder = folder;
    auto loaded = [&]() -> Result<> {
        RESTAGE_TRY(entry.manifest, read_manifest(folder / "plugin.json"));
        return load(*plugin);
    }();
    if (loaded) {
        entry.state = State::loaded;
        log_.debug("plugin " + entry.name() + " " + entry.manifest.version + " loaded from " + folder.string());
    } else {
        entry.reason = loaded.error().message;
        if (plugin->running && plugin->table->shutdown) plugin->table->shutdown();
        plugin->running = false;
        plugin->library.reset();
        log_.warning("plugin " + entry.name() + " is not used: " + entry.reason);
    }
    plugins_.push_back(std::move(plugin));
}

Result<> Registry::load(Plugin& plugin) {
    Entry& entry = plugin.entry;
    const Manifest& manifest = entry.manifest;
    const std::string file = (entry.folder / "plugin.json").string();
    for (const auto& other : plugins_)
        if (other->entry.state == State::loaded && other->entry.manifest.id == manifest.id)
            return fail(file + ": a plugin with this id is already loaded from " + other->entry.folder.string() +
                        ", which comes first in the search order");
    if (RESTAGE_ABI < manifest.abi_min)
        return fail(file + ": needs plugin interface " + std::to_string(manifest.abi_min) + ", this program has " +
                    std::to_string(RESTAGE_ABI) + ": the plugin is too new; update the program");
    if (RESTAGE_ABI > manifest.abi_max)
        return fail(file + ": was made for plugin interface " + std::to_string(manifest.abi_max) +
                    ", this program has " + std::to_string(RESTAGE_ABI) + ": the plugin is too old; update the plugin");
    std::error_code code;
    for (const fs::path& needed : manifest.files)
        if (!fs::exists(entry.folder / needed, code))
            return fail(file + ": \"files\": " + (entry.folder / needed).string() + " is missing");
    const fs::path library = entry.folder / manifest.library;
    if (!fs::exists(library, code)) return fail(library.string() + ": the library is missing");
    RESTAGE_TRY(plugin.library, Library::open(library));

    const auto* table = static_cast<const RestagePlugin*>(plugin.library->symbol(RESTAGE_PLUGIN_SYMBOL));
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

    plugin.table = table;
    plugin.host = {
        .c = {.abi = RESTAGE_ABI, .size = sizeof(RestageHost), .version = host_version, .service = host_service},
        .log_table = {.size = sizeof(RestageLog1), .log = host_log},
        .log = &log_,
        .entry = &entry};
    if (table->init && !table->init(&plugin.host.c))
        return fail(library.string() + ": its init function reports failure");
    plugin.running = true;
    return take_tables(plugin);
}

Result<> Registry::take_tables(Plugin& plugin) {
    const Entry& entry = plugin.entry;
    const std::string library = (entry.folder / entry.manifest.library).string();
    // All of a plugin's tables are judged before the first is taken.
    const auto take = [&]<class Table>(const char* interface_id, std::vector<Provided<Table>>& list) -> Result<> {
        std::vector<Provided<Table>> found;
        for (std::uint32_t i = 0; const auto* table = static_cast<const Table*>(plugin.table->query(interface_id, i));
             ++i) {
            if (i == most_tables) return fail(library + ": provides " + interface_id + " without end");
            std::string problem;
            if constexpr (std::is_same_v<Table, RestageMaterial1>)
                problem = check_table(*table, entry.folder);
            else
                problem = check_table(*table);
            if (!problem.empty()) return fail(library + ": " + problem);
            if (find_in(found, key(*table)))
                return fail(library + ": provides \"" + std::string(key(*table)) + "\" twice");
            if (const auto* other = find_in(list, key(*table)))
                return fail(library + ": \"" + std::string(key(*table)) + "\" is already provided by " +
                            other->plugin->name());
            if constexpr (std::is_same_v<Table, RestageMaterial1>)
                for (const auto* known : {&list, &found})
                    for (const auto& other : *known)
                        if (table->prefix && other.table->prefix && !std::strcmp(table->prefix, other.table->prefix))
                            return fail(library + ": material \"" + table->type + "\": the prefix \"" + table->prefix +
                                        "\" is already taken by material \"" + other.table->type + "\" of " +
                                        other.plugin->name());
            found.push_back({table, &entry});
        }
        if (found.empty())
            return fail(library + ": provides no " + interface_id + ", though its kind is " +
                        to_string(entry.manifest.kind));
        list.insert(list.end(), found.begin(), found.end());
        return {};
    };
    switch (entry.manifest.kind) {
        case Kind::material:
            return take(RESTAGE_MATERIAL1, materials_);
        case Kind::importer:
            return take(RESTAGE_IMPORTER1, importers_);
        case Kind::exporter:
            return take(RESTAGE_EXPORTER1, exporters_);
        case Kind::denoiser:
            return take(RESTAGE_DENOISER1, denoisers_);
    }
    return {};
}

std::vector<const Entry*> Registry::entries() const {
    std::vector<const Entry*> result;
    for (const auto& plugin : plugins_)
        result.push_back(&plugin->entry);
    return result;
}

const MaterialEntry* Registry::find_material(std::string_view type) const { return find_in(materials_, type); }
const ImporterEntry* Registry::find_importer(std::string_view format) const { return find_in(importers_, format); }
const ExporterEntry* Registry::find_exporter(std::string_view format) const { return find_in(exporters_, format); }
const DenoiserEntry* Registry::find_denoiser(std::string_view type) const { return find_in(denoisers_, type); }

} // namespace restage::plugin
