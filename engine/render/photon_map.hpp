// SPDX-License-Identifier: Apache-2.0
// CausticPhotons: photon maps of light that went by specular bounces only from a light to the surface where it is
// gathered, for the wavefront tracer (shaders/lib/photons.glsl). Progressive: map after map of as many photons, with a
// radius that shrinks so that both the noise and the blur of their mean vanish (Knaus and Zwicker 2011, eq. 15, 20).
#pragma once

#include "base/jobs.hpp"
#include "gpu/device.hpp"
#include "render/gpu_scene.hpp"
#include "render/photon_borders.hpp"
#include "render/photon_pilot.hpp"
#include "shared/photon_data.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace restage::render {

class CausticPhotons {
  public:
    CausticPhotons(gpu::Device& device, Jobs& jobs) : device_(device), jobs_(jobs) {}

    // Of a new scene: which instances pass photons on (by index; 1 = a caster). Decides which lights they start from:
    // those that paths rarely find, or with `all` every light.
    Result<void> start(const GpuScene&, std::vector<char> casters, bool all);
    void forget() { started_ = false; }
    bool started() const { return started_; }
    bool active() const { return !sources_.empty(); }
    std::uint64_t address() const { return record_.address(); } // of shared::PhotonMap, once started

    // Before the first map: a wave of photons whose deposits PhotonPilot notes, and what is learned from it: whether
    // photons pay (`all`: they are wanted anyway), and which of them are seen.
    static constexpr std::uint32_t pilot_paths = 16384;
    Result<void> begin_pilot();
    std::span<const shared::Photon> deposits() { return deposits_.span<shared::Photon>(); }
    Result<void> learn(const GpuScene&, const PhotonPilot&, bool all);

    // The maps of a film with so many pixels: map m is of samples [m, m + 1) * samples_per_map. Two photons a sample,
    // as the noise of a map is common to all pixels that see the same photons, so that samples alone do not average it
    // out; in large films, where maps cost a live picture too much, a wave of photons or a quarter a sample. Fewer by
    // as much as more of them are seen than of photons that start everywhere.
    static std::uint32_t samples_per_map(std::uint32_t pixels);
    std::uint32_t paths_per_map(std::uint32_t pixels) const;
    // Some maps in a row are made together, which has the same photons in the same order as one by one.
    struct Maps {
        std::uint32_t first = 0, count = 0;
    };
    Maps maps_with(std::uint32_t map, std::uint32_t pixels) const;
    bool has(const Maps& m, std::uint32_t seed) const {
        return whole_ && maps_.first == m.first && maps_.count == m.count && seed_ == seed;
    }
    // Starts them: all() photons, in waves, with collect() after each bounce, and finish().
    Result<void> begin(const Maps&, std::uint32_t seed, std::uint32_t pixels);
    std::uint64_t all() const { return std::uint64_t(maps_.count) * paths_; }
    Result<void> next_wave(std::uint64_t first_path);
    void collect(std::span<const std::uint32_t> paths); // that were shaded
    Result<void> finish(const GpuScene&, const EmbreeScene&);
    bool knows_radius(std::uint32_t seed) const { return seed_ == seed && first_radius_ > 0; } // once map 0 was made

  private:
    double caster_area() const;
    void add_source(std::uint32_t light, double power);
    void add_environment(const GpuScene&);
    void find_sources(const GpuScene&, const std::function<bool(const shared::LightNode&)>& pays);
    float radius_of(std::uint32_t map) const;
    float nearby(std::span<const shared::Photon>) const;
    Result<void> begin_maps(const Maps&, std::uint32_t seed, std::uint32_t paths);
    Result<void> use(PhotonStarts);
    Result<void> upload(shared::PhotonMap);

    gpu::Device& device_;
    Jobs& jobs_;
    bool started_ = false;
    std::vector<shared::PhotonSource> sources_;
    std::vector<char> is_caster_; // by instance
    std::vector<shared::CasterSphere> casters_;
    PhotonStarts starts_;
    Maps maps_;
    std::uint32_t paths_ = 0; // of each map
    std::uint64_t first_path_ = 0; // of the wave
    std::vector<shared::PhotonRun> runs_; // by map
    std::vector<std::vector<shared::Photon>> photons_; // by map
    double needed_ = 1; // of the photons, the part that is enough beside the noise of paths
    float first_radius_ = 0; // of map 0; 0 = not known yet
    std::uint32_t seed_ = 0;
    bool whole_ = false; // the maps are finished
    shared::PhotonMap head_{};
    gpu::Buffer record_, roles_, deposits_, source_buffer_, cdf_, caster_buffer_, photon_buffer_, cells_, start_buffer_,
        run_buffer_;
};

} // namespace restage::render
