// SPDX-License-Identifier: Apache-2.0
#include "source.hpp"

namespace restage::pbrt {

std::uint32_t Sources::add(std::string name, FileBytes bytes) {
    files_.push_back(std::make_unique<File>(File{std::move(name), std::move(bytes)}));
    return static_cast<std::uint32_t>(files_.size() - 1);
}

std::string to_string(const Sources& sources, Location at) {
    return sources.name(at.file) + ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
}

} // namespace restage::pbrt
