// SPDX-License-Identifier: Apache-2.0
// Sampling a rectangle uniformly by solid angle. Urena et al. 2013, "An Area-Preserving Parametrization for Spherical
// Rectangles"; written without inverse cosines, which lose most of their bits for small rectangles.
#ifndef RESTAGE_LIB_RECTANGLE
#define RESTAGE_LIB_RECTANGLE
#include <restage/v1/bsdf.glsl>
#include "lib/bilinear.glsl"
#include "lib/receiver.glsl"

// Smaller ones look almost the same from everywhere on them: uniform over the area is as good, and more precise.
const float RECTANGLE_LEAST = 1e-2;

// A rectangle in a frame around the point that sees it: from (x0, y0, z0) to (x1, y1, z0), z0 < 0.
struct RectangleView {
    float x0, y0, x1, y1, z0;
    float solid_angle; // 0 if seen from its own plane
};

float rectangle_angle(vec3 a, vec3 b, vec3 c, float volume) { // of a triangle: Van Oosterom and Strackee 1983
    float la = length(a), lb = length(b), lc = length(c);
    return 2.0 * atan(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

// corner, and edges at a right angle; as seen from p.
RectangleView rectangle_view(vec3 corner, vec3 b, vec3 c, vec3 p) {
    RectangleView v;
    vec3 d = corner - p;
    float lx = length(b), ly = length(c);
    vec3 x = b / lx, y = c / ly;
    v.z0 = -abs(dot(d, cross(x, y)));
    v.x0 = dot(d, x);
    v.y0 = dot(d, y);
    v.x1 = v.x0 + lx;
    v.y1 = v.y0 + ly;
    vec3 v00 = vec3(v.x0, v.y0, v.z0), v10 = vec3(v.x1, v.y0, v.z0);
    vec3 v01 = vec3(v.x0, v.y1, v.z0), v11 = vec3(v.x1, v.y1, v.z0);
    float volume = -v.z0 * lx * ly;
    v.solid_angle = rectangle_angle(v00, v10, v11, volume) + rectangle_angle(v00, v11, v01, volume);
    return v;
}

// What its corners contribute to a surface there: at (x0, y0), (x1, y0), (x0, y1), (x1, y1).
vec4 rectangle_corners(RectangleView v, vec3 corner, vec3 b, vec3 c, Receiver to) {
    // n . q = q.x n.x + q.y n.y + k for all points q of the rectangle, relative to the point
    vec2 n = vec2(dot(to.n, b) / (v.x1 - v.x0), dot(to.n, c) / (v.y1 - v.y0));
    float k = dot(to.n, corner - to.p) - dot(n, vec2(v.x0, v.y0));
    vec4 x = vec4(v.x0, v.x1, v.x0, v.x1), y = vec4(v.y0, v.y0, v.y1, v.y1);
    return received((x * n.x + y * n.y + k) * inversesqrt(x * x + y * y + v.z0 * v.z0));
}

// The place along both edges, within [0, 1], for solid_angle > 0.
vec2 rectangle_sample(RectangleView v, vec2 u) {
    float z2 = v.z0 * v.z0;
    // z of the unit normals of the planes through the point and an edge: at y0, x1, y1, x0
    float n0 = -v.y0 * inversesqrt(z2 + v.y0 * v.y0), n1 = v.x1 * inversesqrt(z2 + v.x1 * v.x1);
    float n2 = v.y1 * inversesqrt(z2 + v.y1 * v.y1), n3 = -v.x0 * inversesqrt(z2 + v.x0 * v.x0);
    // The angles at the two corners of x0: their cosines, and of their sum
    float c2 = -n2 * n3, c3 = -n3 * n0;
    float s2 = sqrt(max(0.0, 1.0 - c2 * c2)), s3 = sqrt(max(0.0, 1.0 - c3 * c3));
    float cos_k = c2 * c3 - s2 * s3, sin_k = -(s2 * c3 + c2 * s3);
    // The part of the solid angle up to x
    float part = u.x * v.solid_angle, cos_p = cos(part), sin_p = sin(part);
    float cos_a = cos_p * cos_k - sin_p * sin_k, sin_a = sin_p * cos_k + cos_p * sin_k;
    float f = (cos_a * n0 - n2) / sin_a;
    float cu = inversesqrt(f * f + n0 * n0) * (f > 0.0 ? 1.0 : -1.0);
    cu = clamp(cu, -1.0, 1.0);
    float x = clamp(-cu * v.z0 / sqrt(max(1.0 - cu * cu, 1e-12)), v.x0, v.x1);
    float d2 = x * x + z2;
    float h0 = v.y0 * inversesqrt(d2 + v.y0 * v.y0), h1 = v.y1 * inversesqrt(d2 + v.y1 * v.y1);
    float h = mix(h0, h1, u.y);
    float y = clamp(h * sqrt(d2 / max(1.0 - h * h, 1e-12)), v.y0, v.y1);
    return vec2((x - v.x0) / (v.x1 - v.x0), (y - v.y0) / (v.y1 - v.y0));
}

// Its inverse: the numbers that lead to this place.
vec2 rectangle_invert(RectangleView v, vec2 place) {
    float x = mix(v.x0, v.x1, place.x), y = mix(v.y0, v.y1, place.y);
    vec3 v00 = vec3(v.x0, v.y0, v.z0), v10 = vec3(x, v.y0, v.z0), v01 = vec3(v.x0, v.y1, v.z0), v11 = vec3(x, v.y1, v.z0);
    float volume = -v.z0 * (x - v.x0) * (v.y1 - v.y0);
    float part = rectangle_angle(v00, v10, v11, volume) + rectangle_angle(v00, v11, v01, volume);
    float d2 = x * x + v.z0 * v.z0;
    float h0 = v.y0 * inversesqrt(d2 + v.y0 * v.y0), h1 = v.y1 * inversesqrt(d2 + v.y1 * v.y1);
    return clamp(vec2(part / v.solid_angle, (y * inversesqrt(d2 + y * y) - h0) / (h1 - h0)), 0.0, 1.0);
}

#endif
