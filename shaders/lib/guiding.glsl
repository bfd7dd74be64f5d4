// SPDX-License-Identifier: Apache-2.0
// Directions from the guide of paths, and their density. Invariant 5 of ARCHITECTURE.md: both are of one histogram.
#ifndef RESTAGE_LIB_GUIDING
#define RESTAGE_LIB_GUIDING
#include "shared/guiding_data.h"
#include "shared/octahedral.h"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer GuidingRef { GuidingData guiding; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer GuidingNodes { GuidingNode at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer GuidingLeaves { GuidingLeaf at[]; };

// The leaf of a point with this normal, on the side of wo. As many steps for all: a leaf leads to itself.
uint guiding_leaf(GuidingData guiding, vec3 p, vec3 n) {
    uint node = 0u;
    for (uint k = 0u; k < guiding.depth; ++k) {
        GuidingNode at = GuidingNodes(guiding.nodes).at[node];
        vec3 v = at.axis < 3u ? p : n;
        uint axis = at.axis < 3u ? at.axis : at.axis - 3u;
        float x = axis == 0u ? v.x : axis == 1u ? v.y : v.z;
        node = at.next + (x >= at.split ? 1u : 0u);
    }
    return GuidingNodes(guiding.nodes).at[node].leaf;
}

// Per solid angle. w: unit
float guiding_density(GuidingData guiding, uint leaf, vec3 w) {
    uvec2 cell = min(uvec2(direction_to_octahedral(w) * float(GUIDING_SIDE)), uvec2(GUIDING_SIDE - 1u));
    return GuidingLeaves(guiding.leaves).at[leaf].density[cell.y * GUIDING_SIDE + cell.x];
}

// u.y chooses the row, u.x the cell in it; what is left of both the place in the cell, so that points keep their order.
vec3 guiding_direction(GuidingData guiding, uint leaf, vec2 u) {
    GuidingLeaves leaves = GuidingLeaves(guiding.leaves);
    uint row = 0u, column = 0u;
    for (uint step_ = GUIDING_SIDE / 2u; step_ > 0u; step_ /= 2u)
        if (u.y >= leaves.at[leaf].rows[row + step_ - 1u]) row += step_;
    uint base = row * GUIDING_SIDE;
    for (uint step_ = GUIDING_SIDE / 2u; step_ > 0u; step_ /= 2u)
        if (u.x >= leaves.at[leaf].columns[base + column + step_ - 1u]) column += step_;
    float row_start = leaves.at[leaf].rows[max(row, 1u) - 1u], row_end = leaves.at[leaf].rows[row];
    float start = leaves.at[leaf].columns[base + max(column, 1u) - 1u], end = leaves.at[leaf].columns[base + column];
    if (row == 0u) row_start = 0.0;
    if (column == 0u) start = 0.0;
    vec2 within = vec2((u.x - start) / max(end - start, 1e-12), (u.y - row_start) / max(row_end - row_start, 1e-12));
    vec2 cell = vec2(column, row) + clamp(within, vec2(0), vec2(0.999999));
    return octahedral_to_direction(cell * (1.0 / float(GUIDING_SIDE)));
}

#endif
