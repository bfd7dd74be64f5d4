// SPDX-License-Identifier: Apache-2.0
// Which side of a triangle is the outside. Its geometric normal is cross(p1 - p0, p2 - p0), transformed by the inverse
// transpose; shading normals, where there are some, say which way it points (pbrt 4ed, 6.5.3), and reverse_orientation
// turns both.
#ifndef RESTAGE_SHARED_NORMAL_H
#define RESTAGE_SHARED_NORMAL_H
#include "shared/functions.h"

RESTAGE_SHARED_BEGIN

// Is that cross product to be turned? along: its product with the shading normal, before reversal; 0 = there is none.
RESTAGE_INLINE bool points_inward(RESTAGE_REAL along, bool reversed) { return (along < 0.0) != reversed; }

RESTAGE_SHARED_END
#endif
