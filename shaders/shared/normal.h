// SPDX-License-Identifier: Apache-2.0
// The outside of a triangle. Its geometric normal is cross(p1 - p0, p2 - p0), transformed by the inverse
// transpose; shading normals, if any, decide which way it points (pbrt 4ed, 6.5.3), and reverse_orientation
// flips both.
#ifndef RESTAGE_SHARED_NORMAL_H
#define RESTAGE_SHARED_NORMAL_H
#include "shared/functions.h"

RESTAGE_SHARED_BEGIN

// Whether that cross product must be flipped. along: its product with the shading normal, before reversal; 0 = none.
RESTAGE_INLINE bool points_inward(RESTAGE_REAL along, bool reversed) { return (along < 0.0) != reversed; }

RESTAGE_SHARED_END
#endif
