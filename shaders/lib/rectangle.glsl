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
    vec3 corner;       // (x0, y0, z0), and the unit edges, in world space
    vec3 x, y;
    vec4 lengths;      // to the corners (x0, y0), (x1, y0), (x0, y1), (x1, y1)
};

// That of two triangles, each by Van Oosterom and Strackee 1983: the sum of two arc tangents.
float rectangle_angle(RectangleView v) {
    vec4 l = v.lengths;
    float volume = -v.z0 * (v.x1 - v.x0) * (v.y1 - v.y0), z2 = v.z0 * v.z0;
    float xx = v.x0 * v.x1, yy = v.y0 * v.y1, x00 = v.x0 * v.x0, x11 = v.x1 * v.x1, y00 = v.y0 * v.y0, y11 = v.y1 * v.y1;
    float across = xx + yy + z2; // of opposite corners
    float d1 = l.x * l.y * l.w + (xx + y00 + z2) * l.w + (x11 + yy + z2) * l.x + across * l.y;
    float d2 = l.x * l.w * l.z + across * l.z + (xx + y11 + z2) * l.x + (x00 + yy + z2) * l.w;
    vec3 s = vec3(volume, d1, d2) / max(volume + abs(d1) + abs(d2), 1e-37);
    return 2.0 * atan(s.x * (s.y + s.z), s.y * s.z - s.x * s.x);
}

vec4 rectangle_lengths(RectangleView v) {
    vec4 x = vec4(v.x0, v.x1, v.x0, v.x1), y = vec4(v.y0, v.y0, v.y1, v.y1);
    return sqrt(x * x + y * y + v.z0 * v.z0);
}

// corner, and edges at a right angle; as seen from p.
RectangleView rectangle_view(vec3 corner, vec3 b, vec3 c, vec3 p) {
    RectangleView v;
    v.corner = corner - p;
    float lx = length(b), ly = length(c);
    v.x = b / lx;
    v.y = c / ly;
    v.z0 = -abs(dot(v.corner, cross(v.x, v.y)));
    v.x0 = dot(v.corner, v.x);
    v.y0 = dot(v.corner, v.y);
    v.x1 = v.x0 + lx;
    v.y1 = v.y0 + ly;
    v.lengths = rectangle_lengths(v);
    v.solid_angle = rectangle_angle(v);
    return v;
}

// What light from its corners, in the order of `lengths`, gives a surface with normal n there: times some factor
// max(|cos|, RECEIVED_LEAST), without four divisions.
vec4 rectangle_corners(RectangleView v, vec3 n) {
    // n . q = q.x along.x + q.y along.y + k for all points q of the rectangle
    vec2 along = vec2(dot(n, v.x), dot(n, v.y));
    float k = dot(n, v.corner) - dot(along, vec2(v.x0, v.y0));
    vec4 x = vec4(v.x0, v.x1, v.x0, v.x1), y = vec4(v.y0, v.y0, v.y1, v.y1);
    vec3 r = v.lengths.yzw / max(v.lengths.x, 1e-37);
    vec4 others = vec4(r.x * r.y * r.z, r.y * r.z, r.x * r.z, r.x * r.y);
    return max(abs(x * along.x + y * along.y + k), RECEIVED_LEAST * v.lengths) * others;
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
    RectangleView up_to_x = v;
    up_to_x.x1 = x;
    up_to_x.lengths = rectangle_lengths(up_to_x);
    float part = rectangle_angle(up_to_x);
    float d2 = x * x + v.z0 * v.z0;
    float h0 = v.y0 * inversesqrt(d2 + v.y0 * v.y0), h1 = v.y1 * inversesqrt(d2 + v.y1 * v.y1);
    return clamp(vec2(part / v.solid_angle, (y * inversesqrt(d2 + y * y) - h0) / (h1 - h0)), 0.0, 1.0);
}

#endif
