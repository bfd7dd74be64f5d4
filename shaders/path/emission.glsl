// SPDX-License-Identifier: Apache-2.0
// Light that a surface adds to a path that hits it, with its MIS weight.
#ifndef RESTAGE_PATH_EMISSION
#define RESTAGE_PATH_EMISSION
#include "lib/light.glsl"
#include "path/escape.glsl"
#include "path/surface.glsl"
#include "shared/path_data.h"

struct StepRay {
    vec3 origin;
    vec3 direction;
    float tmax; // < 0: none
    float tmin; // of path rays: where it continues beyond a lamp without surface, else 0
    uint medium; // at the origin; of shadow rays
    uint receiver; // receiver_bits at its last vertex; of path rays
};

// Beer-Lambert up to a hit.
Spectrum absorb_to_hit(SceneData scene, uint medium, float t, StepRay ray) {
    return absorb(scene, medium, HAS_GLOW ? t - ray.tmin : t);
}

// What a surface that emits adds to a path that hits it, of `ray` at t; path.throughput: at the hit. pdf_light: as of
// path_escape
Spectrum surface_emission(SceneData scene, InstanceData inst, uint prim, vec2 bary, Surface s, float t, StepRay ray, PathState path,
                          out float pdf_light) {
    pdf_light = 0.0;
    uint depth = path.flags & PATH_DEPTH_MASK;
    if (HAS_CATCHERS && depth == 1u && (path.flags & PATH_CAUGHT) != 0u) return Spectrum(0); // path/catcher.glsl
    float c = dot(-ray.direction, s.ng);
    if ((inst.flags & INSTANCE_TWO_SIDED) != 0u) c = abs(c);
    if (c <= 0.0) return Spectrum(0);
    float w = 1.0;
    if (LIGHT_ROOTS > 0u && (path.flags & PATH_SPECULAR) == 0u && STRATEGY != 2 && inst.light_base != NONE) {
        LightData light = load_light(scene.lights, inst.light_base + prim);
        Receiver from = receiver_at(ray.origin, ray.receiver);
        pdf_light = light.pmf * light_choice_pmf(scene, from, light.node);
        if (HAS_QUADRICS && (inst.flags & INSTANCE_QUADRIC) != 0u)
            pdf_light *= quadric_density(inst, quadric_of(inst), ray.origin, s.p, c);
        else
            pdf_light *= lamp_density(light, from, s.p, t, c);
        w = STRATEGY == 1 ? 0.0 : mis_weight(path.pdf, pdf_light);
    }
    return clamp_contribution(scene, path.throughput * emitted(scene, inst, prim, bary) * w, depth);
}

Surface surface_at(SceneData scene, InstanceData inst, MaterialData material, uint prim, vec2 bary, float t, StepRay ray) {
    if (HAS_QUADRICS && (inst.flags & INSTANCE_QUADRIC) != 0u)
        return quadric_surface(scene, inst, material, bary, ray.origin, ray.direction, t);
    return make_surface(scene, inst, material, prim, bary, ray.origin, ray.direction, t);
}

#endif
