// SPDX-License-Identifier: Apache-2.0
#include "check/bsdf_lab.hpp"

#include "render/material_composer.hpp"

#include <algorithm>

namespace restage::check {
namespace {

// One call site for eval: it is called in a loop, so that the driver compiles it once.
constexpr const char* kernel = R"(
layout(local_size_x = 64) in;
struct Job { vec3 wo, wi, u; uint config, seed; };
struct Answer {
    vec3 eval; float eval_sq; vec3 eval_sampled, eval_reverse; float pdf, pdf_sampled;
    vec3 wi, weight; float sample_pdf; uint flags; float eta; vec3 albedo;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Jobs { Job at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Answers { Answer at[]; };
layout(push_constant, scalar) uniform Push { uint64_t params, jobs, answers; uint count, words, repeats; } push;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    Job job = Jobs(push.jobs).at[i];
    SceneData scene;
    scene.params = push.params;
    Material m = material_fetch(scene, job.config * push.words, vec2(0));
    Rng rng = Rng(pcg_hash(job.seed));
    BsdfSample s = material_sample(m, job.wo, job.u, rng);
    Answer a;
    a.wi = s.wi; a.weight = s.weight; a.sample_pdf = s.pdf; a.flags = s.flags; a.eta = s.eta;
    a.albedo = material_albedo(m, job.wo);
    a.eval = vec3(0);
    a.eval_sq = 0.0;
    a.eval_sampled = a.eval_reverse = vec3(0);
    a.pdf = a.pdf_sampled = 0.0;
    bool sampled = s.flags != 0u && (s.flags & BSDF_DELTA) == 0u;
    for (uint k = 0u; k < push.repeats + 2u; ++k) {
        if (k < 2u && !sampled) continue;
        vec3 o = k == 1u ? s.wi : job.wo;
        vec3 t = k == 0u ? s.wi : k == 1u ? job.wo : job.wi;
        vec3 f = material_eval(m, o, t, rng);
        float p = material_pdf(m, o, t, rng);
        if (k == 0u) { a.eval_sampled = f; a.pdf_sampled = p; }
        else if (k == 1u) a.eval_reverse = f;
        else { a.eval += f; a.eval_sq += sqr(luminance(f)); a.pdf = p; }
    }
    a.eval /= float(push.repeats);
    a.eval_sq /= float(push.repeats);
    Answers(push.answers).at[i] = a;
}
)";

struct Push {
    std::uint64_t params, jobs, answers;
    std::uint32_t count, words, repeats, pad;
};

} // namespace

Result<BsdfLab> BsdfLab::create(gpu::Device& device, const gpu::ShaderCompiler& compiler,
                                const render::MaterialPlugin& material) {
    BsdfLab lab(device, material);
    const std::string who = material.table->type;
    render::MaterialType type;
    type.type = who;
    type.plugin = material;
    gpu::ShaderSource source = render::compose_material(type, "bsdf_lab_main.glsl", gpu::ShaderStage::compute);
    source.files["bsdf_lab_main.glsl"] = kernel;
    RESTAGE_TRY(const gpu::Spirv spirv, compiler.compile(source));
    const auto constants = render::spec_constants({}, false, render::Strategy::mis, &type);
    RESTAGE_TRY(lab.pipeline_, gpu::ComputePipeline::create(device, spirv, sizeof(Push), constants, who.c_str()));
    return lab;
}

Result<std::vector<BsdfAnswer>> BsdfLab::run(std::span<const scene::ParamSet> configs, std::span<const BsdfJob> jobs,
                                             std::uint32_t repeats) {
    std::vector<std::uint32_t> words;
    for (const scene::ParamSet& set : configs) {
        const auto packed = render::pack_material(table(), set);
        words.insert(words.end(), packed.begin(), packed.end());
    }
    const auto count_of = static_cast<std::uint32_t>(words.size() / configs.size());
    words.resize(words.size() + 4); // a material without parameters still needs memory
    RESTAGE_TRY(const gpu::Buffer params, device_->create_buffer_of<std::uint32_t>(words, "lab params"));
    std::vector<BsdfAnswer> answers(jobs.size());
    constexpr std::size_t most = 1 << 17; // a dispatch
    RESTAGE_TRY(gpu::Buffer in, device_->create_buffer(most * sizeof(BsdfJob), gpu::BufferKind::host, "lab jobs"));
    RESTAGE_TRY(gpu::Buffer out,
                device_->create_buffer(most * sizeof(BsdfAnswer), gpu::BufferKind::readback, "lab answers"));
    for (std::size_t first = 0; first < jobs.size(); first += most) {
        const std::size_t count = std::min(most, jobs.size() - first);
        std::copy_n(jobs.data() + first, count, in.span<BsdfJob>().data());
        const Push push{.params = params.address(),
                        .jobs = in.address(),
                        .answers = out.address(),
                        .count = static_cast<std::uint32_t>(count),
                        .words = count_of,
                        .repeats = repeats,
                        .pad = 0};
        RESTAGE_TRY(gpu::CommandList list, device_->begin());
        list.dispatch(pipeline_, gpu::push_bytes(push), static_cast<std::uint32_t>((count + 63) / 64));
        RESTAGE_CHECK(device_->submit_and_wait(list));
        std::copy_n(out.span<BsdfAnswer>().data(), count, answers.data() + first);
    }
    return answers;
}

} // namespace restage::check
