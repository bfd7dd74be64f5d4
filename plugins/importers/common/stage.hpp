// SPDX-License-Identifier: Apache-2.0
// For files with objects only: a camera that shows all of them, and a neutral studio to light them.
#pragma once

#include "common/matrix.hpp"
#include "common/report.hpp"

#include <restage/scene_io.h>

namespace restage::importing {

enum class Up { y, z };

// Columns right, up, forward: axes of the ABI's cameras (which look along +z, y up, x right) in a right-handed world,
// hence mirrored.
Matrix look_at(Vec3 eye, Vec3 target, Vec3 up);

// A camera in front of `bounds`, slightly from above and from the right, with all of it in a picture of any
// aspect. In one of 16:9 its field of view is 40 degrees.
void add_camera(const RestageSceneWriter1&, Report&, const Bounds& bounds, Up);
// A picture of 1280 x 720 pixels, or of another aspect and that area. See RestageFilm::unexposed.
void add_film(const RestageSceneWriter1&, double aspect = 16.0 / 9, bool unexposed = false);
// Grey walls, a brighter ceiling, a large soft light from the upper left in front, a weaker one behind.
void add_studio(const RestageSceneWriter1&, Report&, Up);

} // namespace restage::importing
