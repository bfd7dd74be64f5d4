// SPDX-License-Identifier: Apache-2.0
#include "render/embree_api.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstring>

namespace restage::render {

namespace {

// Embree asserts that coordinates, in object space too, are below its FLT_LARGE, 1.844e18.
constexpr float largest_coordinate = 5e17f; // of a point before three products are summed

bool has_plain_hits(const GpuScene& scene, std::uint32_t instance) {
    return !(scene.instances()[instance].flags &
             (INSTANCE_HAS_ALPHA | INSTANCE_HAS_GAPS | INSTANCE_PASSES | INSTANCE_QUADRIC));
}

bool is_simple(const GpuScene& scene) {
    for (std::uint32_t i = 0; i < scene.instances().size(); ++i)
        if (scene.traced(i) && !has_plain_hits(scene, i)) return false;
    return true;
}

bool is_empty(const GpuScene& scene) {
    for (std::uint32_t i = 0; i < scene.instances().size(); ++i)
        if (scene.traced(i)) return false;
    return true;
}

} // namespace

Result<std::unique_ptr<EmbreeScene>> EmbreeScene::create(unsigned threads, Use use) {
    std::unique_ptr<EmbreeScene> self(new EmbreeScene);
    self->use_ = use;
    self->reach_ = largest_coordinate;
    self->device_ = rtcNewDevice(fmt::format("threads={},set_affinity=0", threads).c_str());
    if (!self->device_)
        return fail(fmt::format("Embree could not be started (error {})", int(rtcGetDeviceError(nullptr))));
    if (rtcGetDeviceProperty(self->device_, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED))
        self->packet_size_ = 16;
    else if (rtcGetDeviceProperty(self->device_, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED))
        self->packet_size_ = 8;
    for (Instances* instances : {&self->surfaces_, &self->borders_}) {
        instances->scene = rtcNewScene(self->device_);
        rtcSetSceneFlags(instances->scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
        rtcCommitScene(instances->scene);
    }
    return self;
}

EmbreeScene::~EmbreeScene() {
    for (Instances* instances : {&surfaces_, &borders_})
        if (instances->scene) rtcReleaseScene(instances->scene);
    if (flat_) rtcReleaseScene(flat_);
    meshes_.clear();
    box_.reset();
    if (device_) rtcReleaseDevice(device_);
}

Result<void> EmbreeScene::update(const GpuScene& scene, const SceneChanges& changes) {
    scene_ = &scene;
    simple_ = is_simple(scene);
    const bool changed = !changes.meshes.empty() || !changes.instances.empty();
    if (flat_ && !changed && !is_empty(scene)) return {}; // an empty one has no changes, but the flat one was forgotten
    if (flattening_pays(changes)) return flatten(changes);
    return flat_ ? unflatten(changes) : update_instances(changes);
}

Result<void> EmbreeScene::update_instances(const SceneChanges& changes) {
    const GpuScene& scene = *scene_;
    for (auto id : changes.meshes) {
        const GpuMesh* g = scene.mesh(id);
        if (!g) {
            meshes_.erase(id.value); // its instances hold a reference until they are detached below
            continue;
        }
        if (g->quadric) {
            if (!box_) RESTAGE_CHECK(make_box());
            meshes_.erase(id.value);
            continue;
        }
        auto mesh = std::make_unique<Mesh>();
        mesh->owner = this;
        mesh->scene = rtcNewScene(device_);
        rtcSetSceneFlags(mesh->scene, RTC_SCENE_FLAG_ROBUST);
        mesh->geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        const auto set_buffer = [&](RTCBufferType type, RTCFormat format, std::size_t offset, std::size_t count,
                                    const void* source) {
            if (!use_.copies)
                rtcSetSharedGeometryBuffer(mesh->geometry, type, 0, format, g->buffer.mapped(), offset, 12, count);
            else if (void* own = rtcSetNewGeometryBuffer(mesh->geometry, type, 0, format, 12, count))
                std::memcpy(own, source, 12 * count);
        };
        const scene::MeshData& data = *scene.mesh_data(id);
        set_buffer(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, g->positions_offset, g->vertex_count,
                   data.positions.data());
        set_buffer(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, g->indices_offset, g->triangle_count,
                   data.triangles.data());
        rtcSetGeometryUserData(mesh->geometry, static_cast<void*>(&scene_));
        rtcCommitGeometry(mesh->geometry);
        rtcAttachGeometryByID(mesh->scene, mesh->geometry, 0);
        rtcReleaseGeometry(mesh->geometry);
        rtcCommitScene(mesh->scene);
        if (const auto error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
            return fail(
                fmt::format("Embree could not build a mesh of {} triangles (error {})", g->triangle_count, int(error)));
        meshes_[id.value] = std::move(mesh);
    }
    update(surfaces_, scene, changes, &GpuScene::traced);
    update(borders_, scene, changes, &GpuScene::border);
    if (const auto error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
        return fail(fmt::format("Embree could not build the scene (error {})", int(error)));
    return {};
}

// The geometry of all quadrics: one box, placed around each by its instance.
Result<void> EmbreeScene::make_box() {
    box_ = std::make_unique<Mesh>();
    box_->owner = this;
    box_->filtered = true; // by itself
    box_->scene = rtcNewScene(device_);
    rtcSetSceneFlags(box_->scene, RTC_SCENE_FLAG_ROBUST);
    box_->geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    set_embree_box(box_->geometry);
    rtcSetGeometryUserData(box_->geometry, static_cast<void*>(&scene_));
    rtcCommitGeometry(box_->geometry);
    rtcAttachGeometryByID(box_->scene, box_->geometry, 0);
    rtcReleaseGeometry(box_->geometry);
    rtcCommitScene(box_->scene);
    if (const auto error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
        return fail(fmt::format("Embree could not build the box of quadrics (error {})", int(error)));
    return {};
}

void EmbreeScene::update(Instances& top, const GpuScene& scene, const SceneChanges& changes,
                         bool (GpuScene::*is_wanted)(std::uint32_t) const) {
    bool changed = false;
    for (std::size_t i = scene.instances().size(); i < top.attached.size(); ++i) // of a forgotten scene
        if (top.attached[i]) {
            rtcDetachGeometry(top.scene, unsigned(i));
            changed = true;
        }
    top.attached.resize(scene.instances().size(), 0);
    for (auto id : changes.instances) {
        const auto i = id.value;
        const std::uint32_t wanted = (scene.*is_wanted)(i) ? scene.mesh_of(i).value : 0;
        changed |= wanted || top.attached[i];
        const bool same_mesh =
            wanted && top.attached[i] == wanted &&
            std::find(changes.meshes.begin(), changes.meshes.end(), scene.mesh_of(i)) == changes.meshes.end();
        RTCGeometry geometry = nullptr;
        if (same_mesh) {
            geometry = rtcGetGeometry(top.scene, i);
        } else {
            if (top.attached[i]) rtcDetachGeometry(top.scene, i);
            top.attached[i] = wanted;
            if (!wanted) continue;
            geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
            rtcSetGeometryInstancedScene(geometry, (scene.is_quadric(i) ? box_ : meshes_.at(wanted))->scene);
            rtcAttachGeometryByID(top.scene, geometry, i);
            rtcReleaseGeometry(geometry);
        }
        const shared::InstanceData& data = scene.instances()[i];
        const glm::mat4x3 placement = scene.placement(i);
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &placement);
        rtcCommitGeometry(geometry);
        const glm::mat3 inverse = glm::inverse(glm::mat3(placement));
        for (int k = 0; k < 9; ++k)
            reach_ = std::min(reach_, largest_coordinate / std::max(std::abs(inverse[k / 3][k % 3]), 1.f));
        Mesh& mesh = scene.is_quadric(i) ? *box_ : *meshes_.at(wanted);
        if ((data.flags & (INSTANCE_HAS_ALPHA | INSTANCE_HAS_GAPS | INSTANCE_PASSES)) && !mesh.filtered) {
            mesh.filtered = true;
            rtcSetGeometryIntersectFilterFunction(mesh.geometry, embree_hit_filter);
            rtcSetGeometryOccludedFilterFunction(mesh.geometry, embree_hit_filter);
            rtcCommitGeometry(mesh.geometry);
            rtcCommitScene(mesh.scene);
        }
    }
    if (changed) rtcCommitScene(top.scene);
}

} // namespace restage::render
