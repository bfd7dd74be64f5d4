// SPDX-License-Identifier: Apache-2.0
// Radiance seen by a path that leaves the scene.
#ifndef RESTAGE_PATH_ESCAPE
#define RESTAGE_PATH_ESCAPE
#include "lib/light.glsl"
#include "shared/path_data.h"

// Biased; 0 = off.
Spectrum clamp_contribution(SceneData scene, Spectrum c, uint depth) {
    float limit = depth == 0u ? scene.clamp_direct : scene.clamp_indirect;
    float m = max_component(c);
    return limit > 0.0 && m > limit ? c * (limit / m) : c;
}

// Beer-Lambert along a ray in one medium. If the ray crosses borders of media, the tracer has applied it.
Spectrum absorb(SceneData scene, uint medium, float distance_) {
    if (!HAS_MEDIA || HAS_BORDERS || medium == 0u) return Spectrum(1);
    return exp(-distance_ * stored_spectrum(MediumArray(scene.media).at[medium].sigma_a));
}

// Radiance of the environment for a path that left the scene from its last vertex, `from`. pdf_light: density with which
// light sampling finds it; 0: never, or it counts whole.
void path_escape(SceneData scene, Receiver from, vec3 direction, inout PathState path, out float pdf_light) {
    pdf_light = 0.0;
    if (!HAS_ENVIRONMENT || scene.environment.light == NONE) return;
    uint depth = path.flags & PATH_DEPTH_MASK;
    if (HAS_CATCHERS && depth == 1u && (path.flags & PATH_CAUGHT) != 0u) return; // path/catcher.glsl
    // Directly from the camera, also through cut-outs and null surfaces; glass and mirrors show it.
    if (depth == 0u && scene.environment.hidden != 0u) return;
    float pdf_env;
    Spectrum le = environment_eval(scene.environment, direction, pdf_env);
    float w = 1.0;
    if ((path.flags & PATH_SPECULAR) == 0u && STRATEGY != 2) {
        pdf_light = pdf_env * light_choice_pmf(scene, from, LightArray(scene.lights).at[scene.environment.light].node);
        w = STRATEGY == 1 ? 0.0 : mis_weight(path.pdf, pdf_light);
    }
    if (HAS_MEDIA) le *= absorb(scene, path.medium, 1e30); // infinitely far behind the absorber
    path.radiance += clamp_contribution(scene, path.throughput * le * w, depth);
}

#endif
