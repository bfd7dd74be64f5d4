// SPDX-License-Identifier: Apache-2.0
// Queries of EmbreeScene.
#include "render/embree_instances.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

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

void ask(const EmbreeInstances::Part& part, EmbreeQuery& query, shared::RayHit& ray) {
    query.names = part.names;
    ray.mask = part.mask;
#if RESTAGE_EMBREE_MAJOR == 3
    rtcIntersect1(part.scene, &query.embree, reinterpret_cast<RTCRayHit*>(&ray));
#else
    RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.context = &query.embree;
    rtcIntersect1(part.scene, reinterpret_cast<RTCRayHit*>(&ray), &args);
#endif
}

void ask(const EmbreeInstances::Part& part, EmbreeQuery& query, shared::ShadowRay& ray) {
    query.names = part.names;
    ray.mask = part.mask;
#if RESTAGE_EMBREE_MAJOR == 3
    rtcOccluded1(part.scene, &query.embree, reinterpret_cast<RTCRay*>(&ray));
#else
    RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.context = &query.embree;
    rtcOccluded1(part.scene, reinterpret_cast<RTCRay*>(&ray), &args);
#endif
}

// Packets. Embree is told nothing of coherence: then it traverses for one ray after the other, so that among hits at
// one distance the choice does not depend on the other rays.
template <int size>
struct Packet;
template <>
struct Packet<8> {
    using Hits = RTCRayHit8;
    using Rays = RTCRay8;
    static constexpr auto intersect = rtcIntersect8;
    static constexpr auto occluded = rtcOccluded8;
};
template <>
struct Packet<16> {
    using Hits = RTCRayHit16;
    using Rays = RTCRay16;
    static constexpr auto intersect = rtcIntersect16;
    static constexpr auto occluded = rtcOccluded16;
};

template <class Rays>
void ask(void (*query)(const int*, RTCScene, EmbreeQuery::Context*, Rays*), const int* valid, RTCScene scene,
         Rays& rays) {
    EmbreeQuery context;
    query(valid, scene, &context.embree, &rays);
}
template <class Rays, class Arguments> // Embree 4
void ask(void (*query)(const int*, RTCScene, Rays*, Arguments*), const int* valid, RTCScene scene, Rays& rays) {
    query(valid, scene, &rays, nullptr);
}

// The first of `which`, which are taken from it, as a packet. Those that cannot be asked are not valid.
template <int size, class Rays, class Ray>
std::span<const std::uint32_t> gather(Rays& packet, int (&valid)[size], std::span<Ray> rays,
                                      std::span<const std::uint32_t>& which, unsigned mask, float reach) {
    const auto taken = which.first(std::min<std::size_t>(size, which.size()));
    which = which.subspan(taken.size());
    for (std::size_t k = 0; k < size; ++k) {
        const Ray& ray = rays[taken[std::min(k, taken.size() - 1)]];
        const bool asked = can_be_asked(ray.origin, ray.direction, ray.tnear, ray.tfar, reach);
        valid[k] = k < taken.size() && asked ? -1 : 0;
        packet.org_x[k] = ray.origin.x, packet.org_y[k] = ray.origin.y, packet.org_z[k] = ray.origin.z;
        packet.dir_x[k] = ray.direction.x, packet.dir_y[k] = ray.direction.y, packet.dir_z[k] = ray.direction.z;
        packet.tnear[k] = ray.tnear, packet.tfar[k] = ray.tfar;
        packet.time[k] = 0, packet.mask[k] = mask, packet.id[k] = 0, packet.flags[k] = 0;
    }
    return taken;
}

} // namespace

void EmbreeScene::intersect_instances(const EmbreeInstances& instances, shared::RayHit& ray,
                                      std::vector<Undecided>* undecided) const {
    if (!can_be_asked(ray.origin, ray.direction, ray.tnear, ray.tfar, reach_)) return;
    EmbreeQuery query;
    query.borders = &instances == borders_.get();
    query.undecided = undecided;
    query.origin = ray.origin;
    query.direction = ray.direction;
    ask(flat_ && !query.borders ? EmbreeInstances::Part{flat_, ~0u, {}} : instances.all(), query, ray);
    if (!instances.apart()) return;
    const std::uint32_t found = std::exchange(ray.inst, NONE);
    const auto edited = instances.edited();
    ask(edited, query, ray);
    ray.inst = ray.inst == NONE ? found : edited.names[ray.inst];
}

void EmbreeScene::intersect(shared::RayHit& ray, std::vector<Undecided>* undecided) const {
    intersect_instances(*surfaces_, ray, undecided);
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
    for (;;) {
        ray.tfar = stretch.t_end;
        ray.geom = ray.inst = NONE;
        intersect_instances(*borders_, ray, nullptr);
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
    EmbreeQuery query;
    query.shadow = true;
    query.undecided = undecided;
    query.origin = shadow.origin;
    query.direction = shadow.direction;
    ask(flat_ ? EmbreeInstances::Part{flat_, ~0u, {}} : surfaces_->all(), query, shadow);
    if (surfaces_->apart() && shadow.tfar >= 0) ask(surfaces_->edited(), query, shadow);
}

template <int size>
void EmbreeScene::intersect_packets(std::span<shared::RayHit> rays, std::span<const std::uint32_t> which) const {
    alignas(64) typename Packet<size>::Hits packet;
    alignas(64) int valid[size];
    while (!which.empty()) {
        const auto taken = gather(packet.ray, valid, rays, which, ~0u, reach_);
        std::fill_n(packet.hit.geomID, size, RTC_INVALID_GEOMETRY_ID);
        ask(Packet<size>::intersect, valid, flat_, packet);
        for (std::size_t k = 0; k < taken.size(); ++k) {
            shared::RayHit& ray = rays[taken[k]];
            ray.geom = ray.inst = packet.hit.geomID[k];
            if (ray.geom == RTC_INVALID_GEOMETRY_ID) continue;
            ray.tfar = packet.ray.tfar[k];
            ray.prim = packet.hit.primID[k];
            ray.u = packet.hit.u[k], ray.v = packet.hit.v[k];
        }
    }
}

template <int size>
void EmbreeScene::occluded_packets(std::span<shared::ShadowRay> rays, std::span<const std::uint32_t> which) const {
    const auto all = flat_ ? EmbreeInstances::Part{flat_, ~0u, {}} : surfaces_->all();
    alignas(64) typename Packet<size>::Rays packet;
    alignas(64) int valid[size];
    while (!which.empty()) {
        const auto taken = gather(packet, valid, rays, which, all.mask, reach_);
        for (std::size_t k = 0; k < size; ++k)
            if (!valid[k]) packet.tfar[k] = -INFINITY; // an invalid ray carries no light
        ask(Packet<size>::occluded, valid, all.scene, packet);
        if (surfaces_->apart()) {
            const auto edited = surfaces_->edited();
            for (std::size_t k = 0; k < size; ++k) {
                if (!(packet.tfar[k] >= 0)) valid[k] = 0;
                packet.mask[k] = edited.mask;
            }
            ask(Packet<size>::occluded, valid, edited.scene, packet);
        }
        for (std::size_t k = 0; k < taken.size(); ++k)
            rays[taken[k]].tfar = packet.tfar[k];
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
    const bool simple = scene_ && scene_->plain_hits();
    if (simple && packet_size_ == 16) return occluded_packets<16>(rays, which);
    if (simple && packet_size_ == 8) return occluded_packets<8>(rays, which);
    for (const std::uint32_t i : which)
        occluded(rays[i]);
}

} // namespace restage::render
