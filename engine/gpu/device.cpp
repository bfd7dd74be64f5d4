// SPDX-License-Identifier: Apache-2.0
// Choosing and creating the device, its allocator and its pipeline cache.
#include "gpu/device.hpp"

#include "base/file.hpp"
#include "gpu/device_impl.hpp"
#include "gpu/instance.hpp"

#include <vk_mem_alloc.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstring>

namespace restage::gpu {

namespace {

struct Candidate {
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    DeviceInfo info;
};

std::string lower(std::string text) {
    for (char& c : text)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

int rank(const DeviceInfo& info) {
    switch (info.type) {
        case DeviceType::discrete:
            return info.ray_tracing ? 5 : 4;
        case DeviceType::integrated:
            return 3;
        case DeviceType::virtual_gpu:
            return 2;
        case DeviceType::cpu:
            return 1;
        case DeviceType::other:
            break;
    }
    return 0;
}

std::string list_names(const std::vector<Candidate>& candidates) {
    std::string text;
    for (const Candidate& c : candidates)
        text += (text.empty() ? "" : "; ") + std::to_string(c.info.index) + ": " + c.info.name;
    return text;
}

std::string why_not(const DeviceInfo& info, bool require_ray_tracing) {
    if (!info.missing.empty()) return info.missing;
    return require_ray_tracing ? info.missing_ray_tracing : std::string();
}

Result<Candidate> choose(const std::vector<Candidate>& candidates, const DeviceOptions& options) {
    const bool by_index =
        !options.select.empty() && std::all_of(options.select.begin(), options.select.end(),
                                               [](char c) { return std::isdigit(static_cast<unsigned char>(c)); });
    const Candidate* best = nullptr;
    bool matched = false;
    std::string reasons;
    for (const Candidate& c : candidates) {
        if (by_index ? std::to_string(c.info.index) != options.select
                     : lower(c.info.name).find(lower(options.select)) == std::string::npos)
            continue;
        matched = true;
        const std::string reason = why_not(c.info, options.require_ray_tracing);
        if (!reason.empty()) {
            reasons += (reasons.empty() ? "" : "; ") + reason;
        } else if (!best || rank(c.info) > rank(best->info)) {
            best = &c;
        }
    }
    if (best) return *best;
    if (!matched && !options.select.empty())
        return fail("no Vulkan device is called \"" + options.select + "\"; available: " + list_names(candidates));
    return fail("no usable Vulkan device: " + reasons);
}

Result<std::vector<Candidate>> candidates_of(const Instance& instance) {
    RESTAGE_TRY(const std::vector<VkPhysicalDevice> devices, instance.physical_devices());
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < devices.size(); ++i)
        candidates.push_back({devices[i], instance.describe(devices[i], static_cast<std::uint32_t>(i))});
    return candidates;
}

std::filesystem::path choose_cache_dir(const DeviceOptions& options, Log& log) {
    if (!options.cache_dir.empty()) return options.cache_dir;
    if (auto dir = cache_dir())
        return *dir;
    else if (static std::atomic_flag said; !said.test_and_set()) // once, though a program has several devices
        log.warning("shaders will be recompiled at each start: " + dir.error().message);
    return {};
}

// Compute, preferably a family that also has graphics: a window presents from it.
std::uint32_t choose_queue_family(VkPhysicalDevice physical, std::uint32_t& timestamp_bits) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    std::uint32_t best = 0;
    int best_score = -1;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (!(families[i].queueFlags & VK_QUEUE_COMPUTE_BIT)) continue;
        const int score = (families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) ? 1 : 0;
        if (score > best_score) {
            best = i;
            best_score = score;
        }
    }
    timestamp_bits = families[best].timestampValidBits;
    return best;
}

std::string hex(const std::array<std::uint8_t, VK_UUID_SIZE>& uuid) {
    std::string text;
    for (std::uint8_t byte : uuid) {
        text += "0123456789abcdef"[byte >> 4];
        text += "0123456789abcdef"[byte & 15];
    }
    return text;
}

} // namespace

Result<std::vector<DeviceInfo>> list_devices(Log& log) {
    bool no_driver = false;
    auto instance = Instance::create({.cache_dir = choose_cache_dir({}, log)}, log, no_driver);
    if (!instance && no_driver) return std::vector<DeviceInfo>();
    if (!instance) return tl::unexpected(instance.error());
    RESTAGE_TRY(const std::vector<Candidate> candidates, candidates_of(**instance));
    std::vector<DeviceInfo> devices;
    for (const Candidate& c : candidates)
        devices.push_back(c.info);
    return devices;
}

