// SPDX-License-Identifier: Apache-2.0
// Queries of EmbreeScene.
#include "render/embree_api.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace restage::render {

static_assert(sizeof(shared::RayHit) == sizeof(RTCRayHit));
static_assert(offsetof(shared::RayHit, tfar) == offsetof(RTCRayHit, ray.tfar));
static_assert(offsetof(shared::RayHit, u) == offsetof(RTCRayHit, hit.u));
static_assert(offsetof(shared::RayHit, geom) == offsetof(RTCRayHit, hit.geomID));
static_assert(offsetof(shared::RayHit, inst) == offsetof(RTCRayHit, hit.instID));
static_assert(offsetof(shared::ShadowRay, contribution) == sizeof(RTCRay));
static_assert(sizeof(shared::ShadowRay) == 64);

namespace {

// It also asserts: no NaN, and an interval that starts at 0 or later. Whatever kernels computed from a scene of
// absurd sizes counts as a miss instead.
bool can_be_asked(const glm::vec3& origin, const glm::vec3& direction, float near, float far, float reach) {
    // Sums of non-negative values, which NaN also spoils; branch-free, as this runs for every ray.
    const float far_out = std::abs(origin.x) + std::abs(origin.y) + std::abs(origin.z);
    const float steep = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
    return (near >= 0) & (near <= far) & (far_out <= reach) & (steep <= 1e3f);
}

// Packets. Embree is told nothing of coherence: then it traverses for one ray after the other, so that among hits at
// one distance the choice does not depend on the other rays.
template <int size>
struct Packet;
#if RESTAGE_EMBREE_MAJOR == 3
#define RESTAGE_ASK(query, scene, context, rays) \
    EmbreeQuery context;                         \
    query(valid, scene, &(context).embree, rays)
#else
#define RESTAGE_ASK(query, scene, context, rays) query(valid, scene, rays, nullptr)
#endif
template <>
struct Packet<8> {
    using Hits = RTCRayHit8;
    using Rays = RTCRay8;
    static void intersect(const int* valid, RTCScene scene, Hits& hits) {
        RESTAGE_ASK(rtcIntersect8, scene, context, &hits);
    }
    static void occluded(const int* valid, RTCScene scene, Rays& rays) {
        RESTAGE_ASK(rtcOccluded8, scene, context, &rays);
    }
};
template <>
struct Packet<16> {
    using Hits = RTCRayHit16;
    using Rays = RTCRay16;
    static void intersect(const int* valid, RTCScene scene, Hits& hits) {
        RESTAGE_ASK(rtcIntersect16, scene, context, &hits);
    }
    static void occluded(const int* valid, RTCScene scene, Rays& rays) {
        RESTAGE_ASK(rtcOccluded16, scene, context, &rays);
    }
};
#undef RESTAGE_ASK

template <class Rays, class Ray>
void put(Rays& rays, std::size_t k, const Ray& ray) {
    rays.org_x[k] = ray.origin.x, rays.org_y[k] = ray.origin.y, rays.org_z[k] = ray.origin.z;
    rays.dir_x[k] = ray.direction.x, rays.dir_y[k] = ray.direction.y, rays.dir_z[k] = ray.direction.z;
    rays.tnear[k] = ray.tnear, rays.tfar[k] = ray.tfar;
    rays.time[k] = 0, rays.mask[k] = ray.mask, rays.id[k] = 0, rays.flags[k] = 0;
}

} // namespace

void EmbreeScene::intersect(RTCSceneTy* scene, bool borders, shared::RayHit& ray,
                            std::vector<Undecided>* undecided) const {
    if (!can_be_asked(ray.origin, ray.direction, ray.tnear, ray.tfar, reach_)) return;
    EmbreeQuery context;
    context.borders = borders;
    context.undecided = undecided;
    context.origin = ray.origin;
    context.direction = ray.direction;
#if RESTAGE_EMBREE_MAJOR == 3
    rtcIntersect1(scene, &context.embree, reinterpret_cast<RTCRayHit*>(&ray));
#else
    RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.context = &context.embree;
    rtcIntersect1(scene, reinterpret_cast<RTCRayHit*>(&ray), &args);
#endif
}

