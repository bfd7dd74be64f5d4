// SPDX-License-Identifier: Apache-2.0
// Embree's view of a GpuScene: a scene per mesh on the buffers that kernels read, and one of the instances.
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
    // `copies`: copies meshes, for devices whose memory is slow to read from the CPU.
    static Result<std::unique_ptr<EmbreeScene>> create(unsigned threads, bool copies = false);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;

    // Updates to the GpuScene; builds only what `changes` lists.
    Result<void> update(const GpuScene& scene, const SceneChanges& changes);

    // In place, on the kernels' memory: `ray` is a shared::RayHit, `shadow` a shared::ShadowRay. Thread-safe between
    // updates. intersect leaves inst == NONE on a miss; occluded sets tfar to -inf if blocked.
    // Hits that native code cannot decide (GpuScene::undecided) are passed and added to `undecided`, unordered; if it
    // is null, the textures' averages decide them.
    struct Undecided {
        float t = 0;
        std::uint32_t instance = 0, prim = 0;
        glm::vec2 bary{0};
        std::uint32_t choice = 0; // see GpuScene::stops
    };
    void intersect(shared::RayHit& ray, std::vector<Undecided>* undecided = nullptr) const;
    void occluded(shared::ShadowRay& shadow, std::vector<Undecided>* undecided = nullptr) const;

    // Transmittance along a ray from t_start to t_end, and the medium there: Beer-Lambert between
    // the borders of media that the ray passes, nearest first; each one sets the medium behind it (pbrt 4ed, 11.4).
    struct Passed {
        glm::vec4 transmittance; // RGB (x, y, z), or of the wavelengths chosen by `hero`
        std::uint32_t medium;
    };
    struct Stretch {
        glm::vec3 origin, direction;
        float t_start = 0, t_end = 0;
    };
    Passed pass_borders(const Stretch&, std::uint32_t medium, float hero) const;

  private:
    struct Mesh;
    struct Instances { // a scene over instances of the meshes
        RTCSceneTy* scene = nullptr;
        std::vector<std::uint32_t> attached; // mesh by instance, 0 = not attached
    };
    EmbreeScene() = default;
    void update(Instances&, const GpuScene&, const SceneChanges&, bool (GpuScene::*wanted)(std::uint32_t) const);
    void intersect(const Instances&, shared::RayHit&, std::vector<Undecided>*) const;
    const GpuScene* scene_ = nullptr;
    RTCDeviceTy* device_ = nullptr;
    bool copies_ = false;
    float reach_ = 0; // limit of ray coordinates, so that they fit the smallest object's space [scene units]
    Instances surfaces_, borders_; // what light hits; borders of media, which it passes
    Result<void> make_box();
    std::unordered_map<std::uint32_t, std::unique_ptr<Mesh>> meshes_; // by Id<Mesh>::value; without quadrics
    std::unique_ptr<Mesh> box_; // for all quadrics; null until needed
};

} // namespace restage::render
