// SPDX-License-Identifier: Apache-2.0
// Sampling a triangle uniformly by solid angle. Arvo 1995, "Stratified Sampling of Spherical Triangles"; written with half
// vectors instead of angles (after Peters 2021, "BRDF Importance Sampling for Polygonal Lights", sec. 4) and with chords
// instead of cosines, so that small triangles lose no bits.
#ifndef RESTAGE_LIB_TRIANGLE
#define RESTAGE_LIB_TRIANGLE
#include "lib/bilinear.glsl"
#include "lib/receiver.glsl"

// Smaller ones look almost the same from everywhere on them, and larger ones are seen from almost their own plane: there
// they are sampled uniformly over the area.
const float TRIANGLE_LEAST = 1e-2, TRIANGLE_MOST = 6.22;

// A triangle as a point sees it.
struct TriangleView {
    vec3 v0, v1, v2; // unit, towards its corners
    vec3 inverse;    // of the distances to them
    float g0, g1, g2; // tan(half the solid angle) = g0 / (g1 + g2)
    float solid_angle;
};

TriangleView triangle_view(vec3 corner, vec3 b, vec3 c, vec3 p) {
    TriangleView v;
    vec3 d0 = corner - p, d1 = d0 + b, d2 = d0 + c;
    v.inverse = inversesqrt(max(vec3(dot(d0, d0), dot(d1, d1), dot(d2, d2)), 1e-37));
    v.v0 = d0 * v.inverse.x;
    v.v1 = d1 * v.inverse.y;
    v.v2 = d2 * v.inverse.z;
    v.g0 = abs(dot(d0, cross(b, c))) * v.inverse.x * v.inverse.y * v.inverse.z;
    v.g1 = dot(v.v0 + v.v1, v.v2);
    v.g2 = 1.0 + dot(v.v0, v.v1);
    v.solid_angle = 2.0 * atan(v.g0, v.g1 + v.g2);
    return v;
}

bool triangle_by_angle(TriangleView v) { return v.solid_angle >= TRIANGLE_LEAST && v.solid_angle <= TRIANGLE_MOST; }

// What light from its corners gives a surface with normal n there: at (0, 0), (1, 0), (0, 1), (1, 1) of the numbers of
// triangle_sample.
vec4 triangle_corners(TriangleView v, vec3 n) {
    float apex = dot(n, v.v1);
    return max(abs(vec4(apex, apex, dot(n, v.v0), dot(n, v.v2))), RECEIVED_LEAST);
}

float chord2(vec3 a, vec3 b) { return dot(a - b, a - b); } // 2 - 2 cos

// The place along both edges. u.x: the part of the solid angle up to an arc from v1 to a point of the arc from v0 to v2;
// u.y: a place on that arc, from v1.
vec2 triangle_sample(TriangleView v, vec2 u) {
    float part = 0.5 * u.x * v.solid_angle, c = cos(part), s = sin(part);
    // The half vector of v0 and that point, and the point: k0 v0 + k2 v2
    float h0 = max(v.g0 * c - v.g1 * s, 0.0), h2 = v.g2 * s;
    vec3 h = h0 * v.v0 + h2 * v.v2;
    float twice = 2.0 * dot(v.v0, h) / max(dot(h, h), 1e-37);
    float k0 = twice * h0 - 1.0, k2 = twice * h2;
    float e = 0.5 * chord2(v.v1, k0 * v.v0 + k2 * v.v2);
    float t = sqrt(u.y * (2.0 - u.y * e) / max(2.0 - e, 1e-6));
    // Of all corners, then per distance: barycentric
    vec3 weights = max(vec3(t * k0, 1.0 - u.y * e - t * (1.0 - e), t * k2), 0.0) * v.inverse;
    return weights.yz / max(weights.x + weights.y + weights.z, 1e-37);
}

// Its inverse: the numbers that lead to this place.
vec2 triangle_invert(TriangleView v, vec2 place) {
    vec3 at = vec3(max(1.0 - place.x - place.y, 0.0), place) / v.inverse; // of the corners' directions
    vec3 end = at.x * v.v0 + at.z * v.v2;
    float size = length(end);
    if (size <= 0.0) return vec2(0.5, 0.0);
    end /= size;
    float part = 2.0 * atan(v.g0 * at.z / size, 1.0 + dot(v.v0, v.v1) + dot(v.v0 + v.v1, end));
    vec3 way = normalize(size * end + at.y * v.v1);
    return clamp(vec2(part / v.solid_angle, chord2(v.v1, way) / max(chord2(v.v1, end), 1e-37)), 0.0, 1.0);
}

#endif
