// SPDX-License-Identifier: Apache-2.0
// Scenes from stdin and pictures to stdout, for pipes. Formats are read and written as files, so both are stored in a
// file meanwhile, which is removed when these go out of scope.
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

// All of stdin as a file of this extension in the current folder, so that the scene's own relative paths hold there.
Result<TemporaryFile> scene_from_stdin(const std::string& extension);

// Before hours are spent: can a file be written there at all? "-" and "" pass.
Result<> check_file_path(const std::string& path);

// Where a picture is written. "-" and "exr:-" are stdout, "png:-" stdout in another format; else it is a path.
class Output {
  public:
    static Result<Output> create(const std::string& text);
    const std::string& path() const { return path_; } // to write to
    bool to_stdout() const { return !file_.path().empty(); }
    Result<> finish() const; // after it was written

  private:
    explicit Output(std::string path) : path_(std::move(path)) {}
    explicit Output(TemporaryFile file) : file_(std::move(file)), path_(file_.path().string()) {}
    TemporaryFile file_; // of stdout
    std::string path_;
};

} // namespace restage::app
