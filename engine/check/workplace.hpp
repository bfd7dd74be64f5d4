// SPDX-License-Identifier: Apache-2.0
// Shared by steps that run a plugin's native code: a temporary folder, noise, broken versions of a good
// file, and resources of this process that a plugin leaks.
#pragma once

#include "base/result.hpp"
#include "check/configs.hpp"
#include "check/step.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace restage::check {

struct TemporaryFolder {
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::filesystem::path path;
};

// Up to 4 KiB: empty, text, bytes, numbers, or `head` followed by any of these. `kind` selects.
std::string noise(Engine& e, std::size_t kind, std::string_view head = {});
// Truncated, with bytes changed, with a piece removed or duplicated.
std::string broken_version(Engine& e, const std::string& good, std::size_t kind);

std::size_t open_files(); // of this process; 0 if unknown
// Of this process; 0 if unknown: then it is not compared.
struct Resources {
    std::size_t resident = 0, heap = 0; // bytes; heap: allocated by malloc and not freed
    std::size_t mappings = 0, files = 0, threads = 0;
};
Resources resources();
// Runs `once` 20 times, then 100 times more, which must not leak. An error of `once` is a failure.
Result<StepResult> check_nothing_left(const std::string& what, const std::function<Result<>()>& once);

// Without the flush to disk that write_file_atomic waits for: for files that are read once.
Result<> write_scratch(const std::filesystem::path&, std::string_view bytes);
// Every file below a folder, name and content, sorted: to compare two folders.
using Contents = std::vector<std::pair<std::string, std::string>>;
Contents contents_of(const std::filesystem::path& folder);
// "" or the first that differs: "scene.obj:12: v 0 0 1".
std::string first_difference(const Contents& before, const Contents& after);

} // namespace restage::check
