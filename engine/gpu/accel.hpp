// SPDX-License-Identifier: Apache-2.0
// Acceleration structures: a Blas per mesh, one Tlas over the instances. Shaders get a Tlas as its 64-bit address in a
// push constant or buffer: traceRayEXT(accelerationStructureEXT(address), ...).
#pragma once

#include "base/result.hpp"
#include "gpu/buffer.hpp"

#include <volk.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace restage::gpu {

struct BlasInput {
    VkDeviceAddress vertices = 0; // three floats each
    std::uint32_t vertex_stride = 12;
    std::uint32_t vertex_count = 0;
    VkDeviceAddress indices = 0; // three uint32 per triangle
    std::uint32_t triangle_count = 0;
    VkDeviceAddress boxes = 0; // VkAabbPositionsKHR, instead of triangles: intersection shaders define their contents
    std::uint32_t box_count = 0;
    bool opaque = true; // false: any-hit shaders run
    std::string name;
};

// The Vulkan object and its buffer; the basis of Blas and Tlas.
class AccelStructure {
  public:
    static Result<AccelStructure> create(Device& device, VkDeviceSize bytes, VkAccelerationStructureTypeKHR type,
                                         const char* name);
    AccelStructure() = default;
    ~AccelStructure();
    AccelStructure(AccelStructure&& other) noexcept;
    AccelStructure& operator=(AccelStructure&& other) noexcept;

    VkAccelerationStructureKHR handle() const { return handle_; }
    VkDeviceAddress address() const { return address_; }
    std::size_t bytes() const { return buffer_.size(); }

  private:
    Device* device_ = nullptr;
    VkAccelerationStructureKHR handle_ = VK_NULL_HANDLE;
    Buffer buffer_;
    VkDeviceAddress address_ = 0;
};

class Blas {
  public:
    explicit operator bool() const { return structure_.handle() != VK_NULL_HANDLE; }
    VkDeviceAddress address() const { return structure_.address(); } // for TlasInstance::blas
    std::size_t bytes() const { return structure_.bytes(); }

  private:
    friend class AccelBuilder;
    AccelStructure structure_;
};

struct BlasOptions {
    bool compact = true; // copy to the size needed; saves about half on GPUs
    std::size_t max_scratch_bytes = std::size_t(256) << 20; // upper limit of a batch (a single mesh may exceed it)
};

// Builds all and waits. The geometry may then be freed. Result i belongs to input i.
Result<std::vector<Blas>> build_blas(Device& device, std::span<const BlasInput> inputs,
                                     const BlasOptions& options = {});

struct TlasInstance {
    // Object to world, three rows of four: x' = m[0]*x + m[1]*y + m[2]*z + m[3].
    std::array<float, 12> transform{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    VkDeviceAddress blas = 0;       // 0: empty
    std::uint32_t custom_index = 0; // gl_InstanceCustomIndexEXT, 24 bits
    std::uint32_t hit_group = 0;    // index into RayTracingShaders::hit_groups, 24 bits
    std::uint8_t mask = 0xff;
    bool two_sided = true;      // no culling by facing, regardless of ray flags
    bool flip_facing = false;   // front faces are counter-clockwise
    bool force_opaque = false;  // never run any-hit
    bool force_any_hit = false; // run any-hit although the Blas is opaque
};

// Moving one of many instances: set() and build(); no Blas and no other instance is touched.
class Tlas {
  public:
    // Room for `capacity` instances.
    static Result<Tlas> create(Device& device, std::uint32_t capacity, const char* name);

    explicit operator bool() const { return structure_.handle() != VK_NULL_HANDLE; }
    VkDeviceAddress address() const { return structure_.address(); } // unchanged by rebuilds
    std::uint32_t capacity() const { return capacity_; }
    std::uint32_t count() const { return count_; }

    // These write memory that a build reads: no build of this Tlas may be running.
    void set(std::uint32_t index, const TlasInstance& instance);
    void set_all(std::span<const TlasInstance> instances); // count() = their number
    void resize(std::uint32_t count);                      // instances beyond the old count are empty
    // Builds and waits. Or record CommandList::build(tlas).
    Result<void> build();

  private:
    friend class CommandList;
    Device* device_ = nullptr;
    AccelStructure structure_;
    Buffer instances_, scratch_;
    VkDeviceAddress scratch_address_ = 0;
    std::uint32_t capacity_ = 0, count_ = 0;
};

} // namespace restage::gpu
