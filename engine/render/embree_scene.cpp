// SPDX-License-Identifier: Apache-2.0
#include "render/embree_scene.hpp"

#if RESTAGE_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif
#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

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

struct QueryContext {
    Context embree; // first: the part known to Embree
    bool borders;   // query hits borders of media, not surfaces
    bool shadow;    // query hits surfaces that block light
    glm::vec3 origin, direction; // of the ray in world space: Embree transforms it to instance space
    std::vector<EmbreeScene::Undecided>* undecided; // null: undecidable hits are decided by averages
};

// Whether the hit is deferred: then the ray continues.
bool put_aside(const GpuScene& scene, const QueryContext& query, const EmbreeScene::Undecided& hit) {
    if (!query.undecided || !scene.undecided(hit.instance)) return false;
    if (!(query.shadow && (scene.instances()[hit.instance].flags & INSTANCE_PASSES))) query.undecided->push_back(hit);
    return true;
}

// The decision of hit_filter on this hit of a world-space ray.
bool passes_filter(const GpuScene& scene, const QueryContext& query, unsigned instance,
                   const GpuScene::QuadricHit& hit) {
    const auto flags = scene.instances()[instance].flags;
    if ((flags & INSTANCE_HAS_ALPHA) &&
        !scene.alpha_passes(instance, hit.leaves, hit.uv, &query.origin.x, &query.direction.x))
        return false;
    if ((flags & INSTANCE_PASSES) && query.shadow) return false;
    return !(flags & INSTANCE_HAS_GAPS) ||
           (scene.resolve_material(instance, 0, hit.uv) == MATERIAL_NOTHING) == query.borders;
}

// Intersects the quadric of Embree's current instance.
std::optional<GpuScene::QuadricHit> meet(const void* user, const void* context, unsigned instance, glm::vec2 range) {
    const auto& scene = **static_cast<const GpuScene* const*>(user);
    const auto& query = *static_cast<const QueryContext*>(context);
    GpuScene::QuadricHit hits[2];
    const int n = scene.meet_quadric(instance, query.origin, query.direction, range, hits);
    for (int i = 0; i < n; ++i) // the far one if the near one lets rays pass
        if (!put_aside(scene, query, {hits[i].t, instance, 0, hits[i].uv, hits[i].leaves}) &&
            passes_filter(scene, query, instance, hits[i]))
            return hits[i];
    return std::nullopt;
}

// One ray at a time: packets are not used.
void box_intersect(const RTCIntersectFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    auto& ray = *reinterpret_cast<RTCRayHit*>(args->rayhit);
    const unsigned instance = args->context->instID[0];
    const auto hit = meet(args->geometryUserPtr, args->context, instance, {ray.ray.tnear, ray.ray.tfar});
    if (!hit) return;
    ray.ray.tfar = hit->t;
    ray.hit.u = hit->uv.x;
    ray.hit.v = hit->uv.y;
    ray.hit.primID = 0;
    ray.hit.geomID = 0;
    ray.hit.instID[0] = instance;
}
void box_occluded(const RTCOccludedFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
    if (meet(args->geometryUserPtr, args->context, args->context->instID[0], {ray.tnear, ray.tfar}))
        ray.tfar = -std::numeric_limits<float>::infinity();
}
void box_bounds(const RTCBoundsFunctionArguments* args) { *args->bounds_o = {-1, -1, -1, 0, 1, 1, 1, 0}; }

// Cut-outs, lamps without a surface, and mixes with a null component: called for candidate hits of meshes that some
// instance uses that way.
void hit_filter(const RTCFilterFunctionNArguments* args) {
    const auto* scene = *static_cast<const GpuScene* const*>(args->geometryUserPtr);
    const auto& query = *reinterpret_cast<const QueryContext*>(args->context);
    const bool borders = query.borders;
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        const unsigned n = args->N;
        const unsigned instance = args->context->instID[0], prim = RTCHitN_primID(args->hit, n, i);
        const glm::vec2 bary(RTCHitN_u(args->hit, n, i), RTCHitN_v(args->hit, n, i));
        const auto flags = scene->instances()[instance].flags;
        if (put_aside(*scene, query, {RTCRayN_tfar(args->ray, n, i), instance, prim, bary, prim})) {
            args->valid[i] = 0;
            continue;
        }
        if (flags & INSTANCE_HAS_ALPHA) {
            const float o[3] = {RTCRayN_org_x(args->ray, n, i), RTCRayN_org_y(args->ray, n, i),
                                RTCRayN_org_z(args->ray, n, i)};
            const float d[3] = {RTCRayN_dir_x(args->ray, n, i), RTCRayN_dir_y(args->ray, n, i),
                                RTCRayN_dir_z(args->ray, n, i)};
            if (!scene->alpha_passes(instance, prim, bary, o, d)) args->valid[i] = 0;
        }
        if ((flags & INSTANCE_PASSES) && query.shadow) args->valid[i] = 0;
        if ((flags & INSTANCE_HAS_GAPS) &&
            (scene->resolve_material(instance, prim, bary) == MATERIAL_NOTHING) != borders)
            args->valid[i] = 0;
    }
}

