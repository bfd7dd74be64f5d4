// SPDX-License-Identifier: Apache-2.0
// The kernels of the wavefront, each built on a worker when a path first needs it: a material type that no path hits
// costs nothing. Until a kernel is built, the wave waits, or (TracerContext::stand_ins) runs the previous one, or a
// stand-in.
#pragma once

#include "render/pipeline_store.hpp"

#include <array>
#include <span>

namespace restage::render {

// What the kernels' paths do apart from meeting surfaces and light.
struct KernelUse {
    bool guiding = false; // they are guided
    bool photons = false; // they gather photons, where the scene may have caustics
    bool operator==(const KernelUse&) const = default;
};

class WaveKernels {
  public:
    // Pseudo types: hits of surfaces that emit, paths that left the scene
    static constexpr std::uint8_t emit = 253, escape = 254;

    explicit WaveKernels(const TracerContext& c) : c_(c), store_(c) {}

    // Switches to the types and features of `scene`. Starts building what every wave needs.
    Result<void> select(const GpuScene& scene, KernelUse use);
    // Waits for what every wave needs. False: keep_going requested a stop.
    Result<bool> begin(const std::function<bool()>& keep_going);
    // Makes kernels ready for hits of these types (index: type; value: hits). False: keep_going requested a stop.
    Result<bool> need(std::span<const std::uint32_t> hits, const std::function<bool()>& keep_going);

    const gpu::ComputePipeline& generate() const { return *generate_.now; }
    const gpu::ComputePipeline& accumulate() const { return *accumulate_.now; }
    const gpu::ComputePipeline& shade(std::size_t type) const; // after need(); pseudo types too

    // The start of photons. False: keep_going requested a stop.
    Result<bool> need_photons(const std::function<bool()>& keep_going);
    const gpu::ComputePipeline& photons() const { return *photons_.now; } // after need_photons()

    // Of wave_decide.comp, for hits that native code cannot decide. False: keep_going requested a stop.
    Result<bool> need_decide(const std::function<bool()>& keep_going);
    const gpu::ComputePipeline& decide() const { return *decide_.now; } // after need_decide()

    bool adopt(); // see Tracer
    std::optional<CompileProgress> compiling() const;
    void film_emptied();
    std::size_t shader_bytes() const; // SPIR-V of the kernels in use

  private:
    using Store = PipelineStore<gpu::ComputePipeline>;
    struct Slot {
        std::string what; // a type, or a file
        std::shared_ptr<const gpu::ComputePipeline> now; // runs now; nullptr: a stand-in
        Store::EntryPtr wanted; // should run; nullptr: not requested yet, or arrived
        bool settled = false; // `now` is what should run
        bool shown = false; // the film contains a stand-in's result
    };
    Result<gpu::ComputeRequest> request(const Slot& slot) const;
    Result<void> ask(Slot& slot);
    Result<bool> wait(Slot& slot, const std::function<bool()>& keep_going);
    void arrive(Slot& slot);
    void prepare_stand_in();

    TracerContext c_;
    Store store_;
    const void* scene_ = nullptr; // of the last select(), to tell it from another
    SceneFeatures features_;
    std::vector<MaterialType> types_;
    TextureTypes texture_types_;
    std::uint32_t stand_in_type_ = 0;
    std::vector<Slot> slots_; // by type
    Slot generate_{.what = "wave_generate.comp"}, emit_{.what = "wave_emit.comp"}, escape_{.what = "wave_escape.comp"},
        accumulate_{.what = "wave_accumulate.comp"}, stand_in_{.what = "stand-in"}, decide_{.what = "wave_decide.comp"},
        photons_{.what = "wave_photons.comp"};
};

} // namespace restage::render
