// SPDX-License-Identifier: Apache-2.0
// Registry: finds plugins, judges them, loads what fits, and finds their tables by id. What does not fit stays in the
// list with the reason; nothing that is foreign, too new, broken or missing stops the program. Materials may be
// replaced while they are in use (reload_changed).
#pragma once

#include "base/crash_note.hpp"
#include "base/log.hpp"
#include "base/result.hpp"
#include "model/action.hpp"
#include "model/formats.hpp"
#include "model/sky.hpp"
#include "model/texture.hpp"
#include "plugin/denoiser.hpp"
#include "plugin/inspector.hpp"
#include "plugin/manifest.hpp"
#include "plugin/material_source.hpp"
#include "plugin/quarantine.hpp"

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

struct RestageImporter1;
struct RestageExporter1;
struct RestageSky1;
struct RestageAction1;
struct RestagePanel1;

namespace restage::plugin {

struct MaterialAdapter;
class TextureSource;

enum class State { loaded, refused };

struct Entry {
    std::filesystem::path folder;
    Manifest manifest; // empty where the manifest itself could not be read
    State state = State::refused;
    std::string reason; // why it was refused: one sentence, with the file
    bool own = false; // came with the program
    bool quarantined = false; // refused because it crashed
    std::string crash_file; // where a crash of it is noted; "" = nowhere
    std::uint64_t stamp = 0; // of its files when they were last looked at
    std::string trouble; // why its newest version is not in use, while the one before is; "" = it is
    // Its name in lists: the id, or the folder when there is no id.
    std::string name() const { return manifest.id.empty() ? folder.string() : manifest.id; }
    // What a crash in its code is to leave behind. `doing`: "while it read a file".
    Blame blame(const std::string& doing) const;
};

template <class Declared>
struct Provided { // what was declared, and who provides it
    const Declared* table = nullptr;
    std::shared_ptr<const Entry> plugin; // as it was when this was listed; its files are in plugin->folder
    std::shared_ptr<const void> library; // stays open while somebody holds this
};
using DenoiserEntry = Provided<Denoiser>;
using InspectorEntry = Provided<Inspector>;
struct ImporterEntry : Provided<model::Importer> {
    const RestageImporter1* native = nullptr; // for io/, which calls it
};
struct ExporterEntry : Provided<model::Exporter> {
    const RestageExporter1* native = nullptr; // for io/, which calls it
};

struct SkyEntry : Provided<model::Sky> {
    const RestageSky1* native = nullptr; // for io/, which calls it
};
struct ActionEntry : Provided<model::Action> {
    const RestageAction1* native = nullptr; // for io/, which calls it
};
struct PanelEntry : Provided<model::Panel> {
    const RestagePanel1* native = nullptr; // for io/, which calls it
};

struct TextureEntry {
    const model::Texture* table = nullptr; // source's
    std::shared_ptr<const Entry> plugin;   // as it was when this was listed
    Blame blame; // for compiling its GLSL
    std::shared_ptr<const TextureSource> source; // keeps the table alive, also after the plugin was reloaded
};

struct MaterialEntry {
    const model::Material* table = nullptr;  // source's
    std::shared_ptr<const Entry> plugin;     // as it was when this was listed
    Blame blame; // for compiling its GLSL
    std::shared_ptr<const MaterialSource> source; // keeps the table alive, also after the plugin was reloaded
};

// All that was provided at one moment, by type or format in order of the alphabet. Never changes.
struct Catalogue {
    std::vector<MaterialEntry> materials;
    std::vector<ImporterEntry> importers;
    std::vector<ExporterEntry> exporters;
    std::vector<DenoiserEntry> denoisers;
    std::vector<InspectorEntry> inspectors;
    std::vector<TextureEntry> textures;
    std::vector<SkyEntry> skies;
    std::vector<ActionEntry> actions;
    std::vector<PanelEntry> panels;
};

struct SearchPath {
    std::filesystem::path folder; // plugins are in it or up to three folders below
    bool required = false;        // warn when it does not exist
    bool own = false;             // the program's own plugins
};

// What the host offers to plugins besides the log, from the modules above.
struct HostService {
    const char* id;    // "restage.image/1"
    const void* table; // alive as long as the program
};

struct RegistryOptions {
    bool safe_mode = false; // the program's own plugins only
    std::filesystem::path quarantine; // folder, see Quarantine; empty: crashes are not remembered
    std::span<const MaterialAdapter> material_adapters = {}; // empty: those of plugin/adapters.hpp
    std::span<const HostService> services = {}; // io/services.hpp has them
};

// What became of a plugin whose files changed.
struct Reload {
    const Entry* plugin = nullptr;
    std::string error; // "" = the new version is in use; else why not: the one before stays, where there was one
};

class Loaded;

class Registry {
  public:
    explicit Registry(Log&, RegistryOptions = {});
    ~Registry(); // shuts the plugins down and unloads them, the last loaded first
    Registry(const Registry&) = delete;
    Registry& operator=(const Registry&) = delete;

