// SPDX-License-Identifier: Apache-2.0
// Display: converts a frame to 8-bit pixels for viewing: exposure and a tone curve for the picture, false colours for
// guides. The rendered data is unchanged.
#pragma once

#include "render/film_layers.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace restage::view {

enum class ToneCurve {
    srgb,   // clipped: as in a saved PNG
    filmic, // soft highlights: ACES fitted curve (Narkowicz 2016), per channel
};

// The displayable data of a film: its layers (render/film_layers.hpp), by name, and the relative error.
struct LayerChoice {
    const char *name, *label;
};
std::span<const LayerChoice> layer_choices();
inline constexpr std::string_view picture_layer = "color", error_layer = "error";

struct DisplaySettings {
    std::string_view layer = picture_layer; // one of the choices
    ToneCurve tone = ToneCurve::srgb;
    float exposure = 0; // [stops]
    float scale = 1;    // of the scene's film
};

// width * height RGBA, row 0 on top. 1280x720 takes about 5 ms on one thread. [any]
void to_display(const render::FilmImage&, const DisplaySettings&, std::vector<std::uint32_t>& rgba);

// Outlines, `width` pixels thick, of marked objects: marks[instance id] is 0 (not; ids beyond the end too), 1 or 2
// (wins over 1), colors[mark - 1] the RGBA; else 0. False, and `rgba` empty, if nothing marked is visible. [any]
bool to_outlines(const render::FilmImage&, std::span<const std::uint8_t> marks, int width,
                 std::array<std::uint32_t, 2> colors, std::vector<std::uint32_t>& rgba);

} // namespace restage::view
