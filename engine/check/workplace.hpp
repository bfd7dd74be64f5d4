// SPDX-License-Identifier: Apache-2.0
// What steps that run native code of a plugin share: a folder that goes away again, noise, broken versions of a good
// file, and what of this process somebody left open.
#pragma once

#include "check/configs.hpp"

#include <filesystem>
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

// Up to 4 KiB: nothing at all, text, bytes, numbers, or `head` and then any of these. `kind` chooses.
std::string noise(Engine& e, std::size_t kind, std::string_view head = {});
// Cut short, with bytes changed, with a piece left out or twice.
std::string broken_version(Engine& e, const std::string& good, std::size_t kind);

std::size_t open_files(); // of this process; 0 where that cannot be known
// Every file below a folder, name and content, in order: whether two are the same.
std::vector<std::pair<std::string, std::string>> contents_of(const std::filesystem::path& folder);

} // namespace restage::check
