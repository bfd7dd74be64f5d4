// SPDX-License-Identifier: Apache-2.0
// PhotonPilot: a few camera paths and photons, before the samples and apart from them, tell whether a picture sees
// light that photons would carry, and from where such light starts. They run through the kernels of paths, so to learn
// that photons do not pay takes no kernel that gathers them.
#pragma once

#include "render/photon_starts.hpp"
#include "render/wave_memory.hpp"
#include "shared/photon_data.h"

#include <cstdint>
#include <span>
#include <vector>

namespace restage::render {

class PhotonPilot {
  public:
    explicit PhotonPilot(WaveMemory& wave) : wave_(wave) {}

    // A wave of camera paths, and then one of photons.
    void begin(std::uint32_t paths);
    // Hits of these paths, before they are shaded and after.
    void before_bounce(std::span<const std::uint32_t> active);
    void after_camera_bounce(std::span<const std::uint32_t> active);
    void end_camera();
    // After the kernel that starts photons, which left their cells and their lights' radiance in their deposits.
    void photons_started(std::span<const shared::Photon> deposits);
    void after_photon_bounce(std::span<const std::uint32_t> active, std::span<const char> casters);

    // What photons would do for the picture, and which of them. Noise is that of one sample of a pixel.
    struct Findings {
        double found = 0; // mean over the picture of: of the noise of paths, the part that photons would carry
        double never = 0; // mean over the picture of: of its light, what photons would carry and paths never find
        double photons = 0; // mean over the picture of: of the noise, the part that would be that of photons if each
                            // vertex met one of them
        std::vector<PhotonStarts::Try> tries;
    };
    // least: of distances, for which the scene is large enough to have cells.
    Findings findings(float least) const;

  private:
    struct Hit { // the last one of a path
        glm::vec3 p{0};
        std::uint32_t instance = NONE, depth = 0;
        float throughput = 0; // before it
    };
    struct Vertex { // of a camera path, where it scattered
        glm::vec3 p{0};
        std::uint32_t path = 0;
        float throughput = 0; // behind it
    };
    struct Start {
        std::uint32_t cell = 0;
        float power = 0;
        float radiance = 0; // of its light; 0: no path can meet that
    };
    struct Deposit { // where a photon met something that scatters
        glm::vec3 p{0};
        std::uint32_t photon = 0;
        float power = 0;
    };
    struct Carried { // light of a path that photons would carry, by its means
        double found = 0, never = 0; // of lights that paths can meet, and of others
        double found_squared = 0; // of the path that finds it by chance
    };
    static bool goes_on(const Hit&, const shared::PathState&);
    std::vector<Carried> carried(float least) const;
    void mark_seen(float least, std::span<char> seen) const;

    WaveMemory& wave_;
    std::vector<Hit> hits_; // by path
    std::vector<float> light_; // by camera path
    std::vector<Vertex> vertices_;
    std::vector<Start> starts_; // by photon
    std::vector<Deposit> deposits_;
};

} // namespace restage::render