Device::Device() : impl_(std::make_unique<Impl>()) {}
Device::Impl::~Impl() = default;

Result<std::unique_ptr<Device>> Device::create(const DeviceOptions& options, Log& log) {
    const std::filesystem::path cache = choose_cache_dir(options, log);
    auto self = std::unique_ptr<Device>(new Device);
    self->log_ = &log;
    Impl& impl = *self->impl_;
    impl.fault = options.fault;
    bool no_driver = false;
    RESTAGE_TRY(impl.instance, Instance::create({.validation = options.validation,
                                                 .driver_defaults = options.driver_defaults,
                                                 .cache_dir = cache,
                                                 .extensions = options.instance_extensions},
                                                log, no_driver));
    RESTAGE_TRY(const std::vector<Candidate> candidates, candidates_of(*impl.instance));
    if (candidates.empty())
        return fail(
            "the installed Vulkan drivers found no device; install your graphics card's driver, or Mesa's "
            "lavapipe, which needs none (Debian: mesa-vulkan-drivers)");
    RESTAGE_TRY(const Candidate chosen, choose(candidates, options));
    self->info_ = chosen.info;
    self->instance_ = impl.instance->handle();
    self->physical_ = chosen.physical;
    const bool ray_tracing = chosen.info.ray_tracing;

    const std::vector<VkExtensionProperties> available = device_extensions(chosen.physical);
    std::vector<const char*> extensions;
    for (const std::string& extension : options.device_extensions) {
        if (!has_extension(available, extension.c_str()))
            return fail(chosen.info.name + " lacks the Vulkan extension " + extension + "; update its driver");
        extensions.push_back(extension.c_str());
    }
    if (ray_tracing)
        extensions.insert(extensions.end(), std::begin(ray_tracing_extensions), std::end(ray_tracing_extensions));
    const bool budget = has_extension(available, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
    if (budget) extensions.push_back(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
    if (has_extension(available, "VK_KHR_portability_subset")) extensions.push_back("VK_KHR_portability_subset");

    FeatureChain features;
    features.link(ray_tracing);
    features.core.features.shaderInt64 = VK_TRUE;
    features.v12.bufferDeviceAddress = VK_TRUE;
    features.v12.scalarBlockLayout = VK_TRUE;
    features.v13.synchronization2 = VK_TRUE;
    features.v13.maintenance4 = VK_TRUE;
    features.accel.accelerationStructure = VK_TRUE;
    features.pipeline.rayTracingPipeline = VK_TRUE;
    self->queue_family_ = choose_queue_family(chosen.physical, self->timestamp_bits_);
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                        .queueFamilyIndex = self->queue_family_,
                                        .queueCount = 1,
                                        .pQueuePriorities = &priority};
    const VkDeviceCreateInfo create{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                    .pNext = &features.core,
                                    .queueCreateInfoCount = 1,
                                    .pQueueCreateInfos = &queue,
                                    .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                                    .ppEnabledExtensionNames = extensions.data()};
    VkResult result = vkCreateDevice(chosen.physical, &create, nullptr, &self->device_);
    if (result != VK_SUCCESS) {
        self->device_ = VK_NULL_HANDLE;
        return self->error(result, "opening the device");
    }
    volkLoadDeviceTable(&self->vk_, self->device_);
    self->vk_.vkGetDeviceQueue(self->device_, self->queue_family_, 0, &self->queue_);

    VkPhysicalDeviceAccelerationStructurePropertiesKHR accel{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR};
    self->rt_properties_ = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR,
                            .pNext = &accel};
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                           .pNext = ray_tracing ? &self->rt_properties_ : nullptr};
    vkGetPhysicalDeviceProperties2(chosen.physical, &properties);
    self->rt_properties_.pNext = nullptr;
    self->scratch_alignment_ = std::max(256u, accel.minAccelerationStructureScratchOffsetAlignment);
    self->timestamp_period_ns_ = properties.properties.limits.timestampPeriod;
    self->info_.timestamps = self->timestamp_bits_ > 0;

    if (impl.instance->has_debug_utils())
        impl.set_object_name = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
            vkGetInstanceProcAddr(self->instance_, "vkSetDebugUtilsObjectNameEXT"));

    const VmaVulkanFunctions functions{.vkGetInstanceProcAddr = vkGetInstanceProcAddr,
                                       .vkGetDeviceProcAddr = vkGetDeviceProcAddr};
    VmaAllocatorCreateInfo allocator{.flags = VMA_ALLOCATOR_CREATE_BUFFER_DEVICE_ADDRESS_BIT,
                                     .physicalDevice = chosen.physical,
                                     .device = self->device_,
                                     .pVulkanFunctions = &functions,
                                     .instance = self->instance_,
                                     .vulkanApiVersion = VK_API_VERSION_1_3};
    if (budget) allocator.flags |= VMA_ALLOCATOR_CREATE_EXT_MEMORY_BUDGET_BIT;
    result = vmaCreateAllocator(&allocator, &self->allocator_);
    if (result != VK_SUCCESS) return self->error(result, "creating the memory allocator");

    std::string cached;
    if (!cache.empty()) {
        impl.pipeline_cache_file = cache / ("pipelines-" + hex(chosen.info.uuid) + ".bin");
        if (std::error_code ignored; std::filesystem::exists(impl.pipeline_cache_file, ignored))
            if (auto bytes = read_file(impl.pipeline_cache_file)) cached = std::move(*bytes);
    }
    // The driver checks the header (vendor, device, UUID) and ignores data of other drivers.
    const VkPipelineCacheCreateInfo cache_info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                               .initialDataSize = cached.size(),
                                               .pInitialData = cached.data()};
    result = self->vk_.vkCreatePipelineCache(self->device_, &cache_info, nullptr, &self->pipeline_cache_);
    if (result != VK_SUCCESS) return self->error(result, "creating the pipeline cache");
    impl.saved_cache_bytes = cached.size();
    log.debug("Vulkan device: " + self->info_.name + ", " + self->info_.driver);
    return self;
}

