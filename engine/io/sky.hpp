// SPDX-License-Identifier: Apache-2.0
// Generates the image of a sky plugin from its parameters (restage/sky.h), with its suns drawn into it. The same values
// give the same pixels, so that projects store only the values. [any]
#pragma once

#include "base/result.hpp"
#include "io/report.hpp"
#include "io/sun_disk.hpp"
#include "plugin/registry.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace restage::io {

std::optional<plugin::SkyEntry> find_sky(const plugin::Registry&, std::string_view type);

// The value converted to the type in the sky's table. Refused: unknown ids and invalid values.
Result<> check_sky_value(const model::Sky&, std::string_view id, const scene::Value&);

// The plugin's output for one width, checked: texels are finite and not negative, suns are valid.
struct SkyPicture {
    scene::PixelData pixels; // square, equal-area octahedral
    std::vector<Sun> suns;
};
Result<SkyPicture> sky_picture(const plugin::SkyEntry&, const scene::ParamSet& values, std::uint32_t width,
                               const Progress& = {});

// The complete sky. Values that are not in the table are ignored, missing ones take their defaults. The image is 512
// texels wide, or two or four times that if its smallest sun would cover fewer than four texels.
Result<std::shared_ptr<const scene::PixelData>> make_sky(const plugin::SkyEntry&, const scene::ParamSet& values,
                                                         const Progress& = {});

// Generates the image of an environment that names a sky but has no image, or reports why that is impossible.
void make_missing_sky(scene::Scene&, const plugin::Registry&, Report&, const Progress& = {});

} // namespace restage::io
