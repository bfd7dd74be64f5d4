// SPDX-License-Identifier: Apache-2.0
// Finds plugins, and keeps the lists of what they provide. loaded.cpp validates plugins.
#include "plugin/registry.hpp"

#include "base/file.hpp"
#include "plugin/adapters.hpp"
#include "plugin/loaded.hpp"
#include "plugin/table_reader.hpp"

#include <algorithm>
#include <cstdlib>
#include <set>

namespace restage::plugin {

namespace fs = std::filesystem;

namespace {

constexpr int deepest_folder = 3; // lib/restage/plugins/<kinds>/<name>, and one for a vendor

template <class Listed>
std::optional<Listed> find_in(const std::vector<Listed>& list, std::string_view name) {
    const auto it = std::find_if(list.begin(), list.end(), [&](const auto& p) { return key(*p.table) == name; });
    return it == list.end() ? std::nullopt : std::optional<Listed>(*it);
}

bool has_manifest(const fs::path& folder) {
    std::error_code code;
    return fs::is_regular_file(folder / "plugin.json", code);
}

// Folders with a manifest, sorted by path; a plugin's own subfolders are not searched.
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

// Hash of time and size of everything in a plugin's folder: a different number means a change.
std::uint64_t stamp_of(const fs::path& folder) {
    std::set<std::string> lines;
    std::error_code code;
    fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied, code), end;
    for (; !code && it != end; it.increment(code)) {
        if (it.depth() >= 4) it.disable_recursion_pending();
        std::error_code ignored;
        if (!it->is_regular_file(ignored)) continue;
        const auto time = it->last_write_time(ignored).time_since_epoch().count();
        lines.insert(it->path().string() + '\n' + std::to_string(time) + '\n' + std::to_string(it->file_size(ignored)));
    }
    std::uint64_t stamp = 1;
    for (const std::string& line : lines)
        stamp = hash64(line, stamp);
    return stamp;
}

} // namespace

struct Registry::Plugin {
    Entry entry;
    std::shared_ptr<Loaded> loaded; // shared with catalogues
};

Blame Entry::blame(const std::string& doing) const {
    return crash_file.empty() ? Blame() : Blame{crash_file, Quarantine::note(doing, stamp)};
}

Registry::Registry(Log& log, RegistryOptions options)
    : log_(log),
      options_(std::move(options)),
      quarantine_(options_.quarantine),
      catalogue_(std::make_shared<const Catalogue>()) {
    if (options_.material_adapters.empty()) options_.material_adapters = material_adapters();
}

Registry::~Registry() {
    catalogue_.reset();
    replaced_.clear();
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
    if (!prefix.empty()) paths.push_back({.folder = prefix / "lib" / "restage" / "plugins", .own = true});
    return paths;
}

fs::path Registry::default_quarantine() {
    const auto user = user_data_dir();
    return user ? *user / "quarantine" : fs::path();
}

void Registry::scan(std::span<const SearchPath> paths) {
    for (const SearchPath& path : paths) {
        if (options_.safe_mode && !path.own) continue;
        std::error_code code;
        if (!fs::is_directory(path.folder, code)) {
            if (path.required) log_.warning("plugin folder " + path.folder.string() + " does not exist");
            continue;
        }
        std::vector<fs::path> folders;
        find_folders(path.folder, deepest_folder, folders);
        for (const fs::path& folder : folders)
            add(fs::absolute(folder, code).lexically_normal(), path.own);
    }
    publish();
}

void Registry::add(const fs::path& folder, bool own) {
    if (std::any_of(plugins_.begin(), plugins_.end(), [&](const auto& p) { return p->entry.folder == folder; }))
        return; // two search paths lead here
    auto plugin = std::make_unique<Plugin>();
    Entry& entry = plugin->entry;
    entry.folder = folder;
    entry.own = own;
    if (const auto done = load(*plugin, false); done) {
        log_.debug("plugin " + entry.name() + " " + entry.manifest.version + " loaded from " + folder.string());
    } else {
        entry.reason = done.error().message;
        log_.warning("plugin " + entry.name() + " is not used: " + entry.reason);
    }
    plugins_.push_back(std::move(plugin));
}

