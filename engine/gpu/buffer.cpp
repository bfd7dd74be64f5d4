// SPDX-License-Identifier: Apache-2.0
// Buffers: allocation through VMA, upload and download.
#include "gpu/buffer.hpp"

#include "gpu/device_impl.hpp"

#include <vk_mem_alloc.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace restage::gpu {

namespace {

constexpr std::size_t staging_bytes = std::size_t(64) << 20;

std::string size_text(std::uint64_t bytes) {
    return bytes < (1u << 20) ? std::to_string(bytes) + " bytes" : std::to_string(bytes >> 20) + " MiB";
}

VkBufferUsageFlags usage_of(const DeviceInfo& info) {
    VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                               VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                               VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    if (info.ray_tracing)
        usage |= VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR |
                 VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR | VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR;
    return usage;
}

VmaAllocationCreateInfo allocation_of(BufferKind kind, const DeviceInfo& info) {
    VmaAllocationCreateInfo create{.usage = VMA_MEMORY_USAGE_AUTO_PREFER_DEVICE};
    switch (kind) {
        case BufferKind::device:
            if (!info.unified_memory) break;
            create.flags = VMA_ALLOCATION_CREATE_MAPPED_BIT | VMA_ALLOCATION_CREATE_HOST_ACCESS_RANDOM_BIT;
            create.requiredFlags = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
            break;
        case BufferKind::host:
            create.flags = VMA_ALLOCATION_CREATE_MAPPED_BIT | VMA_ALLOCATION_CREATE_HOST_ACCESS_SEQUENTIAL_WRITE_BIT;
            create.requiredFlags = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
            break;
        case BufferKind::readback:
            create.usage = VMA_MEMORY_USAGE_AUTO_PREFER_HOST;
            create.flags = VMA_ALLOCATION_CREATE_MAPPED_BIT | VMA_ALLOCATION_CREATE_HOST_ACCESS_RANDOM_BIT;
            create.requiredFlags = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
            create.preferredFlags = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
            break;
    }
    // A CPU device overcommits memory, and the process is killed when touching it. The budget includes
    // what other programs use; fits_in_memory() adds what we hold but have not touched.
    if (info.type == DeviceType::cpu) create.flags |= VMA_ALLOCATION_CREATE_WITHIN_BUDGET_BIT;
    return create;
}

std::uint64_t bytes_of(VmaAllocator allocator) {
    VmaBudget budgets[VK_MAX_MEMORY_HEAPS] = {};
    vmaGetHeapBudgets(allocator, budgets);
    std::uint64_t sum = 0;
    for (const VmaBudget& budget : budgets)
        sum += budget.statistics.blockBytes;
    return sum;
}

bool fits_in_memory(VmaAllocator allocator, std::size_t bytes, const DeviceInfo& info) {
    return bytes < (1u << 20) || bytes_of(allocator) + bytes <= info.memory_bytes;
}

} // namespace

std::uint64_t Device::allocated_bytes() const { return bytes_of(allocator_); }

Buffer::~Buffer() { release(); }

Buffer::Buffer(Buffer&& other) noexcept { *this = std::move(other); }

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    if (this == &other) return *this;
    release();
    device_ = std::exchange(other.device_, nullptr);
    buffer_ = std::exchange(other.buffer_, VkBuffer(VK_NULL_HANDLE));
    allocation_ = std::exchange(other.allocation_, nullptr);
    address_ = std::exchange(other.address_, 0);
    size_ = std::exchange(other.size_, 0);
    mapped_ = std::exchange(other.mapped_, nullptr);
    name_ = std::exchange(other.name_, {});
    return *this;
}

void Buffer::release() {
    if (buffer_) vmaDestroyBuffer(device_->allocator(), buffer_, allocation_);
    buffer_ = VK_NULL_HANDLE;
}

