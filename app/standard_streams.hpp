// SPDX-License-Identifier: Apache-2.0
// Scenes from stdin and pictures to stdout, for pipes. As formats are read and written as files, both use a temporary
// file, which is removed when these go out of scope.
#pragma once

#include "base/result.hpp"

#include <filesystem>
#include <string>
#include <utility>

namespace restage::app {

class TemporaryFile {
  public:
    TemporaryFile() = default;
    explicit TemporaryFile(std::filesystem::path path) : path_(std::move(path)) {}
    TemporaryFile(TemporaryFile&& other) noexcept : path_(std::move(other.path_)) { other.path_.clear(); }
    TemporaryFile& operator=(TemporaryFile&&) = delete;
    ~TemporaryFile();
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_; // empty = none
};

// All of stdin as a file with this extension in the current folder, so that the scene's relative paths are valid.
Result<TemporaryFile> scene_from_stdin(const std::string& extension);

// Checks that a file can be written there, before hours are spent. "-" and "" pass.
Result<> check_file_path(const std::string& path);

// The destination of a picture. "-" and "exr:-" are stdout, "png:-" is stdout in another format; else it is a path.
class Output {
  public:
    static Result<Output> create(const std::string& text);
    const std::string& path() const { return path_; } // path to write to
    bool to_stdout() const { return !file_.path().empty(); }
    Result<> finish() const; // call after writing it

  private:
    explicit Output(std::string path) : path_(std::move(path)) {}
    explicit Output(TemporaryFile file) : file_(std::move(file)), path_(file_.path().string()) {}
    TemporaryFile file_; // of stdout
    std::string path_;
};

} // namespace restage::app
