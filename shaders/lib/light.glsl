// SPDX-License-Identifier: Apache-2.0
// Lights: choosing one by power (alias table), sampling a point on it, and the density of having done so.
#ifndef RESTAGE_LIB_LIGHT
#define RESTAGE_LIB_LIGHT
#include <restage/v1/bsdf.glsl>
#include "shared/octahedral.h"
#include "lib/quadric.glsl"
#include "lib/ray_offset.glsl"
#include "lib/sampler.glsl"
#include <restage/v1/sampling.glsl>
#include "lib/scene.glsl"
#include "lib/texture.glsl"
#include "shared/lamps.h"

struct LightSample {
    vec3 wi;       // unit, towards the light
    float dist;    // to it; 1e30 = infinitely far
    vec3 end;      // end of a shadow ray that cannot hit the light itself; unless infinitely far
    vec3 radiance; // arriving, unoccluded; for delta lights divided by squared distance only
    float pdf;     // solid angle, times the probability of choosing this light; 0 = no sample
    bool delta;    // point, spot, distant: cannot be hit, no MIS
    float unseen;  // fraction of the radiance that rays pass without a hit: only this sampling finds it, no MIS
};

uint scaled_index(uint bits, uint count) { // 32 random bits to [0, count)
    uint high, low;
    umulExtended(bits, count, high, low);
    return high;
}

// `bits` choose the entry, u_keep between it and its alias. Two numbers, because what one has left after choosing among
// a hundred thousand is too coarse for the second choice, and the frequencies would not be the pmf. All 32 bits, because
// a float's 24 never reach some texels of an 8192 x 4096 sky.
uint alias_pick(address table, uint count, uint bits, inout float u_keep) {
    uint i = scaled_index(bits, count);
    AliasEntry e = AliasArray(table).at[i];
    // u_keep is rescaled to [0,1) within the choice
    bool keep = u_keep < e.q;
    u_keep = min(keep ? u_keep / e.q : (u_keep - e.q) / (1.0 - e.q), 0.99999994);
    return keep ? i : e.alias;
}

// ---- environment: bilinear between texel centres, as is its density: the alias table chooses a texel's tent, then a
// point under the tent is drawn. The sum of the tents is the interpolated table, so sampling follows the radiance.
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
// Likewise for a point in the unit square's plane.
vec2 environment_wrap(EnvironmentData env, vec2 uv) {
    if (env.mapping == ENV_OCTAHEDRAL) return octahedral_wrap(uv);
    return vec2(fract(uv.x), uv.y < 0.0 ? -uv.y : uv.y > 1.0 ? 2.0 - uv.y : uv.y);
}
// rgb: radiance, without scale. a: density over the unit square.
vec4 environment_lookup(EnvironmentData env, vec2 uv) {
    vec2 x = uv * vec2(env.width, env.height) - 0.5;
    vec2 base = floor(x);
    vec2 d = x - base;
    vec4 sum = vec4(0);
    for (int k = 0; k < 4; ++k) {
        ivec2 o = ivec2(k & 1, k >> 1);
        vec2 w = mix(1.0 - d, d, vec2(o));
        sum += w.x * w.y * Vec4Array(env.texels).at[environment_texel(env, ivec2(base) + o)];
    }
    return sum;
}
// Solid-angle density from that over the unit square.
float environment_density(EnvironmentData env, float density, float sin_theta) {
    if (env.mapping == ENV_OCTAHEDRAL) return density / (4.0 * PI);
    return sin_theta <= 0.0 ? 0.0 : density / (2.0 * PI * PI * sin_theta);
}
// Radiance from direction w (world), and the density with which light sampling finds it (without the light's pmf).
vec3 environment_eval(EnvironmentData env, vec3 w, out float pdf) {
    if (env.mapping == ENV_CONSTANT) {
        pdf = 0.25 * INV_PI;
        return env.scale;
    }
    vec3 local = env.env_from_world * w;
    vec4 le = environment_lookup(env, environment_uv(env, local));
    pdf = environment_density(env, le.w, length(local.xy));
    return env.scale * le.xyz;
}
LightSample environment_sample(EnvironmentData env, uvec2 bits, float u_keep) {
    LightSample s = LightSample(vec3(0, 0, 1), 1e30, vec3(0), env.scale, 0.25 * INV_PI, false, 0.0);
    vec2 u = vec2(to_unit(bits.x), to_unit(bits.y));
    if (env.mapping == ENV_CONSTANT) {
        float z = 1.0 - 2.0 * u.x;
        float r = sqrt(max(0.0, 1.0 - z * z));
        s.wi = vec3(r * cos(TWO_PI * u.y), r * sin(TWO_PI * u.y), z);
        return s;
    }
    uint n = env.width * env.height;
    uint i = alias_pick(env.alias, n, bits.x, u_keep);
    vec2 uv = vec2(i % env.width, i / env.width) + 0.5 + vec2(sample_tent(u_keep, 1.0), sample_tent(u.y, 1.0));
    uv = environment_wrap(env, uv / vec2(env.width, env.height));
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
    vec4 le = environment_lookup(env, uv);
    s.radiance = env.scale * le.xyz;
    s.pdf = environment_density(env, le.w, sin_theta);
    return s;
}

// Density, in solid angle from a point `dist` away, of sampling a point on a triangle light of this area.
float triangle_density(float area, float dist, float cos_light) {
    return cos_light <= 0.0 ? 0.0 : dist * dist / (cos_light * area);
}

