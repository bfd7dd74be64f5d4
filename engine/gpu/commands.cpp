// SPDX-License-Identifier: Apache-2.0
// Command lists: recording, submitting, waiting, and reusing their pools.
#include "gpu/commands.hpp"

#include "gpu/accel.hpp"
#include "gpu/device_impl.hpp"
#include "gpu/pipeline.hpp"

#include <cassert>
#include <limits>
#include <utility>

namespace restage::gpu {

// ---- state ---------------------------------------------------------------------------------------------------------

VkResult Submission::State::wait() {
    if (!pending) return VK_SUCCESS;
    const VkResult result =
        device->vk().vkWaitForFences(device->handle(), 1, &fence, VK_TRUE, std::numeric_limits<std::uint64_t>::max());
    pending = false; // even after an error: a lost device never signals
    return result;
}

void Submission::State::full_barrier(VkPipelineStageFlags2 dst_stage, VkAccessFlags2 dst_access) {
    const VkMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                   .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                   .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                   .dstStageMask = dst_stage,
                                   .dstAccessMask = dst_access};
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &barrier};
    device->vk().vkCmdPipelineBarrier2(commands, &dependency);
}

void Submission::State::begin_recording() {
    const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    record_error = device->vk().vkBeginCommandBuffer(commands, &info);
    recording = true;
    // Makes writes of earlier lists visible to this one.
    full_barrier(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
}

void Submission::State::end_recording() {
    full_barrier(VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_HOST_WRITE_BIT);
    const VkResult result = device->vk().vkEndCommandBuffer(commands);
    if (record_error == VK_SUCCESS) record_error = result;
    recording = false;
}

// ---- device --------------------------------------------------------------------------------------------------------

Result<CommandList> Device::begin() {
    std::unique_ptr<Submission::State> state;
    {
        std::lock_guard lock(impl_->free_mutex);
        if (!impl_->free_lists.empty()) {
            state = std::move(impl_->free_lists.back());
            impl_->free_lists.pop_back();
        }
    }
    if (!state) {
        state = std::make_unique<Submission::State>();
        state->device = this;
        const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                           .queueFamilyIndex = queue_family_};
        VkResult result = vk_.vkCreateCommandPool(device_, &pool, nullptr, &state->pool);
        if (result != VK_SUCCESS) return error(result, "creating a command pool");
        const VkCommandBufferAllocateInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                 .commandPool = state->pool,
                                                 .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                 .commandBufferCount = 1};
        const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        result = vk_.vkAllocateCommandBuffers(device_, &buffer, &state->commands);
        if (result == VK_SUCCESS) result = vk_.vkCreateFence(device_, &fence, nullptr, &state->fence);
        if (result != VK_SUCCESS) {
            vk_.vkDestroyCommandPool(device_, state->pool, nullptr);
            return error(result, "creating a command list");
        }
    }
    CommandList list;
    list.state_ = std::shared_ptr<Submission::State>(state.release(), [](Submission::State* s) {
        s->wait();
        s->device->vk().vkResetCommandPool(s->device->handle(), s->pool, 0);
        Impl& impl = *s->device->impl_;
        std::lock_guard lock(impl.free_mutex);
        impl.free_lists.emplace_back(s);
    });
    list.state_->begin_recording();
    return list;
}

Result<Submission> Device::submit(CommandList& list) {
    assert(list.state_ && "an empty command list");
    Submission::State& state = *list.state_;
    if (state.recording) state.end_recording();
    if (state.record_error != VK_SUCCESS) return error(state.record_error, "recording commands");
    VkResult result = state.wait(); // the list is still running: one fence, one run
    if (result == VK_SUCCESS) result = vk_.vkResetFences(device_, 1, &state.fence);
    if (result != VK_SUCCESS) return error(result, "waiting for earlier work");
    const VkCommandBufferSubmitInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                             .commandBuffer = state.commands};
    const VkSubmitInfo2 info{
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &commands};
    {
        std::lock_guard lock(impl_->queue_mutex);
        if (lost() || (impl_->fault && impl_->fault->strikes()))
            result = VK_ERROR_DEVICE_LOST;
        else
            result = vk_.vkQueueSubmit2(queue_, 1, &info, state.fence);
    }
    if (result != VK_SUCCESS) return error(result, "submitting work");
    state.pending = true;
    Submission submission;
    submission.state_ = list.state_;
    return submission;
}

