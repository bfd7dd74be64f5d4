// SPDX-License-Identifier: Apache-2.0
// The kinds of lights without a surface, one row each. Project files, validation, comparison, the light meter, the
// light table, the editor, commands and Python use the row; the emission of a kind is in shaders/shared/lamps.h, shared
// by the GPU and the light meter.
#pragma once

#include <cstdint>
#include <iterator>
#include <optional>
#include <string_view>

namespace restage::scene {

enum class LightKind : std::uint8_t { point, spot, distant };

// How a spot fades over its edge, t = (cos - cos cone) / (cos(cone - delta) - cos cone) in [0,1].
enum class Falloff : std::uint8_t {
    smooth, // t^2 (3 - 2t): pbrt-v4
    quartic // t^4: pbrt-v3
};

struct Cone { // in cosines
    double edge, start; // edge of the spot; where it begins to fade
    Falloff falloff;
};

struct LightKindRow {
    LightKind kind;
    const char* id; // in project files, scripts and lists
    const char* label; // in the editor
    const char* name; // of a new one
    const char* unit; // of Light::value
    const char* shines; // its description
    const char* added; // description of a new one, in the editor
    bool placed; // the position in light_to_world is used
    bool aimed; // its +z is used
    bool cone; // cone_angle, cone_delta and falloff are used
};

// In order of LightKind.
inline constexpr LightKindRow light_kinds[] = {
    {LightKind::point, "point", "Point", "Point light", "W/sr", "Emits in all directions from a point",
     "Emits in all directions, above the middle of the picture", true, false, false},
    {LightKind::spot, "spot", "Spot", "Spot light", "W/sr", "A cone of light from a point",
     "A cone pointing down at the middle of the picture", true, true, true},
    {LightKind::distant, "distant", "Sun", "Sun", "W/m²", "Parallel rays from far away",
     "Parallel light from behind the camera", false, true, false},
};
static_assert([] {
    for (std::size_t i = 0; i < std::size(light_kinds); ++i)
        if (light_kinds[i].kind != static_cast<LightKind>(i)) return false;
    return true;
}());

constexpr const LightKindRow& light_row(LightKind kind) { return light_kinds[static_cast<std::size_t>(kind)]; }

constexpr std::optional<LightKind> light_kind(std::string_view id) { // nullopt if there is none with that id
    for (const LightKindRow& r : light_kinds)
        if (id == r.id) return r.kind;
    return std::nullopt;
}

} // namespace restage::scene
