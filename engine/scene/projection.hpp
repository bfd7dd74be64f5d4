// SPDX-License-Identifier: Apache-2.0
// Mapping from world to film, shared by tracers, picking and overlays.
#pragma once

#include "scene/scene.hpp"

namespace restage::scene {

// The whole film's window x0 x1 y0 y1, y up: at camera-space z = 1; for an orthographic camera where its rays begin,
// in units of its space. `aspect`: the film's width / height. pbrt 4ed, 5.2: fov is of the shorter side; with
// fit_aspect of a frame's, and the window is the smallest enclosing it. Spherical cameras have no window; they get
// that of their fov.
glm::dvec4 film_window(const Camera&, double aspect);

// The film's crop window in pixels, x0 x1 y0 y1, y down; empty if x0 >= x1 or y0 >= y1. pbrt 4ed, 5.4.2, in floats
// as there: 0.2f of 30 is 6.
glm::uvec4 crop_window(const Film&);

// fov as in pbrt, of the shorter side of a film with that aspect [deg].
double camera_fov(const Camera&, double aspect);

inline bool is_spherical(const Camera& c) {
    return c.projection == scene::Projection::spherical || c.projection == scene::Projection::spherical_equal_area;
}

} // namespace restage::scene