Result<void> Device::submit_and_wait(CommandList& list) {
    RESTAGE_TRY(const Submission submission, submit(list));
    return submission.wait();
}

Result<void> Device::wait_idle() {
    std::lock_guard lock(impl_->queue_mutex);
    const VkResult result = vk_.vkQueueWaitIdle(queue_);
    if (result != VK_SUCCESS) return error(result, "waiting for the device");
    return {};
}

Result<void> Submission::wait() const {
    if (!state_) return {};
    const VkResult result = state_->wait();
    if (result != VK_SUCCESS) return state_->device->error(result, "waiting for work");
    return {};
}

Result<bool> Submission::done() const {
    if (!state_ || !state_->pending) return true;
    const VkResult result = state_->device->vk().vkGetFenceStatus(state_->device->handle(), state_->fence);
    if (result == VK_NOT_READY) return false;
    state_->pending = false;
    if (result != VK_SUCCESS) return state_->device->error(result, "running work");
    return true;
}

// ---- recording -----------------------------------------------------------------------------------------------------

CommandList::~CommandList() {
    if (state_) state_->wait();
}
CommandList::CommandList(CommandList&& other) noexcept = default;
CommandList& CommandList::operator=(CommandList&& other) noexcept {
    if (this == &other) return *this;
    if (state_) state_->wait();
    state_ = std::move(other.state_);
    return *this;
}

VkCommandBuffer CommandList::handle() const { return state_ ? state_->commands : VK_NULL_HANDLE; }

void CommandList::reset() {
    state_->wait();
    state_->device->vk().vkResetCommandPool(state_->device->handle(), state_->pool, 0);
    state_->begin_recording();
}

namespace {

void push(const VolkDeviceTable& vk, VkCommandBuffer commands, VkPipelineLayout layout, VkShaderStageFlags stages,
          std::uint32_t declared, std::span<const std::byte> bytes) {
    assert(bytes.size() <= declared && bytes.size() % 4 == 0 && "push constants do not fit the pipeline");
    (void)declared;
    if (!bytes.empty())
        vk.vkCmdPushConstants(commands, layout, stages, 0, static_cast<std::uint32_t>(bytes.size()), bytes.data());
}

} // namespace

void CommandList::dispatch(const ComputePipeline& pipeline, std::span<const std::byte> constants,
                           std::uint32_t groups_x, std::uint32_t groups_y, std::uint32_t groups_z) {
    assert(state_->recording);
    const VolkDeviceTable& vk = state_->device->vk();
    vk.vkCmdBindPipeline(state_->commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle());
    push(vk, state_->commands, pipeline.layout(), VK_SHADER_STAGE_COMPUTE_BIT, pipeline.push_constant_bytes(),
         constants);
    vk.vkCmdDispatch(state_->commands, groups_x, groups_y, groups_z);
}

void CommandList::dispatch_indirect(const ComputePipeline& pipeline, std::span<const std::byte> constants,
                                    const Buffer& counts, std::size_t offset) {
    assert(state_->recording && offset + sizeof(VkDispatchIndirectCommand) <= counts.size());
    const VolkDeviceTable& vk = state_->device->vk();
    vk.vkCmdBindPipeline(state_->commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle());
    push(vk, state_->commands, pipeline.layout(), VK_SHADER_STAGE_COMPUTE_BIT, pipeline.push_constant_bytes(),
         constants);
    vk.vkCmdDispatchIndirect(state_->commands, counts.handle(), offset);
}

void CommandList::trace(const RayTracingPipeline& pipeline, std::span<const std::byte> constants, std::uint32_t width,
                        std::uint32_t height, std::uint32_t depth) {
    assert(state_->recording);
    const VolkDeviceTable& vk = state_->device->vk();
    vk.vkCmdBindPipeline(state_->commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline.handle());
    push(vk, state_->commands, pipeline.layout(), RayTracingPipeline::stages, pipeline.push_constant_bytes(),
         constants);
    vk.vkCmdTraceRaysKHR(state_->commands, &pipeline.raygen_, &pipeline.misses_, &pipeline.hits_, &pipeline.callables_,
                         width, height, depth);
}

