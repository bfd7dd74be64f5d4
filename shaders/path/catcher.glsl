// SPDX-License-Identifier: Apache-2.0
// Shadow catchers: differential rendering (Debevec 1998, "Rendering Synthetic Objects into Real Scenes") in one pass. What
// is behind a catcher is multiplied by L_with / L_without, the radiance that a white diffuse surface would reflect there
// with the other objects and without them (render/catcher.hpp takes the ratio of means). Only camera rays meet a catcher:
// its light is of the photograph, which the sky holds, so all other rays pass. Then nothing is between a catcher and the
// lights but objects, and one light sample is of both: whole in L_without, with its shadow ray in L_with. Where nothing is
// in the way, the two are equal to the last bit. Light sampling has all the weight, as a ray that finds a lamp
// says nothing about what it would find without the objects.
#ifndef RESTAGE_PATH_CATCHER
#define RESTAGE_PATH_CATCHER
#include <restage/v1/sampling.glsl>
#include "path/escape.glsl"
#include "path/film.glsl"

bool is_caught(PathState path) { return HAS_CATCHERS && (path.flags & PATH_CAUGHT) != 0u; }

Spectrum catcher_eval(vec3 wo, vec3 wi) { return Spectrum(same_hemisphere(wo, wi) ? INV_PI * abs(wi.z) : 0.0); }
BsdfSample catcher_sample(vec3 wo, vec2 u) {
    vec3 wi = sample_cosine_hemisphere(u);
    float pdf = cosine_hemisphere_pdf(wi.z);
    if (pdf <= 0.0 || wo.z == 0.0) return BSDF_NONE;
    if (wo.z < 0.0) wi.z = -wi.z;
    return BsdfSample(wi, Spectrum(1), pdf, BSDF_REFLECT, 1.0);
}

// The sky in the direction of a camera ray, as seen there without the catcher.
vec3 behind_catcher(SceneData scene, PathState path, vec3 direction) {
    path.radiance = Spectrum(0);
    float pdf_light;
    path.flags = (path.flags & ~PATH_CAUGHT) | PATH_SPECULAR;
    path_escape(scene, receiver_at(vec3(0), 0u), direction, path, pdf_light);
    return rgb_from_spectrum(path.radiance);
}

#endif
