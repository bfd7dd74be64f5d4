// SPDX-License-Identifier: Apache-2.0
#include "check/bsdf_lab.hpp"

#include "render/material_composer.hpp"

#include <algorithm>

namespace restage::check {
namespace {

enum Mode : std::uint32_t { list = 0, drawing = 1, looking = 2 }; // LAB_* of shaders/check_lab.glsl
constexpr std::size_t most_in_dispatch = 1 << 17;

} // namespace

struct BsdfLab::Push {
    std::uint64_t params = 0, jobs = 0, answers = 0;
    std::uint32_t count = 0, words = 0, repeats = 1, mode = list, seed = 0;
    Vec3 wo{};
};

Result<BsdfLab> BsdfLab::create(gpu::Device& device, const gpu::ShaderCompiler& compiler,
                                const render::MaterialPlugin& material) {
    BsdfLab lab(device, material);
    const std::string who = material.table->type;
    render::MaterialType type;
    type.type = who;
    type.plugin = material;
    RESTAGE_TRY(const gpu::Spirv spirv,
                compiler.compile(render::compose_material(type, "check_lab.glsl", gpu::ShaderStage::compute)));
    const auto constants = render::spec_constants({}, false, render::Strategy::mis, &type);
    RESTAGE_TRY(lab.pipeline_, gpu::ComputePipeline::create(device, spirv, sizeof(Push), constants, who.c_str()));
    RESTAGE_TRY(lab.in_, device.create_buffer(most_in_dispatch * sizeof(BsdfJob), gpu::BufferKind::host, "lab jobs"));
    RESTAGE_TRY(lab.out_,
                device.create_buffer(most_in_dispatch * sizeof(BsdfAnswer), gpu::BufferKind::readback, "lab answers"));
    return lab;
}

template <class In, class Out>
Result<std::vector<Out>> BsdfLab::dispatch(Push push, std::span<const scene::ParamSet> configs, std::span<const In> in,
                                           std::size_t count) {
    std::vector<std::uint32_t> words;
    for (const scene::ParamSet& set : configs) {
        RESTAGE_TRY(const auto tables, tables_.find(material_, set));
        const auto packed = render::pack_material(table(), set, tables);
        words.insert(words.end(), packed.begin(), packed.end());
    }
    push.words = static_cast<std::uint32_t>(words.size() / configs.size());
    words.resize(words.size() + 4); // a material without parameters still needs memory
    RESTAGE_TRY(const gpu::Buffer params, device_->create_buffer_of<std::uint32_t>(words, "lab params"));
    push.params = params.address();
    push.jobs = in_.address();
    push.answers = out_.address();
    std::vector<Out> answers(count);
    const std::uint32_t seed = push.seed;
    for (std::size_t first = 0; first < count; first += most_in_dispatch) {
        const std::size_t n = std::min(most_in_dispatch, count - first);
        if (!in.empty()) std::copy_n(in.data() + first, n, in_.span<In>().data());
        push.count = static_cast<std::uint32_t>(n);
        push.seed = seed ^ (static_cast<std::uint32_t>(first / most_in_dispatch) * 0x9e3779b9u);
        RESTAGE_TRY(gpu::CommandList commands, device_->begin());
        commands.dispatch(pipeline_, gpu::push_bytes(push), static_cast<std::uint32_t>((n + 63) / 64));
        RESTAGE_CHECK(device_->submit_and_wait(commands));
        std::copy_n(out_.span<Out>().data(), n, answers.data() + first);
        if (on_dispatch) on_dispatch();
    }
    return answers;
}

Result<std::vector<BsdfAnswer>> BsdfLab::run(std::span<const scene::ParamSet> configs, std::span<const BsdfJob> jobs,
                                             std::uint32_t repeats) {
    Push push;
    push.repeats = repeats;
    return dispatch<BsdfJob, BsdfAnswer>(push, configs, jobs, jobs.size());
}

Result<std::vector<BsdfDrawn>> BsdfLab::draw(const scene::ParamSet& config, const Vec3& wo, std::uint32_t seed,
                                             std::size_t count) {
    Push push;
    push.mode = drawing, push.wo = wo, push.seed = seed;
    return dispatch<BsdfJob, BsdfDrawn>(push, {&config, 1}, {}, count);
}

Result<std::vector<BsdfLooked>> BsdfLab::look(const scene::ParamSet& config, const Vec3& wo, std::span<const Vec3> wi,
                                              std::uint32_t repeats, std::uint32_t seed) {
    Push push;
    push.mode = looking, push.wo = wo, push.seed = seed, push.repeats = repeats;
    return dispatch<Vec3, BsdfLooked>(push, {&config, 1}, wi, wi.size());
}

} // namespace restage::check
