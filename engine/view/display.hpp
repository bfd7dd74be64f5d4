// SPDX-License-Identifier: Apache-2.0
// Display: converts a frame to 8-bit pixels for viewing: the developed picture (develop.hpp), false colours for
// guides. The rendered data is unchanged.
#pragma once

#include "render/film_layers.hpp"
#include "scene/scene.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace restage::view {

// The displayable data of a film: its layers (render/film_layers.hpp), by name, the relative error, and the exposure as
// false colours.
struct LayerChoice {
    const char *name, *label;
};
std::span<const LayerChoice> layer_choices();
inline constexpr std::string_view picture_layer = "color", error_layer = "error", exposure_layer = "exposure";

struct DisplaySettings {
    std::string_view layer = picture_layer; // one of the choices
    float exposure = 0; // [stops]
    float scale = 1; // the exposure of the scene's film
    scene::Development development; // its, too
    bool operator==(const DisplaySettings&) const = default;
};

// False colours of the exposure, as in film cameras: luminance in whole stops from middle grey (0.18), exposed but not
// developed; and what the development cuts off: black if all channels are 0, white if one is 255.
struct ExposureZone {
    const char* label; // "+2", "White"
    std::uint32_t color; // RGBA
};
std::span<const ExposureZone> exposure_zones(); // from black up

// width * height RGBA, row 0 on top; for times see develop(). [any]
void to_display(const render::FilmImage&, const DisplaySettings&, std::vector<std::uint32_t>& rgba);

// A transparent picture as it is usually shown: over grey squares of 8 pixels. Then all are opaque.
void over_checkers(std::uint32_t width, std::vector<std::uint32_t>& rgba);

// Outlines, `width` pixels thick, of marked objects: marks[instance id] is 0 (not; ids beyond the end too), 1 or 2
// (wins over 1), colors[mark - 1] the RGBA; else 0. False, and `rgba` empty, if nothing marked is visible. [any]
bool to_outlines(const render::FilmImage&, std::span<const std::uint8_t> marks, int width,
                 std::array<std::uint32_t, 2> colors, std::vector<std::uint32_t>& rgba);

} // namespace restage::view
