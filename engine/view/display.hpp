// SPDX-License-Identifier: Apache-2.0
// Display: converts a frame to 8-bit pixels for viewing: the developed picture (develop.hpp), false colours for
// guides. The rendered data is unchanged.
#pragma once

#include "render/clay_look.hpp"
#include "render/film_layers.hpp"
#include "scene/scene.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace restage::view {

// What can be displayed: a film's layers (render/film_layers.hpp), by name, looks of first hits (render/clay_look.hpp),
// the relative error, the numbers of samples, and the exposure as false colours.
struct LayerChoice {
    const char *name, *label;
    const char* about; // what it shows, one sentence
};
std::span<const LayerChoice> layer_choices();
const LayerChoice& layer_choice(std::string_view name); // the picture's if there is no such layer
inline constexpr std::string_view picture_layer = "color", clay_layer = "clay", wire_layer = "wires", uv_layer = "uv",
                                  samples_layer = "samples", error_layer = "error", exposure_layer = "exposure";
// Of the layers that show first hits; none for others.
std::optional<render::ClayLook> look_of(std::string_view layer);

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

// The numbers that the ends of the colour scale stand for: distances, samples or the relative error (on a logarithmic
// scale). Equal for layers without a scale.
struct Scale {
    float dark = 0, bright = 0;
    bool logarithmic = false;
    const char* unit = "";
};
// width * height RGBA, row 0 on top. `counts`: samples of each pixel, for that layer; none = all as many. For
// times see develop(). [any]
Scale to_display(const render::FilmImage&, const DisplaySettings&, std::vector<std::uint32_t>& rgba,
                 std::span<const std::uint32_t> counts = {});
// The colour of 0..1 on such a scale.
std::uint32_t scale_color(float x);

// A transparent picture as it is usually shown: over grey squares of 8 pixels. Then all are opaque.
void over_checkers(std::uint32_t width, std::vector<std::uint32_t>& rgba);

// Outlines, `width` pixels thick, of marked objects: marks[instance id] is 0 (not; ids beyond the end too), 1 or 2
// (wins over 1), colors[mark - 1] the RGBA; else 0. False, and `rgba` empty, if nothing marked is visible. [any]
bool to_outlines(const render::FilmImage&, std::span<const std::uint8_t> marks, int width,
                 std::array<std::uint32_t, 2> colors, std::vector<std::uint32_t>& rgba);

} // namespace restage::view
