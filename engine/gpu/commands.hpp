// SPDX-License-Identifier: Apache-2.0
// Recording work and waiting for it. A CommandList is recorded once and may be submitted many times (not while an
// earlier submission of it is running: submitting waits first); reset() makes it recordable again. One thread at a
// time per list; different lists on different threads are fine.
#pragma once

#include "base/result.hpp"

#include <volk.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace restage::gpu {

class Device;
class Buffer;
class ComputePipeline;
class RayTracingPipeline;
class Tlas;
class Timestamps;

// Push constants as bytes: push_bytes(my_struct). A view: my_struct must live until the call that takes it returns.
template <class T>
    requires std::is_trivially_copyable_v<T>
std::span<const std::byte> push_bytes(const T& value) {
    return std::as_bytes(std::span<const T, 1>(&value, 1));
}

class Submission {
  public:
    Submission() = default;
    Result<void> wait() const; // until the work completes; its writes are then visible to the host
    Result<bool> done() const; // without waiting

  private:
    friend class Device;
    friend class CommandList;
    struct State;
    std::shared_ptr<State> state_; // shared with the list: a submission may outlive it
};

class CommandList {
  public:
    CommandList() = default;
    ~CommandList(); // waits for its work
    CommandList(CommandList&& other) noexcept;
    CommandList& operator=(CommandList&& other) noexcept;

    // Recording. Push constants shorter than declared by the pipeline leave the rest undefined.
    void dispatch(const ComputePipeline& pipeline, std::span<const std::byte> push, std::uint32_t groups_x,
                  std::uint32_t groups_y = 1, std::uint32_t groups_z = 1);
    // The three group counts (VkDispatchIndirectCommand) are read at `offset` when the work runs.
    void dispatch_indirect(const ComputePipeline& pipeline, std::span<const std::byte> push, const Buffer& counts,
                           std::size_t offset);
    void trace(const RayTracingPipeline& pipeline, std::span<const std::byte> push, std::uint32_t width,
               std::uint32_t height, std::uint32_t depth = 1);
    void copy(const Buffer& src, std::size_t src_offset, const Buffer& dst, std::size_t dst_offset, std::size_t bytes);
    // `bytes` is a multiple of 4, or whole_size: to the end.
    static constexpr std::size_t whole_size = ~std::size_t{0};
    void fill(const Buffer& dst, std::size_t offset, std::size_t bytes, std::uint32_t value);
    // Builds `tlas` from its count() instances, as they are when the work runs.
    void build(Tlas& tlas);
    // Makes all earlier writes visible to everything after it (shaders, copies, builds, indirect counts).
    // The beginning and end of a list need none: earlier lists' writes are visible to device and host; what the host
    // wrote before a submission is visible to that submission.
    void barrier();
    // Writes the time at which all work before it was done; see Timestamps.
    void timestamp(Timestamps& timestamps, std::uint32_t index);

    void reset(); // waits for its work and starts recording again
    VkCommandBuffer handle() const;
    explicit operator bool() const { return state_ != nullptr; }

  private:
    friend class Device;
    std::shared_ptr<Submission::State> state_;
};

// A few points in time on the device's clock.
class Timestamps {
  public:
    static Result<Timestamps> create(Device& device, std::uint32_t count);
    Timestamps() = default;
    ~Timestamps();
    Timestamps(Timestamps&& other) noexcept;
    Timestamps& operator=(Timestamps&& other) noexcept;

    // Seconds since the first one, once the work that writes them is done. NaN for any not written.
    // All NaN if the device has no timestamps.
    Result<std::vector<double>> read() const;

  private:
    friend class CommandList;
    Device* device_ = nullptr;
    VkQueryPool pool_ = VK_NULL_HANDLE;
    std::uint32_t count_ = 0;
};

} // namespace restage::gpu
