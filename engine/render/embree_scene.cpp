// SPDX-License-Identifier: Apache-2.0
#include "render/embree_scene.hpp"

#if RESTAGE_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif
#include <fmt/format.h>

namespace restage::render {

static_assert(sizeof(shared::RayHit) == sizeof(RTCRayHit));
static_assert(offsetof(shared::RayHit, tfar) == offsetof(RTCRayHit, ray.tfar));
static_assert(offsetof(shared::RayHit, u) == offsetof(RTCRayHit, hit.u));
static_assert(offsetof(shared::RayHit, geom) == offsetof(RTCRayHit, hit.geomID));
static_assert(offsetof(shared::RayHit, inst) == offsetof(RTCRayHit, hit.instID));
static_assert(offsetof(shared::ShadowRay, contribution) == sizeof(RTCRay));
static_assert(sizeof(shared::ShadowRay) == 64);

struct EmbreeScene::Mesh {
    RTCScene scene = nullptr;
    RTCGeometry geometry = nullptr; // owned by `scene`
    bool filtered = false;
    const EmbreeScene* owner = nullptr;
    ~Mesh() {
        if (scene) rtcReleaseScene(scene);
    }
};

namespace {

#if RESTAGE_EMBREE_MAJOR == 3
using Context = RTCIntersectContext;
void init_context(Context& c) { rtcInitIntersectContext(&c); }
#else
using Context = RTCRayQueryContext;
void init_context(Context& c) { rtcInitRayQueryContext(&c); }
#endif

// Cut-outs: called for candidate hits of meshes that some instance cuts out.
void alpha_filter(const RTCFilterFunctionNArguments* args) {
    const auto* scene = *static_cast<const GpuScene* const*>(args->geometryUserPtr);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        const unsigned n = args->N;
        const unsigned instance = args->context->instID[0];
        if (!(scene->instances()[instance].flags & INSTANCE_HAS_ALPHA)) continue;
        const float o[3] = {RTCRayN_org_x(args->ray, n, i), RTCRayN_org_y(args->ray, n, i),
                            RTCRayN_org_z(args->ray, n, i)};
        const float d[3] = {RTCRayN_dir_x(args->ray, n, i), RTCRayN_dir_y(args->ray, n, i),
                            RTCRayN_dir_z(args->ray, n, i)};
        if (!scene->alpha_passes(instance, RTCHitN_primID(args->hit, n, i),
                                 {RTCHitN_u(args->hit, n, i), RTCHitN_v(args->hit, n, i)}, o, d))
            args->valid[i] = 0;
    }
}

} // namespace

Result<std::unique_ptr<EmbreeScene>> EmbreeScene::create(unsigned threads) {
    std::unique_ptr<EmbreeScene> self(new EmbreeScene);
    self->device_ = rtcNewDevice(fmt::format("threads={},set_affinity=0", threads).c_str());
    if (!self->device_)
        return fail(fmt::format("Embree could not be started (error {})", int(rtcGetDeviceError(nullptr))));
    self->top_ = rtcNewScene(self->device_);
    rtcSetSceneFlags(self->top_, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
    rtcCommitScene(self->top_);
    return self;
}

EmbreeScene::~EmbreeScene() {
    if (top_) rtcReleaseScene(top_);
    meshes_.clear();
    if (device_) rtcReleaseDevice(device_);
}

Result<void> EmbreeScene::update(const GpuScene& scene, const SceneChanges& changes) {
    scene_ = &scene;
    for (auto id : changes.meshes) {
        const GpuMesh* g = scene.mesh(id);
        if (!g) {
            meshes_.erase(id.value); // instances of it hold a reference until they are detached below
            continue;
        }
        auto mesh = std::make_unique<Mesh>();
        mesh->owner = this;
        mesh->scene = rtcNewScene(device_);
        rtcSetSceneFlags(mesh->scene, RTC_SCENE_FLAG_ROBUST);
        mesh->geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(mesh->geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, g->buffer.mapped(),
                                   g->positions_offset, 12, g->vertex_count);
        rtcSetSharedGeometryBuffer(mesh->geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, g->buffer.mapped(),
                                   g->indices_offset, 12, g->triangle_count);
        rtcSetGeometryUserData(mesh->geometry, &scene_);
        rtcCommitGeometry(mesh->geometry);
        rtcAttachGeometryByID(mesh->scene, mesh->geometry, 0);
        rtcReleaseGeometry(mesh->geometry);
        rtcCommitScene(mesh->scene);
        if (const auto error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
            return fail(
                fmt::format("Embree could not build a mesh of {} triangles (error {})", g->triangle_count, int(error)));
        meshes_[id.value] = std::move(mesh);
    }
    const bool shrunk = attached_.size() > scene.instances().size();
    for (std::size_t i = scene.instances().size(); i < attached_.size(); ++i) // of a scene that was forgotten
        if (attached_[i]) rtcDetachGeometry(top_, unsigned(i));
    attached_.resize(scene.instances().size(), 0);
    for (auto id : changes.instances) {
        const auto i = id.value;
        const std::uint32_t wanted = scene.traced(i) ? scene.mesh_of(i).value : 0;
        const bool same_mesh =
            wanted && attached_[i] == wanted &&
            std::find(changes.meshes.begin(), changes.meshes.end(), scene.mesh_of(i)) == changes.meshes.end();
        RTCGeometry geometry = nullptr;
        if (same_mesh) {
            geometry = rtcGetGeometry(top_, i);
        } else {
            if (attached_[i]) rtcDetachGeometry(top_, i);
            attached_[i] = wanted;
            if (!wanted) continue;
            geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
            rtcSetGeometryInstancedScene(geometry, meshes_.at(wanted)->scene);
            rtcAttachGeometryByID(top_, geometry, i);
            rtcReleaseGeometry(geometry);
        }
        const shared::InstanceData& data = scene.instances()[i];
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &data.object_to_world);
        rtcCommitGeometry(geometry);
        Mesh& mesh = *meshes_.at(wanted);
        if ((data.flags & INSTANCE_HAS_ALPHA) && !mesh.filtered) {
            mesh.filtered = true;
            rtcSetGeometryIntersectFilterFunction(mesh.geometry, alpha_filter);
            rtcSetGeometryOccludedFilterFunction(mesh.geometry, alpha_filter);
            rtcCommitGeometry(mesh.geometry);
            rtcCommitScene(mesh.scene);
        }
    }
    if (shrunk || !changes.instances.empty() || !changes.meshes.empty()) rtcCommitScene(top_);
    if (const auto error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
        return fail(fmt::format("Embree could not build the scene (error {})", int(error)));
    return {};
}

void EmbreeScene::intersect(shared::RayHit& ray) const {
    Context context;
    init_context(context);
#if RESTAGE_EMBREE_MAJOR == 3
    rtcIntersect1(top_, &context, reinterpret_cast<RTCRayHit*>(&ray));
#else
    RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.context = &context;
    rtcIntersect1(top_, reinterpret_cast<RTCRayHit*>(&ray), &args);
#endif
}

void EmbreeScene::occluded(shared::ShadowRay& shadow) const {
    Context context;
    init_context(context);
#if RESTAGE_EMBREE_MAJOR == 3
    rtcOccluded1(top_, &context, reinterpret_cast<RTCRay*>(&shadow));
#else
    RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.context = &context;
    rtcOccluded1(top_, reinterpret_cast<RTCRay*>(&shadow), &args);
#endif
}

} // namespace restage::render
