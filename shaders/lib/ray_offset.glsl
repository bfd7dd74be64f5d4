// SPDX-License-Identifier: Apache-2.0
// Ray origins that cannot hit the surface they leave: the offset bounds the rounding of every step from barycentrics
// to a world-space point and back into the triangle's object space, where intersection happens. No scene epsilon.
// Error analysis: pbrt 4ed, 6.8; Higham 2002, ch. 3; the constants for a two-level hierarchy follow Woop et al. 2013 and
// NVIDIA, "Solving Self-Intersection Artifacts in DirectX Raytracing" (2023).
#ifndef RESTAGE_LIB_RAY_OFFSET
#define RESTAGE_LIB_RAY_OFFSET

const float EPS = 5.9604645e-8; // 2^-24, half an ulp at 1

// The intersector's plane: 4 roundings of each component of the edges' cross product tilt it about a corner; but for
// slivers this is no more than 3 of the edges. Nothing, if the triangle lies along two axes. In units of EPS, along the
// normal; d: from the corner to the point.
float plane_tilt(vec3 e1, vec3 e2, vec3 d) {
    vec3 extent = abs(e1) + abs(e2);
    vec3 products = abs(e1.yzx * e2.zxy) + abs(e1.zxy * e2.yzx);
    float tilt = 4.0 * dot(abs(d), products) / max(length(cross(e1, e2)), 1e-37);
    return min(tilt, 3.0 * max(extent.x, max(extent.y, extent.z)));
}

// Distance along the unit geometric normal that keeps a ray off the triangle.
//   p0, e1, e2: the triangle in object space; p: the point there; w: in world space
//   m: object to world; n: unit world normal; nw: transposed inverse of m's linear part (rows of the inverse)
//   world_copy: 1 if rays meet a copy of the triangle in world space, else 0
float ray_offset(vec3 p0, vec3 e1, vec3 e2, vec3 p, vec3 w, mat4x3 m, mat3 nw, vec3 n, float world_copy) {
    vec3 extent = abs(e1) + abs(e2);
    float tilt = plane_tilt(e1, e2, p - p0);
    // To world: gamma(3) of the products, 2 eps of the translation.
    mat3 lin = mat3(m[0], m[1], m[2]);
    mat3 abs_lin = mat3(abs(m[0]), abs(m[1]), abs(m[2]));
    vec3 world_error = 3.0 * EPS * (abs_lin * abs(p)) + 2.0 * EPS * abs(m[3]);
    // Back to object space, as the intersector does for the origin: |inv| * |w| and |inv * t|, gamma(3) of the products
    // and as much again for the entries of its own inverse, computed in floats.
    mat3 abs_nw = mat3(abs(nw[0]), abs(nw[1]), abs(nw[2]));
    vec3 object_error = EPS * abs(p0) + 6.0 * EPS * ((abs(w) + abs(m[3])) * abs_nw); // v * M = transpose(M) * v
    // All bounds, along n. An object-space error e moves the point by lin*e, hence along n by dot(n*lin, e), and a plane
    // by |n*lin| times its move along its normal. Interpolation: 3 roundings on the edges' extent, 1 on the sum with p0.
    vec3 along = abs(n * lin);
    float edges = EPS * max(3.0 * dot(along, extent), tilt * length(along));
    if (world_copy > 0.0) {
        // The copy's corners are rounded once: EPS of w, which object_error has to spare, as nothing is transformed back,
        // and of their distance from w, the edges. Each corner minus the origin is rounded, too, and their product
        // with the normal has 3 roundings: together 5 of the edges.
        vec3 w1 = lin * e1, w2 = lin * e2;
        edges += EPS * (5.0 * dot(abs(n), abs(w1) + abs(w2)) + plane_tilt(w1, w2, lin * (p - p0)));
    }
    return dot(abs(n), world_error) + dot(along, object_error) + edges;
}

// pushes p off the plane, to the side of d, and one ulp further so that rounding of the sum cannot undo it
vec3 offset_origin(vec3 p, vec3 n, float offset, vec3 d) {
    vec3 step = dot(d, n) < 0.0 ? -offset * n : offset * n;
    vec3 q = p + step;
    // Next float away, componentwise, for components that move. Signs by their bits: a conversion to int takes lavapipe
    // several instructions per lane.
    ivec3 up = 1 - 2 * ((floatBitsToInt(step) ^ floatBitsToInt(q)) >> 31 & 1);
    vec3 r = intBitsToFloat(floatBitsToInt(q) + up);
    r = mix(q, r, notEqual(step, vec3(0)));
    return mix(q, r, greaterThan(abs(q), vec3(1e-30))); // not tiny ones
}

#endif