// Loads the plugin from its current files, or leaves everything unchanged.
Result<> Registry::load(Plugin& plugin, bool judged) {
    Entry& entry = plugin.entry;
    entry.stamp = stamp_of(entry.folder);
    RESTAGE_TRY(const Manifest manifest, read_manifest(entry.folder / "plugin.json"));
    const std::string file = (entry.folder / "plugin.json").string();
    if (!plugin.loaded) entry.manifest = manifest; // so that a refused plugin has a name
    for (const auto& other : plugins_)
        if (other.get() != &plugin && other->loaded && other->entry.manifest.id == manifest.id)
            return fail(file + ": a plugin with this id is already loaded from " + other->entry.folder.string() +
                        ", which comes first in the search order");
    if (!entry.own) {
        entry.crash_file = quarantine_.note_of(manifest.id);
        if (static std::atomic_flag said;
            entry.crash_file.empty() && !options_.quarantine.empty() && !said.test_and_set())
            log_.warning("crashes of plugins will not be remembered: " + options_.quarantine.string() +
                         " cannot be created or written");
        const auto crashed = quarantine_.reason(manifest.id, entry.stamp);
        entry.quarantined = crashed.has_value();
        if (crashed)
            return fail(file + ": " + *crashed +
                        "; it stays off until it changes, or until 'restage plugins --enable " + manifest.id + "'");
    }
    std::shared_ptr<Loaded> loaded;
    {
        const CrashNote note(entry.blame("while it was being loaded"));
        RESTAGE_TRY(loaded, Loaded::open(entry.folder, manifest, options_, log_));
    }
    RESTAGE_CHECK(unique(plugin, *loaded));
    if (judged && judge_)
        for (const auto& source : loaded->materials)
            RESTAGE_CHECK(judge_({&source->material(), std::make_shared<const Entry>(entry),
                                  entry.blame("while its GLSL was being compiled"), source}));
    if (judged && texture_judge_)
        for (const auto& source : loaded->textures)
            RESTAGE_CHECK(texture_judge_({&source->texture(), std::make_shared<const Entry>(entry),
                                          entry.blame("while its GLSL was being compiled"), source}));
    if (plugin.loaded) replaced_.push_back(std::move(plugin.loaded)); // renderers have copies of its tables
    plugin.loaded = std::move(loaded);
    entry.manifest = manifest;
    entry.state = State::loaded;
    entry.reason.clear();
    entry.trouble.clear();
    return {};
}

// Two plugins must not provide the same thing.
Result<> Registry::unique(const Plugin& plugin, const Loaded& loaded) const {
    const std::string who = (plugin.entry.folder / plugin.entry.manifest.library).string();
    const auto taken = [&](std::string_view what, const Plugin& by) {
        return fail(who + ": \"" + std::string(what) + "\" is already provided by " + by.entry.name());
    };
    for (const auto& other : plugins_) {
        if (other.get() == &plugin || !other->loaded) continue;
        const auto twice = [&](const auto& mine, const auto& theirs) -> Result<> {
            for (const auto& a : mine)
                for (const auto& b : theirs)
                    if (key(a.declared) == key(b.declared)) return taken(key(a.declared), *other);
            return {};
        };
        RESTAGE_CHECK(twice(loaded.importers, other->loaded->importers));
        RESTAGE_CHECK(twice(loaded.exporters, other->loaded->exporters));
        RESTAGE_CHECK(twice(loaded.actions, other->loaded->actions));
        RESTAGE_CHECK(twice(loaded.panels, other->loaded->panels));
        RESTAGE_CHECK(twice(loaded.skies, other->loaded->skies));
        for (const Denoiser& a : loaded.denoisers)
            for (const Denoiser& b : other->loaded->denoisers)
                if (a.type == b.type) return taken(a.type, *other);
        for (const auto& a : loaded.materials)
            for (const auto& b : other->loaded->materials) {
                const model::Material &mine = a->material(), &theirs = b->material();
                if (mine.type == theirs.type) return taken(mine.type, *other);
                if (!mine.prefix.empty() && mine.prefix == theirs.prefix)
                    return fail(who + ": material \"" + mine.type + "\": the prefix \"" + mine.prefix +
                                "\" is already taken by material \"" + theirs.type + "\" of " + other->entry.name());
            }
        for (const auto& a : loaded.textures)
            for (const auto& b : other->loaded->textures)
                if (a->texture().type == b->texture().type) return taken(a->texture().type, *other);
        // Materials and textures share shaders, and so one namespace for prefixes.
        const auto apart = [&](const Loaded& one, const Loaded& two) -> Result<> {
            for (const auto& a : one.textures) {
                const auto same = [&](const auto& declared) -> Result<> {
                    if (declared.prefix != a->texture().prefix) return {};
                    return fail(who + ": the prefix \"" + declared.prefix + "\" is already taken by " +
                                other->entry.name());
                };
                for (const auto& b : two.textures)
                    RESTAGE_CHECK(same(b->texture()));
                for (const auto& b : two.materials)
                    if (b->material().has_code()) RESTAGE_CHECK(same(b->material()));
            }
            return {};
        };
        RESTAGE_CHECK(apart(loaded, *other->loaded));
        RESTAGE_CHECK(apart(*other->loaded, loaded));
    }
    return {};
}

