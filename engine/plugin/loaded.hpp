// SPDX-License-Identifier: Apache-2.0
// Private to plugin/: one opening of one plugin, from its manifest to tables that have been judged. Closing it shuts
// the plugin down and unloads its library. [main]
#pragma once

#include "base/log.hpp"
#include "base/result.hpp"
#include "plugin/library.hpp"
#include "plugin/manifest.hpp"
#include "plugin/material_source.hpp"

#include <restage/denoiser.h>
#include <restage/emission.h>
#include <restage/inspector.h>
#include <restage/plugin.h>
#include <restage/scene_io.h>
#include <restage/table.h>
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
};

class Loaded {
  public:
    // Judges, in this order: abi range, files there, library opens, entry symbol, entry abi and size, id and version as
    // promised, init, tables. The error is the sentence that refuses the plugin.
    static Result<std::unique_ptr<Loaded>> open(const std::filesystem::path& folder, const Manifest& manifest,
                                                Log& log);
    ~Loaded();
    Loaded(const Loaded&) = delete;

    std::vector<std::shared_ptr<const MaterialSource>> materials;
    std::vector<const RestageInspector1*> inspectors;
    std::vector<std::shared_ptr<TableReader>> table_readers;
    std::vector<const RestageImporter1*> importers;
    std::vector<const RestageExporter1*> exporters;
    std::vector<const RestageDenoiser1*> denoisers;

  private:
    Loaded() = default;
    Result<> open_library(const std::filesystem::path& folder, const Manifest& manifest, Log& log);
    Result<> take_tables(const std::filesystem::path& folder, const Manifest& manifest, Log& log);
    Result<> take_materials(std::span<const RestageMaterial1* const> tables,
                            std::span<const RestageEmission1* const> emissions, const std::filesystem::path& folder,
                            const std::string& who);
    Result<> take_table_readers(std::span<const RestageMaterial1* const> materials,
                                std::span<const RestageTable1* const> readers, const Manifest& manifest, Log& log,
                                const std::string& who);

    std::optional<Library> library_;
    Host host_{};
    const RestagePlugin* table_ = nullptr;
    bool running_ = false; // init succeeded: shutdown is due
};

// "conductor", "pbrt", "oidn": what a table is found by.
inline std::string_view key(const RestageMaterial1& t) { return t.type; }
inline std::string_view key(const RestageInspector1& t) { return t.type; }
inline std::string_view key(const RestageTable1& t) { return t.type; }
inline std::string_view key(const RestageEmission1& t) { return t.type; }
inline std::string_view key(const RestageImporter1& t) { return t.format; }
inline std::string_view key(const RestageExporter1& t) { return t.format; }
inline std::string_view key(const RestageDenoiser1& t) { return t.type; }

} // namespace restage::plugin
