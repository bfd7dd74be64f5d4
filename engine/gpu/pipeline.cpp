// SPDX-License-Identifier: Apache-2.0
// Compute and ray-tracing pipelines, and the shader binding table.
#include "gpu/pipeline.hpp"

#include "gpu/device.hpp"
#include "gpu/float_controls.hpp"

#include <cassert>
#include <cstring>
#include <deque>
#include <utility>

namespace restage::gpu {

namespace {

// Modules live only during pipeline creation.
class Modules {
  public:
    explicit Modules(Device& device) : device_(device) {}
    ~Modules() {
        for (VkShaderModule module : modules_)
            device_.vk().vkDestroyShaderModule(device_.handle(), module, nullptr);
    }
    Modules(const Modules&) = delete;
    Modules& operator=(const Modules&) = delete;

    Result<VkShaderModule> create(const Spirv& shader) {
        const auto words = device_.info().keeps_nan ? keep_nan(shader.words) : shader.words;
        const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                            .codeSize = words.size() * sizeof(std::uint32_t),
                                            .pCode = words.data()};
        VkShaderModule module = VK_NULL_HANDLE;
        const VkResult result = device_.vk().vkCreateShaderModule(device_.handle(), &info, nullptr, &module);
        if (result != VK_SUCCESS) return device_.error(result, "loading the shader " + shader.name);
        modules_.push_back(module);
        device_.set_name(VK_OBJECT_TYPE_SHADER_MODULE, reinterpret_cast<std::uint64_t>(module), shader.name.c_str());
        return module;
    }

  private:
    Device& device_;
    std::vector<VkShaderModule> modules_;
};

class Specialization {
  public:
    explicit Specialization(std::span<const SpecConstant> constants) {
        for (const SpecConstant& c : constants) {
            entries_.push_back(
                {c.id, static_cast<std::uint32_t>(values_.size() * sizeof(std::uint32_t)), sizeof(std::uint32_t)});
            values_.push_back(c.value);
        }
        info_ = {static_cast<std::uint32_t>(entries_.size()), entries_.data(), values_.size() * sizeof(std::uint32_t),
                 values_.data()};
    }
    const VkSpecializationInfo* info() const { return &info_; }

  private:
    std::vector<VkSpecializationMapEntry> entries_;
    std::vector<std::uint32_t> values_;
    VkSpecializationInfo info_{};
};

Result<VkPipelineLayout> create_layout(Device& device, VkShaderStageFlags stages, std::uint32_t push_constant_bytes,
                                       const char* name) {
    assert(push_constant_bytes % 4 == 0);
    if (push_constant_bytes > device.info().max_push_constant_bytes)
        return fail(std::string("pipeline ") + name + " needs " + std::to_string(push_constant_bytes) +
                    " bytes of push constants; " + device.info().name + " has " +
                    std::to_string(device.info().max_push_constant_bytes));
    const VkPushConstantRange range{.stageFlags = stages, .offset = 0, .size = push_constant_bytes};
    const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                          .pushConstantRangeCount = push_constant_bytes > 0 ? 1u : 0u,
                                          .pPushConstantRanges = &range};
    VkPipelineLayout layout = VK_NULL_HANDLE;
    const VkResult result = device.vk().vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout);
    if (result != VK_SUCCESS) return device.error(result, std::string("creating the layout of pipeline ") + name);
    return layout;
}

std::uint32_t align_up(std::uint32_t value, std::uint32_t alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

} // namespace

// ---- either kind ---------------------------------------------------------------------------------------------------

Pipeline::~Pipeline() {
    if (pipeline_) device_->vk().vkDestroyPipeline(device_->handle(), pipeline_, nullptr);
    if (layout_) device_->vk().vkDestroyPipelineLayout(device_->handle(), layout_, nullptr);
}
Pipeline::Pipeline(Pipeline&& other) noexcept { *this = std::move(other); }
Pipeline& Pipeline::operator=(Pipeline&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(pipeline_, other.pipeline_);
    std::swap(layout_, other.layout_);
    std::swap(push_constant_bytes_, other.push_constant_bytes_);
    std::swap(shader_bytes_, other.shader_bytes_);
    return *this;
}

Result<void> Pipeline::begin(Device& device, VkShaderStageFlags stages, std::uint32_t push_constant_bytes,
                             const char* name) {
    device_ = &device;
    push_constant_bytes_ = push_constant_bytes;
    RESTAGE_TRY(layout_, create_layout(device, stages, push_constant_bytes, name));
    return {};
}

