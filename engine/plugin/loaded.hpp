// SPDX-License-Identifier: Apache-2.0
// Private to plugin/: one opening of one plugin, from its manifest to validated tables. Closing it shuts
// the plugin down and unloads its library. [main]
#pragma once

#include "base/log.hpp"
#include "base/result.hpp"
#include "model/action.hpp"
#include "model/formats.hpp"
#include "plugin/adapters.hpp"
#include "plugin/denoiser.hpp"
#include "plugin/inspector.hpp"
#include "plugin/library.hpp"
#include "plugin/manifest.hpp"
#include "plugin/material_source.hpp"
#include "plugin/registry.hpp"
#include "plugin/texture_source.hpp"

#include <restage/plugin.h>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace restage::plugin {

struct Host { // one per opening, so that its log lines carry the plugin's name
    RestageHost c; // first: a RestageHost* of ours is a Host*
    RestageLog1 log_table;
    Log* log;
    std::string id;
    std::span<const HostService> services;
};

class Loaded {
  public:
    // Checks, in this order: its needs, files exist, library opens, entry symbol, entry abi and size, id and
    // version as in the manifest, init, tables. The error is a sentence that says why the plugin is refused.
    static Result<std::unique_ptr<Loaded>> open(const std::filesystem::path& folder, const Manifest& manifest,
                                                const RegistryOptions& host, Log& log);
    ~Loaded();
    Loaded(const Loaded&) = delete;

    std::vector<std::shared_ptr<const MaterialSource>> materials;
    std::vector<std::shared_ptr<const TextureSource>> textures;
    std::vector<std::shared_ptr<TableReader>> table_readers;
    std::deque<Inspector> inspectors; // deques: catalogues point into them
    std::deque<Denoiser> denoisers;
    template <class Declared, class Native>
    struct Table {
        Declared declared;
        const Native* native;
    };
    std::deque<Table<model::Importer, RestageImporter1>> importers;
    std::deque<Table<model::Exporter, RestageExporter1>> exporters;
    std::deque<Table<model::Action, RestageAction1>> actions;
    std::deque<Table<model::Panel, RestagePanel1>> panels;
    std::deque<Table<model::Sky, RestageSky1>> skies;

  private:
    Loaded() = default;
    Result<> open_library(const std::filesystem::path& folder, const Manifest& manifest,
                          std::span<const HostService> services, Log& log);
    Result<> take_materials(const std::filesystem::path& folder, const Manifest&,
                            std::span<const MaterialAdapter> adapters, Log&);
    Result<> take_textures(const std::filesystem::path& folder, const Manifest&);
    Result<> take_formats(const Manifest&, const std::string& who); // and everything else without GLSL

    std::optional<Library> library_;
    Host host_{};
    const RestagePlugin* table_ = nullptr;
    bool running_ = false; // init succeeded: shutdown is due
};

// "conductor", "pbrt", "oidn": the lookup key of a table.
inline std::string_view key(const model::Material& t) { return t.type; }
inline std::string_view key(const model::Texture& t) { return t.type; }
inline std::string_view key(const model::Importer& t) { return t.format; }
inline std::string_view key(const model::Exporter& t) { return t.format; }
inline std::string_view key(const model::Action& t) { return t.id; }
inline std::string_view key(const model::Panel& t) { return t.id; }
inline std::string_view key(const model::Sky& t) { return t.type; }
inline std::string_view key(const Inspector& t) { return t.material_type; }
inline std::string_view key(const Denoiser& t) { return t.type; }

} // namespace restage::plugin
