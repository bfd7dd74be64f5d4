// SPDX-License-Identifier: Apache-2.0
// A scene file as a flat list of directives: syntax checked, Include and Import resolved, nothing interpreted yet. The
// list exists because defaults depend on the version of pbrt, and possibly only the last line reveals the version.
#pragma once

#include "params.hpp"

#include <deque>

namespace restage::pbrt {

enum class Version { v3, v4 };

enum class Verb {
    accelerator,
    active_transform,
    area_light_source,
    attribute,
    attribute_begin,
    attribute_end,
    camera,
    color_space,
    concat_transform,
    coord_sys_transform,
    coordinate_system,
    film,
    identity,
    import_begin,
    import_end,
    integrator,
    light_source,
    look_at,
    make_named_material,
    make_named_medium,
    material,
    medium_interface,
    missing_file, // an Include or Import: `name` as written, `second` the path tried, `third` why it failed
    named_material,
    object_begin,
    object_end,
    object_instance,
    option,
    pixel_filter,
    reverse_orientation,
    rotate,
    sampler,
    scale,
    shape,
    texture,
    transform,
    transform_begin,
    transform_end,
    transform_times,
    translate,
    world_begin,
    world_end,
    ignored, // directives of other renderers of the family (Renderer, Volume, ...)
};

struct Directive {
    Verb verb{};
    Location at;
    std::string word;               // the directive as written
    std::string name;               // first string: "sphere", "path", the texture's name, the interior medium
    std::string second, third;      // Texture: value type and class; MediumInterface: exterior; Option: value
    std::vector<double> numbers;    // of transforms
    ParamList params;
    std::vector<std::string_view> comments; // on separate lines before it, without the '#'
    bool ours = false; // of a line `#restage ...`: a comment to pbrt
};

struct SceneFile {
    std::deque<Directive> directives; // does not move when it grows
    std::vector<Slip> slips;           // of the text, in order
    bool has_missing_file = false;
    bool has_world_begin = false, has_world_end = false;
    Location end;
};

// Parses file 0 of `sources` and what it includes; throws ImportError. `folder`: of the main file, where pbrt looks for
// everything the scene names. `goes_on` is called regularly; if it returns false, parsing stops and returns nullopt.
std::optional<SceneFile> parse(Sources& sources, const std::filesystem::path& folder,
                               const std::function<bool()>& goes_on);

// Whether there is a Sampler, Integrator or Accelerator of that name. Others are v2's, or typos; pbrt stops at them.
bool pbrt_has(Verb kind, std::string_view name, bool v3);

bool is_directive(std::string_view word);

// pbrt-v3 or v4, by features of only one of them; v4 if there is no evidence. `evidence` is one sentence of proof.
Version detect_version(const SceneFile& scene, const Sources& sources, std::string& evidence);

} // namespace restage::pbrt
