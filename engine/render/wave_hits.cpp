// SPDX-License-Identifier: Apache-2.0
#include "render/wave_hits.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

namespace restage::render {
namespace {

constexpr std::size_t ahead = 16; // paths prefetched: kernels left them in another cache
constexpr std::uint8_t type_none = WaveMemory::type_none;

// Calls trace(std::span<const std::uint32_t>) for those of `active` that have a ray, some at a time. Returns their
// number.
template <class Prefetch, class HasRay, class Trace>
std::uint32_t in_batches(std::span<const std::uint32_t> active, Prefetch&& prefetch, HasRay&& has_ray, Trace&& trace) {
    std::array<std::uint32_t, 16> batch;
    std::size_t size = 0;
    std::uint32_t traced = 0;
    for (std::size_t a = 0; a < active.size(); ++a) {
        if (a + ahead < active.size()) prefetch(active[a + ahead]);
        if (has_ray(active[a])) batch[size++] = active[a];
        if (size < batch.size() && a + 1 < active.size()) continue;
        trace(std::span<const std::uint32_t>(batch.data(), size));
        traced += std::uint32_t(std::exchange(size, 0));
    }
    return traced;
}

} // namespace

struct WaveHits::View {
    const GpuScene& scene;
    const EmbreeScene& embree;
    bool last_vertex;

    // A path's last vertex contributes only emission or denoiser guides; but lamps without surface are no vertices.
    bool ends(const shared::PathState& path, std::uint32_t instance) const {
        const std::uint32_t depth = path.flags & PATH_DEPTH_MASK;
        return depth > 0 && depth >= scene.data().max_depth && !(path.flags & PATH_GUIDED) &&
               !(scene.instances()[instance].flags & INSTANCE_PASSES);
    }
};

WaveHits::Traced WaveHits::trace(const GpuScene& scene, const EmbreeScene& embree,
                                 std::span<const std::uint32_t> active, bool last_vertex) {
    const View view{scene, embree, last_vertex};
    const std::size_t chunks = (active.size() + chunk - 1) / chunk;
    counts_.assign(chunks, {});
    undecided_.resize(scene.any_undecided() ? chunks : 0);
    for (Undecided& u : undecided_) {
        u.hits.clear();
        u.open.clear();
    }
    std::atomic<std::uint64_t> rays = 0, shadow_rays = 0;
    jobs_.parallel_for(chunks, 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t k = begin; k < end; ++k) {
            const auto paths = active.subspan(k * chunk, std::min(chunk, active.size() - k * chunk));
            Undecided* undecided = undecided_.empty() ? nullptr : &undecided_[k];
            shadow_rays += trace_shadows(view, paths, undecided);
            rays += trace_closest(view, paths, counts_[k], undecided);
        }
    });
    return {rays, shadow_rays};
}

// nullptr in RGB mode.
shared::FourthData* WaveHits::fourth_of(const View& view, std::uint32_t path) {
    return view.scene.features().spectral ? &wave_.fourths()[path] : nullptr;
}

// Light that arrives along an unoccluded shadow ray.
void WaveHits::add_light(const View& view, std::uint32_t path, float distance) {
    const shared::ShadowRay& shadow = wave_.shadows()[path];
    shared::FourthData* fourth = fourth_of(view, path);
    glm::vec4 c(shadow.contribution, fourth ? fourth->contribution : 0.f);
    if (view.scene.features().borders) {
        const EmbreeScene::Stretch way{shadow.origin, shadow.direction, 0, distance};
        c *= view.embree.pass_borders(way, shadow.medium, fourth ? fourth->hero : 0.f).transmittance;
    }
    wave_.paths()[path].radiance += glm::vec3(c);
    if (fourth) fourth->radiance += c.w;
}