// Distance along a triangle's normal that keeps the end of a shadow ray off it: bounds the rounding of the point on the
// light, and of the intersector, which sees the ray from p in the light's object space (see ray_offset.glsl).
// condition = |n| |m| |inverse m|, of the object-to-world m: 1 to 3 unless it shears.
float light_offset(LightData light, vec3 p, float dist) {
    float condition = float(light.kind >> 16) * (1.0 / 16.0);
    // Origin to object space: 6 roundings of |p|. Direction, its normalisation and length, the two products whose
    // quotient is the hit's distance: 15 of the distance. All projected onto the normal.
    return light.offset + EPS * condition * (6.0 * (abs(p.x) + abs(p.y) + abs(p.z)) + 15.0 * dist);
}

// Radiance leaving a point of an emitter, on its emitting side.
vec3 emitted(SceneData scene, InstanceData inst, uint prim, vec2 bary) {
    if (!HAS_EMISSION_TEXTURES || inst.emission_texture == 0u) return inst.emission;
    TextureAt at = texture_at(scene, inst, prim, bary, hit_uv(inst, prim, bary));
    return inst.emission *
           max(vec3(0), rgb_from_spectrum(texture_eval(scene, inst.emission_texture, at, TEXTURE_UNBOUNDED)));
}

LightSample light_sample(SceneData scene, vec3 p, uint pick, float u_keep, uvec2 bits) {
    LightSample s = LightSample(vec3(0, 0, 1), 0.0, vec3(0), vec3(0), 0.0, false, 0.0);
    uint index = alias_pick(scene.light_alias, scene.light_count, pick, u_keep);
    LightData light = LightArray(scene.lights).at[index];
    uint kind = light.kind & 255u;
    if (HAS_ENVIRONMENT && kind == LIGHT_ENVIRONMENT) {
        s = environment_sample(scene.environment, bits, u_keep);
        s.pdf *= light.pmf;
        return s;
    }
    if (kind >= LIGHT_LAMP) {
        LampRay ray = lamp_ray(kind - LIGHT_LAMP, light.a, light.b, light.c, p);
        return LightSample(ray.wi, ray.dist, light.a, light.value * ray.amount, ray.dist > 0.0 ? light.pmf : 0.0, true, 0.0);
    }
    vec3 q = light.a;
    vec2 bary = vec2(0);
    InstanceData lamp;
    QuadricData quadric;
    vec3 n = vec3(0); // of surfaces, on the emitting side
    if (HAS_QUADRICS && kind == LIGHT_QUADRIC) {
        lamp = InstanceArray(scene.instances).at[light.instance];
        quadric = quadric_of(lamp);
        vec3 from = to_object(lamp, p);
        vec2 u = vec2(to_unit(bits.x), to_unit(bits.y));
        vec3 at = quadric_by_cone(quadric, from) ? quadric_sample_cone(quadric, from, u) : quadric_sample_area(quadric, u);
        bary = quadric_uv(quadric, at);
        n = normalize(lamp.normal_to_world * quadric_normal(quadric, at));
        if ((lamp.flags & INSTANCE_FLIP_NORMAL) != 0u) n = -n;
        q = lamp.object_to_world * vec4(at, 1.0);
    } else { // uniform over the area; Heitz 2019's mapping has less distortion than the square root
        float x = to_unit(bits.x), y = to_unit(bits.y);
        if (y > x) {
            x *= 0.5;
            y -= x;
        } else {
            y *= 0.5;
            x -= y;
        }
        q += x * light.b + y * light.c;
        bary = (light.kind & LIGHT_SWAPPED) != 0u ? vec2(y, x) : vec2(x, y);
        n = normalize(cross(light.b, light.c)); // set when the light table is built
    }
    vec3 d = q - p;
    float d2 = dot(d, d);
    if (d2 <= 0.0) return s;
    s.dist = sqrt(d2);
    s.wi = d / s.dist;
    float c = -dot(n, s.wi);
    if ((light.kind & LIGHT_TWO_SIDED) != 0u) c = abs(c);
    if (c <= 0.0) return s;
    s.end = offset_origin(q, n, scene.ray_epsilon > 0.0 ? scene.ray_epsilon : light_offset(light, p, s.dist), -s.wi);
    s.radiance = light.value;
    if ((HAS_EMISSION_TEXTURES || HAS_LIGHT_ALPHA) && light.instance != NONE) {
        InstanceData inst = InstanceArray(scene.instances).at[light.instance];
        uint prim = index - inst.light_base;
        s.radiance = emitted(scene, inst, prim, bary);
        if (HAS_LIGHT_ALPHA && (inst.flags & INSTANCE_HAS_ALPHA) != 0u) {
            float there = hit_alpha(scene, inst, prim, bary);
            if ((inst.flags & INSTANCE_EMITS_UNSEEN) != 0u) s.unseen = 1.0 - there;
            else s.radiance *= there;
        }
    }
    if (HAS_QUADRICS && kind == LIGHT_QUADRIC) s.pdf = light.pmf * quadric_density(lamp, quadric, p, q, c);
    else s.pdf = light.pmf * triangle_density(light.area, s.dist, c);
    return s;
}

// Power heuristic, beta = 2. Veach 1997, eq. 9.14
float mis_weight(float a, float b) {
    if (STRATEGY == 1) return 1.0; // called by the only strategy in use
    float r = b / a;               // a > 0; b may be +inf
    return 1.0 / (1.0 + r * r);
}

#endif
