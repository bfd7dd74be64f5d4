// SPDX-License-Identifier: Apache-2.0
// Changes to a scene as text, "Wall paint.reflectance=0.1,0.2,0.3": for command lines.
#pragma once

#include "base/result.hpp"
#include "document/session.hpp"

#include <string>

namespace restage::document {

// "name.field=value" as one edit of the session. The name is
// - a material's (field: a parameter of its table, or `type`), an object's (material, emission, hidden), a light's
//   (value, cone_angle, cone_delta, hidden), a camera's (fov, lens_radius, focal_distance); where several things have
//   it, the first of this order that has the field is meant;
// - or `film` (exposure), `sky` (scale, rotation, hidden_from_camera), `settings` (max_depth, samples).
// A value is a number, three with commas between (one stands for all three), true or false, a choice, the name of a
// texture or material, or the path of a table, as the field wants it; `none` takes an emission away. Angles in degrees,
// colours linear sRGB. The same rules of values hold as for every edit; an error lists the fields that there are.
Result<> assign(Session&, const std::string& assignment);

} // namespace restage::document
