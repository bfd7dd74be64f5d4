// SPDX-License-Identifier: Apache-2.0
#include "ray_recorder.hpp"

#include "embree_counts.hpp"

#if RESTAGE_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>
#include <mutex>

#if RESTAGE_EMBREE_MAJOR == 3
#define INTERSECT_ARGS(size) RTCScene scene, RTCIntersectContext *context, RTCRayHit##size *ray
#define OCCLUDED_ARGS(size) RTCScene scene, RTCIntersectContext *context, RTCRay##size *ray
#define FORWARD scene, context, ray
#else
#define INTERSECT_ARGS(size) RTCScene scene, RTCRayHit##size *ray, RTCIntersectArguments *args
#define OCCLUDED_ARGS(size) RTCScene scene, RTCRay##size *ray, RTCOccludedArguments *args
#define FORWARD scene, ray, args
#endif

// NOLINTBEGIN(bugprone-reserved-identifier): required by the linker's --wrap
extern "C" {
void __real_rtcIntersect1(INTERSECT_ARGS());
void __real_rtcOccluded1(OCCLUDED_ARGS());
void __wrap_rtcIntersect1(INTERSECT_ARGS());
void __wrap_rtcOccluded1(OCCLUDED_ARGS());
#define DECLARE_PACKETS(size)                                               \
    void __real_rtcIntersect##size(const int* valid, INTERSECT_ARGS(size)); \
    void __real_rtcOccluded##size(const int* valid, OCCLUDED_ARGS(size));   \
    void __wrap_rtcIntersect##size(const int* valid, INTERSECT_ARGS(size)); \
    void __wrap_rtcOccluded##size(const int* valid, OCCLUDED_ARGS(size));
DECLARE_PACKETS(8)
DECLARE_PACKETS(16)
#undef DECLARE_PACKETS
RTCScene __real_rtcNewScene(RTCDevice);
RTCScene __wrap_rtcNewScene(RTCDevice);
}
// NOLINTEND(bugprone-reserved-identifier)

namespace restage::bench {
namespace {

std::atomic<bool> recording = false;
std::atomic<std::uint64_t> scenes_made = 0;
RTCScene traced_scene = nullptr;
std::mutex mutex;
std::vector<std::unique_ptr<std::vector<RecordedRay>>> lists; // a thread each

std::vector<RecordedRay>& my_list() {
    thread_local std::vector<RecordedRay>* mine = nullptr;
    if (!mine) {
        const std::lock_guard lock(mutex);
        lists.push_back(std::make_unique<std::vector<RecordedRay>>());
        mine = lists.back().get();
    }
    return *mine;
}

void note(RTCScene scene, const RTCRay& r, bool shadow) {
    traced_scene = scene;
    my_list().push_back({{r.org_x, r.org_y, r.org_z}, r.tnear, {r.dir_x, r.dir_y, r.dir_z}, r.tfar, shadow});
}

template <int size, class Rays>
void note_packet(RTCScene scene, const int* valid, const Rays& r, bool shadow) {
    traced_scene = scene;
    for (int k = 0; k < size; ++k)
        if (valid[k])
            my_list().push_back({{r.org_x[k], r.org_y[k], r.org_z[k]},
                                 r.tnear[k],
                                 {r.dir_x[k], r.dir_y[k], r.dir_z[k]},
                                 r.tfar[k],
                                 shadow});
}

RTCRay embree_ray(const RecordedRay& r) {
    RTCRay ray{};
    ray.org_x = r.origin.x, ray.org_y = r.origin.y, ray.org_z = r.origin.z;
    ray.dir_x = r.direction.x, ray.dir_y = r.direction.y, ray.dir_z = r.direction.z;
    ray.tnear = r.tnear;
    ray.tfar = r.tfar;
    ray.mask = 0xffffffffu;
    return ray;
}

bool hits(RTCScene scene, const RecordedRay& recorded) {
#if RESTAGE_EMBREE_MAJOR == 3
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    const auto intersect = [&](RTCRayHit& r) { __real_rtcIntersect1(scene, &context, &r); };
    const auto occluded = [&](RTCRay& r) { __real_rtcOccluded1(scene, &context, &r); };
#else
    const auto intersect = [&](RTCRayHit& r) { __real_rtcIntersect1(scene, &r, nullptr); };
    const auto occluded = [&](RTCRay& r) { __real_rtcOccluded1(scene, &r, nullptr); };
#endif
    if (recorded.shadow) {
        RTCRay ray = embree_ray(recorded);
        occluded(ray);
        return ray.tfar == -std::numeric_limits<float>::infinity();
    }
    RTCRayHit ray{};
    ray.ray = embree_ray(recorded);
    ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersect(ray);
    return ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

} // namespace

std::uint64_t embree_scenes_made() { return scenes_made; }

void start_recording() { recording = true; }

std::vector<RecordedRay> stop_recording() {
    recording = false;
    std::vector<RecordedRay> all;
    for (auto& list : lists) {
        all.insert(all.end(), list->begin(), list->end());
        list->clear();
        list->shrink_to_fit();
    }
    return all;
}

std::uint64_t trace_plainly(const std::vector<RecordedRay>& rays, Jobs& jobs) {
    std::atomic<std::uint64_t> sum = 0;
    jobs.parallel_for(rays.size(), 4096, [&](std::size_t begin, std::size_t end, unsigned) {
        std::uint64_t n = 0;
        for (std::size_t i = begin; i < end; ++i)
            n += hits(traced_scene, rays[i]);
        sum += n;
    });
    return sum;
}

} // namespace restage::bench

// NOLINTBEGIN(bugprone-reserved-identifier): required by the linker's --wrap
extern "C" {
void __wrap_rtcIntersect1(INTERSECT_ARGS()) {
    if (restage::bench::recording.load(std::memory_order_relaxed)) restage::bench::note(scene, ray->ray, false);
    __real_rtcIntersect1(FORWARD);
}
void __wrap_rtcOccluded1(OCCLUDED_ARGS()) {
    if (restage::bench::recording.load(std::memory_order_relaxed)) restage::bench::note(scene, *ray, true);
    __real_rtcOccluded1(FORWARD);
}
#define WRAP_PACKETS(size)                                                    \
    void __wrap_rtcIntersect##size(const int* valid, INTERSECT_ARGS(size)) {  \
        if (restage::bench::recording.load(std::memory_order_relaxed))        \
            restage::bench::note_packet<size>(scene, valid, ray->ray, false); \
        __real_rtcIntersect##size(valid, FORWARD);                            \
    }                                                                         \
    void __wrap_rtcOccluded##size(const int* valid, OCCLUDED_ARGS(size)) {    \
        if (restage::bench::recording.load(std::memory_order_relaxed))        \
            restage::bench::note_packet<size>(scene, valid, *ray, true);      \
        __real_rtcOccluded##size(valid, FORWARD);                             \
    }
WRAP_PACKETS(8)
WRAP_PACKETS(16)
#undef WRAP_PACKETS
RTCScene __wrap_rtcNewScene(RTCDevice device) {
    ++restage::bench::scenes_made;
    return __real_rtcNewScene(device);
}
}
// NOLINTEND(bugprone-reserved-identifier)
