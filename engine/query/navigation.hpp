// SPDX-License-Identifier: Apache-2.0
// Navigation: mouse control of a camera, as pure functions. Cameras look along their own +z, +y is up, +x right
// (left if mirrored); angles in radians; all in world space.
#pragma once

#include "scene/bounds.hpp"
#include "scene/scene.hpp"

#include <glm/glm.hpp>

namespace restage::query {

// The signed world axis nearest to the camera's up: orbiting keeps it upright.
glm::dvec3 guess_up(const scene::Camera&);

// Turns the camera around `pivot`: `angles.x` about `up`, `angles.y` about the camera's own x axis. It stops short of
// the poles.
void orbit(scene::Camera&, const glm::dvec3& pivot, const glm::dvec3& up, glm::dvec2 angles);
// Rotates in place.
void look(scene::Camera&, const glm::dvec3& up, glm::dvec2 angles);
// Moves along the camera's own axes [world units].
void translate_local(scene::Camera&, const glm::dvec3& by);
// Moves so that the point under `pixel` at `distance` along the view follows a drag of `delta` (in units of the film's
// height; +y down).
void pan(scene::Camera&, glm::dvec2 delta, double distance, double aspect);
// Moves towards the world point by this fraction of the distance (negative: away). An orthographic one moves across the
// view only, and its x and y axes shrink by that fraction: the point stays in place on the film.
void dolly(scene::Camera&, const glm::dvec3& towards, double part);
// Steps back along the view until the sphere around the bounds fits; keeps the direction. An orthographic camera's
// x and y axes are fitted; a spherical one goes to the centre.
void frame(scene::Camera&, const scene::Bounds&, double aspect);

// Looks at the pivot from this side (`from`: unit, away from it), as far from it as now. `up` stays up; along it, what
// was in front is.
void look_along(scene::Camera&, const glm::dvec3& pivot, const glm::dvec3& from, const glm::dvec3& up);

// The pinhole ray through a point of the film: (0,0) top left, (1,1) bottom right. `direction` has z = 1 in camera
// space, so a camera-space depth times it is a displacement; for spherical cameras it has length 1 there.
struct ViewRay {
    glm::dvec3 origin, direction;
};
ViewRay view_ray(const scene::Camera&, glm::dvec2 film, double aspect);
// A world point's position on the film, and its camera-space depth in z (behind the camera: <= 0); its distance for a
// spherical camera, which also sees behind itself.
glm::dvec3 project(const scene::Camera&, const glm::dvec3& world, double aspect);

} // namespace restage::query
