// SPDX-License-Identifier: Apache-2.0
// CausticPhotons: photon maps of light that went by specular bounces only from a light to the surface where it is
// gathered, for the wavefront tracer (shaders/lib/photons.glsl). Progressive: map after map of as many photons, with a
// radius that shrinks so that both the noise and the blur of their mean vanish (Knaus and Zwicker 2011, eq. 15, 20).
#pragma once

#include "base/jobs.hpp"
#include "gpu/device.hpp"
#include "render/gpu_scene.hpp"
#include "render/photon_borders.hpp"
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

    // The maps of a film with so many pixels: map m is of samples [m, m + 1) * samples_per_map. Two photons a sample,
    // as the noise of a map is common to all pixels that see the same photons, so that samples alone do not average it
    // out; in large films, where maps cost a live picture too much, a wave of photons or a quarter a sample.
    static std::uint32_t paths_per_map(std::uint32_t pixels);
    static std::uint32_t samples_per_map(std::uint32_t pixels);
    bool has(std::uint32_t map, std::uint32_t seed) const { return whole_ && map_ == map && seed_ == seed; }
    // Empties the map; then waves of its `paths` photons, collect() after each bounce, and finish().
    void begin(std::uint32_t map, std::uint32_t seed, std::uint32_t paths);
    Result<void> next_wave(std::uint32_t first_path);
    void collect(std::span<const std::uint32_t> paths); // that were shaded
    Result<void> finish(const GpuScene&, const EmbreeScene&);
    bool knows_radius(std::uint32_t seed) const { return seed_ == seed && first_radius_ > 0; } // once map 0 was made
    std::size_t count() const { return photons_.size(); }

  private:
    double caster_area() const;
    void add_source(std::uint32_t light, double power);
    void add_environment(const GpuScene&);
    void find_sources(const GpuScene&, const std::function<bool(const shared::LightNode&)>& pays);
    float radius_of(std::uint32_t map) const;
    float nearby() const;
    Result<void> upload(shared::PhotonMap);

    gpu::Device& device_;
    Jobs& jobs_;
    bool started_ = false;
    std::vector<shared::PhotonSource> sources_;
    std::vector<char> is_caster_; // by instance
    std::vector<shared::CasterSphere> casters_;
    std::vector<shared::Photon> photons_;
    float first_radius_ = 0; // of map 0; 0 = not known yet
    std::uint32_t map_ = 0, seed_ = 0;
    bool whole_ = false; // the map is finished
    shared::PhotonMap head_{};
    gpu::Buffer record_, roles_, deposits_, source_buffer_, cdf_, caster_buffer_, photon_buffer_, cells_;
};

} // namespace restage::render
