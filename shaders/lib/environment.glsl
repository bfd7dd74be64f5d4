// SPDX-License-Identifier: Apache-2.0
// The environment: radiance, and density of sampling it, are bilinear between the middles of texels.
#ifndef RESTAGE_LIB_ENVIRONMENT
#define RESTAGE_LIB_ENVIRONMENT
#include <restage/v1/sampling.glsl>
#include "lib/bilinear.glsl"
#include "lib/cdf.glsl"
#include "lib/sampler.glsl"
#include "lib/spectral.glsl"
#include "shared/octahedral.h"

struct LightSample {
    vec3 wi;       // unit, towards the light
    float dist;    // to it; 1e30 = infinitely far
    vec3 end;      // end of a shadow ray that cannot hit the light itself; unless infinitely far
    Spectrum radiance; // arriving, unoccluded; for delta lights divided by squared distance only
    float pdf;     // solid angle, times the probability of choosing this light; 0 = no sample
    bool delta;    // point, spot, distant: cannot be hit, no MIS
    float unseen;  // fraction of the radiance that rays pass without a hit: only this sampling finds it, no MIS
};

vec2 environment_uv(EnvironmentData env, vec3 w) { // w in the environment's frame
    if (env.mapping == ENV_OCTAHEDRAL) return direction_to_octahedral(w);
    float phi = atan(w.y, w.x);
    return vec2((phi < 0.0 ? phi + TWO_PI : phi) * (0.5 * INV_PI), atan(length(w.xy), w.z) * INV_PI); // acos is coarse at the poles
}
// The texel at integer coordinates up to one outside the image: an equirectangular map wraps in u and ends at
// the poles, an octahedral one folds over each edge onto itself (pbrt 4ed, fig. 3.22).
uint environment_texel(EnvironmentData env, ivec2 p) {
    ivec2 size = ivec2(env.width, env.height);
    if (env.mapping == ENV_OCTAHEDRAL) {
        if (p.x < 0 || p.x >= size.x) p = ivec2(p.x < 0 ? -1 - p.x : 2 * size.x - 1 - p.x, size.y - 1 - p.y);
        if (p.y < 0 || p.y >= size.y) p = ivec2(size.x - 1 - p.x, p.y < 0 ? -1 - p.y : 2 * size.y - 1 - p.y);
    } else {
        p = ivec2((p.x + size.x) % size.x, clamp(p.y, 0, size.y - 1));
    }
    return uint(p.y) * env.width + uint(p.x);
}
vec4 environment_at(EnvironmentData env, ivec2 p) { return Vec4Array(env.texels).at[environment_texel(env, p)]; }
// rgb: radiance, without scale. a: density over the unit square.
vec4 environment_lookup(EnvironmentData env, vec2 uv) {
    vec2 x = uv * vec2(env.width, env.height) - 0.5;
    vec2 base = floor(x);
    vec2 d = x - base;
    vec4 sum = vec4(0);
    for (int k = 0; k < 4; ++k) {
        ivec2 o = ivec2(k & 1, k >> 1);
        vec2 w = mix(1.0 - d, d, vec2(o));
        sum += w.x * w.y * environment_at(env, ivec2(base) + o);
    }
    return sum;
}
// Solid-angle density from that over the unit square.
float environment_density(EnvironmentData env, float density, float sin_theta) {
    if (env.mapping == ENV_OCTAHEDRAL) return density / (4.0 * PI);
    return sin_theta <= 0.0 ? 0.0 : density / (2.0 * PI * PI * sin_theta);
}
// Radiance from direction w (world), and the density with which light sampling finds it (without the light's pmf).
Spectrum environment_eval(EnvironmentData env, vec3 w, out float pdf) {
    if (env.mapping == ENV_CONSTANT) {
        pdf = 0.25 * INV_PI;
        return stored_spectrum(env.scale);
    }
    vec3 local = env.env_from_world * w;
    vec4 le = environment_lookup(env, environment_uv(env, local));
    pdf = environment_density(env, le.w, length(local.xy));
    return spectrum_from_rgb_unbounded(env.scale * le.xyz);
}
// Between the middles of texels the density is bilinear: a row of such cells is drawn, a cell of it, and a point in the
// cell. The cells at the image's edges are halves or quarters.
LightSample environment_sample(EnvironmentData env, uvec2 bits) {
    LightSample s = LightSample(vec3(0, 0, 1), 1e30, vec3(0), Spectrum(0), 0.25 * INV_PI, false, 0.0);
    if (env.mapping == ENV_CONSTANT) {
        s.radiance = stored_spectrum(env.scale);
        s.wi = sample_sphere(vec2(to_unit(bits.x), to_unit(bits.y)));
        return s;
    }
    CdfDraw row = cdf_draw(env.rows, env.height + 1u, bits.y);
    CdfDraw column = cdf_draw(env.columns + uint64_t(row.index) * uint64_t(env.width + 1u) * 8ul, env.width + 1u, bits.x);
    ivec2 cell = ivec2(column.index, row.index), size = ivec2(env.width, env.height);
    vec4 c00 = environment_at(env, cell - 1), c10 = environment_at(env, cell + ivec2(0, -1));
    vec4 c01 = environment_at(env, cell + ivec2(-1, 0)), c11 = environment_at(env, cell);
    // the part of the cell within the image
    vec2 low = vec2(cell.x == 0 ? 0.5 : 0.0, cell.y == 0 ? 0.5 : 0.0);
    vec2 high = vec2(cell.x == size.x ? 0.5 : 1.0, cell.y == size.y ? 0.5 : 1.0);
    vec2 upper = mix(vec2(c00.w, c10.w), vec2(c01.w, c11.w), low.y), lower = mix(vec2(c00.w, c10.w), vec2(c01.w, c11.w), high.y);
    upper = mix(upper.xx, upper.yy, vec2(low.x, high.x));
    lower = mix(lower.xx, lower.yy, vec2(low.x, high.x));
    vec2 u = vec2(cdf_left(column, bits.x), cdf_left(row, bits.y));
    vec2 d = mix(low, high, bilinear_sample(vec4(upper, lower), u));
    vec4 le = mix(mix(c00, c10, d.x), mix(c01, c11, d.x), d.y);
    vec2 uv = (vec2(cell) - 0.5 + d) / vec2(size);
    vec3 local;
    float sin_theta = 1.0;
    if (env.mapping == ENV_OCTAHEDRAL) {
        local = octahedral_to_direction(uv);
    } else {
        float theta = uv.y * PI, phi = uv.x * TWO_PI;
        sin_theta = sin(theta);
        local = vec3(sin_theta * cos(phi), sin_theta * sin(phi), cos(theta));
    }
    s.wi = env.world_from_env * local;
    s.radiance = spectrum_from_rgb_unbounded(env.scale * le.xyz);
    s.pdf = environment_density(env, le.w, sin_theta);
    return s;
}

#endif