void CommandList::copy(const Buffer& src, std::size_t src_offset, const Buffer& dst, std::size_t dst_offset,
                       std::size_t bytes) {
    assert(state_->recording && src_offset + bytes <= src.size() && dst_offset + bytes <= dst.size());
    if (bytes == 0) return;
    const VkBufferCopy region{.srcOffset = src_offset, .dstOffset = dst_offset, .size = bytes};
    state_->device->vk().vkCmdCopyBuffer(state_->commands, src.handle(), dst.handle(), 1, &region);
}

void CommandList::fill(const Buffer& dst, std::size_t offset, std::size_t bytes, std::uint32_t value) {
    if (bytes == whole_size) bytes = (dst.size() - offset) & ~std::size_t(3);
    assert(state_->recording && offset % 4 == 0 && bytes % 4 == 0 && offset + bytes <= dst.size());
    if (bytes > 0) state_->device->vk().vkCmdFillBuffer(state_->commands, dst.handle(), offset, bytes, value);
}

void CommandList::barrier() {
    assert(state_->recording);
    state_->full_barrier(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                         VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
}

// ---- timestamps ----------------------------------------------------------------------------------------------------

void CommandList::timestamp(Timestamps& timestamps, std::uint32_t index) {
    assert(state_->recording && index < timestamps.count_);
    if (!timestamps.pool_) return;
    const VolkDeviceTable& vk = state_->device->vk();
    vk.vkCmdResetQueryPool(state_->commands, timestamps.pool_, index, 1);
    vk.vkCmdWriteTimestamp2(state_->commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, timestamps.pool_, index);
}

Result<Timestamps> Timestamps::create(Device& device, std::uint32_t count) {
    Timestamps result;
    result.device_ = &device;
    result.count_ = count;
    if (device.timestamp_bits() == 0 || count == 0) return result;
    const VkQueryPoolCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, .queryType = VK_QUERY_TYPE_TIMESTAMP, .queryCount = count};
    const VkResult created = device.vk().vkCreateQueryPool(device.handle(), &info, nullptr, &result.pool_);
    if (created != VK_SUCCESS) return device.error(created, "creating timestamps");
    // A query that was never reset cannot be read.
    RESTAGE_TRY(CommandList list, device.begin());
    device.vk().vkCmdResetQueryPool(list.handle(), result.pool_, 0, count);
    RESTAGE_CHECK(device.submit_and_wait(list));
    return result;
}

Timestamps::~Timestamps() {
    if (pool_) device_->vk().vkDestroyQueryPool(device_->handle(), pool_, nullptr);
}
Timestamps::Timestamps(Timestamps&& other) noexcept { *this = std::move(other); }
Timestamps& Timestamps::operator=(Timestamps&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(pool_, other.pool_);
    std::swap(count_, other.count_);
    return *this;
}

Result<std::vector<double>> Timestamps::read() const {
    std::vector<double> seconds(count_, std::numeric_limits<double>::quiet_NaN());
    if (!pool_) return seconds;
    std::vector<std::uint64_t> raw(2 * std::size_t(count_)); // value, available
    const VkResult result = device_->vk().vkGetQueryPoolResults(
        device_->handle(), pool_, 0, count_, raw.size() * sizeof(std::uint64_t), raw.data(), 2 * sizeof(std::uint64_t),
        VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WITH_AVAILABILITY_BIT);
    if (result != VK_SUCCESS && result != VK_NOT_READY) return device_->error(result, "reading timestamps");
    const std::uint32_t bits = device_->timestamp_bits();
    const std::uint64_t mask = bits >= 64 ? ~std::uint64_t(0) : (std::uint64_t(1) << bits) - 1;
    for (std::size_t i = 0; i < count_; ++i) // differences modulo the counter's width
        if (raw[2 * i + 1] && raw[1])
            seconds[i] = static_cast<double>((raw[2 * i] - raw[0]) & mask) * device_->timestamp_period_ns() * 1e-9;
    return seconds;
}

} // namespace restage::gpu
