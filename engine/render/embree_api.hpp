// SPDX-License-Identifier: Apache-2.0
// Embree's interface, of version 3 or 4, and what a query passes to the filters. For the files of EmbreeScene.
#pragma once

#include "render/embree_scene.hpp"

#if RESTAGE_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <vector>

namespace restage::render {

struct EmbreeScene::Mesh {
    RTCScene scene = nullptr;
    RTCGeometry geometry = nullptr; // owned by `scene`
    bool filtered = false;
    const EmbreeScene* owner = nullptr;
    ~Mesh() {
        if (scene) rtcReleaseScene(scene);
    }
};

struct EmbreeQuery {
#if RESTAGE_EMBREE_MAJOR == 3
    using Context = RTCIntersectContext;
#else
    using Context = RTCRayQueryContext;
#endif
    Context embree; // first: the part known to Embree
    bool borders = false;        // query hits borders of media, not surfaces
    bool shadow = false;         // query hits surfaces that block light
    glm::vec3 origin, direction; // of a single ray in world space: Embree transforms it to instance space
    std::span<const std::uint32_t> names; // see EmbreeInstances::Part
    std::vector<EmbreeScene::Undecided>* undecided = nullptr; // null: undecidable hits are decided by averages

    EmbreeQuery() {
#if RESTAGE_EMBREE_MAJOR == 3
        rtcInitIntersectContext(&embree);
#else
        rtcInitRayQueryContext(&embree);
#endif
    }
    std::uint32_t instance() const { return names.empty() ? embree.instID[0] : names[embree.instID[0]]; } // being met
};

// Cut-outs, lamps without a surface, and mixes with a null component: called for candidate hits of meshes that some
// instance uses that way.
void embree_hit_filter(const RTCFilterFunctionNArguments*);
// Makes a user geometry the box of all quadrics.
void set_embree_box(RTCGeometry);

} // namespace restage::render
