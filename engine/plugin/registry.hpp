// SPDX-License-Identifier: Apache-2.0
// Registry: finds plugins, judges them, loads what fits, and finds their tables by id. What does not fit stays in the
// list with the reason; nothing that is foreign, too new, broken or missing stops the program.
// [main] for scan; the rest is [any] between scans. Pointers it hands out live as long as the registry.
#pragma once

#include "base/log.hpp"
#include "base/result.hpp"
#include "plugin/manifest.hpp"

#include <restage/denoiser.h>
#include <restage/material.h>
#include <restage/scene_io.h>
#include <filesystem>
#include <memory>
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
    // Its name in lists: the id, or the folder when there is no id.
    std::string name() const { return manifest.id.empty() ? folder.string() : manifest.id; }
};

template <class Table>
struct Provided { // a table and who provides it
    const Table* table = nullptr;
    const Entry* plugin = nullptr; // its GLSL and other files are in plugin->folder
};
using MaterialEntry = Provided<RestageMaterial1>;
using ImporterEntry = Provided<RestageImporter1>;
using ExporterEntry = Provided<RestageExporter1>;
using DenoiserEntry = Provided<RestageDenoiser1>;

struct SearchPath {
    std::filesystem::path folder; // plugins are in it or up to three folders below
    bool required = false;        // warn when it does not exist
};

class Registry {
  public:
    explicit Registry(Log&);
    ~Registry(); // shuts the plugins down and unloads them, the last loaded first
    Registry(const Registry&) = delete;
    Registry& operator=(const Registry&) = delete;

    // The user's folder, then RESTAGE_PLUGIN_PATH, then <prefix>/lib/restage/plugins. Of one id the first wins.
    // `prefix`: where Restage is installed; empty = the folder above the program's.
    static std::vector<SearchPath> default_paths(std::filesystem::path prefix = {});
    void scan(std::span<const SearchPath>);

    // Everything that was found, in the order of finding; pointers stay valid.
    std::vector<const Entry*> entries() const;

    const MaterialEntry* find_material(std::string_view type) const; // null = no plugin provides it
    const ImporterEntry* find_importer(std::string_view format) const;
    const ExporterEntry* find_exporter(std::string_view format) const;
    const DenoiserEntry* find_denoiser(std::string_view type) const;
    // By type or format, in order of the alphabet.
    const std::vector<MaterialEntry>& materials() const { return materials_; }
    const std::vector<ImporterEntry>& importers() const { return importers_; }
    const std::vector<ExporterEntry>& exporters() const { return exporters_; }
    const std::vector<DenoiserEntry>& denoisers() const { return denoisers_; }

    Log& log() const { return log_; }

  private:
    struct Plugin;
    void add(const std::filesystem::path& folder);
    Result<> load(Plugin&);
    Result<> take_tables(Plugin&);

    Log& log_;
    std::vector<std::unique_ptr<Plugin>> plugins_;
    std::vector<MaterialEntry> materials_;
    std::vector<ImporterEntry> importers_;
    std::vector<ExporterEntry> exporters_;
    std::vector<DenoiserEntry> denoisers_;
};

} // namespace restage::plugin