// Adds the unoccluded shadow-ray contributions of these paths. Returns the number of rays.
std::uint32_t WaveHits::trace_shadows(const View& view, std::span<const std::uint32_t> active, Undecided* undecided) {
    const auto shadows = wave_.shadows();
    const auto paths = wave_.paths();
    const auto prefetch = [&](std::uint32_t i) {
        __builtin_prefetch(&shadows[i]);
        __builtin_prefetch(&paths[i]);
    };
    const auto has_ray = [&](std::uint32_t i) { return shadows[i].tfar > 0; };
    return in_batches(active, prefetch, has_ray, [&](std::span<const std::uint32_t> batch) {
        if (undecided) {
            for (const std::uint32_t i : batch)
                occluded_undecided(view, i, *undecided);
            return;
        }
        view.embree.occluded(shadows, batch);
        for (const std::uint32_t i : batch) {
            const float distance = std::exchange(shadows[i].tfar, -1.f);
            if (distance > 0) add_light(view, i, distance);
        }
    });
}

// Adds the light unless something blocks it, or what might is undecided.
void WaveHits::occluded_undecided(const View& view, std::uint32_t i, Undecided& undecided) {
    shared::ShadowRay& shadow = wave_.shadows()[i];
    const float distance = shadow.tfar;
    const std::size_t first = undecided.hits.size();
    view.embree.occluded(shadow, &undecided.hits);
    const bool is_free = shadow.tfar > 0;
    shadow.tfar = -1;
    if (!is_free) undecided.hits.resize(first);
    if (undecided.hits.size() > first)
        undecided.open.push_back({i, true, distance, first, undecided.hits.size() - first});
    else if (is_free)
        add_light(view, i, distance);
}

// The type that shades this hit or miss. `material`: of a hit, if already known.
std::uint8_t WaveHits::shader_of(const View& view, std::uint32_t i, std::optional<std::uint32_t> material) {
    const GpuScene& scene = view.scene;
    shared::RayHit& ray = wave_.rays()[i];
    shared::PathState& path = wave_.paths()[i];
    if (scene.features().borders) {
        shared::FourthData* fourth = fourth_of(view, i);
        const auto passed = view.embree.pass_borders({ray.origin, ray.direction, ray.tnear, ray.tfar}, path.medium,
                                                     fourth ? fourth->hero : 0.f);
        path.throughput *= glm::vec3(passed.transmittance);
        if (fourth) fourth->throughput *= passed.transmittance.w;
        path.medium = passed.medium;
    }
    emits_[i] = ray.inst != NONE && (scene.instances()[ray.inst].flags & INSTANCE_EMITS);
    if (ray.inst == NONE) return scene.features().environment ? WaveMemory::type_escape : type_none;
    const bool shades = !view.last_vertex || !view.ends(path, ray.inst);
    if (!shades && !emits_[i]) return type_none;
    ray.geom = material ? *material : scene.resolve_material(ray.inst, ray.prim, {ray.u, ray.v});
    if (ray.geom == MATERIAL_NOTHING) ray.geom = 0; // the filter accepted it: unreachable
    return shades ? std::uint8_t(scene.materials()[ray.geom].type) : type_none;
}

void WaveHits::note_caster(const View& view, std::uint32_t i) {
    const std::uint32_t flags = wave_.paths()[i].flags, inst = wave_.rays()[i].inst;
    if ((flags & PATH_DEPTH_MASK) > 0 && (flags & PATH_SPECULAR) && inst != NONE &&
        !(view.scene.instances()[inst].flags & INSTANCE_PASSES))
        std::atomic_ref(casters_[inst]).store(1, std::memory_order_relaxed);
}

// Next hits of these paths: types_ holds each one's type, `count` the number per type.
std::uint32_t WaveHits::trace_closest(const View& view, std::span<const std::uint32_t> active, TypeCounts& count,
                                      Undecided* undecided) {
    const auto rays = wave_.rays();
    const auto prefetch = [&](std::uint32_t i) {
        __builtin_prefetch(&rays[i]);
        __builtin_prefetch(&rays[i].u);
    };
    const auto has_ray = [&](std::uint32_t i) {
        shared::RayHit& ray = rays[i];
        emits_[i] = 0;
        if (!(ray.tfar > 0)) {
            types_[i] = type_none;
            ++count[type_none];
            return false;
        }
        if (!casters_.empty()) note_caster(view, i);
        ray.geom = ray.inst = NONE;
        return true;
    };
    return in_batches(active, prefetch, has_ray, [&](std::span<const std::uint32_t> batch) {
        if (!undecided) view.embree.intersect(rays, batch);
        for (const std::uint32_t i : batch)
            if (!undecided || !intersect_undecided(view, i, *undecided)) give_type(view, i, count);
    });
}

