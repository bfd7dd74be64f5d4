// SPDX-License-Identifier: Apache-2.0
// Document: what a scene file or a project file holds, read on any thread before a Session adopts it. A project is the
// scene it began with (the base), which is read anew, and the changes since.
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
#include <string>
#include <string_view>

namespace restage::document {

struct Base {
    std::string file;   // absolute; "" = the scene was made in the program, and the base is empty
    std::string format; // of the importer
    std::uint64_t hash = 0; // of the file's bytes
    scene::Scene scene; // as the importer gave it
};

// Where geometry or pixels that came from a file are to be found again: a project names them instead of holding them.
struct DataSource {
    std::string file, format; // absolute; of the importer
    std::uint32_t id = 0;     // the mesh or image in what importing the file gives
    std::string name;
};

// By identity of the shared data.
class DataSources {
  public:
    void note(const std::shared_ptr<const void>& data, DataSource source);
    void note_all(const scene::Scene& imported, const std::string& file, const std::string& format);
    void add(const DataSources& other) { by_data_.insert(other.by_data_.begin(), other.by_data_.end()); }
    const DataSource* find(const void* data) const;

  private:
    struct Held {
        std::shared_ptr<const void> data; // so that the address stays its own
        DataSource source;
    };
    std::map<const void*, Held> by_data_;
};

struct Document {
    std::string path; // of the file that was read
    Base base;
    scene::Edit changes; // from the base to what was saved; empty for a scene file
    io::Report report;   // of the base's import, and what of the changes did not fit
    DataSources sources;
    std::string unknown; // JSON: what a newer program put into a project; written back
    std::map<std::string, std::string> note; // of a recovery file, see recovery.hpp
};

enum class BaseProblem {
    none,
    missing,
    changed
}; // of a project's base, where somebody can help by naming another file

struct IsolateOptions; // isolate.hpp

struct ReadOptions {
    io::Progress progress;
    std::shared_ptr<const IsolateOptions> isolate = nullptr; // scenes are read in a process of their own
    std::filesystem::path base; // stands for the one the project names; "" = that
    bool drop_lost = false;     // changes to things the base has no more are left out and reported, not an error
    // Gives the pixels of an image that is a file; null = it has none, and that has been reported. Empty: the file is
    // read.
    std::function<Result<std::shared_ptr<const scene::PixelData>>(const scene::Image&)> pixels{};
    BaseProblem* problem = nullptr; // set when reading fails for this reason
    bool expose = true; // exposure.hpp; false where only the objects of a file are wanted
};

inline constexpr std::string_view project_extension = ".restage";
bool is_project(const std::filesystem::path& path);

// A scene file, isolated or not. `format`: of one importer; "" = ask all of them. [worker]
Result<io::ImportedScene> read_scene(const std::string& path, const plugin::Registry&, const ReadOptions&,
                                     const std::string& format = {});
// A scene file or a project, by the extension. [worker]
Result<Document> read_document(const std::string& path, const plugin::Registry&, const ReadOptions& = {});

} // namespace restage::document
