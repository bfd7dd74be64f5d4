// SPDX-License-Identifier: Apache-2.0
// Spheres, disks and cylinders in object space: intersection, (u, v) and tangents as in pbrt (4ed, 6.2-6.4), and
// sampling them as lights. Every tracer transforms rays from world space by the same matrices, so that the bounds of
// rounding hold (ray_offset.glsl).
#ifndef RESTAGE_LIB_QUADRIC
#define RESTAGE_LIB_QUADRIC
#include <restage/v1/bsdf.glsl>
#include <restage/v1/frame.glsl>
#include "lib/ray_offset.glsl"
#include <restage/v1/sampling.glsl>
#include "lib/scene.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer QuadricRef { QuadricData data; };

QuadricData quadric_of(InstanceData inst) { return QuadricRef(inst.positions).data; }

vec3 to_object(InstanceData inst, vec3 w) { return (w - inst.object_to_world[3]) * inst.normal_to_world; } // v * M = transpose(M) * v
vec3 to_object_direction(InstanceData inst, vec3 w) { return w * inst.normal_to_world; }
mat3 linear_part(InstanceData inst) { return mat3(inst.object_to_world[0], inst.object_to_world[1], inst.object_to_world[2]); }

// Projects a nearby point onto the surface; the error is a few ulps. pbrt 4ed, 6.8.5.
vec3 quadric_refine(QuadricData q, vec3 p) {
    if (q.kind == QUADRIC_SPHERE) return p * (q.radius / max(length(p), 1e-30));
    if (q.kind == QUADRIC_DISK) return vec3(p.xy, q.z_min);
    return vec3(p.xy * (q.radius / max(length(p.xy), 1e-30)), p.z);
}

float quadric_turn(vec3 p) { // angle about z, in [0, 2 pi)
    float phi = p.x == 0.0 && p.y == 0.0 ? 0.0 : atan(p.y, p.x);
    return phi < 0.0 ? phi + TWO_PI : phi;
}

vec2 quadric_uv(QuadricData q, vec3 p) {
    float u = quadric_turn(p) / q.phi_max;
    if (q.kind == QUADRIC_DISK) return vec2(u, (q.radius - length(p.xy)) / (q.radius - q.inner));
    if (q.kind == QUADRIC_CYLINDER) return vec2(u, (p.z - q.z_min) / (q.z_max - q.z_min));
    float theta = atan(length(p.xy), p.z); // acos is coarse at the poles
    return vec2(u, (theta - q.theta_min) / (q.theta_max - q.theta_min));
}

vec3 quadric_at(QuadricData q, vec2 uv) { // the point with these (u, v)
    float phi = uv.x * q.phi_max;
    vec2 around = vec2(cos(phi), sin(phi));
    if (q.kind == QUADRIC_DISK) return vec3(mix(q.radius, q.inner, uv.y) * around, q.z_min);
    if (q.kind == QUADRIC_CYLINDER) return vec3(q.radius * around, mix(q.z_min, q.z_max, uv.y));
    float theta = mix(q.theta_min, q.theta_max, uv.y);
    return q.radius * vec3(sin(theta) * around, cos(theta));
}

vec3 quadric_normal(QuadricData q, vec3 p) { // unit, dp/du x dp/dv
    if (q.kind == QUADRIC_DISK) return vec3(0, 0, 1);
    return q.kind == QUADRIC_SPHERE ? p / q.radius : vec3(p.xy / q.radius, 0.0);
}

void quadric_tangents(QuadricData q, vec3 p, out vec3 dpdu, out vec3 dpdv) {
    float r = length(p.xy);
    vec2 around = r > 0.0 ? p.xy / r : vec2(1, 0);
    dpdu = q.phi_max * max(r, 1e-6 * q.radius) * vec3(-around.y, around.x, 0.0); // at the poles: only its direction
    if (q.kind == QUADRIC_DISK) dpdv = vec3(around * (q.inner - q.radius), 0.0);
    else if (q.kind == QUADRIC_CYLINDER) dpdv = vec3(0, 0, q.z_max - q.z_min);
    else dpdv = (q.theta_max - q.theta_min) * vec3(p.z * around, -r);
}

// Whether this point of the complete quadric is within its bounds.
bool quadric_has(QuadricData q, vec3 p) {
    if (q.kind == QUADRIC_DISK) {
        float r = length(p.xy);
        if (r > q.radius || r < q.inner) return false;
    } else if (q.kind == QUADRIC_CYLINDER || q.whole == 0u) {
        if (q.z_min > (q.kind == QUADRIC_SPHERE ? -q.radius : -1e38) && p.z < q.z_min) return false;
        if ((q.kind == QUADRIC_CYLINDER || q.z_max < q.radius) && p.z > q.z_max) return false;
    }
    return q.phi_max >= TWO_PI || quadric_turn(p) <= q.phi_max;
}

