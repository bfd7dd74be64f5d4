// SPDX-License-Identifier: Apache-2.0
// WaveHits: the CPU pass between two bounces. Embree answers the shadow rays of the last vertices and finds the next
// hits, in natural path order and in place; each path gets the type that shades it.
#pragma once

#include "base/jobs.hpp"
#include "render/embree_scene.hpp"
#include "render/wave_memory.hpp"

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace restage::render {

class WaveHits {
  public:
    static constexpr std::size_t chunk = 2048; // paths per job
    using TypeCounts = std::array<std::uint32_t, 256>;
    struct Traced {
        std::uint64_t rays = 0, shadow_rays = 0;
    };

    WaveHits(WaveMemory& wave, Jobs& jobs) : wave_(wave), jobs_(jobs) {
        types_.resize(WaveMemory::most_paths);
        emits_.resize(WaveMemory::most_paths);
    }

    // For these paths, in chunks. last_vertex: those that a last vertex may end (see Settings::max_depth).
    Traced trace(const GpuScene&, const EmbreeScene&, std::span<const std::uint32_t> active, bool last_vertex);

    // Rays that met what native code cannot decide wait for `asked()` to be decided, in order; settle() completes them.
    std::vector<shared::HitAsked> asked() const;
    void settle(const GpuScene&, const EmbreeScene&, std::span<const shared::HitDecided>, bool last_vertex);

    std::span<const std::uint8_t> types() const { return types_; } // by path
    std::span<const std::uint8_t> emits() const { return emits_; } // by path: 1 = its hit emits
    std::span<const TypeCounts> counts() const { return counts_; } // by chunk of the active paths

    // Until found_casters(), notes the instances that rays left by a delta lobe.
    void look_for_casters(std::size_t instances) { casters_.assign(instances, 0); }
    std::vector<char> found_casters() { return std::exchange(casters_, {}); } // by instance

  private:
    // Rays of one chunk with hits that native code cannot decide, and these hits.
    struct Open {
        std::uint32_t path = 0;
        bool shadow = false;
        float distance = 0; // of a shadow ray
        std::size_t first = 0, count = 0; // of `hits`
    };
    struct Undecided {
        std::vector<EmbreeScene::Undecided> hits;
        std::vector<Open> open;
    };
    struct View; // of the scene
    shared::FourthData* fourth_of(const View&, std::uint32_t path);
    void add_light(const View&, std::uint32_t path, float distance);
    std::uint32_t trace_shadows(const View&, std::span<const std::uint32_t> active, Undecided*);
    std::uint32_t trace_closest(const View&, std::span<const std::uint32_t> active, TypeCounts&, Undecided*);
    std::uint8_t shader_of(const View&, std::uint32_t path, std::optional<std::uint32_t> material);
    void give_type(const View&, std::uint32_t path, TypeCounts&, std::optional<std::uint32_t> material = std::nullopt);
    void occluded_undecided(const View&, std::uint32_t path, Undecided&);
    bool intersect_undecided(const View&, std::uint32_t path, Undecided&);
    void note_caster(const View&, std::uint32_t path);
    void settle(const View&, const Undecided&, const shared::HitDecided*, TypeCounts&);

    WaveMemory& wave_;
    Jobs& jobs_;
    std::vector<std::uint8_t> types_, emits_;
    std::vector<TypeCounts> counts_;
    std::vector<Undecided> undecided_; // by chunk
    std::vector<char> casters_; // empty: not looked for
};

} // namespace restage::render
