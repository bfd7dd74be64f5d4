// SPDX-License-Identifier: Apache-2.0
// Lights: choosing an emitter and a point on it, and the density of having done so. The point's two numbers stay in
// order from the emitter's first triangle to its last, so that points are spread over it as well as over the unit square.
#ifndef RESTAGE_LIB_LIGHT
#define RESTAGE_LIB_LIGHT
#include <restage/v1/bsdf.glsl>
#include "lib/cdf.glsl"
#include "lib/environment.glsl"
#include "lib/light_tree.glsl"
#include "lib/quadric.glsl"
#include "lib/ray_offset.glsl"
#include "lib/rectangle.glsl"
#include "lib/sampler.glsl"
#include <restage/v1/sampling.glsl>
#include "lib/scene.glsl"
#include "lib/texture.glsl"
#include "lib/triangle.glsl"
#include "lib/words.glsl"
#include "shared/lamps.h"

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
Spectrum emitted(SceneData scene, InstanceData inst, uint prim, vec2 bary) {
    if (!HAS_EMISSION_TEXTURES || inst.emission_texture == 0u) return stored_spectrum(inst.emission);
    TextureAt at = texture_at(scene, inst, prim, bary, hit_uv(inst, prim, bary));
    return spectrum_from_rgb_unbounded(inst.emission * max(vec3(0), texture_data(scene, inst.emission_texture, at)));
}

// A point's place along both edges.
vec2 place_on(LightData light, vec3 q) {
    vec3 n = cross(light.b, light.c), d = q - light.a;
    return clamp(vec2(dot(cross(d, light.c), n), dot(cross(light.b, d), n)) / dot(n, n), 0.0, 1.0);
}

// Density per solid angle of sampling the point q of a lamp, chosen already. cos_light: at the point, above 0.
float lamp_density(LightData light, Receiver to, vec3 q, float dist, float cos_light) {
    if (HAS_LAMP_RECTANGLES && (light.kind & LIGHT_RECTANGLE) != 0u) {
        RectangleView view = rectangle_view(light.a, light.b, light.c, to.p);
        if (view.solid_angle >= RECTANGLE_LEAST) {
            vec4 corners = rectangle_corners(view, to.n);
            return bilinear_density(corners, rectangle_invert(view, place_on(light, q))) / view.solid_angle;
        }
    }
    if (HAS_LAMP_TRIANGLES && (light.kind & LIGHT_BY_ANGLE) != 0u) {
        TriangleView view = triangle_view(light.a, light.b, light.c, to.p);
        if (triangle_by_angle(view))
            return bilinear_density(triangle_corners(view, to.n), triangle_invert(view, place_on(light, q))) / view.solid_angle;
    }
    return triangle_density(light.area, dist, cos_light);
}