// Distances along the ray, in units of d, of both candidates; false: a miss. The discriminant as in pbrt 4ed, eq. 6.6,
// does not cancel for small, distant quadrics; roots by Press et al. 2007, 5.6.
bool quadric_roots(QuadricData q, vec3 o, vec3 d, out vec2 t) {
    t = vec2(-1.0);
    if (q.kind == QUADRIC_DISK) {
        if (d.z == 0.0) return false;
        t = vec2((q.z_min - o.z) / d.z);
        return true;
    }
    if (q.kind == QUADRIC_CYLINDER) o.z = d.z = 0.0;
    float a = dot(d, d), b = dot(o, d);
    if (!positive(a)) return false;
    vec3 v = o - (b / a) * d;
    float l = length(v), disc = (q.radius + l) * (q.radius - l);
    if (is_nan(disc) || disc < 0.0) return false;
    float lo = length(o), c = (lo + q.radius) * (lo - q.radius);
    float k = b < 0.0 ? -b + sqrt(a * disc) : -b - sqrt(a * disc);
    t = k == 0.0 ? vec2(0.0) : vec2(k / a, c / k);
    if (t.x > t.y) t = t.yx;
    return true;
}

// Distance along the unit world normal n that keeps a ray off the surface: the rounding of p (object space; w: in world
// space), of the transform back, and of solving for the next hit from there.
float quadric_offset(InstanceData inst, QuadricData q, vec3 p, vec3 w, vec3 n) {
    float reach = q.kind == QUADRIC_DISK ? abs(q.z_min) : q.radius;
    // The refined point: gamma(5); |o| - r of a ray that starts there: as much again.
    vec3 extent = vec3(10.0 * reach);
    return ray_offset(vec3(0), extent * (1.0 / 3.0), vec3(0), p, w, inst.object_to_world, inst.normal_to_world, n, 0.0);
}

// ---- as lights ------------------------------------------------------------------------------------------------------

// Uniform over the area.
vec3 quadric_sample_area(QuadricData q, vec2 u) {
    float phi = u.y * q.phi_max;
    vec2 around = normalize(vec2(cos(phi), sin(phi)));
    if (q.kind == QUADRIC_DISK) return vec3(around * sqrt(mix(q.inner * q.inner, q.radius * q.radius, u.x)), q.z_min);
    float z = mix(q.z_min, q.z_max, u.x);
    if (q.kind == QUADRIC_CYLINDER) return vec3(around * q.radius, z);
    return vec3(around * sqrt(max(0.0, (q.radius - z) * (q.radius + z))), z);
}

// Complete spheres are sampled by the cone they subtend, from points clearly outside; pbrt 4ed, 6.2.4.
bool quadric_by_cone(QuadricData q, vec3 from) {
    return q.kind == QUADRIC_SPHERE && q.whole != 0u && dot(from, from) > sqr(1.0001 * q.radius);
}
const float SMALL_CONE = 0.00068523; // sin^2 of 1.5 degrees: below, cosines cancel
float cone_height(float sin2) { return sin2 < SMALL_CONE ? 0.5 * sin2 : 1.0 - sqrt(max(0.0, 1.0 - sin2)); } // 1 - cos

vec3 quadric_sample_cone(QuadricData q, vec3 from, vec2 u) {
    float away = length(from), sin_max = q.radius / away, sin2_max = sin_max * sin_max;
    float cos_theta = 1.0 - u.x * cone_height(sin2_max);
    float sin2 = sin2_max < SMALL_CONE ? sin2_max * u.x : max(0.0, 1.0 - cos_theta * cos_theta);
    if (sin2_max < SMALL_CONE) cos_theta = sqrt(1.0 - sin2);
    // The angle at the centre between the axis and the point (pbrt 4ed, eq. 6.18).
    float cos_alpha = sin2 / sin_max + cos_theta * sqrt(max(0.0, 1.0 - sin2 / sin2_max));
    float sin_alpha = sqrt(max(0.0, 1.0 - cos_alpha * cos_alpha));
    float phi = TWO_PI * u.y;
    Frame f = frame_from_normal(from / away);
    return quadric_refine(q, to_world(f, vec3(sin_alpha * cos(phi), sin_alpha * sin(phi), cos_alpha)));
}

// Density, in solid angle at `from`, of sampling the point `at` of the surface (both in world space), where the cosine
// between the light's normal and the direction is c. Sampling is in object space: a transform M scales solid angles by
// |det M| / |M w|^3, areas by |det M| |M^-T n|.
float quadric_density(InstanceData inst, QuadricData q, vec3 from, vec3 at, float c) {
    vec3 o = to_object(inst, from), p = quadric_refine(q, to_object(inst, at));
    float det = abs(determinant(linear_part(inst))), way = distance(from, at);
    if (quadric_by_cone(q, o)) {
        if (dot(o, p) < (1.0 - 1e-5) * sqr(q.radius)) return 0.0; // the far side, seen through holes
        float stretch = way / distance(o, p);
        return stretch * stretch * stretch / (det * TWO_PI * cone_height(sqr(q.radius) / dot(o, o)));
    }
    float area = q.area * det * length(inst.normal_to_world * quadric_normal(q, p));
    return c <= 0.0 ? 0.0 : way * way / (c * area);
}

#endif
