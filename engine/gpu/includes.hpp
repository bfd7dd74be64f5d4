// SPDX-License-Identifier: Apache-2.0
// Private to gpu/: expands #include and #pragma once into one text with #line directives, so that the compiler's
// messages map back to the original file and line, and so that one hash covers everything compiled.
#pragma once

#include "gpu/compiler.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace restage::gpu {

struct ExpandedSource {
    std::string text;
    std::vector<std::string> names; // "source string number" of #line and of messages -> file name as shown
    std::vector<std::filesystem::path> files; // those on disk
    // Errors in includes, or in what a plugin's file uses. The text says "#error
    // RESTAGE_SOURCE_ERROR_<index>_", because the compiler tokenizes messages.
    std::vector<std::string> errors;
};

// Never fails: a failed include becomes an #error in its place, which matters only if that place is compiled.
ExpandedSource expand_includes(const ShaderSource& source, std::span<const std::filesystem::path> include_dirs);

} // namespace restage::gpu
