// SPDX-License-Identifier: Apache-2.0
// Compute and ray-tracing pipelines. Their only inputs are push constants (which carry addresses) and specialization
// constants. Creating or destroying one may block until running work ends (lavapipe does): do it between tiles.
#pragma once

#include "base/result.hpp"
#include "gpu/buffer.hpp"
#include "gpu/compiler.hpp"

#include <volk.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace restage::gpu {

// layout(constant_id = id) const uint|int|bool. Ids unknown to a shader are ignored. For float: std::bit_cast.
struct SpecConstant {
    std::uint32_t id = 0;
    std::uint32_t value = 0;
};

// Common to both kinds.
class Pipeline {
  public:
    Pipeline() = default;
    ~Pipeline();
    Pipeline(Pipeline&& other) noexcept;
    Pipeline& operator=(Pipeline&& other) noexcept;

    explicit operator bool() const { return pipeline_ != VK_NULL_HANDLE; }
    VkPipeline handle() const { return pipeline_; }
    VkPipelineLayout layout() const { return layout_; }
    std::uint32_t push_constant_bytes() const { return push_constant_bytes_; }
    std::size_t shader_bytes() const { return shader_bytes_; } // of the SPIR-V it was built from

  protected:
    // With a layout of `push_constant_bytes` for `stages`, and no pipeline yet.
    Result<void> begin(Device& device, VkShaderStageFlags stages, std::uint32_t push_constant_bytes, const char* name);
    // The result of vkCreate...Pipelines, named, or its error.
    Result<void> finish(VkResult result, const char* name);

    Device* device_ = nullptr;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    std::uint32_t push_constant_bytes_ = 0;
    std::size_t shader_bytes_ = 0;
};

class ComputePipeline : public Pipeline {
  public:
    // The shader sets the workgroup size, possibly by specialization constants (local_size_x_id).
    static Result<ComputePipeline> create(Device& device, const Spirv& shader, std::uint32_t push_constant_bytes,
                                          std::span<const SpecConstant> constants, const char* name);
};

// One kind of surface: the shaders for the closest hit, and (nullptr: none) for every non-opaque candidate hit.
struct HitGroup {
    const Spirv* closest_hit = nullptr;
    const Spirv* any_hit = nullptr;
    const Spirv* intersection = nullptr; // of boxes; nullptr: of triangles
};

struct RayTracingShaders {
    const Spirv* raygen = nullptr;
    std::span<const Spirv* const> misses;    // index = missIndex of traceRayEXT
    std::span<const HitGroup> hit_groups;    // index = sbtRecordOffset of traceRayEXT + the instance's hit_group
    std::span<const Spirv* const> callables; // index = sbtRecordIndex of executeCallableEXT
    // Empty, or per callable the constants that replace the pipeline's.
    std::span<const std::vector<SpecConstant>> callable_constants;
};

// Recursion depth is 1: only raygen traces. Geometry contributes nothing to the hit group index (sbtRecordStride 0).
class RayTracingPipeline : public Pipeline {
  public:
    static Result<RayTracingPipeline> create(Device& device, const RayTracingShaders& shaders,
                                             std::uint32_t push_constant_bytes, std::span<const SpecConstant> constants,
                                             const char* name);
    // Push constants are visible to all of them.
    static constexpr VkShaderStageFlags stages =
        VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_MISS_BIT_KHR | VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR |
        VK_SHADER_STAGE_ANY_HIT_BIT_KHR | VK_SHADER_STAGE_INTERSECTION_BIT_KHR | VK_SHADER_STAGE_CALLABLE_BIT_KHR;

  private:
    friend class CommandList;
    Buffer binding_table_;
    VkStridedDeviceAddressRegionKHR raygen_{}, misses_{}, hits_{}, callables_{};
};

} // namespace restage::gpu
