// SPDX-License-Identifier: Apache-2.0
// A sky plugin's parameters become pixels (restage/sky.h): the picture it makes, with its suns drawn into it. The same
// values give the same pixels, so that projects keep the values only. [any]
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

// The value as the sky's table has it. Refused: an id that it has not, a value that does not fit.
Result<> check_sky_value(const model::Sky&, std::string_view id, const scene::Value&);

// What the plugin gives for one width: texels judged to be finite and not negative, suns to be whole.
struct SkyPicture {
    scene::PixelData pixels; // square, equal-area octahedral
    std::vector<Sun> suns;
};
Result<SkyPicture> sky_picture(const plugin::SkyEntry&, const scene::ParamSet& values, std::uint32_t width,
                               const Progress& = {});

// The whole sky. Values that the table does not have are passed over, missing ones have its defaults. The picture is
// 512 texels wide, or twice or four times that where its smallest sun would cover fewer than four texels.
Result<std::shared_ptr<const scene::PixelData>> make_sky(const plugin::SkyEntry&, const scene::ParamSet& values,
                                                         const Progress& = {});

// Makes the image of an environment that names a sky and has none, or says in the report why it cannot be.
void make_missing_sky(scene::Scene&, const plugin::Registry&, Report&, const Progress& = {});

} // namespace restage::io
