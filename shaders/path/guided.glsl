// SPDX-License-Identifier: Apache-2.0
// Directions from a mixture of the BSDF and the guide of paths. The material composer defines the material_* functions
// before this file.
#ifndef RESTAGE_PATH_GUIDED
#define RESTAGE_PATH_GUIDED
#include <restage/v1/bsdf.glsl>
#include <restage/v1/rng.glsl>
#include "lib/guiding.glsl"
#include "path/surface.glsl"

// The guide's cells are this wide [sr]; what a BSDF scatters into less, it samples better by itself.
const float GUIDING_CELL = 4.0 * PI / float(GUIDING_SIDE * GUIDING_SIDE);

struct Guide {
    GuidingData data;
    uint leaf;
    float share; // of the directions
};

// At a vertex. The share depends on the material and wo alone: for a mirror it is 0, which a trial sample tells.
Guide guide_at(GuidingData data, Surface s, Material m, vec3 wo) {
    Guide g;
    g.data = data;
    g.leaf = guiding_leaf(data, s.p, wo.z < 0.0 ? -s.ns : s.ns);
    Rng rng = Rng(0u);
    BsdfSample trial = material_sample(m, wo, vec3(0.5), rng);
    bool usable = trial.flags != 0u && (trial.flags & BSDF_DELTA) == 0u && finite(trial.pdf);
    g.share = usable ? GuidingLeaves(data.leaves).at[g.leaf].share / (1.0 + trial.pdf * GUIDING_CELL) : 0.0;
    return g;
}

// The density of guided_sample without its delta lobes. pdf: of the BSDF
float guided_pdf(Guide g, vec3 wi_world, float pdf) {
    return mix(pdf, guiding_density(g.data, g.leaf, wi_world), g.share);
}

// b: a sample of the BSDF, which is kept unless `guided`, the case with a chance of g.share; u: two numbers that were not
// used for that. The balance heuristic over both techniques
// (Veach 1997, 9.2.4) is right also where a material's pdf is a stand-in. `roulette`: throughput that this vertex takes
// away because the direction was likely, and not because the surface is dark.
BsdfSample guided_sample(Guide g, Material m, Surface s, vec3 wo, vec2 u, bool guided, BsdfSample b, inout Rng rng,
                         out float roulette) {
    roulette = 1.0;
    vec3 wi_world = guided ? guiding_direction(g.data, g.leaf, u) : to_world(s, b.wi);
    vec3 wi = guided ? to_local(s, wi_world) : b.wi;
    float pdf_bsdf = guided ? material_pdf(m, wo, wi, rng) : b.pdf;
    float pdf = guided_pdf(g, wi_world, pdf_bsdf);
    if (guided) {
        b = BsdfSample(wi, Spectrum(0), pdf, same_hemisphere(wo, wi) ? BSDF_REFLECT : BSDF_TRANSMIT, 1.0);
        if (positive(pdf)) b.weight = material_eval(m, wo, wi, rng) / pdf;
        else b.flags = 0u;
    } else if ((b.flags & BSDF_DELTA) != 0u) {
        b.weight /= 1.0 - g.share;
        roulette = 1.0 - g.share;
    } else if (b.flags != 0u) {
        b.weight *= pdf_bsdf / pdf;
        b.pdf = pdf;
    }
    if ((b.flags & BSDF_DELTA) == 0u && positive(pdf_bsdf)) roulette = clamp(pdf / pdf_bsdf, 1e-3, 1e3);
    return b;
}

#endif