void EmbreeScene::intersect(shared::RayHit& ray, std::vector<Undecided>* undecided) const {
    intersect(surfaces(), false, ray, undecided);
    if (flat_) ray.inst = ray.geom;
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
        intersect(borders_.scene, true, ray, nullptr);
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
    EmbreeQuery context;
    context.shadow = true;
    context.undecided = undecided;
    context.origin = shadow.origin;
    context.direction = shadow.direction;
#if RESTAGE_EMBREE_MAJOR == 3
    rtcOccluded1(surfaces(), &context.embree, reinterpret_cast<RTCRay*>(&shadow));
#else
    RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.context = &context.embree;
    rtcOccluded1(surfaces(), reinterpret_cast<RTCRay*>(&shadow), &args);
#endif
}

template <int size>
void EmbreeScene::intersect_packets(std::span<shared::RayHit> rays, std::span<const std::uint32_t> which) const {
    alignas(64) typename Packet<size>::Hits packet;
    alignas(64) int valid[size];
    for (; !which.empty(); which = which.subspan(std::min<std::size_t>(size, which.size()))) {
        const std::size_t n = std::min<std::size_t>(size, which.size());
        for (std::size_t k = 0; k < size; ++k) {
            const shared::RayHit& ray = rays[which[std::min(k, n - 1)]];
            valid[k] = k < n && can_be_asked(ray.origin, ray.direction, ray.tnear, ray.tfar, reach_) ? -1 : 0;
            put(packet.ray, k, ray);
            packet.hit.geomID[k] = packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        }
        Packet<size>::intersect(valid, surfaces(), packet);
        for (std::size_t k = 0; k < n; ++k) {
            shared::RayHit& ray = rays[which[k]];
            ray.geom = packet.hit.geomID[k];
            if (ray.geom == RTC_INVALID_GEOMETRY_ID) continue;
            ray.inst = flat_ ? ray.geom : packet.hit.instID[0][k];
            ray.tfar = packet.ray.tfar[k];
            ray.prim = packet.hit.primID[k];
            ray.u = packet.hit.u[k], ray.v = packet.hit.v[k];
        }
    }
}

template <int size>
void EmbreeScene::occluded_packets(std::span<shared::ShadowRay> rays, std::span<const std::uint32_t> which) const {
    alignas(64) typename Packet<size>::Rays packet;
    alignas(64) int valid[size];
    for (; !which.empty(); which = which.subspan(std::min<std::size_t>(size, which.size()))) {
        const std::size_t n = std::min<std::size_t>(size, which.size());
        for (std::size_t k = 0; k < size; ++k) {
            const shared::ShadowRay& ray = rays[which[std::min(k, n - 1)]];
            const bool asked = can_be_asked(ray.origin, ray.direction, ray.tnear, ray.tfar, reach_);
            valid[k] = k < n && asked ? -1 : 0;
            put(packet, k, ray);
            if (!asked) packet.tfar[k] = -INFINITY; // an invalid ray carries no light
        }
        Packet<size>::occluded(valid, surfaces(), packet);
        for (std::size_t k = 0; k < n; ++k)
            rays[which[k]].tfar = packet.tfar[k];
    }
}

// Not where meshes have instances: there, packets were seen to choose among hits at one distance by what other rays
// hit.
void EmbreeScene::intersect(std::span<shared::RayHit> rays, std::span<const std::uint32_t> which) const {
    if (flat_ && packet_size_ == 16) return intersect_packets<16>(rays, which);
    if (flat_ && packet_size_ == 8) return intersect_packets<8>(rays, which);
    for (const std::uint32_t i : which)
        intersect(rays[i]);
}

void EmbreeScene::occluded(std::span<shared::ShadowRay> rays, std::span<const std::uint32_t> which) const {
    if (simple_ && packet_size_ == 16) return occluded_packets<16>(rays, which);
    if (simple_ && packet_size_ == 8) return occluded_packets<8>(rays, which);
    for (const std::uint32_t i : which)
        occluded(rays[i]);
}

} // namespace restage::render
