// SPDX-License-Identifier: Apache-2.0
// Names of scene::ToneCurve and Backdrop in files, on the command line, in Python, and in the editor; and the
// development that applies to a scene's picture.
#pragma once

#include "scene/scene.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace restage::scene {

struct ToneCurveRow {
    const char *name, *label, *tooltip;
};
inline constexpr std::array tone_curves{
                                         // in the order of ToneCurve
    ToneCurveRow{"srgb", "Standard", "Colours as they are, up to white, where they are cut off"},
    ToneCurveRow{"filmic", "Filmic", "High contrast, soft highlights; bright colours turn to other hues"},
    ToneCurveRow{"agx", "AgX", "Low contrast, very soft highlights; bright colours fade to white, as on film"},
    ToneCurveRow{"neutral", "Neutral", "Colours as they are, as far as possible; only highlights are compressed"}};

inline constexpr auto tone_names = [] {
    std::array<const char*, tone_curves.size()> names{};
    std::ranges::transform(tone_curves, names.begin(), &ToneCurveRow::name);
    return names;
}();

inline constexpr std::array backdrop_names{"black", "color", "transparent"}; // in the order of Backdrop

constexpr const char* tone_name(ToneCurve t) { return tone_names[std::size_t(t)]; }

constexpr std::optional<ToneCurve> find_tone(std::string_view name) {
    const auto at = std::ranges::find(tone_names, name, [](const char* n) { return std::string_view(n); });
    return at == tone_names.end() ? std::nullopt : std::optional(ToneCurve(at - tone_names.begin()));
}

// The film's; a visible sky leaves no room for a backdrop.
inline Development development_of(const Scene& scene) {
    Development d = scene.film.value.development;
    if (const auto& sky = scene.environment.value; sky && !sky->hidden_from_camera) d.backdrop = Backdrop::black;
    return d;
}

} // namespace restage::scene