Result<void> Pipeline::finish(VkResult result, const char* name) {
    if (result != VK_SUCCESS) {
        pipeline_ = VK_NULL_HANDLE;
        return device_->error(result, std::string("creating pipeline ") + name);
    }
    device_->set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline_), name);
    return {};
}

// ---- compute -------------------------------------------------------------------------------------------------------

Result<ComputePipeline> ComputePipeline::create(Device& device, const Spirv& shader, std::uint32_t push_constant_bytes,
                                                std::span<const SpecConstant> constants, const char* name) {
    assert(shader.stage == ShaderStage::compute);
    ComputePipeline self;
    RESTAGE_CHECK(self.begin(device, VK_SHADER_STAGE_COMPUTE_BIT, push_constant_bytes, name));
    self.shader_bytes_ = shader.words.size() * sizeof(std::uint32_t);
    Modules modules(device);
    RESTAGE_TRY(const VkShaderModule module, modules.create(shader));
    const Specialization specialization(constants);
    const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                           .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                     .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                     .module = module,
                                                     .pName = "main",
                                                     .pSpecializationInfo = specialization.info()},
                                           .layout = self.layout_};
    const VkResult result = device.vk().vkCreateComputePipelines(device.handle(), device.pipeline_cache(), 1, &info,
                                                                 nullptr, &self.pipeline_);
    RESTAGE_CHECK(self.finish(result, name));
    return self;
}

// ---- ray tracing ---------------------------------------------------------------------------------------------------

