// SPDX-License-Identifier: Apache-2.0
// Building acceleration structures. Blas in batches, compacted; Tlas from an instance buffer that the host writes.
#include "gpu/accel.hpp"

#include "gpu/device.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

namespace restage::gpu {

namespace {

VkAccelerationStructureGeometryKHR triangles_of(const BlasInput& input) {
    VkAccelerationStructureGeometryKHR geometry{.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
                                                .geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR};
    geometry.geometry.triangles = {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR,
                                   .vertexFormat = VK_FORMAT_R32G32B32_SFLOAT,
                                   .vertexData = {.deviceAddress = input.vertices},
                                   .vertexStride = input.vertex_stride,
                                   .maxVertex = input.vertex_count > 0 ? input.vertex_count - 1 : 0,
                                   .indexType = VK_INDEX_TYPE_UINT32,
                                   .indexData = {.deviceAddress = input.indices}};
    if (input.boxes) {
        geometry.geometryType = VK_GEOMETRY_TYPE_AABBS_KHR;
        geometry.geometry.aabbs = {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA_KHR,
                                   .data = {.deviceAddress = input.boxes},
                                   .stride = sizeof(VkAabbPositionsKHR)};
    }
    // A candidate is then reported once, as counting or stochastic cut-outs require.
    geometry.flags = input.opaque ? VK_GEOMETRY_OPAQUE_BIT_KHR : VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR;
    return geometry;
}

std::uint32_t count_of(const BlasInput& input) { return input.boxes ? input.box_count : input.triangle_count; }

VkAccelerationStructureBuildSizesInfoKHR sizes_of(Device& device,
                                                  const VkAccelerationStructureBuildGeometryInfoKHR& info,
                                                  std::uint32_t count) {
    VkAccelerationStructureBuildSizesInfoKHR sizes{.sType =
                                                       VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    device.vk().vkGetAccelerationStructureBuildSizesKHR(
        device.handle(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, &count, &sizes);
    return sizes;
}

VkDeviceAddress align_up(VkDeviceAddress value, VkDeviceAddress alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

} // namespace

// ---- either level --------------------------------------------------------------------------------------------------

Result<AccelStructure> AccelStructure::create(Device& device, VkDeviceSize bytes, VkAccelerationStructureTypeKHR type,
                                              const char* name) {
    AccelStructure self;
    self.device_ = &device;
    RESTAGE_TRY(self.buffer_, device.create_buffer(bytes, BufferKind::device, name));
    const VkAccelerationStructureCreateInfoKHR info{.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR,
                                                    .buffer = self.buffer_.handle(),
                                                    .size = bytes,
                                                    .type = type};
    const VkResult result =
        device.vk().vkCreateAccelerationStructureKHR(device.handle(), &info, nullptr, &self.handle_);
    if (result != VK_SUCCESS) {
        self.handle_ = VK_NULL_HANDLE;
        return device.error(result, std::string("creating the acceleration structure of ") + name);
    }
    device.set_name(VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR, reinterpret_cast<std::uint64_t>(self.handle_), name);
    const VkAccelerationStructureDeviceAddressInfoKHR query{
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR,
        .accelerationStructure = self.handle_};
    self.address_ = device.vk().vkGetAccelerationStructureDeviceAddressKHR(device.handle(), &query);
    return self;
}

AccelStructure::~AccelStructure() {
    if (handle_) device_->vk().vkDestroyAccelerationStructureKHR(device_->handle(), handle_, nullptr);
}
AccelStructure::AccelStructure(AccelStructure&& other) noexcept { *this = std::move(other); }
AccelStructure& AccelStructure::operator=(AccelStructure&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    std::swap(buffer_, other.buffer_);
    std::swap(address_, other.address_);
    return *this;
}

// ---- bottom level --------------------------------------------------------------------------------------------------

// Builds inputs [begin, end) of one batch, whose scratch fits together.
class AccelBuilder {
  public:
    AccelBuilder(Device& device, std::span<const BlasInput> inputs, const BlasOptions& options)
        : device_(device), inputs_(inputs), options_(options) {}

    Result<std::vector<Blas>> build() {
        const std::size_t count = inputs_.size();
        geometries_.reserve(count);
        for (const BlasInput& input : inputs_) {
            assert(input.triangle_count == 0 || input.boxes || (input.vertices && input.indices));
            geometries_.push_back(triangles_of(input));
        }
        const VkBuildAccelerationStructureFlagsKHR compaction =
            options_.compact
                ? VkBuildAccelerationStructureFlagsKHR(VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR)
                : 0;
        for (std::size_t i = 0; i < count; ++i) {
            infos_.push_back({.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR,
                              .type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR,
                              .flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR | compaction,
                              .mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR,
                              .geometryCount = 1,
                              .pGeometries = &geometries_[i]});
            sizes_.push_back(sizes_of(device_, infos_[i], count_of(inputs_[i])));
            RESTAGE_TRY(Blas blas, create(sizes_[i].accelerationStructureSize, inputs_[i].name));
            infos_[i].dstAccelerationStructure = blas.structure_.handle();
            blases_.push_back(std::move(blas));
        }
        for (std::size_t begin = 0; begin < count;) {
            VkDeviceSize scratch = 0;
            std::size_t end = begin;
            while (end < count && (end == begin || scratch + scratch_of(end) <= options_.max_scratch_bytes))
                scratch += scratch_of(end++);
            RESTAGE_CHECK(build_batch(begin, end, scratch));
            begin = end;
        }
        return std::move(blases_);
    }

  private:
    VkDeviceSize scratch_of(std::size_t i) const {
        return align_up(sizes_[i].buildScratchSize, device_.scratch_alignment());
    }

    Result<Blas> create(VkDeviceSize bytes, const std::string& name) {
        Blas blas;
        RESTAGE_TRY(
            blas.structure_,
            AccelStructure::create(device_, bytes, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, name.c_str()));
        return blas;
    }

    Result<void> build_batch(std::size_t begin, std::size_t end, VkDeviceSize scratch_bytes) {
        const VkDeviceSize alignment = device_.scratch_alignment();
        RESTAGE_TRY(const Buffer scratch,
                    device_.create_buffer(scratch_bytes + alignment, BufferKind::device, "blas scratch"));
        VkDeviceAddress address = align_up(scratch.address(), alignment);
        std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
        for (std::size_t i = begin; i < end; ++i) {
            infos_[i].scratchData.deviceAddress = address;
            address += scratch_of(i);
            ranges.push_back({.primitiveCount = count_of(inputs_[i])});
        }
        std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> range_pointers;
        for (const auto& range : ranges)
            range_pointers.push_back(&range);
        RESTAGE_TRY(CommandList list, device_.begin());
        device_.vk().vkCmdBuildAccelerationStructuresKHR(list.handle(), static_cast<std::uint32_t>(end - begin),
                                                         &infos_[begin], range_pointers.data());
        if (!options_.compact) return device_.submit_and_wait(list);
        return compact(begin, end, list);
    }

    Result<void> compact(std::size_t begin, std::size_t end, CommandList& list) {
        const auto count = static_cast<std::uint32_t>(end - begin);
        const VolkDeviceTable& vk = device_.vk();
        const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                         .queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR,
                                         .queryCount = count};
        VkQueryPool pool = VK_NULL_HANDLE;
        VkResult result = vk.vkCreateQueryPool(device_.handle(), &info, nullptr, &pool);
        if (result != VK_SUCCESS) return device_.error(result, "creating the query of compacted sizes");
        struct Guard {
            Device& device;
            VkQueryPool pool;
            ~Guard() { device.vk().vkDestroyQueryPool(device.handle(), pool, nullptr); }
        } guard{device_, pool};
        std::vector<VkAccelerationStructureKHR> handles;
        for (std::size_t i = begin; i < end; ++i)
            handles.push_back(blases_[i].structure_.handle());
        list.barrier();
        vk.vkCmdResetQueryPool(list.handle(), pool, 0, count);
        vk.vkCmdWriteAccelerationStructuresPropertiesKHR(
            list.handle(), count, handles.data(), VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR, pool, 0);
        RESTAGE_CHECK(device_.submit_and_wait(list));
        std::vector<VkDeviceSize> sizes(count);
        result = vk.vkGetQueryPoolResults(device_.handle(), pool, 0, count, sizes.size() * sizeof(VkDeviceSize),
                                          sizes.data(), sizeof(VkDeviceSize),
                                          VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
        if (result != VK_SUCCESS) return device_.error(result, "reading compacted sizes");
        list.reset();
        std::vector<Blas> compacted(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            if (sizes[i] >= blases_[begin + i].bytes()) continue; // nothing to gain (lavapipe)
            RESTAGE_TRY(compacted[i], create(sizes[i], inputs_[begin + i].name));
            const VkCopyAccelerationStructureInfoKHR copy{
                .sType = VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR,
                .src = handles[i],
                .dst = compacted[i].structure_.handle(),
                .mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR};
            vk.vkCmdCopyAccelerationStructureKHR(list.handle(), &copy);
        }
        RESTAGE_CHECK(device_.submit_and_wait(list));
        for (std::uint32_t i = 0; i < count; ++i)
            if (compacted[i]) blases_[begin + i] = std::move(compacted[i]);
        return {};
    }

    Device& device_;
    std::span<const BlasInput> inputs_;
    BlasOptions options_;
    std::vector<VkAccelerationStructureGeometryKHR> geometries_;
    std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos_;
    std::vector<VkAccelerationStructureBuildSizesInfoKHR> sizes_;
    std::vector<Blas> blases_;
};

Result<std::vector<Blas>> build_blas(Device& device, std::span<const BlasInput> inputs, const BlasOptions& options) {
    if (!device.info().ray_tracing) return fail(device.info().missing_ray_tracing);
    return AccelBuilder(device, inputs, options).build();
}

// ---- top level -----------------------------------------------------------------------------------------------------

namespace {

VkAccelerationStructureGeometryKHR instances_of(VkDeviceAddress address) {
    VkAccelerationStructureGeometryKHR geometry{.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
                                                .geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR};
    geometry.geometry.instances = {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR,
                                   .data = {.deviceAddress = address}};
    return geometry;
}

VkAccelerationStructureBuildGeometryInfoKHR tlas_info(const VkAccelerationStructureGeometryKHR& geometry) {
    return {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR,
            .type = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR,
            .flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR,
            .mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR,
            .geometryCount = 1,
            .pGeometries = &geometry};
}

} // namespace

Result<Tlas> Tlas::create(Device& device, std::uint32_t capacity, const char* name) {
    if (!device.info().ray_tracing) return fail(device.info().missing_ray_tracing);
    capacity = std::max(capacity, 1u);
    Tlas self;
    self.device_ = &device;
    self.capacity_ = capacity;
    RESTAGE_TRY(self.instances_,
                device.create_buffer(std::size_t(capacity) * sizeof(VkAccelerationStructureInstanceKHR),
                                     BufferKind::host, "tlas instances"));
    const auto geometry = instances_of(self.instances_.address());
    const auto sizes = sizes_of(device, tlas_info(geometry), capacity);
    RESTAGE_TRY(self.structure_, AccelStructure::create(device, sizes.accelerationStructureSize,
                                                        VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, name));
    RESTAGE_TRY(self.scratch_, device.create_buffer(sizes.buildScratchSize + device.scratch_alignment(),
                                                    BufferKind::device, "tlas scratch"));
    self.scratch_address_ = align_up(self.scratch_.address(), device.scratch_alignment());
    return self;
}

void Tlas::set(std::uint32_t index, const TlasInstance& instance) {
    assert(index < count_ && instance.custom_index < (1u << 24) && instance.hit_group < (1u << 24));
    VkGeometryInstanceFlagsKHR flags = 0;
    if (instance.two_sided) flags |= VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR;
    if (instance.flip_facing) flags |= VK_GEOMETRY_INSTANCE_TRIANGLE_FLIP_FACING_BIT_KHR;
    if (instance.force_opaque) flags |= VK_GEOMETRY_INSTANCE_FORCE_OPAQUE_BIT_KHR;
    if (instance.force_any_hit) flags |= VK_GEOMETRY_INSTANCE_FORCE_NO_OPAQUE_BIT_KHR;
    VkAccelerationStructureInstanceKHR raw{};
    static_assert(sizeof raw.transform == sizeof instance.transform);
    std::memcpy(&raw.transform, instance.transform.data(), sizeof raw.transform);
    raw.instanceCustomIndex = instance.custom_index & 0xffffffu;
    raw.mask = instance.mask;
    raw.instanceShaderBindingTableRecordOffset = instance.hit_group & 0xffffffu;
    raw.flags = flags & 0xffu;
    raw.accelerationStructureReference = instance.blas;
    instances_.span<VkAccelerationStructureInstanceKHR>()[index] = raw;
}

void Tlas::set_all(std::span<const TlasInstance> instances) {
    resize(static_cast<std::uint32_t>(instances.size()));
    for (std::uint32_t i = 0; i < count_; ++i)
        set(i, instances[i]);
}

void Tlas::resize(std::uint32_t count) {
    assert(count <= capacity_);
    for (std::uint32_t i = count_; i < count; ++i)
        instances_.span<VkAccelerationStructureInstanceKHR>()[i] = {};
    count_ = count;
}

Result<void> Tlas::build() {
    RESTAGE_TRY(CommandList list, device_->begin());
    list.build(*this);
    return device_->submit_and_wait(list);
}

void CommandList::build(Tlas& tlas) {
    const auto geometry = instances_of(tlas.instances_.address());
    auto info = tlas_info(geometry);
    info.dstAccelerationStructure = tlas.structure_.handle();
    info.scratchData.deviceAddress = tlas.scratch_address_;
    const VkAccelerationStructureBuildRangeInfoKHR range{.primitiveCount = tlas.count_};
    const VkAccelerationStructureBuildRangeInfoKHR* const ranges = &range;
    tlas.device_->vk().vkCmdBuildAccelerationStructuresKHR(handle(), 1, &info, &ranges);
}

} // namespace restage::gpu