Device::~Device() {
    if (device_) {
        vk_.vkDeviceWaitIdle(device_);
        save_pipeline_cache();
        for (const auto& list : impl_->free_lists) {
            vk_.vkDestroyFence(device_, list->fence, nullptr);
            vk_.vkDestroyCommandPool(device_, list->pool, nullptr);
        }
        if (pipeline_cache_) vk_.vkDestroyPipelineCache(device_, pipeline_cache_, nullptr);
        if (allocator_) vmaDestroyAllocator(allocator_);
        vk_.vkDestroyDevice(device_, nullptr);
    }
}

void Device::save_pipeline_cache() {
    if (!pipeline_cache_ || impl_->pipeline_cache_file.empty()) return;
    std::size_t bytes = 0;
    if (vk_.vkGetPipelineCacheData(device_, pipeline_cache_, &bytes, nullptr) != VK_SUCCESS) return;
    std::lock_guard lock(impl_->free_mutex);
    if (bytes == impl_->saved_cache_bytes || bytes == 0) return; // drivers only add to it
    std::string data(bytes, '\0');
    if (vk_.vkGetPipelineCacheData(device_, pipeline_cache_, &bytes, data.data()) != VK_SUCCESS) return;
    data.resize(bytes);
    std::error_code ignored;
    std::filesystem::create_directories(impl_->pipeline_cache_file.parent_path(), ignored);
    if (auto written = write_file_atomic(impl_->pipeline_cache_file, data); !written)
        log_->debug("the pipeline cache was not saved: " + written.error().message);
    else
        impl_->saved_cache_bytes = bytes;
}

bool Device::lost() const { return impl_->lost; }

bool DeviceFault::strikes() {
    if (times <= 0 || --left > 0) return false;
    left = after;
    --times;
    return true;
}

std::vector<std::string> Device::validation_messages() const { return impl_->instance->messages(); }
void Device::clear_validation_messages() { impl_->instance->clear_messages(); }

void Device::set_name(VkObjectType type, std::uint64_t object, const char* name) const {
    if (!impl_->set_object_name || !name) return;
    const VkDebugUtilsObjectNameInfoEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                             .objectType = type,
                                             .objectHandle = object,
                                             .pObjectName = name};
    impl_->set_object_name(device_, &info);
}

tl::unexpected<Error> Device::error(VkResult result, const std::string& doing) const {
    std::string text = doing + " on " + info_.name + " failed: ";
    switch (result) {
        case VK_ERROR_DEVICE_LOST:
            impl_->lost = true;
            return fail(text +
                        "the graphics driver stopped (VK_ERROR_DEVICE_LOST). Work that runs too long is a common "
                        "cause: try smaller tiles or another --device; if it persists, update the driver");
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            return fail(text + "out of device memory (" + std::to_string(info_.memory_bytes >> 20) +
                        " MiB in total); close other programs, use a smaller image or scene, or another --device");
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            return fail(text + "out of memory; close other programs or use a smaller image or scene");
        default:
            return fail(text + result_name(result));
    }
}

} // namespace restage::gpu
