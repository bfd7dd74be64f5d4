// SPDX-License-Identifier: Apache-2.0
// Registry: finds plugins, validates and loads them, and finds their tables by id. Refused plugins stay
// listed with the reason; no broken, missing or incompatible plugin stops the program. Materials may be
// replaced while in use (reload_changed).
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
    Manifest manifest; // empty if the manifest could not be read
    State state = State::refused;
    std::string reason; // why it was refused: one sentence, with the file
    bool own = false; // shipped with the program
    bool quarantined = false; // refused because it crashed
    std::string crash_file; // where its crash is recorded; "" = nowhere
    std::uint64_t stamp = 0; // of its files when last checked
    std::string trouble; // why the previous version is still in use; "" = the newest is
    // Its name in lists: the id, or the folder if there is no id.
    std::string name() const { return manifest.id.empty() ? folder.string() : manifest.id; }
    // What a crash in its code will record. `doing`: "while it read a file".
    Blame blame(const std::string& doing) const;
};

template <class Declared>
struct Provided { // a declaration, and its provider
    const Declared* table = nullptr;
    std::shared_ptr<const Entry> plugin; // snapshot from when this was listed; its files are in plugin->folder
    std::shared_ptr<const void> library; // stays open while this is held
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
    const model::Texture* table = nullptr; // owned by source
    std::shared_ptr<const Entry> plugin;   // snapshot from when this was listed
    Blame blame; // for compiling its GLSL
    std::shared_ptr<const TextureSource> source; // keeps the table alive, even after a reload
};

struct MaterialEntry {
    const model::Material* table = nullptr;  // owned by source
    std::shared_ptr<const Entry> plugin;     // snapshot from when this was listed
    Blame blame; // for compiling its GLSL
    std::shared_ptr<const MaterialSource> source; // keeps the table alive, even after a reload
};

// A snapshot of everything provided, sorted by type or format. Immutable.
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
    std::filesystem::path folder; // plugins are in it, up to three levels deep
    bool required = false;        // warn if it does not exist
    bool own = false;             // the program's own plugins
};

// Services that the host offers to plugins besides the log, implemented by modules above this one.
struct HostService {
    const char* id;    // "restage.image/1"
    const void* table; // valid as long as the program runs
};

struct RegistryOptions {
    bool safe_mode = false; // the program's own plugins only
    std::filesystem::path quarantine; // folder, see Quarantine; empty: crashes are not remembered
    std::span<const MaterialAdapter> material_adapters = {}; // empty: those of plugin/adapters.hpp
    std::span<const HostService> services = {}; // io/services.hpp has them
};

// The outcome for a plugin whose files changed.
struct Reload {
    const Entry* plugin = nullptr;
    std::string error; // "" = the new version is in use; else why not: the previous one, if any, stays
};

class Loaded;

class Registry {
  public:
    explicit Registry(Log&, RegistryOptions = {});
    ~Registry(); // shuts the plugins down and unloads them, last loaded first
    Registry(const Registry&) = delete;
    Registry& operator=(const Registry&) = delete;

    // The user's folder, then RESTAGE_PLUGIN_PATH, then <prefix>/lib/restage/plugins. For equal ids the first wins.
    // `prefix`: where Restage is installed; empty = the folder above the program's.
    static std::vector<SearchPath> default_paths(std::filesystem::path prefix = {});
    // The user's folder for crash notes; empty if the user has none.
    static std::filesystem::path default_quarantine();
    void scan(std::span<const SearchPath>); // [main] may be called again: adds what is new

    // [main] Reloads plugins whose files have changed: manifest, library or GLSL. A version that is invalid
    // or that `judge` refuses is rejected, and the previous one stays in use; parameter values live in the
    // scene and stay. Cheap if nothing has changed (a few stat() per plugin). Denoisers need a restart.
    std::vector<Reload> reload_changed();
    Result<> reload(const Entry& plugin); // changed or not
    // Called before reload_changed accepts a material or texture: checks that its GLSL compiles. See
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

    // [main] Everything found, in order of discovery; pointers stay valid, entries change.
    std::vector<const Entry*> entries() const;

    // [any] The newest catalogue. scan() and reloads publish a new one atomically; holders of this one,
    // or of an entry, continue with the plugins as they were, and their libraries stay open that long.
    std::shared_ptr<const Catalogue> catalogue() const;
    // [any] From the newest catalogue. nullopt = no plugin provides it.
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
    void publish(); // a catalogue of all loaded plugins
    void close_replaced();

    Log& log_;
    RegistryOptions options_;
    Quarantine quarantine_;
    Judge judge_;
    TextureJudge texture_judge_;
    std::vector<std::unique_ptr<Plugin>> plugins_;
    std::atomic<std::uint64_t> version_{0};
    std::vector<std::shared_ptr<Loaded>> replaced_; // closed on the main thread, once unused
    mutable std::mutex catalogue_mutex_; // guards the pointer; held only to copy it
    std::shared_ptr<const Catalogue> catalogue_;
};

} // namespace restage::plugin
