// SPDX-License-Identifier: Apache-2.0
// Registry: finds plugins, judges them, loads what fits, and finds their tables by id. What does not fit stays in the
// list with the reason; nothing that is foreign, too new, broken or missing stops the program. Materials may be
// replaced while they are in use (reload_changed).
#pragma once

#include "base/crash_note.hpp"
#include "base/log.hpp"
#include "base/result.hpp"
#include "plugin/manifest.hpp"
#include "plugin/material_source.hpp"
#include "plugin/quarantine.hpp"

#include <restage/denoiser.h>
#include <restage/inspector.h>
#include <restage/material.h>
#include <restage/scene_io.h>
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

namespace restage::plugin {

inline constexpr const char* host_version = "0.1.0";

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

template <class Table>
struct Provided { // a table and who provides it
    const Table* table = nullptr;
    const Entry* plugin = nullptr; // its files are in plugin->folder
};
using ImporterEntry = Provided<RestageImporter1>;
using ExporterEntry = Provided<RestageExporter1>;
using DenoiserEntry = Provided<RestageDenoiser1>;

struct MaterialEntry {
    const RestageMaterial1* table = nullptr; // source's
    const Entry* plugin = nullptr;
    Blame blame; // for compiling its GLSL
    std::shared_ptr<const MaterialSource> source; // keeps the table alive, also after the plugin was loaded anew
};

struct SearchPath {
    std::filesystem::path folder; // plugins are in it or up to three folders below
    bool required = false;        // warn when it does not exist
    bool own = false;             // the program's own plugins
};

struct RegistryOptions {
    bool safe_mode = false; // the program's own plugins only
    std::filesystem::path quarantine; // folder, see Quarantine; empty: crashes are not remembered
};

// What became of a plugin whose files changed.
struct Reload {
    const Entry* plugin = nullptr;
    std::string error; // "" = the new version is in use; else why not: the one before stays, where there was one
};

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

    // [main] Loads anew the materials whose files have changed since: manifest, library or GLSL. A version that does
    // not fit, or that `judge` refuses, is not taken, and the one before goes on; values of parameters live in the
    // scene and stay. Cheap when nothing has changed (a few stat() a plugin). Other kinds of plugins need a new start.
    std::vector<Reload> reload_changed();
    Result<> reload(const Entry& plugin); // this one, changed or not
    // Asked before a material is taken by reload_changed: does its GLSL compile? See render/material_types.hpp.
    using Judge = std::function<Result<>(const MaterialEntry&)>;
    void set_judge(Judge judge) { judge_ = std::move(judge); }
    // [any] Grows with each change of the lists.
    std::uint64_t version() const { return version_; }

    const Quarantine& quarantine() const { return quarantine_; }

    // Everything that was found, in the order of finding; pointers stay valid.
    std::vector<const Entry*> entries() const;

    // [any] Materials are handed out as copies, because another thread may load them anew.
    std::optional<MaterialEntry> find_material(std::string_view type) const; // nullopt = no plugin provides it
    std::vector<MaterialEntry> materials() const; // by type
    const RestageInspector1* find_inspector(std::string_view material_type) const; // [main] until the next reload
    const ImporterEntry* find_importer(std::string_view format) const;
    const ExporterEntry* find_exporter(std::string_view format) const;
    const DenoiserEntry* find_denoiser(std::string_view type) const;
    // By format or type, in order of the alphabet.
    const std::vector<ImporterEntry>& importers() const { return importers_; }
    const std::vector<ExporterEntry>& exporters() const { return exporters_; }
    const std::vector<DenoiserEntry>& denoisers() const { return denoisers_; }

    Log& log() const { return log_; }

  private:
    struct Plugin;
    void add(const std::filesystem::path& folder, bool own);
    Result<> load(Plugin&, bool judged);
    Result<> unique(const Plugin&, const class Loaded&) const;
    void list(); // makes the lists anew

    Log& log_;
    RegistryOptions options_;
    Quarantine quarantine_;
    Judge judge_;
    std::vector<std::unique_ptr<Plugin>> plugins_;
    std::atomic<std::uint64_t> version_{0};
    mutable std::mutex materials_mutex_;
    std::vector<MaterialEntry> materials_;
    std::vector<const RestageInspector1*> inspectors_;
    std::vector<ImporterEntry> importers_;
    std::vector<ExporterEntry> exporters_;
    std::vector<DenoiserEntry> denoisers_;
};

} // namespace restage::plugin
