// SPDX-License-Identifier: Apache-2.0
// The Vulkan device: selection, capabilities, memory, uploads, and submitting recorded work.
// Everything a shader reads or writes is a buffer known by its 64-bit address: there are no descriptor sets.
//
// Threads: a Device may be used from any thread; objects it creates (CommandList, Tlas, ...) by one thread at a time.
// A Device outlives everything created from it. The first Device of a process is created before other threads read the
// environment (drivers are configured through it).
#pragma once

#include "base/log.hpp"
#include "base/result.hpp"
#include "gpu/buffer.hpp"
#include "gpu/commands.hpp"

#include <volk.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct VmaAllocator_T;

namespace restage::gpu {

enum class DeviceType { discrete, integrated, virtual_gpu, cpu, other };
const char* to_string(DeviceType type);

struct DeviceInfo {
    std::uint32_t index = 0; // position in the loader's list; what `--device 1` means
    std::string name;        // "NVIDIA GeForce RTX 3070", "llvmpipe (LLVM 15.0.6, 256 bits)"
    std::string driver;      // "Mesa 25.0.7 (LLVM 15.0.6)"
    DeviceType type = DeviceType::other;
    std::uint32_t vulkan_version = 0;              // VK_MAKE_API_VERSION
    std::array<std::uint8_t, VK_UUID_SIZE> uuid{}; // of device and driver: the key of the pipeline cache
    std::uint64_t memory_bytes = 0;                // of the largest device-local heap
    std::uint64_t max_buffer_bytes = 0;            // of one buffer
    std::uint64_t max_storage_range_bytes = 0;     // applies to descriptors only, not to addresses
    std::uint32_t max_push_constant_bytes = 0;     // at least 128
    std::uint32_t subgroup_size = 0;
    bool ray_tracing = false; // acceleration structures and ray-tracing pipelines, with callables
    bool timestamps = false;
    bool keeps_nan = false; // shaders may request that NaN, infinity and -0 be kept: SignedZeroInfNanPreserve, 32 bit
    bool unified_memory = false;     // the host sees all device memory (CPU, integrated)
    std::string missing;             // why it is unusable ("... has no bufferDeviceAddress"); empty: usable
    std::string missing_ray_tracing; // why ray_tracing is false; empty if true
};

// Every device of every installed driver, including unusable ones. An empty list means no Vulkan driver.
Result<std::vector<DeviceInfo>> list_devices(Log& log);

// For tests: the driver "stops" (VK_ERROR_DEVICE_LOST) at the `after`-th submission to a device created with
// this, and again, `times` in total, at the `after`-th submission to the device created next. [any]
struct DeviceFault {
    DeviceFault(int after_, int times_) : after(after_), times(times_), left(after_) {}
    bool strikes();
    const int after;
    std::atomic<int> times, left;
};

struct DeviceOptions {
    std::string select;               // index or part of the name (case ignored); empty: the best one
    bool validation = false; // validation and synchronization validation; fails if the layer is not installed
    bool require_ray_tracing = false; // reject devices without it
    bool driver_defaults = true; // Mesa's shader cache in cache_dir, unless the user has set one
    std::filesystem::path cache_dir; // pipeline cache and the driver's own shader cache; empty: restage::cache_dir()
    std::vector<std::string> instance_extensions; // needed by a window to present; all must be available
    std::vector<std::string> device_extensions;
    std::shared_ptr<DeviceFault> fault; // for tests; may be null
};

class Device {
  public:
    // Prefers discrete with ray tracing, then discrete, integrated, virtual, CPU.
    static Result<std::unique_ptr<Device>> create(const DeviceOptions& options, Log& log);
    ~Device(); // waits for the device, saves the pipeline cache
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const { return info_; }
    Log& log() const { return *log_; }

    // Size 0 is allowed: a small buffer with a valid address and size() == 0. At least 16 bytes past the end may be
    // read (Embree and vectorised loads do). `name` shows in validation messages and errors. Memory is not cleared.
    Result<Buffer> create_buffer(std::size_t bytes, BufferKind kind, const char* name);
    // A `device` buffer with the given content.
    Result<Buffer> create_buffer(std::span<const std::byte> content, const char* name);
    template <class T>
    Result<Buffer> create_buffer_of(std::span<const T> content, const char* name) {
        return create_buffer(std::as_bytes(content), name);
    }

    // Copies now: memcpy if the buffer is mapped, else through a staging buffer, and waits. The caller ensures
    // that no work in flight uses the range.
    Result<void> upload(Buffer& dst, std::size_t offset, std::span<const std::byte> bytes);
    Result<void> download(const Buffer& src, std::size_t offset, std::span<std::byte> bytes);

    // A new list, already recording. Cheap: pools are recycled.
    Result<CommandList> begin();
    // Lists run in submission order, and each sees all writes of earlier ones.
    Result<Submission> submit(CommandList& list);
    Result<void> submit_and_wait(CommandList& list);
    Result<void> wait_idle();

    // With validation on: the layers' messages (warnings and errors), oldest first; and clears them.
    std::vector<std::string> validation_messages() const;
    void clear_validation_messages();

    // Writes the pipeline cache to disk now (the destructor does it too). A no-op if nothing is new.
    void save_pipeline_cache();

    std::uint64_t allocated_bytes() const; // in all existing buffers

    // True once the driver has reported it; everything fails from then on, and the Device must be recreated.
    bool lost() const;

    // For gpu/ itself and for the window (swapchain, Dear ImGui); other code must not use raw Vulkan.
    const VolkDeviceTable& vk() const { return vk_; }
    VkInstance instance() const { return instance_; }
    VkPhysicalDevice physical_device() const { return physical_; }
    VkDevice handle() const { return device_; }
    VkQueue queue() const { return queue_; }
    std::uint32_t queue_family() const { return queue_family_; }
    VkPipelineCache pipeline_cache() const { return pipeline_cache_; }
    VmaAllocator_T* allocator() const { return allocator_; }
    const VkPhysicalDeviceRayTracingPipelinePropertiesKHR& ray_tracing_properties() const { return rt_properties_; }
    std::uint32_t scratch_alignment() const { return scratch_alignment_; }
    double timestamp_period_ns() const { return timestamp_period_ns_; }
    std::uint32_t timestamp_bits() const { return timestamp_bits_; }
    void set_name(VkObjectType type, std::uint64_t object, const char* name) const; // shows in validation messages
    // An error with its remedy ("out of device memory: ... use a smaller resolution").
    tl::unexpected<Error> error(VkResult result, const std::string& doing) const;

  private:
    friend class CommandList;
    friend class Submission;
    struct Impl;
    Device();

    DeviceInfo info_;
    Log* log_ = nullptr;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queue_family_ = 0;
    VkPipelineCache pipeline_cache_ = VK_NULL_HANDLE;
    VmaAllocator_T* allocator_ = nullptr;
    VolkDeviceTable vk_{};
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR rt_properties_{};
    std::uint32_t scratch_alignment_ = 256;
    double timestamp_period_ns_ = 0;
    std::uint32_t timestamp_bits_ = 0;
    std::unique_ptr<Impl> impl_;
};

} // namespace restage::gpu
