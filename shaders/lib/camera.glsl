// SPDX-License-Identifier: Apache-2.0
// Camera rays: pixel filter by importance sampling (Ernst et al. 2006; pbrt 4ed, 8.8.1), thin lens (pbrt 4ed, 5.2.3),
// orthographic and spherical cameras (5.2.1, 5.3).
#ifndef RESTAGE_LIB_CAMERA
#define RESTAGE_LIB_CAMERA
#include <restage/v1/bsdf.glsl>
#include "shared/octahedral.h"
#include <restage/v1/sampling.glsl>
#include "lib/scene.glsl"

// One axis of a tabulated |f|: offset in [-radius, radius], and the sign of f there.
float sample_table(FilterData f, uint axis, float u, out float sign_) {
    uint n = f.table_size;
    uint cdf = axis * (n + 1u);
    FloatArray t = FloatArray(f.table);
    uint lo = 0u, hi = n;
    while (hi - lo > 1u) {
        uint mid = (lo + hi) / 2u;
        if (t.at[cdf + mid] <= u) lo = mid;
        else hi = mid;
    }
    float a = t.at[cdf + lo], b = t.at[cdf + lo + 1u];
    float x = (float(lo) + (b > a ? (u - a) / (b - a) : 0.5)) / float(n);
    sign_ = t.at[2u * (n + 1u) + axis * n + lo];
    return (2.0 * x - 1.0) * f.radius[axis];
}

// Offset from the pixel's centre [pixel] and the sample's weight (1, or signed for filters with negative lobes).
vec2 filter_sample(FilterData f, vec2 u, out float weight) {
    weight = 1.0;
    if (HAS_FILTER_TABLE && f.kind == FILTER_TABLE) {
        float sx, sy;
        vec2 d = vec2(sample_table(f, 0u, u.x, sx), sample_table(f, 1u, u.y, sy));
        weight = sx * sy * f.weight.x * f.weight.y;
        return d;
    }
    if (f.kind == FILTER_TRIANGLE) return vec2(sample_tent(u.x, f.radius.x), sample_tent(u.y, f.radius.y));
    return (2.0 * u - 1.0) * f.radius;
}

// Uniform disk, Shirley and Chiu 1997.
vec2 concentric_disk(vec2 u) {
    vec2 o = 2.0 * u - 1.0;
    if (o.x == 0.0 && o.y == 0.0) return vec2(0);
    bool wide = abs(o.x) > abs(o.y);
    float r = wide ? o.x : o.y;
    float theta = wide ? (PI / 4.0) * (o.y / o.x) : PI / 2.0 - (PI / 4.0) * (o.x / o.y);
    return r * vec2(cos(theta), sin(theta));
}

void camera_ray(CameraData camera, vec2 film_point, vec2 u_lens, out vec3 origin, out vec3 direction) {
    if (CAMERA_KIND >= CAMERA_SPHERICAL) { // +y up; a wide pixel filter may reach beyond the film's edge
        vec2 uv = film_point / vec2(camera.width, camera.height);
        float theta = uv.y * PI, phi = uv.x * TWO_PI;
        vec3 w = CAMERA_KIND == CAMERA_EQUAL_AREA ? octahedral_to_direction(octahedral_wrap(uv)).xzy
                                                  : vec3(sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi));
        origin = camera.camera_to_world[3];
        direction = normalize(camera.camera_to_world * vec4(w, 0.0));
        return;
    }
    vec2 s = mix(camera.screen_min, camera.screen_max, film_point / vec2(camera.width, camera.height));
    bool parallel = CAMERA_KIND == CAMERA_ORTHOGRAPHIC;
    vec3 d = parallel ? vec3(0, 0, 1) : vec3(s, 1.0);
    vec3 o = parallel ? vec3(s, 0.0) : vec3(0);
    if (HAS_LENS && camera.lens_radius > 0.0) {
        vec3 focus = o + d * camera.focal_distance; // rays start on the lens around the axis, even orthographic ones
        o = vec3(camera.lens_radius * concentric_disk(u_lens), 0.0);
        d = focus - o;
    }
    origin = camera.camera_to_world * vec4(o, 1.0);
    direction = normalize(camera.camera_to_world * vec4(d, 0.0));
}

#endif
