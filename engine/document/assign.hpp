// SPDX-License-Identifier: Apache-2.0
// Changes to a scene as text, "Wall paint.reflectance=0.1,0.2,0.3": for command lines.
#pragma once

#include "base/result.hpp"
#include "document/session.hpp"

#include <string>

namespace restage::document {

// "name.field=value" as one edit of the session. The name is
// - a material's (field: a parameter of its table, or `type`), an object's (material, emission, hidden,
//   catcher), a light's (value, cone_angle, cone_delta, hidden), a camera's (fov, lens_radius, focal_distance); if
//   several items share it, the first in this order that has the field is used;
// - or `film` (exposure, tone, white_balance, tint, vignette, bloom), `sky` (scale, rotation, hidden_from_camera),
// `settings` (max_depth, samples). A value is a number, three separated by commas (one stands for all three), true or
// false, a choice, the name of a texture or material, or the path of a table, depending on the field; `none` removes an
// emission. Angles in degrees, colours linear sRGB. Values follow the same rules as in every edit; errors list the
// available fields.
Result<> assign(Session&, const std::string& assignment);

} // namespace restage::document
