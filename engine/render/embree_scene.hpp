// SPDX-License-Identifier: Apache-2.0
// Embree's view of a GpuScene: a scene per mesh over the buffers that kernels read, and one over the instances.
#pragma once

#include "render/gpu_scene.hpp"
#include "shared/path_data.h"

#include <memory>
#include <unordered_map>

struct RTCDeviceTy;
struct RTCSceneTy;

namespace restage::render {

class EmbreeScene {
  public:
    static Result<std::unique_ptr<EmbreeScene>> create(unsigned threads);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;

    // Follows the GpuScene; builds only what `changes` names.
    Result<void> update(const GpuScene& scene, const SceneChanges& changes);

    // In place, on the kernels' memory: `ray` is a shared::RayHit, `shadow` a shared::ShadowRay. Thread-safe between
    // updates. intersect leaves inst == NONE on a miss; occluded sets tfar to -inf when something is in the way.
    void intersect(shared::RayHit& ray) const;
    void occluded(shared::ShadowRay& shadow) const;

  private:
    struct Mesh;
    EmbreeScene() = default;
    const GpuScene* scene_ = nullptr;
    RTCDeviceTy* device_ = nullptr;
    RTCSceneTy* top_ = nullptr;
    std::unordered_map<std::uint32_t, std::unique_ptr<Mesh>> meshes_; // by Id<Mesh>::value
    std::vector<std::uint32_t> attached_; // by instance: its mesh, 0 = not attached
};

} // namespace restage::render
