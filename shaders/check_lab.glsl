// SPDX-License-Identifier: Apache-2.0
// The main of a material under test (engine/check/bsdf_lab.cpp): runs the composed material above on lists of
// directions. One kernel for all modes, and one call site each: drivers compile every call separately. What a mode does
// not need is a loop with no iterations, which is free.
layout(local_size_x = 64) in;

const uint LAB_LIST = 0u; // everything for one job per invocation
const uint LAB_DRAW = 1u; // samples for one wo, from random numbers generated here
const uint LAB_LOOK = 2u; // eval and pdf of one wo at a list of wi

struct Job { vec3 wo, wi, u; uint config, seed; };
struct Answer {
    vec3 eval; float eval_sq; vec3 eval_sampled, eval_reverse; float pdf, pdf_sampled;
    vec3 wi, weight; float sample_pdf; uint flags; float eta; vec3 albedo;
};
struct Drawn { vec3 wi, weight; float pdf; uint flags; float eta; };
struct Looked { vec3 eval; float eval_sq, pdf; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Jobs { Job at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Directions { vec3 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Answers { Answer at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer DrawnArray { Drawn at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer LookedArray { Looked at[]; };
layout(push_constant, scalar) uniform Push {
    uint64_t params, jobs, answers;
    uint count, words, repeats, mode, seed;
    vec3 wo;
} push;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    Rng rng = Rng(pcg_hash(push.seed ^ pcg_hash(i)));
    Job job = Job(push.wo, vec3(0, 0, 1), vec3(0), 0u, 0u);
    if (push.mode == LAB_LIST) {
        job = Jobs(push.jobs).at[i];
        rng = Rng(pcg_hash(job.seed));
    } else if (push.mode == LAB_DRAW) {
        job.u = rng_next3(rng);
    } else {
        job.wi = Directions(push.jobs).at[i];
    }
    SceneData scene;
    scene.params = push.params;
    Material m = material_fetch(scene, job.config * push.words, texture_at_uv(vec4(0)));
#ifdef MATERIAL_SITE // the same for all: compared values must belong to the same place
    m.site = Site(vec2(0.31, 0.57), vec2(1e-3, 0), vec2(0, 1e-3), vec3(0.31, 0.57, 0.11), vec3(1e-3, 0, 0), vec3(0, 1e-3, 0),
                  vec3(0.31, 0.57, 0.11), vec3(0, 0, 1), 1e-3, 0x9e3779b9u);
#endif

    BsdfSample s = BSDF_NONE;
    for (uint k = 0u; k < (push.mode == LAB_LOOK ? 0u : 1u); ++k)
        s = material_sample(m, job.wo, job.u, rng);
    if (push.mode == LAB_DRAW)
        DrawnArray(push.answers).at[i] = Drawn(s.wi, rgb_from_spectrum(s.weight), s.pdf, s.flags, s.eta);

    Answer a;
    a.eval = a.eval_sampled = a.eval_reverse = vec3(0);
    a.eval_sq = a.pdf = a.pdf_sampled = 0.0;
    bool sampled = s.flags != 0u && (s.flags & BSDF_DELTA) == 0u;
    for (uint k = 0u; k < (push.mode == LAB_DRAW ? 0u : push.repeats + 2u); ++k) {
        if (k < 2u && !sampled) continue;
        vec3 o = k == 1u ? s.wi : job.wo;
        vec3 t = k == 0u ? s.wi : k == 1u ? job.wo : job.wi;
        vec3 f = rgb_from_spectrum(material_eval(m, o, t, rng));
        float p = material_pdf(m, o, t, rng);
        if (k == 0u) { a.eval_sampled = f; a.pdf_sampled = p; }
        else if (k == 1u) a.eval_reverse = f;
        else { a.eval += f; a.eval_sq += sqr(luminance(f)); a.pdf += p; }
    }
    a.eval /= float(push.repeats);
    a.eval_sq /= float(push.repeats);
    a.pdf /= float(push.repeats);
    if (push.mode == LAB_LOOK)
        LookedArray(push.answers).at[i] = Looked(a.eval, a.eval_sq, a.pdf);
    for (uint k = 0u; k < (push.mode == LAB_LIST ? 1u : 0u); ++k) {
        a.wi = s.wi; a.weight = rgb_from_spectrum(s.weight); a.sample_pdf = s.pdf; a.flags = s.flags; a.eta = s.eta;
        a.albedo = rgb_from_spectrum(material_albedo(m, job.wo));
        Answers(push.answers).at[i] = a;
    }
}
