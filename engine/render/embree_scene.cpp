// SPDX-License-Identifier: Apache-2.0
#include "render/embree_instances.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_set>
#include <utility>

namespace restage::render {

namespace {

// Embree asserts that coordinates, in object space too, are below its FLT_LARGE, 1.844e18.
constexpr float largest_coordinate = 5e17f; // of a point before three products are summed

} // namespace

EmbreeScene::EmbreeScene() = default;

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
    self->surfaces_ = std::make_unique<EmbreeInstances>(self->device_);
    self->borders_ = std::make_unique<EmbreeInstances>(self->device_);
    return self;
}

EmbreeScene::~EmbreeScene() {
    surfaces_.reset();
    borders_.reset();
    if (flat_) rtcReleaseScene(flat_);
    meshes_.clear();
    box_.reset();
    if (device_) rtcReleaseDevice(device_);
}

Result<void> EmbreeScene::check(const char* what) const {
    if (const auto error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
        return fail(fmt::format("Embree could not build {} (error {})", what, int(error)));
    return {};
}

Result<void> EmbreeScene::update(const GpuScene& scene, const SceneChanges& changes) {
    scene_ = &scene;
    const bool changed = !changes.meshes.empty() || !changes.instances.empty();
    if (flat_ && !changed && scene.any_traced())
        return {}; // an empty one has no changes, but the flat one is forgotten
    if (flattening_pays(changes)) return flatten(changes);
    return flat_ ? unflatten(changes) : update_instances(changes);
}

bool EmbreeScene::settled() const { return !surfaces_->apart() && !borders_->apart(); }

Result<void> EmbreeScene::settle() {
    surfaces_->merge();
    borders_->merge();
    return check("the scene");
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
        RESTAGE_CHECK(check(fmt::format("a mesh of {} triangles", g->triangle_count).c_str()));
        meshes_[id.value] = std::move(mesh);
    }
    const bool refiltered = add_filters(changes);
    update(*surfaces_, changes, refiltered, &GpuScene::traced);
    update(*borders_, changes, refiltered, &GpuScene::border);
    return check("the scene");
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
    return check("the box of quadrics");
}

EmbreeScene::Mesh& EmbreeScene::mesh_of(std::uint32_t instance) const {
    return scene_->is_quadric(instance) ? *box_ : *meshes_.at(scene_->mesh_of(instance).value);
}

// Filters of meshes that had none. True: some were, and what has their instances must be built again.
bool EmbreeScene::add_filters(const SceneChanges& changes) {
    bool some = false;
    for (auto id : changes.instances) {
        if (!scene_->traced(id.value) && !scene_->border(id.value)) continue;
        if (!(scene_->instances()[id.value].flags & (INSTANCE_HAS_ALPHA | INSTANCE_HAS_GAPS | INSTANCE_PASSES)))
            continue;
        Mesh& mesh = mesh_of(id.value);
        if (std::exchange(mesh.filtered, true)) continue;
        some = true;
        rtcSetGeometryIntersectFilterFunction(mesh.geometry, embree_hit_filter);
        rtcSetGeometryOccludedFilterFunction(mesh.geometry, embree_hit_filter);
        rtcCommitGeometry(mesh.geometry);
        rtcCommitScene(mesh.scene);
    }
    return some;
}

void EmbreeScene::update(EmbreeInstances& top, const SceneChanges& changes, bool refiltered,
                         bool (GpuScene::*is_wanted)(std::uint32_t) const) {
    const std::size_t count = scene_->instances().size();
    top.begin(count, refiltered ? count : changes.instances.size());
    std::unordered_set<std::uint32_t> replaced;
    for (auto id : changes.meshes)
        replaced.insert(id.value);
    for (auto id : changes.instances) {
        const auto i = id.value;
        if (!(scene_->*is_wanted)(i)) {
            top.remove(i);
            continue;
        }
        const glm::mat4x3 placement = scene_->placement(i);
        const std::uint32_t mesh = scene_->mesh_of(i).value;
        top.place(i, mesh, mesh_of(i).scene, placement, refiltered || replaced.contains(mesh));
        const glm::mat3 inverse = glm::inverse(glm::mat3(placement));
        for (int k = 0; k < 9; ++k)
            reach_ = std::min(reach_, largest_coordinate / std::max(std::abs(inverse[k / 3][k % 3]), 1.f));
    }
    top.commit();
}

} // namespace restage::render