void Registry::publish() {
    auto all = std::make_shared<Catalogue>();
    for (const auto& plugin : plugins_) {
        if (!plugin->loaded) continue;
        const auto entry = std::make_shared<const Entry>(plugin->entry);
        const std::shared_ptr<const void> library = plugin->loaded;
        for (const Inspector& i : plugin->loaded->inspectors)
            all->inspectors.push_back({&i, entry, library});
        for (const Denoiser& d : plugin->loaded->denoisers)
            all->denoisers.push_back({&d, entry, library});
        for (const auto& [declared, native] : plugin->loaded->importers)
            all->importers.push_back({{&declared, entry, library}, native});
        for (const auto& [declared, native] : plugin->loaded->exporters)
            all->exporters.push_back({{&declared, entry, library}, native});
        for (const auto& [declared, native] : plugin->loaded->actions)
            all->actions.push_back({{&declared, entry, library}, native});
        for (const auto& [declared, native] : plugin->loaded->panels)
            all->panels.push_back({{&declared, entry, library}, native});
        for (const auto& [declared, native] : plugin->loaded->skies)
            all->skies.push_back({{&declared, entry, library}, native});
        for (const auto& source : plugin->loaded->materials)
            all->materials.push_back(
                {&source->material(), entry, entry->blame("while its GLSL was being compiled"), source});
        for (const auto& source : plugin->loaded->textures) // with the library, which contains its native evaluation
            all->textures.push_back({&source->texture(), entry, entry->blame("while its GLSL was being compiled"),
                                     std::shared_ptr<const TextureSource>(plugin->loaded, source.get())});
        for (const auto& reader : plugin->loaded->table_readers)
            reader->set_blame(entry->blame("while it read a table"));
    }
    const auto sort = [](auto& list) {
        std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return key(*a.table) < key(*b.table); });
    };
    sort(all->materials), sort(all->importers), sort(all->exporters), sort(all->denoisers), sort(all->inspectors);
    sort(all->actions), sort(all->panels);
    sort(all->skies), sort(all->textures);
    std::shared_ptr<const Catalogue> before = std::move(all);
    {
        std::lock_guard lock(catalogue_mutex_);
        catalogue_.swap(before);
    }
    ++version_;
    before.reset();
    close_replaced();
}

// Only the main thread may shut down (restage/plugin.h), so plugins still used by another thread wait until next time.
void Registry::close_replaced() {
    std::erase_if(replaced_, [](const std::shared_ptr<Loaded>& l) { return l.use_count() == 1; });
}

std::vector<Reload> Registry::reload_changed() {
    close_replaced();
    std::vector<Reload> news;
    for (const auto& plugin : plugins_) {
        Entry& entry = plugin->entry;
        if (!entry.manifest.id.empty() && entry.manifest.provides_any("restage.denoiser")) continue;
        if (stamp_of(entry.folder) == entry.stamp) continue;
        const auto done = load(*plugin, true);
        if (done) {
            log_.info("plugin " + entry.name() + ": reloaded");
        } else {
            (plugin->loaded ? entry.trouble : entry.reason) = done.error().message;
            log_.error("plugin " + entry.name() + ": " + done.error().message +
                       (plugin->loaded ? " (the previous version stays in use)" : ""));
        }
        news.push_back({&entry, done ? "" : done.error().message});
    }
    if (!news.empty()) publish();
    return news;
}

Result<> Registry::reload(const Entry& which) {
    for (const auto& plugin : plugins_) {
        if (plugin->entry.folder != which.folder) continue;
        const auto done = load(*plugin, true);
        if (!done) (plugin->loaded ? plugin->entry.trouble : plugin->entry.reason) = done.error().message;
        publish();
        return done;
    }
    return fail("no such plugin");
}

std::vector<const Entry*> Registry::entries() const {
    std::vector<const Entry*> result;
    for (const auto& plugin : plugins_)
        result.push_back(&plugin->entry);
    return result;
}

std::shared_ptr<const Catalogue> Registry::catalogue() const {
    std::lock_guard lock(catalogue_mutex_);
    return catalogue_;
}
std::optional<MaterialEntry> Registry::find_material(std::string_view type) const {
    return find_in(catalogue()->materials, type);
}
std::optional<TextureEntry> Registry::find_texture(std::string_view type) const {
    return find_in(catalogue()->textures, type);
}
std::optional<ImporterEntry> Registry::find_importer(std::string_view format) const {
    return find_in(catalogue()->importers, format);
}
std::optional<ExporterEntry> Registry::find_exporter(std::string_view format) const {
    return find_in(catalogue()->exporters, format);
}
std::optional<DenoiserEntry> Registry::find_denoiser(std::string_view type) const {
    return find_in(catalogue()->denoisers, type);
}
const Inspector* Registry::find_inspector(std::string_view type) const {
    const auto found = find_in(catalogue()->inspectors, type);
    return found ? found->table : nullptr;
}

} // namespace restage::plugin
