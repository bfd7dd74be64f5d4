// SPDX-License-Identifier: Apache-2.0
// EmbreeInstances: instances of meshes, to be traced. Embree builds a scene of them as a whole, which takes some 0.5 us
// an instance; so where there are many, those that are edited move to a small second scene, and rays go through both.
// The first one stays as built: there, rays do not see what has moved, by their mask. A mask has 32 bits, so that it
// hides a group at once: all with the same two bits, which move to the second scene, too.
#pragma once

#include "render/embree_api.hpp"

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace restage::render {

class EmbreeInstances {
  public:
    explicit EmbreeInstances(RTCDevice device);
    ~EmbreeInstances();
    EmbreeInstances(const EmbreeInstances&) = delete;

    // Changes, between begin() and commit(): of `changes` of the instances with indices below `count`; others are gone.
    void begin(std::size_t count, std::size_t changes);
    // mesh: not 0. replaced: `scene`, that of the mesh, is not the one of before.
    void place(std::uint32_t instance, std::uint32_t mesh, RTCScene scene, const glm::mat4x3& placement, bool replaced);
    void remove(std::uint32_t instance);
    void commit();
    // In one scene again, which is what long renderings are fastest with.
    void merge();
    bool apart() const { return apart_ != nullptr; } // whether merge() has something to do

    std::uint32_t mesh_of(std::uint32_t instance) const { return meshes_[instance]; } // 0: it has no place

    // What rays ask, one after the other. The id of an instance hit is its index in `names`, or without these its own.
    struct Part {
        RTCScene scene;
        unsigned mask; // of rays
        std::span<const std::uint32_t> names;
    };
    Part all() const { return {base_, seen_, {}}; }
    Part edited() const { return {apart_, ~0u, names_}; } // without a scene unless apart()

  private:
    RTCGeometry geometry(std::uint32_t instance) const;
    bool hidden(std::uint32_t instance) const { return codes_[instance] && !(codes_[instance] & seen_); }
    std::uint32_t code(std::uint32_t instance) const;
    void attach_to_base(RTCGeometry, std::uint32_t instance);
    void attach_apart(RTCGeometry, std::uint32_t instance);
    void detach(std::uint32_t instance); // from where it is to be changed
    void hide_group(std::uint32_t instance);
    void end_apart();

    RTCDevice device_;
    bool masks_; // Embree may have been built without
    RTCScene base_, apart_ = nullptr;
    unsigned seen_ = ~0u; // mask of rays in base_: without the bits of those hidden
    bool aside_ = false; // the changes go to apart_, not to base_
    bool base_changed_ = false, apart_changed_ = false;
    std::size_t per_group_ = 1;
    // By instance:
    std::vector<std::uint32_t> meshes_;
    std::vector<std::uint32_t> codes_; // mask in base_; 0: it is not there
    std::vector<std::uint32_t> ids_; // in apart_, or NONE
    std::vector<std::uint32_t> names_; // instances by id in apart_
};

} // namespace restage::render
