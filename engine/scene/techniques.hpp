// SPDX-License-Identifier: Apache-2.0
// Names of scene::Technique in files, on the command line, in Python and in the Rendering panel.
#pragma once

#include "scene/scene.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace restage::scene {

inline constexpr std::array technique_names{"auto", "on", "off"}; // in the order of Technique

constexpr const char* technique_name(Technique t) { return technique_names[std::size_t(t)]; }

constexpr std::optional<Technique> find_technique(std::string_view name) {
    const auto at = std::ranges::find(technique_names, name, [](const char* n) { return std::string_view(n); });
    return at == technique_names.end() ? std::nullopt : std::optional(Technique(at - technique_names.begin()));
}

} // namespace restage::scene