// Towards a point. `pick` chooses the emitter, `bits` the place on it. Loads stand outside of conditions as far as possible: see records.glsl.
LightSample light_sample(SceneData scene, Receiver to, uint pick, uvec2 bits) {
    vec3 p = to.p;
    LightSample s = LightSample(vec3(0, 0, 1), 0.0, vec3(0), Spectrum(0), 0.0, false, 0.0);
    float pmf;
    uint chosen = light_choose(scene, to, pick, pmf);
    LightNode emitter = LightNodeArray(scene.light_nodes).at[chosen];
    LightArray lights = LightArray(scene.lights);
    uint index = emitter.first;
    float x = to_unit(bits.x), y = to_unit(bits.y);
    if (HAS_LAMP_MESHES && (emitter.flags & LIGHT_PIECES) != 0u) {
        address table = scene.light_cdf + uint64_t(emitter.first) * 8ul;
        CdfDraw draw = cdf_draw(table, emitter.lights, bits.x);
        uint kind = lights.at[emitter.first + draw.index].kind;
        if ((kind & LIGHT_PAIR) != 0u) draw.end = cdf_end(table, emitter.lights, draw.index + 1u);
        if ((kind & LIGHT_PAIR_END) != 0u) draw.start = CdfArray(table).at[--draw.index].start;
        x = cdf_left(draw, bits.x);
        index += draw.index;
    }
    LightData light = load_light(scene.lights, index);
    pmf *= light.pmf;
    uint kind = light.kind & 255u;
    if (HAS_ENVIRONMENT && kind == LIGHT_ENVIRONMENT) {
        s = environment_sample(scene.environment, bits);
        s.pdf *= pmf;
    } else if (HAS_LAMPS && kind >= LIGHT_LAMP) {
        LampRay ray = lamp_ray(kind - LIGHT_LAMP, light.a, light.b, light.c, p);
        s = LightSample(ray.wi, ray.dist, light.a, stored_spectrum(light.value) * ray.amount, ray.dist > 0.0 ? pmf : 0.0, true, 0.0);
    } else if (HAS_LAMP_SURFACES) {
        vec3 q = light.a;
        vec2 bary = vec2(0);
        InstanceData lamp;
        QuadricData quadric;
        vec3 n = vec3(0); // of surfaces, on the emitting side
        float density = 0.0; // per solid angle; 0: the area's
        if (HAS_QUADRICS && kind == LIGHT_QUADRIC) {
            lamp = InstanceArray(scene.instances).at[light.instance];
            quadric = quadric_of(lamp);
            vec3 from = to_object(lamp, p);
            vec2 u = vec2(x, y);
            vec3 at = quadric_by_cone(quadric, from) ? quadric_sample_cone(quadric, from, u) : quadric_sample_area(quadric, u);
            bary = quadric_uv(quadric, at);
            n = normalize(lamp.normal_to_world * quadric_normal(quadric, at));
            if ((lamp.flags & INSTANCE_FLIP_NORMAL) != 0u) n = -n;
            q = lamp.object_to_world * vec4(at, 1.0);
        } else {
            bool by_angle = false;
            if (HAS_LAMP_TRIANGLES && (light.kind & LIGHT_BY_ANGLE) != 0u) {
                TriangleView view = triangle_view(light.a, light.b, light.c, p);
                by_angle = triangle_by_angle(view);
                if (by_angle) {
                    vec4 corners = triangle_corners(view, to.n);
                    vec2 u = bilinear_sample(corners, vec2(x, y)), at = triangle_sample(view, u);
                    x = at.x;
                    y = at.y;
                    density = bilinear_density(corners, u) / view.solid_angle;
                }
            }
            if (HAS_LAMP_RECTANGLES && (light.kind & LIGHT_RECTANGLE) != 0u) {
                RectangleView view = rectangle_view(light.a, light.b, light.c, p);
                if (view.solid_angle >= RECTANGLE_LEAST) {
                    vec4 corners = rectangle_corners(view, to.n);
                    vec2 u = bilinear_sample(corners, vec2(x, y)), at = rectangle_sample(view, u);
                    x = at.x;
                    y = at.y;
                    density = bilinear_density(corners, u) / view.solid_angle;
                }
            } else if (by_angle || (light.kind & (LIGHT_PAIR | LIGHT_PAIR_END)) != 0u) {
                // done, or uniform over the parallelogram
            } else if (y > x) { // uniform over the area; Heitz 2019's mapping has less distortion than the square root
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
        s.dist = sqrt(d2);
        s.wi = d / s.dist;
        float c = -dot(n, s.wi);
        if ((light.kind & LIGHT_TWO_SIDED) != 0u) c = abs(c);
        s.end = offset_origin(q, n, scene.ray_epsilon > 0.0 ? scene.ray_epsilon : light_offset(light, p, s.dist), -s.wi);
        s.radiance = stored_spectrum(light.value);
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
        if (HAS_QUADRICS && kind == LIGHT_QUADRIC) s.pdf = quadric_density(lamp, quadric, p, q, c);
        else if (density > 0.0) s.pdf = density;
        else s.pdf = triangle_density(light.area, s.dist, c);
        s.pdf = c > 0.0 && d2 > 0.0 ? s.pdf * pmf : 0.0;
    }
    return s;
}

// Power heuristic, beta = 2. Veach 1997, eq. 9.14
float mis_weight(float a, float b) {
    if (STRATEGY == 1) return 1.0; // called by the only strategy in use
    float r = b / a;               // a > 0; b may be +inf
    return 1.0 / (1.0 + r * r);
}

#endif