void WaveHits::give_type(const View& view, std::uint32_t i, TypeCounts& count, std::optional<std::uint32_t> material) {
    types_[i] = shader_of(view, i, material);
    ++count[types_[i]];
    count[WaveMemory::type_emit] += emits_[i];
}

// Finds the nearest hit, and undecided ones in front of it. Returns whether there are any.
bool WaveHits::intersect_undecided(const View& view, std::uint32_t i, Undecided& undecided) {
    shared::RayHit& ray = wave_.rays()[i];
    auto& hits = undecided.hits;
    const std::size_t first = hits.size();
    view.embree.intersect(ray, &hits);
    if (ray.inst != NONE) // those behind it are irrelevant
        hits.erase(std::remove_if(hits.begin() + std::ptrdiff_t(first), hits.end(),
                                  [&](const auto& hit) { return hit.t >= ray.tfar; }),
                   hits.end());
    if (ray.inst != NONE && view.scene.undecided(ray.inst)) // a mix without gaps: nothing filters its mesh
        hits.push_back({ray.tfar, ray.inst, ray.prim, {ray.u, ray.v}, ray.prim});
    if (hits.size() == first) return false;
    std::sort(hits.begin() + std::ptrdiff_t(first), hits.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
    undecided.open.push_back({.path = i, .first = first, .count = hits.size() - first});
    return true;
}

std::vector<shared::HitAsked> WaveHits::asked() const {
    std::vector<shared::HitAsked> all;
    for (const Undecided& u : undecided_)
        for (const auto& hit : u.hits)
            all.push_back({hit.instance, hit.prim, hit.bary});
    return all;
}

void WaveHits::settle(const GpuScene& scene, const EmbreeScene& embree, std::span<const shared::HitDecided> decided,
                      bool last_vertex) {
    const View view{scene, embree, last_vertex};
    std::vector<std::size_t> begins(undecided_.size());
    for (std::size_t k = 1; k < begins.size(); ++k)
        begins[k] = begins[k - 1] + undecided_[k - 1].hits.size();
    jobs_.parallel_for(undecided_.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t k = begin; k < end; ++k)
            settle(view, undecided_[k], decided.data() + begins[k], counts_[k]);
    });
}

void WaveHits::settle(const View& view, const Undecided& undecided, const shared::HitDecided* decided,
                      TypeCounts& count) {
    const auto rays = wave_.rays();
    const auto shadows = wave_.shadows();
    for (const Open& open : undecided.open) {
        shared::RayHit& ray = rays[open.path];
        const shared::ShadowRay& shadow = shadows[open.path];
        const glm::vec3 origin = open.shadow ? shadow.origin : ray.origin;
        const glm::vec3 direction = open.shadow ? shadow.direction : ray.direction;
        std::size_t h = open.first;
        const std::size_t end = open.first + open.count;
        while (h < end &&
               !view.scene.stops(undecided.hits[h].instance, undecided.hits[h].choice, decided[h], origin, direction))
            ++h;
        if (open.shadow) {
            if (h == end) add_light(view, open.path, open.distance);
            continue;
        }
        std::optional<std::uint32_t> material;
        if (h < end) {
            const auto& hit = undecided.hits[h];
            ray.tfar = hit.t, ray.inst = hit.instance, ray.prim = hit.prim;
            ray.u = hit.bary.x, ray.v = hit.bary.y;
            material = decided[h].material;
        }
        give_type(view, open.path, count, material);
    }
}

} // namespace restage::render