    // The user's folder, then RESTAGE_PLUGIN_PATH, then <prefix>/lib/restage/plugins. Of one id the first wins.
    // `prefix`: where Restage is installed; empty = the folder above the program's.
    static std::vector<SearchPath> default_paths(std::filesystem::path prefix = {});
    // The user's folder for notes about crashes; empty where the user has none.
    static std::filesystem::path default_quarantine();
    void scan(std::span<const SearchPath>); // [main] may be called again: adds what is new

    // [main] Reloads the plugins whose files have changed since: manifest, library or GLSL. A version that does
    // not fit, or that `judge` refuses, is not taken, and the one before goes on; values of parameters live in the
    // scene and stay. Cheap when nothing has changed (a few stat() a plugin). Denoisers need a new start.
    std::vector<Reload> reload_changed();
    Result<> reload(const Entry& plugin); // this one, changed or not
    // Asked before a material or texture is taken by reload_changed: does its GLSL compile? See
    // render/material_composer.hpp and texture_composer.hpp.
    using Judge = std::function<Result<>(const MaterialEntry&)>;
    using TextureJudge = std::function<Result<>(const TextureEntry&)>;
    void set_judge(Judge judge, TextureJudge texture_judge = {}) {
        judge_ = std::move(judge);
        texture_judge_ = std::move(texture_judge);
    }
    // [any] Grows with each change of the lists.
    std::uint64_t version() const { return version_; }

    const Quarantine& quarantine() const { return quarantine_; }

    // [main] Everything that was found, in the order of finding; pointers stay valid, what they point to changes.
    std::vector<const Entry*> entries() const;

    // [any] The newest catalogue. scan() and the reloads publish another one, whole, in one step; who holds this one,
    // or an entry of it, goes on with the plugins as they were, and their libraries stay open that long.
    std::shared_ptr<const Catalogue> catalogue() const;
    // [any] Of the newest catalogue. nullopt = no plugin provides it.
    std::optional<MaterialEntry> find_material(std::string_view type) const;
    std::optional<TextureEntry> find_texture(std::string_view type) const;
    std::optional<ImporterEntry> find_importer(std::string_view format) const;
    std::optional<ExporterEntry> find_exporter(std::string_view format) const;
    std::optional<DenoiserEntry> find_denoiser(std::string_view type) const;
    std::vector<MaterialEntry> materials() const { return catalogue()->materials; }
    std::vector<TextureEntry> textures() const { return catalogue()->textures; }
    std::vector<ImporterEntry> importers() const { return catalogue()->importers; }
    std::vector<ExporterEntry> exporters() const { return catalogue()->exporters; }
    std::vector<DenoiserEntry> denoisers() const { return catalogue()->denoisers; }
    const Inspector* find_inspector(std::string_view material_type) const; // [main] until the next reload

    Log& log() const { return log_; }

  private:
    struct Plugin;
    void add(const std::filesystem::path& folder, bool own);
    Result<> load(Plugin&, bool judged);
    Result<> unique(const Plugin&, const Loaded&) const;
    void publish(); // a catalogue of what is loaded now
    void close_replaced();

    Log& log_;
    RegistryOptions options_;
    Quarantine quarantine_;
    Judge judge_;
    TextureJudge texture_judge_;
    std::vector<std::unique_ptr<Plugin>> plugins_;
    std::atomic<std::uint64_t> version_{0};
    std::vector<std::shared_ptr<Loaded>> replaced_; // closed on the main thread, when nobody uses them any more
    mutable std::mutex catalogue_mutex_; // of the pointer; nobody waits for more than its copy
    std::shared_ptr<const Catalogue> catalogue_;
};

} // namespace restage::plugin
