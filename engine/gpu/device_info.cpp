// SPDX-License-Identifier: Apache-2.0
// Properties and features of a physical device, and descriptions of missing ones.
#include "gpu/instance.hpp"

#include <algorithm>
#include <cstring>

namespace restage::gpu {

const char* to_string(DeviceType type) {
    switch (type) {
        case DeviceType::discrete:
            return "discrete GPU";
        case DeviceType::integrated:
            return "integrated GPU";
        case DeviceType::virtual_gpu:
            return "virtual GPU";
        case DeviceType::cpu:
            return "CPU";
        case DeviceType::other:
            break;
    }
    return "unknown device";
}

const char* result_name(VkResult result) {
    switch (result) {
        case VK_SUCCESS:
            return "VK_SUCCESS";
        case VK_NOT_READY:
            return "VK_NOT_READY";
        case VK_TIMEOUT:
            return "VK_TIMEOUT";
        case VK_INCOMPLETE:
            return "VK_INCOMPLETE";
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            return "VK_ERROR_OUT_OF_HOST_MEMORY";
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
        case VK_ERROR_INITIALIZATION_FAILED:
            return "VK_ERROR_INITIALIZATION_FAILED";
        case VK_ERROR_DEVICE_LOST:
            return "VK_ERROR_DEVICE_LOST";
        case VK_ERROR_MEMORY_MAP_FAILED:
            return "VK_ERROR_MEMORY_MAP_FAILED";
        case VK_ERROR_LAYER_NOT_PRESENT:
            return "VK_ERROR_LAYER_NOT_PRESENT";
        case VK_ERROR_EXTENSION_NOT_PRESENT:
            return "VK_ERROR_EXTENSION_NOT_PRESENT";
        case VK_ERROR_FEATURE_NOT_PRESENT:
            return "VK_ERROR_FEATURE_NOT_PRESENT";
        case VK_ERROR_INCOMPATIBLE_DRIVER:
            return "VK_ERROR_INCOMPATIBLE_DRIVER";
        case VK_ERROR_TOO_MANY_OBJECTS:
            return "VK_ERROR_TOO_MANY_OBJECTS";
        case VK_ERROR_FRAGMENTATION:
            return "VK_ERROR_FRAGMENTATION";
        case VK_ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS:
            return "VK_ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS";
        default:
            return "an unexpected VkResult";
    }
}

std::vector<VkExtensionProperties> device_extensions(VkPhysicalDevice physical) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data());
    extensions.resize(count);
    return extensions;
}

void FeatureChain::link(bool ray_tracing) {
    core.pNext = &v12;
    v12.pNext = &v13;
    v13.pNext = ray_tracing ? &accel : nullptr;
    accel.pNext = &pipeline;
    pipeline.pNext = nullptr;
}

namespace {

std::string version_text(std::uint32_t version) {
    return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
           std::to_string(VK_API_VERSION_PATCH(version));
}

const char* first_missing_feature(const FeatureChain& f) {
    if (!f.core.features.shaderInt64) return "shaderInt64";
    if (!f.v12.bufferDeviceAddress) return "bufferDeviceAddress";
    if (!f.v12.scalarBlockLayout) return "scalarBlockLayout";
    if (!f.v13.synchronization2) return "synchronization2";
    if (!f.v13.maintenance4) return "maintenance4";
    return nullptr;
}

void describe_memory(VkPhysicalDevice physical, DeviceInfo& info) {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    info.unified_memory = info.type == DeviceType::cpu || info.type == DeviceType::integrated;
    for (std::uint32_t heap = 0; heap < memory.memoryHeapCount; ++heap) {
        if (!(memory.memoryHeaps[heap].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)) continue;
        info.memory_bytes = std::max<std::uint64_t>(info.memory_bytes, memory.memoryHeaps[heap].size);
        bool mappable = false;
        for (std::uint32_t t = 0; t < memory.memoryTypeCount; ++t)
            mappable |= memory.memoryTypes[t].heapIndex == heap &&
                        (memory.memoryTypes[t].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT);
        info.unified_memory &= mappable;
    }
}

} // namespace

DeviceInfo Instance::describe(VkPhysicalDevice physical, std::uint32_t index) const {
    VkPhysicalDeviceDriverProperties driver{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceMaintenance3Properties maintenance3{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES, .pNext = &driver};
    VkPhysicalDeviceSubgroupProperties subgroup{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES,
                                                .pNext = &maintenance3};
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    vkGetPhysicalDeviceProperties(physical, &properties.properties);
    const VkPhysicalDeviceProperties& p = properties.properties;

    DeviceInfo info;
    info.index = index;
    info.name = p.deviceName;
    info.vulkan_version = p.apiVersion;
    switch (p.deviceType) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            info.type = DeviceType::discrete;
            break;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            info.type = DeviceType::integrated;
            break;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            info.type = DeviceType::virtual_gpu;
            break;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            info.type = DeviceType::cpu;
            break;
        default:
            break;
    }
    std::copy(std::begin(p.pipelineCacheUUID), std::end(p.pipelineCacheUUID), info.uuid.begin());
    info.max_push_constant_bytes = p.limits.maxPushConstantsSize;
    info.max_storage_range_bytes = p.limits.maxStorageBufferRange;
    describe_memory(physical, info);
    if (p.apiVersion < VK_API_VERSION_1_3) {
        info.missing =
            info.name + " has only Vulkan " + version_text(p.apiVersion) + "; 1.3 is needed: update the driver";
        info.missing_ray_tracing = info.missing;
        return info;
    }

    VkPhysicalDeviceFloatControlsProperties floats{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES,
                                                   .pNext = &subgroup};
    VkPhysicalDeviceMaintenance4Properties maintenance4{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES, .pNext = &floats};
    properties.pNext = &maintenance4;
    vkGetPhysicalDeviceProperties2(physical, &properties);
    info.driver = std::string(driver.driverName) + " " + driver.driverInfo;
    info.subgroup_size = subgroup.subgroupSize;
    info.keeps_nan = floats.shaderSignedZeroInfNanPreserveFloat32 == VK_TRUE;
    info.max_buffer_bytes = std::min(maintenance3.maxMemoryAllocationSize, maintenance4.maxBufferSize);

    const std::vector<VkExtensionProperties> extensions = device_extensions(physical);
    std::string lacking;
    for (const char* extension : ray_tracing_extensions)
        if (!has_extension(extensions, extension)) lacking += std::string(lacking.empty() ? "" : ", ") + extension;
    FeatureChain features;
    features.link(lacking.empty());
    vkGetPhysicalDeviceFeatures2(physical, &features.core);
    if (lacking.empty() && !features.accel.accelerationStructure) lacking = "the feature accelerationStructure";
    if (lacking.empty() && !features.pipeline.rayTracingPipeline) lacking = "the feature rayTracingPipeline";
    info.ray_tracing = lacking.empty();
    if (!info.ray_tracing) info.missing_ray_tracing = info.name + " cannot trace rays: it lacks " + lacking;
    if (const char* feature = first_missing_feature(features))
        info.missing =
            info.name + " cannot be used: its driver (" + info.driver + ") lacks the Vulkan feature " + feature;

    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    bool compute = false;
    for (const VkQueueFamilyProperties& family : families) {
        compute |= (family.queueFlags & VK_QUEUE_COMPUTE_BIT) != 0;
        if (family.queueFlags & VK_QUEUE_COMPUTE_BIT) info.timestamps |= family.timestampValidBits > 0;
    }
    if (!compute && info.missing.empty()) info.missing = info.name + " has no compute queue";
    return info;
}

} // namespace restage::gpu
