// SPDX-License-Identifier: Apache-2.0
// Borders of surfaces in photon maps. Where a surface ends, at a wall or an edge, part of the disk in which photons are
// gathered is empty, and their density comes out too low. Photons near a border are mirrored at it, so that the disk is
// full (the reflection method of density estimation: Silverman 1986, "Density Estimation", sec. 2.10).
#pragma once

#include "base/jobs.hpp"
#include "render/embree_scene.hpp"
#include "shared/photon_data.h"

#include <span>
#include <vector>

namespace restage::render {

struct PhotonBorders {
    const GpuScene& scene;
    const EmbreeScene& embree;
    std::span<const char> casters; // by instance: light passes these, so that surfaces go on behind them

    // The images of photons that are closer than `radius` to a border, in the order of the photons. Four rays look
    // around each photon; straight borders are exact. An image that lies on a surface again, as behind a thin wall that
    // stands on a floor, is left out, unless a solid covers that place.
    std::vector<shared::Photon> images(std::span<const shared::Photon>, float radius, Jobs&) const;
};

} // namespace restage::render
