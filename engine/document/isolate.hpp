// SPDX-License-Identifier: Apache-2.0
// Reading a scene in a separate process: for untrusted files. A crash, hang or memory exhaustion
// there, in an importer or a library it uses, is an error here. The child runs `restage import-child`, which passes
// the scene back as a self-contained project and, as plain numbers in separate files, the images that the scene names
// by path: these too are decoded in the child, within its limits.
#pragma once

#include "io/import.hpp"

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace restage::document {

struct IsolateOptions {
    std::filesystem::path program; // restage
    std::vector<std::string> arguments; // of the program, before the command: --plugin-path
    std::chrono::seconds time_limit{300};
    std::uint64_t memory_limit = std::uint64_t(4) << 30; // bytes of address space
};

// [worker] Errors: the importer's own; "scene.obj: reading it crashed (SIGSEGV ...); nothing was imported".
Result<io::ImportedScene> import_isolated(const std::string& path, const plugin::Registry& registry,
                                          const IsolateOptions& options, const io::ImportOptions& reading = {});

// The child's part: imports `path` and writes `out`. Progress goes to stdout, one line "0.25 meshes" each. [main]
// `reading`: its format, and its values as text.
Result<> import_child(const std::string& path, const std::string& out, const plugin::Registry& registry,
                      io::ImportOptions reading = {});

} // namespace restage::document
