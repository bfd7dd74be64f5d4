// SPDX-License-Identifier: Apache-2.0
// Lights without a surface (scene/light_kinds.hpp): the unoccluded light at a point.
#ifndef RESTAGE_SHARED_LAMPS_H
#define RESTAGE_SHARED_LAMPS_H
#include "shared/functions.h"

RESTAGE_CONSTANTS_BEGIN
RESTAGE_UINT(LAMP_POINT, 0u); // scene::LightKind
RESTAGE_UINT(LAMP_SPOT, 1u);
RESTAGE_UINT(LAMP_DISTANT, 2u);
RESTAGE_CONSTANTS_END

RESTAGE_SHARED_BEGIN

struct LampRay {
    vec3 wi; // unit, towards the lamp
    float dist; // to it; 1e30 = infinitely far; 0 = the point is the lamp, which gives no light there
    float amount; // irradiance at normal incidence, in multiples of the light's value
};

// Whether its light arrives everywhere from the same direction, -axis.
RESTAGE_INLINE bool lamp_is_parallel(uint lamp) { return lamp == LAMP_DISTANT; }

// position; axis: unit, the direction of emission; cone: cosine of the edge, of where it begins to fade, and 1 =
// quartic.
RESTAGE_INLINE LampRay lamp_ray(uint lamp, vec3 position, vec3 axis, vec3 cone, vec3 p) {
    if (lamp_is_parallel(lamp)) return LampRay(-axis, 1e30f, 1.0f);
    vec3 d = position - p;
    float d2 = dot(d, d);
    if (d2 <= 0.0f) return LampRay(vec3(0), 0.0f, 0.0f);
    float dist = sqrt(d2);
    vec3 wi = d / dist;
    float amount = 1.0f / d2;
    if (lamp == LAMP_SPOT) { // pbrt 4ed, 12.2.1; quartic: pbrt 3ed, 12.3.1
        float t = clamp((-dot(axis, wi) - cone.x) / max(cone.y - cone.x, 1e-7f), 0.0f, 1.0f);
        amount *= t * t * (cone.z > 0.0f ? t * t : 3.0f - 2.0f * t);
    }
    return LampRay(wi, dist, amount);
}

RESTAGE_SHARED_END
#endif
