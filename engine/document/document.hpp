// SPDX-License-Identifier: Apache-2.0
// Document: the content of a scene or project file, read on any thread before a Session adopts it. A project is the
// scene it began with (the base), which is reimported, plus the changes since.
#pragma once

#include "base/result.hpp"
#include "io/import.hpp"
#include "plugin/registry.hpp"
#include "scene/edit.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace restage::document {

struct Base {
    std::string file;   // absolute; "" = the scene was created in the program, and the base is empty
    std::string format; // of the importer
    std::uint64_t hash = 0; // of the file's bytes
    scene::Scene scene; // as imported
    scene::ParamSet options{}; // of the importer: those that were set
};

// The source of geometry or pixels from a file: a project references them instead of storing them.
struct DataSource {
    std::string file, format; // absolute; of the importer
    std::uint32_t id = 0;     // the mesh or image in the imported file
    std::string name;
    scene::ParamSet options{}; // of the importer: those that were set
};

// By identity of the shared data.
class DataSources {
  public:
    void note(const std::shared_ptr<const void>& data, DataSource source);
    void note_all(const scene::Scene& imported, const std::string& file, const std::string& format,
                  const scene::ParamSet& options);
    void add(const DataSources& other) { by_data_.insert(other.by_data_.begin(), other.by_data_.end()); }
    const DataSource* find(const void* data) const;

  private:
    struct Held {
        std::shared_ptr<const void> data; // so that the address is not recycled
        DataSource source;
    };
    std::map<const void*, Held> by_data_;
};

struct Looks; // looks.hpp

struct Document {
    std::string path; // of the file that was read
    Base base;
    scene::Edit changes; // from the base to the saved state; empty for a scene file
    io::Report report;   // of the base's import, and changes that did not fit
    DataSources sources;
    std::shared_ptr<const Looks> looks = nullptr; // looks.hpp; null = none
    std::string unknown; // JSON: additions of a newer program to a project; written back
    std::map<std::string, std::string> note; // of a recovery file, see recovery.hpp
    bool unsaved = false; // not as in the file: its scene was read with other options
};

enum class BaseProblem { none, missing, changed }; // of a project's base that the user can solve by naming another file

struct IsolateOptions; // isolate.hpp

struct ReadOptions {
    io::Progress progress;
    std::shared_ptr<const IsolateOptions> isolate = nullptr; // scenes are read in a separate process
    std::filesystem::path base; // replaces the one the project names; "" = that one
    bool drop_lost = false; // changes to items missing from the base are skipped and reported, instead of an error
    // Returns the pixels of an image file; null = none, already reported. Empty: the file is
    // read.
    std::function<Result<std::shared_ptr<const scene::PixelData>>(const scene::Image&)> pixels{};
    BaseProblem* problem = nullptr; // set if reading fails for this reason
    bool expose = true; // exposure.hpp; false if only the objects of a file are wanted
    // Of the importer (io::ImportOptions::values). nullopt: none are set, or for a project the saved ones.
    std::optional<scene::ParamSet> import_options{};
};

inline constexpr std::string_view project_extension = ".restage";
bool is_project(const std::filesystem::path& path);

// A scene file, isolated or not. `format`: of one importer; "" = try all. [worker]
Result<io::ImportedScene> read_scene(const std::string& path, const plugin::Registry&, const ReadOptions&,
                                     const std::string& format = {});
// A scene file or a project, by the extension. [worker]
Result<Document> read_document(const std::string& path, const plugin::Registry&, const ReadOptions& = {});

} // namespace restage::document
