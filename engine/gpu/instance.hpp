// SPDX-License-Identifier: Apache-2.0
// Private to gpu/: a VkInstance with its validation messages, the capabilities of its devices, and driver settings.
#pragma once

#include "base/log.hpp"
#include "base/result.hpp"
#include "gpu/device.hpp"

#include <volk.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace restage::gpu {

struct InstanceOptions {
    bool validation = false;
    bool driver_defaults = true;
    std::filesystem::path cache_dir; // empty: the driver's own choice
    std::vector<std::string> extensions;
};

class Instance {
  public:
    // `no_driver` true on return means no Vulkan driver: not an error for callers that only list devices.
    static Result<std::unique_ptr<Instance>> create(const InstanceOptions& options, Log& log, bool& no_driver);
    ~Instance();
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    VkInstance handle() const { return handle_; }
    bool has_debug_utils() const { return debug_utils_; }
    Result<std::vector<VkPhysicalDevice>> physical_devices() const;
    DeviceInfo describe(VkPhysicalDevice physical, std::uint32_t index) const;

    std::vector<std::string> messages() const;
    void clear_messages();

  private:
    Instance() = default;
    static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                     VkDebugUtilsMessageTypeFlagsEXT types,
                                                     const VkDebugUtilsMessengerCallbackDataEXT* data, void* user);

    VkInstance handle_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    bool debug_utils_ = false;
    Log* log_ = nullptr;
    mutable std::mutex mutex_; // guards messages_: layers call from any thread
    std::vector<std::string> messages_;
};

// Required device features, as a chain for vkGetPhysicalDeviceFeatures2 and vkCreateDevice.
struct FeatureChain {
    VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceAccelerationStructureFeaturesKHR accel{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR};
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipeline{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR};
    void link(bool ray_tracing); // sets the pNext pointers; the chain must not move afterwards
};

// The extensions that make up `ray_tracing`.
inline constexpr const char* ray_tracing_extensions[] = {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                                         VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME,
                                                         VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};

bool has_extension(const std::vector<VkExtensionProperties>& extensions, const char* name);
std::vector<VkExtensionProperties> device_extensions(VkPhysicalDevice physical);

const char* result_name(VkResult result); // "VK_ERROR_DEVICE_LOST"

} // namespace restage::gpu
