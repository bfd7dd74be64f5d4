// SPDX-License-Identifier: Apache-2.0
// BsdfLab: runs a material's real GLSL, composed as in the renderer, on lists of directions, and returns the results of
// eval, pdf, sample and albedo. Interpretation is left to the caller.
#pragma once

#include "gpu/compiler.hpp"
#include "gpu/device.hpp"
#include "gpu/pipeline.hpp"
#include "render/table_store.hpp"
#include "scene/params.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace restage::check {

using Vec3 = std::array<float, 3>;

struct BsdfJob {
    Vec3 wo{0, 0, 1}, wi{0, 0, 1}, u{0.5f, 0.5f, 0.5f};
    std::uint32_t config = 0; // which parameter set
    std::uint32_t seed = 0; // of the Rng of stochastic materials
};

struct BsdfAnswer {
    Vec3 eval; // (wo, wi), mean of the repeats
    float eval_sq; // mean square of its luminance
    Vec3 eval_sampled; // (wo, sample.wi)
    Vec3 eval_reverse; // (sample.wi, wo)
    float pdf; // (wo, wi)
    float pdf_sampled; // (wo, sample.wi)
    Vec3 wi, weight; // the sample
    float sample_pdf;
    std::uint32_t flags;
    float eta;
    Vec3 albedo;
};

struct BsdfDrawn { // one sample
    Vec3 wi, weight;
    float pdf;
    std::uint32_t flags;
    float eta;
};

struct BsdfLooked { // eval and pdf in one direction; means of the repeats
    Vec3 eval;
    float eval_sq; // mean square of its luminance
    float pdf;
};

inline constexpr std::uint32_t reflect = 1, transmit = 2, delta = 4; // BSDF_* of shaders/restage/v1/bsdf.glsl

class BsdfLab {
  public:
    // The plugin's table, device and compiler must outlive it. Errors are the compiler's, naming the plugin's own file.
    static Result<BsdfLab> create(gpu::Device&, const gpu::ShaderCompiler&, const render::MaterialPlugin&);

    // `repeats` > 1 averages eval over that many random streams (stochastic materials).
    Result<std::vector<BsdfAnswer>> run(std::span<const scene::ParamSet> configs, std::span<const BsdfJob> jobs,
                                        std::uint32_t repeats = 1);
    // `count` samples for one wo, from random numbers generated on the device. Same seed, same samples.
    Result<std::vector<BsdfDrawn>> draw(const scene::ParamSet& config, const Vec3& wo, std::uint32_t seed,
                                        std::size_t count);
    Result<std::vector<BsdfLooked>> look(const scene::ParamSet& config, const Vec3& wo, std::span<const Vec3> wi,
                                         std::uint32_t repeats = 1, std::uint32_t seed = 0);

    // Called after every dispatch (progress; a supervisor's sign of life).
    std::function<void()> on_dispatch;

    const model::Material& table() const { return *material_.table; }
    const std::filesystem::path& folder() const { return material_.folder; }
    std::size_t spirv_bytes() const { return pipeline_.shader_bytes(); }

  private:
    BsdfLab(gpu::Device& device, render::MaterialPlugin material)
        : device_(&device), material_(std::move(material)), tables_(device) {}
    gpu::Device* device_;
    render::MaterialPlugin material_;
    gpu::ComputePipeline pipeline_;
    render::TableStore tables_;
    gpu::Buffer in_, out_; // of one dispatch; reused

    struct Push;
    template <class In, class Out>
    Result<std::vector<Out>> dispatch(Push, std::span<const scene::ParamSet> configs, std::span<const In> in,
                                      std::size_t count);
};

} // namespace restage::check
