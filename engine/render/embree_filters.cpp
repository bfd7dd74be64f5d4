// SPDX-License-Identifier: Apache-2.0
// What Embree asks while it traverses: whether a ray passes a candidate hit, and where it meets a quadric.
#include "render/embree_api.hpp"

#include <limits>
#include <optional>

namespace restage::render {
namespace {

// Whether the hit is deferred: then the ray continues.
bool put_aside(const GpuScene& scene, const EmbreeQuery& query, const EmbreeScene::Undecided& hit) {
    if (!query.undecided || !scene.undecided(hit.instance)) return false;
    if (!(query.shadow && (scene.instances()[hit.instance].flags & INSTANCE_PASSES))) query.undecided->push_back(hit);
    return true;
}

// The decision of hit_filter on this hit of a world-space ray.
bool passes_filter(const GpuScene& scene, const EmbreeQuery& query, unsigned instance,
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
std::optional<GpuScene::QuadricHit> meet(const void* user, const void* context, glm::vec2 range) {
    const auto& scene = **static_cast<const GpuScene* const*>(user);
    const auto& query = *static_cast<const EmbreeQuery*>(context);
    const std::uint32_t instance = query.instance();
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
    const auto hit = meet(args->geometryUserPtr, args->context, {ray.ray.tnear, ray.ray.tfar});
    if (!hit) return;
    ray.ray.tfar = hit->t;
    ray.hit.u = hit->uv.x;
    ray.hit.v = hit->uv.y;
    ray.hit.primID = 0;
    ray.hit.geomID = 0;
    ray.hit.instID[0] = args->context->instID[0];
}
void box_occluded(const RTCOccludedFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
    if (meet(args->geometryUserPtr, args->context, {ray.tnear, ray.tfar}))
        ray.tfar = -std::numeric_limits<float>::infinity();
}
void box_bounds(const RTCBoundsFunctionArguments* args) { *args->bounds_o = {-1, -1, -1, 0, 1, 1, 1, 0}; }

} // namespace

void embree_hit_filter(const RTCFilterFunctionNArguments* args) {
    const auto* scene = *static_cast<const GpuScene* const*>(args->geometryUserPtr);
    const auto& query = *reinterpret_cast<const EmbreeQuery*>(args->context);
    const bool borders = query.borders;
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        const unsigned n = args->N;
        const unsigned instance = query.instance(), prim = RTCHitN_primID(args->hit, n, i);
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

void set_embree_box(RTCGeometry geometry) {
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryBoundsFunction(geometry, box_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, box_intersect);
    rtcSetGeometryOccludedFunction(geometry, box_occluded);
}

} // namespace restage::render