Result<Buffer> Device::create_buffer(std::size_t bytes, BufferKind kind, const char* name) {
    // 16 readable bytes past the end, and never 0; multiples of 64 avoid shared cache lines.
    const std::size_t padded = (bytes + 16 + 63) & ~std::size_t(63);
    const auto doing = [&] { return std::string("allocating buffer \"") + name + "\" (" + size_text(bytes) + ")"; };
    if (padded < bytes || padded > info_.max_buffer_bytes)
        return fail(doing() + ": " + info_.name + " allows at most " + size_text(info_.max_buffer_bytes) +
                    " in one buffer; use a smaller image, or split the mesh or texture");
    const VkBufferCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = padded, .usage = usage_of(info_)};
    const VmaAllocationCreateInfo create = allocation_of(kind, info_);
    Buffer buffer;
    VmaAllocationInfo placed{};
    VkResult result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    if (info_.type != DeviceType::cpu || fits_in_memory(allocator_, padded, info_))
        result = vmaCreateBufferWithAlignment(allocator_, &info, &create, 256, &buffer.buffer_, &buffer.allocation_,
                                              &placed);
    if (result != VK_SUCCESS) {
        buffer.buffer_ = VK_NULL_HANDLE;
        const std::string held = " besides the " + size_text(allocated_bytes()) + " already held";
        return error(result, doing() + held);
    }
    buffer.device_ = this;
    buffer.size_ = bytes;
    buffer.mapped_ = static_cast<std::byte*>(placed.pMappedData);
    buffer.name_ = name;
    const VkBufferDeviceAddressInfo address{.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO,
                                            .buffer = buffer.buffer_};
    buffer.address_ = vk_.vkGetBufferDeviceAddress(device_, &address);
    set_name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<std::uint64_t>(buffer.buffer_), name);
    return buffer;
}

Result<Buffer> Device::create_buffer(std::span<const std::byte> content, const char* name) {
    RESTAGE_TRY(Buffer buffer, create_buffer(content.size(), BufferKind::device, name));
    RESTAGE_CHECK(upload(buffer, 0, content));
    return buffer;
}

Result<void> Device::upload(Buffer& dst, std::size_t offset, std::span<const std::byte> bytes) {
    assert(offset <= dst.size() && bytes.size() <= dst.size() - offset);
    if (bytes.empty()) return {};
    if (dst.mapped()) {
        std::memcpy(dst.mapped() + offset, bytes.data(), bytes.size());
        return {};
    }
    const std::size_t chunk = std::min(bytes.size(), staging_bytes);
    RESTAGE_TRY(Buffer staging, create_buffer(chunk, BufferKind::host, "upload staging"));
    RESTAGE_TRY(CommandList list, begin());
    for (std::size_t done = 0; done < bytes.size(); done += chunk) {
        const std::size_t n = std::min(chunk, bytes.size() - done);
        std::memcpy(staging.mapped(), bytes.data() + done, n);
        list.copy(staging, 0, dst, offset + done, n);
        RESTAGE_CHECK(submit_and_wait(list));
        list.reset();
    }
    return {};
}

Result<void> Device::download(const Buffer& src, std::size_t offset, std::span<std::byte> bytes) {
    assert(offset <= src.size() && bytes.size() <= src.size() - offset);
    if (bytes.empty()) return {};
    if (src.mapped()) {
        std::memcpy(bytes.data(), src.mapped() + offset, bytes.size());
        return {};
    }
    const std::size_t chunk = std::min(bytes.size(), staging_bytes);
    RESTAGE_TRY(Buffer staging, create_buffer(chunk, BufferKind::readback, "download staging"));
    RESTAGE_TRY(CommandList list, begin());
    for (std::size_t done = 0; done < bytes.size(); done += chunk) {
        const std::size_t n = std::min(chunk, bytes.size() - done);
        list.copy(src, offset + done, staging, 0, n);
        RESTAGE_CHECK(submit_and_wait(list));
        std::memcpy(bytes.data() + done, staging.mapped(), n);
        list.reset();
    }
    return {};
}

} // namespace restage::gpu