// Embree asserts that coordinates, in object space too, are below its FLT_LARGE, 1.844e18.
constexpr float largest_coordinate = 5e17f; // of a point before three products are summed

// It also asserts: no NaN, and an interval that starts at 0 or later. Whatever kernels computed from a scene of
// absurd sizes counts as a miss instead.
bool can_be_asked(const glm::vec3& origin, const glm::vec3& direction, float near, float far, float reach) {
    // Sums of non-negative values, which NaN also spoils; branch-free, as this runs for every ray.
    const float far_out = std::abs(origin.x) + std::abs(origin.y) + std::abs(origin.z);
    const float steep = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
    return (near >= 0) & (near <= far) & (far_out <= reach) & (steep <= 1e3f);
}

} // namespace

Result<std::unique_ptr<EmbreeScene>> EmbreeScene::create(unsigned threads, bool copies) {
    std::unique_ptr<EmbreeScene> self(new EmbreeScene);
    self->copies_ = copies;
    self->reach_ = largest_coordinate;
    self->device_ = rtcNewDevice(fmt::format("threads={},set_affinity=0", threads).c_str());
    if (!self->device_)
        return fail(fmt::format("Embree could not be started (error {})", int(rtcGetDeviceError(nullptr))));
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
    meshes_.clear();
    box_.reset();
    if (device_) rtcReleaseDevice(device_);
}

Result<void> EmbreeScene::update(const GpuScene& scene, const SceneChanges& changes) {
    scene_ = &scene;
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
            if (!copies_)
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
    rtcSetGeometryUserPrimitiveCount(box_->geometry, 1);
    rtcSetGeometryUserData(box_->geometry, static_cast<void*>(&scene_));
    rtcSetGeometryBoundsFunction(box_->geometry, box_bounds, nullptr);
    rtcSetGeometryIntersectFunction(box_->geometry, box_intersect);
    rtcSetGeometryOccludedFunction(box_->geometry, box_occluded);
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
            rtcSetGeometryIntersectFilterFunction(mesh.geometry, hit_filter);
            rtcSetGeometryOccludedFilterFunction(mesh.geometry, hit_filter);
            rtcCommitGeometry(mesh.geometry);
            rtcCommitScene(mesh.scene);
        }
    }
    if (changed) rtcCommitScene(top.scene);
}

void EmbreeScene::intersect(const Instances& top, shared::RayHit& ray, std::vector<Undecided>* undecided) const {
    if (!can_be_asked(ray.origin, ray.direction, ray.tnear, ray.tfar, reach_)) return;
    QueryContext context;
    init_context(context.embree);
    context.borders = &top == &borders_;
    context.shadow = false;
    context.undecided = undecided;
    context.origin = ray.origin;
    context.direction = ray.direction;
#if RESTAGE_EMBREE_MAJOR == 3
    rtcIntersect1(top.scene, &context.embree, reinterpret_cast<RTCRayHit*>(&ray));
#else
    RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.context = &context.embree;
    rtcIntersect1(top.scene, reinterpret_cast<RTCRayHit*>(&ray), &args);
#endif
}

void EmbreeScene::intersect(shared::RayHit& ray, std::vector<Undecided>* undecided) const {
    intersect(surfaces_, ray, undecided);
}

EmbreeScene::Passed EmbreeScene::pass_borders(const Stretch& stretch, std::uint32_t medium, float hero) const {
    const glm::vec3& direction = stretch.direction;
    glm::vec4 depth(0); // optical
    float t = stretch.t_start;
    std::uint32_t step = 4; // [ulp] past the border just met
    alignas(16) shared::RayHit ray{};
    ray.origin = stretch.origin;
    ray.direction = direction;
    ray.tnear = t;
    ray.mask = ~0u;
    for (;;) {
        ray.tfar = stretch.t_end;
        ray.geom = ray.inst = NONE;
        intersect(borders_, ray, nullptr);
        depth += scene_->absorption(medium, hero) * (ray.tfar - t);
        if (ray.inst == NONE) return {glm::exp(-depth), medium};
        medium = scene_->medium_behind(ray.inst, ray.prim, {ray.u, ray.v}, direction);
        step = ray.tfar > t ? 4 : 2 * step; // rounding may find the same border again
        t = std::max(t, ray.tfar);
        ray.tnear = std::bit_cast<float>(std::bit_cast<std::uint32_t>(t) + step);
    }
}

void EmbreeScene::occluded(shared::ShadowRay& shadow, std::vector<Undecided>* undecided) const {
    if (!can_be_asked(shadow.origin, shadow.direction, shadow.tnear, shadow.tfar, reach_)) {
        shadow.tfar = -INFINITY; // an invalid ray carries no light
        return;
    }
    QueryContext context;
    init_context(context.embree);
    context.borders = false;
    context.shadow = true;
    context.undecided = undecided;
    context.origin = shadow.origin;
    context.direction = shadow.direction;
#if RESTAGE_EMBREE_MAJOR == 3
    rtcOccluded1(surfaces_.scene, &context.embree, reinterpret_cast<RTCRay*>(&shadow));
#else
    RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.context = &context.embree;
    rtcOccluded1(surfaces_.scene, reinterpret_cast<RTCRay*>(&shadow), &args);
#endif
}

} // namespace restage::render