Result<RayTracingPipeline> RayTracingPipeline::create(Device& device, const RayTracingShaders& shaders,
                                                      std::uint32_t push_constant_bytes,
                                                      std::span<const SpecConstant> constants, const char* name) {
    if (!device.info().ray_tracing) return fail(device.info().missing_ray_tracing);
    RayTracingPipeline self;
    RESTAGE_CHECK(self.begin(device, stages, push_constant_bytes, name));

    Modules modules(device);
    const Specialization specialization(constants);
    std::vector<VkPipelineShaderStageCreateInfo> stage_infos;
    std::vector<std::pair<const Spirv*, std::uint32_t>> known; // a shader shared by several groups is compiled once
    std::deque<Specialization> own; // of callables
    const auto stage_of = [&](const Spirv* shader, VkShaderStageFlagBits stage,
                              const VkSpecializationInfo* own_constants = nullptr) -> Result<std::uint32_t> {
        if (!shader) return VK_SHADER_UNUSED_KHR;
        for (const auto& [other, index] : known)
            if (other == shader) return index;
        RESTAGE_TRY(const VkShaderModule module, modules.create(*shader));
        self.shader_bytes_ += shader->words.size() * sizeof(std::uint32_t);
        stage_infos.push_back({.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                               .stage = stage,
                               .module = module,
                               .pName = "main",
                               .pSpecializationInfo = own_constants ? own_constants : specialization.info()});
        known.emplace_back(shader, static_cast<std::uint32_t>(stage_infos.size() - 1));
        return known.back().second;
    };
    std::vector<VkRayTracingShaderGroupCreateInfoKHR> groups;
    const auto add_general = [&](const Spirv* shader, VkShaderStageFlagBits stage,
                                 const VkSpecializationInfo* own_constants = nullptr) -> Result<void> {
        RESTAGE_TRY(const std::uint32_t index, stage_of(shader, stage, own_constants));
        groups.push_back({.sType = VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR,
                          .type = VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR,
                          .generalShader = index,
                          .closestHitShader = VK_SHADER_UNUSED_KHR,
                          .anyHitShader = VK_SHADER_UNUSED_KHR,
                          .intersectionShader = VK_SHADER_UNUSED_KHR});
        return {};
    };
    RESTAGE_CHECK(add_general(shaders.raygen, VK_SHADER_STAGE_RAYGEN_BIT_KHR));
    for (const Spirv* shader : shaders.misses)
        RESTAGE_CHECK(add_general(shader, VK_SHADER_STAGE_MISS_BIT_KHR));
    for (const HitGroup& group : shaders.hit_groups) {
        RESTAGE_TRY(const std::uint32_t closest, stage_of(group.closest_hit, VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR));
        RESTAGE_TRY(const std::uint32_t any, stage_of(group.any_hit, VK_SHADER_STAGE_ANY_HIT_BIT_KHR));
        RESTAGE_TRY(const std::uint32_t in_box, stage_of(group.intersection, VK_SHADER_STAGE_INTERSECTION_BIT_KHR));
        groups.push_back({.sType = VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR,
                          .type = group.intersection ? VK_RAY_TRACING_SHADER_GROUP_TYPE_PROCEDURAL_HIT_GROUP_KHR
                                                     : VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR,
                          .generalShader = VK_SHADER_UNUSED_KHR,
                          .closestHitShader = closest,
                          .anyHitShader = any,
                          .intersectionShader = in_box});
    }
    assert(shaders.callable_constants.empty() || shaders.callable_constants.size() == shaders.callables.size());
    for (std::size_t i = 0; i < shaders.callables.size(); ++i) {
        if (!shaders.callable_constants.empty()) own.emplace_back(shaders.callable_constants[i]);
        RESTAGE_CHECK(add_general(shaders.callables[i], VK_SHADER_STAGE_CALLABLE_BIT_KHR,
                                  own.empty() ? nullptr : own.back().info()));
    }

    const VkRayTracingPipelineCreateInfoKHR info{.sType = VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR,
                                                 .stageCount = static_cast<std::uint32_t>(stage_infos.size()),
                                                 .pStages = stage_infos.data(),
                                                 .groupCount = static_cast<std::uint32_t>(groups.size()),
                                                 .pGroups = groups.data(),
                                                 .maxPipelineRayRecursionDepth = 1,
                                                 .layout = self.layout_};
    const VolkDeviceTable& vk = device.vk();
    VkResult result = vk.vkCreateRayTracingPipelinesKHR(device.handle(), VK_NULL_HANDLE, device.pipeline_cache(), 1,
                                                        &info, nullptr, &self.pipeline_);
    RESTAGE_CHECK(self.finish(result, name));

    // The binding table: four regions, each with one handle per group, in the order of the groups.
    const VkPhysicalDeviceRayTracingPipelinePropertiesKHR& rt = device.ray_tracing_properties();
    const std::uint32_t handle_bytes = rt.shaderGroupHandleSize;
    const std::uint32_t stride = align_up(handle_bytes, rt.shaderGroupHandleAlignment);
    std::vector<std::byte> handles(groups.size() * std::size_t(handle_bytes));
    result = vk.vkGetRayTracingShaderGroupHandlesKHR(
        device.handle(), self.pipeline_, 0, static_cast<std::uint32_t>(groups.size()), handles.size(), handles.data());
    if (result != VK_SUCCESS) return device.error(result, std::string("reading the shader groups of ") + name);
    const std::uint32_t counts[4] = {1, static_cast<std::uint32_t>(shaders.misses.size()),
                                     static_cast<std::uint32_t>(shaders.hit_groups.size()),
                                     static_cast<std::uint32_t>(shaders.callables.size())};
    VkStridedDeviceAddressRegionKHR* const regions[4] = {&self.raygen_, &self.misses_, &self.hits_, &self.callables_};
    std::vector<std::byte> table;
    std::size_t group = 0;
    for (int r = 0; r < 4; ++r) {
        if (counts[r] == 0) continue; // the region stays zero
        const std::size_t start = align_up(static_cast<std::uint32_t>(table.size()), rt.shaderGroupBaseAlignment);
        table.resize(start + std::size_t(counts[r]) * stride);
        for (std::uint32_t i = 0; i < counts[r]; ++i, ++group)
            std::memcpy(table.data() + start + std::size_t(i) * stride, handles.data() + group * handle_bytes,
                        handle_bytes);
        *regions[r] = {.deviceAddress = start, .stride = stride, .size = VkDeviceSize(counts[r]) * stride};
    }
    // Room to align the start: base alignment applies to addresses.
    RESTAGE_TRY(self.binding_table_,
                device.create_buffer(table.size() + rt.shaderGroupBaseAlignment, BufferKind::device, name));
    const VkDeviceAddress address = self.binding_table_.address();
    const VkDeviceAddress aligned =
        (address + rt.shaderGroupBaseAlignment - 1) / rt.shaderGroupBaseAlignment * rt.shaderGroupBaseAlignment;
    RESTAGE_CHECK(device.upload(self.binding_table_, aligned - address, table));
    for (VkStridedDeviceAddressRegionKHR* region : regions)
        if (region->size > 0) region->deviceAddress += aligned;
    return self;
}

} // namespace restage::gpu
