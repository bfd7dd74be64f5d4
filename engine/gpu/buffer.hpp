// SPDX-License-Identifier: Apache-2.0
// A buffer and its memory, addressed by shaders through its address. Created by Device::create_buffer.
#pragma once

#include <volk.h>

#include <cassert>
#include <cstddef>
#include <span>
#include <string>

struct VmaAllocation_T;

namespace restage::gpu {

class Device;

enum class BufferKind {
    device,   // fastest for the GPU; mapped only where memory is unified
    host,     // always mapped, coherent, 64-byte aligned; device-local where possible. The host writes, the GPU reads
    readback, // always mapped, coherent, 64-byte aligned, cached on the host. The GPU writes, the host reads (or both)
};

// Move-only. Usable as storage, transfer source and target, indirect arguments, and where the device traces rays as
// input of acceleration structures.
class Buffer {
  public:
    Buffer() = default; // empty: no memory, address 0
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;

    explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }
    VkBuffer handle() const { return buffer_; }
    VkDeviceAddress address() const { return address_; } // at least 256-byte aligned
    std::size_t size() const { return size_; } // as requested
    std::byte* mapped() const { return mapped_; } // nullptr if not host-visible
    const char* name() const { return name_.c_str(); }

    // The mapped memory as an array of T; a partial element at the end is excluded.
    template <class T>
    std::span<T> span() const {
        assert((mapped_ || size_ == 0) && "buffer is not host-visible: use BufferKind::host or readback");
        return {reinterpret_cast<T*>(mapped_), size_ / sizeof(T)};
    }

  private:
    friend class Device;
    void release();

    Device* device_ = nullptr;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VmaAllocation_T* allocation_ = nullptr;
    VkDeviceAddress address_ = 0;
    std::size_t size_ = 0;
    std::byte* mapped_ = nullptr;
    std::string name_;
};

} // namespace restage::gpu
