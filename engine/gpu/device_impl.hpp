// SPDX-License-Identifier: Apache-2.0
// Private to gpu/: a Device's state besides its handles, and the state of a command list.
#pragma once

#include "gpu/device.hpp"
#include "gpu/instance.hpp"

#include <atomic>
#include <mutex>

namespace restage::gpu {

// A pool with one command buffer and a fence: the unit of reuse. One pool each, so that lists of different
// threads never share one.
struct Submission::State {
    Device* device = nullptr;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    bool recording = false;
    std::atomic<bool> pending = false; // submitted, fence not yet seen signalled
    VkResult record_error = VK_SUCCESS;

    VkResult wait();
    void begin_recording();
    void end_recording();
    void full_barrier(VkPipelineStageFlags2 dst_stage, VkAccessFlags2 dst_access);
};

struct Device::Impl {
    std::unique_ptr<Instance> instance;
    std::filesystem::path pipeline_cache_file;
    std::size_t saved_cache_bytes = 0;
    PFN_vkSetDebugUtilsObjectNameEXT set_object_name = nullptr; // with validation only
    std::mutex queue_mutex;
    std::mutex free_mutex;
    std::vector<std::unique_ptr<Submission::State>> free_lists;
    std::atomic<bool> lost = false;
    std::shared_ptr<DeviceFault> fault;

    ~Impl();
};

} // namespace restage::gpu
