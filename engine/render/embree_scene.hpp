// SPDX-License-Identifier: Apache-2.0
// Embree's view of a GpuScene: a scene per mesh on the buffers that kernels read, and one of the instances. A scene
// that was read as a whole and hardly repeats meshes is flat instead: one scene of all triangles in world space, until
// an edit.
#pragma once

#include "render/gpu_scene.hpp"
#include "shared/path_data.h"

#include <memory>
#include <span>
#include <unordered_map>

struct RTCDeviceTy;
struct RTCSceneTy;

namespace restage::render {

class EmbreeInstances;

class EmbreeScene {
  public:
    struct Use {
        bool copies = false; // copies meshes, for devices whose memory is slow to read from the CPU
        std::uint64_t flat_from = never; // triangles of a scene to be flattened
    };
    static constexpr std::uint64_t never = ~std::uint64_t(0);
    static Result<std::unique_ptr<EmbreeScene>> create(unsigned threads, Use);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;

    // Updates to the GpuScene; builds only what `changes` lists.
    Result<void> update(const GpuScene& scene, const SceneChanges& changes);
    // Of many instances, edited ones are kept apart, so that updates are fast; settle() ends that, so that rays are.
    bool settled() const;
    Result<void> settle();

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
    // The same for several rays, those of these indices; in packets where that is faster. What a ray hits does not
    // depend on the others. Of `ng`, nothing.
    void intersect(std::span<shared::RayHit>, std::span<const std::uint32_t> which) const;
    void occluded(std::span<shared::ShadowRay>, std::span<const std::uint32_t> which) const;

    // Whether hits are those of triangles in world space, whose vertices are rounded there (lib/ray_offset.glsl), and
    // `ng` is in world space, too.
    bool flat() const { return flat_ != nullptr; }

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
    EmbreeScene();
    Result<void> update_instances(const SceneChanges&);
    bool flattening_pays(const SceneChanges&) const;
    Result<void> flatten(const SceneChanges&);
    Result<void> unflatten(const SceneChanges&);
    Result<void> make_box();
    Mesh& mesh_of(std::uint32_t instance) const;
    bool add_filters(const SceneChanges&);
    template <int>
    void intersect_packets(std::span<shared::RayHit>, std::span<const std::uint32_t>) const;
    template <int>
    void occluded_packets(std::span<shared::ShadowRay>, std::span<const std::uint32_t>) const;
    void update(EmbreeInstances&, const SceneChanges&, bool refiltered, bool (GpuScene::*wanted)(std::uint32_t) const);
    void intersect_instances(const EmbreeInstances&, shared::RayHit&, std::vector<Undecided>*) const;
    Result<void> check(const char* what) const;
    const GpuScene* scene_ = nullptr;
    RTCDeviceTy* device_ = nullptr;
    Use use_;
    int packet_size_ = 1; // that this machine's instructions support
    float reach_ = 0; // limit of ray coordinates, so that they fit the smallest object's space [scene units]
    std::unique_ptr<EmbreeInstances> surfaces_, borders_; // what light hits; borders of media, which it passes
    std::unordered_map<std::uint32_t, std::unique_ptr<Mesh>> meshes_; // by Id<Mesh>::value; without quadrics
    RTCSceneTy* flat_ = nullptr; // instead of surfaces_; geometries by instance
    std::vector<scene::Id<scene::Mesh>> not_built_; // meshes of a flat scene
    std::unique_ptr<Mesh> box_; // for all quadrics; null until needed
};

} // namespace restage::render
