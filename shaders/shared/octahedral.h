// SPDX-License-Identifier: Apache-2.0
// Equal-area octahedral map between the sphere and the unit square, with +z in the middle: Clarberg 2008; pbrt 4ed,
// 3.8.3, with the exact arc tangent.
#ifndef RESTAGE_SHARED_OCTAHEDRAL_H
#define RESTAGE_SHARED_OCTAHEDRAL_H
#include "shared/functions.h"

RESTAGE_SHARED_BEGIN

RESTAGE_INLINE RESTAGE_REAL3 octahedral_to_direction(RESTAGE_REAL2 p) { // unit
    RESTAGE_REAL2 uv = 2.0 * p - 1.0;
    RESTAGE_REAL2 a = abs(uv);
    RESTAGE_REAL d = 1.0 - (a.x + a.y);
    RESTAGE_REAL r = 1.0 - abs(d);
    RESTAGE_REAL phi = (r == 0.0 ? 1.0 : (a.y - a.x) / r + 1.0) * 0.78539816339744831;
    RESTAGE_REAL z = (d < 0.0 ? -1.0 : 1.0) * (1.0 - r * r);
    RESTAGE_REAL s = r * sqrt(max(0.0, 2.0 - r * r));
    return RESTAGE_REAL3((uv.x < 0.0 ? -1.0 : 1.0) * cos(phi) * s, (uv.y < 0.0 ? -1.0 : 1.0) * sin(phi) * s, z);
}
RESTAGE_INLINE RESTAGE_REAL2 direction_to_octahedral(RESTAGE_REAL3 w) { // of a unit vector
    RESTAGE_REAL3 a = abs(w);
    RESTAGE_REAL r = sqrt(max(0.0, 1.0 - a.z));
    RESTAGE_REAL hi = max(a.x, a.y);
    RESTAGE_REAL lo = min(a.x, a.y);
    RESTAGE_REAL phi = (hi == 0.0 ? 0.0 : atan(lo / hi)) * 0.63661977236758134;
    if (a.x < a.y) phi = 1.0 - phi;
    RESTAGE_REAL v = phi * r;
    RESTAGE_REAL u = r - v;
    if (w.z < 0.0) {
        RESTAGE_REAL t = u;
        u = 1.0 - v;
        v = 1.0 - t;
    }
    return 0.5 * (RESTAGE_REAL2(w.x < 0.0 ? -u : u, w.y < 0.0 ? -v : v) + 1.0);
}
// A point up to one square outside, where the map continues (pbrt 4ed, fig. 3.22).
RESTAGE_INLINE RESTAGE_REAL2 octahedral_wrap(RESTAGE_REAL2 p) {
    if (p.x < 0.0 || p.x > 1.0) p = RESTAGE_REAL2(p.x < 0.0 ? -p.x : 2.0 - p.x, 1.0 - p.y);
    if (p.y < 0.0 || p.y > 1.0) p = RESTAGE_REAL2(1.0 - p.x, p.y < 0.0 ? -p.y : 2.0 - p.y);
    return p;
}

RESTAGE_SHARED_END
#endif
