// SPDX-License-Identifier: Apache-2.0
#include "render/photon_map.hpp"

#include "render/cdf_table.hpp"
#include "scene/bounds.hpp"
#include "shared/lamps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

namespace restage::render {
namespace {

constexpr double alpha = 2.0 / 3;       // of the squared radius that a map leaves: Knaus and Zwicker 2011, sec. 5
constexpr std::size_t neighbours = 5;   // photons within the first radius, at the median photon
constexpr std::size_t probes = 256;     // photons whose neighbours are looked for
constexpr double small = 0.1; // solid angle [sr] of a light, seen from casters, below which paths rarely find it

struct Box {
    glm::dvec3 lower{1e300}, upper{-1e300};
    void add(const Box& b) { lower = glm::min(lower, b.lower), upper = glm::max(upper, b.upper); }
    glm::dvec3 center() const { return 0.5 * (lower + upper); }
    double radius() const { return 0.5 * glm::length(upper - lower); }
    double distance(const glm::dvec3& p) const { return glm::length(glm::max(glm::max(lower - p, p - upper), 0.0)); }
    bool empty() const { return lower.x > upper.x; }
};

// In the kernels' world space.
Box world_box(const GpuScene& scene, std::uint32_t i) {
    const auto mesh = scene.mesh_of(i);
    const scene::MeshData* data = scene.mesh_data(mesh);
    const bool quadric = scene.is_quadric(i);
    if (!quadric && !data) return {};
    const glm::vec3 lower = quadric ? glm::vec3(-1) : data->lower, upper = quadric ? glm::vec3(1) : data->upper;
    const glm::mat4x3 m = scene.placement(i);
    Box box;
    for (int k = 0; k < 8; ++k) {
        const glm::dvec3 p(
            m * glm::vec4(k & 1 ? upper.x : lower.x, k & 2 ? upper.y : lower.y, k & 4 ? upper.z : lower.z, 1));
        box.add({p, p});
    }
    return box;
}

// At most `most` spheres around all boxes: halved at the middle of the longest axis of their centers.
void spheres_around(std::span<Box> boxes, std::size_t most, std::vector<shared::CasterSphere>& out) {
    Box all, centers;
    for (const Box& b : boxes)
        all.add(b), centers.add({b.center(), b.center()});
    const glm::dvec3 size = centers.upper - centers.lower;
    if (most < 2 || boxes.size() < 2 || !(glm::length(size) > 0)) {
        out.push_back({glm::vec3(all.center()), float(all.radius() * (1 + 1e-5))});
        return;
    }
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t half = boxes.size() / 2;
    std::ranges::nth_element(boxes, boxes.begin() + std::ptrdiff_t(half), {},
                             [axis](const Box& b) { return b.center()[axis]; });
    spheres_around(boxes.first(half), most / 2, out);
    spheres_around(boxes.subspan(half), most - most / 2, out);
}

double solid_angle(double radius, double distance) { // of a sphere, roughly
    return distance > radius ? std::numbers::pi * radius * radius / (distance * distance) : 4 * std::numbers::pi;
}

// Of a light's value, as records store it; roughly.
double brightness(const glm::vec3& c, bool spectral) {
    return spectral ? double(c.z) : 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

// The number that chooses the wavelengths of a map: of any 4^n maps in a row the sets of four wavelengths are evenly
// spread, and so is the one of the four that is left after dispersion. Points of the (0, 2)-sequence of Sobol 1967, by
// Kollig and Keller 2002.
float hero_of(std::uint32_t map, std::uint32_t seed) {
    std::uint32_t set = 0, first = 0;
    for (std::uint32_t i = map, a = 1u << 31, b = 1u << 31; i; i >>= 1, a >>= 1, b ^= b >> 1)
        if (i & 1) set ^= a, first ^= b;
    set += shared::pcg_hash(seed ^ 0x51ed270bu);
    return 0.25f * (float(first >> 30) + float(set >> 8) * 0x1p-24f);
}

template <class T>
Result<void> fill(gpu::Device& device, gpu::Buffer& buffer, std::span<const T> values, const char* name) {
    const std::size_t bytes = std::max<std::size_t>(values.size_bytes(), 16);
    if (!buffer || buffer.size() < bytes) {
        RESTAGE_TRY(buffer, device.create_buffer(bytes + bytes / 2, gpu::BufferKind::host, name));
    }
    return values.empty() ? Result<void>{} : device.upload(buffer, 0, std::as_bytes(values));
}

} // namespace

std::uint32_t CausticPhotons::samples_per_map(std::uint32_t pixels) {
    return std::clamp(paths_per_map(pixels) / std::max(2 * pixels, 1u), 1u, 16u);
}

std::uint32_t CausticPhotons::paths_per_map(std::uint32_t pixels) {
    const std::uint32_t enough = std::max(65536u, std::min(pixels / 4, 16 * WAVE_PATHS));
    return std::clamp(2 * pixels, 4096u, enough) / 64 * 64;
}

Result<void> CausticPhotons::start(const GpuScene& scene, std::vector<char> casters, bool all) {
    started_ = true;
    whole_ = false;
    first_radius_ = 0;
    photons_.clear();
    sources_.clear();
    casters_.clear();
    head_ = {};
    head_.hero = -1;
    Box world;
    std::vector<Box> boxes;
    const auto n = std::uint32_t(scene.instances().size());
    for (std::uint32_t i = 0; i < n; ++i) {
        if (!scene.traced(i)) continue;
        const Box box = world_box(scene, i);
        if (box.empty()) continue;
        world.add(box);
        if (casters[i]) boxes.push_back(box);
    }
    std::vector<std::uint32_t> roles(n);
    if (!boxes.empty()) {
        spheres_around(boxes, CASTERS_MOST, casters_);
        // The largest solid angle of an emitter from a caster.
        find_sources(scene, [&](const shared::LightNode& node) {
            if (all) return true;
            double most = 0;
            for (const Box& b : boxes)
                most = std::max(most, solid_angle(node.radius, b.distance(node.center)));
            return most < small;
        });
        if (all || scene.sunny()) add_environment(scene);
    }
    if (active()) {
        for (std::uint32_t i = 0; i < n; ++i)
            if (casters[i]) roles[i] |= ROLE_CASTER;
        for (const auto& source : sources_) {
            const shared::LightData& light = scene.lights()[source.light];
            if ((light.kind & 255u) == LIGHT_ENVIRONMENT) head_.environment = ROLE_LIGHT;
        }
        std::vector<char> from(scene.lights().size());
        for (const auto& source : sources_)
            from[source.light] = 1;
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t base = scene.instances()[i].light_base;
            if (base != NONE && (scene.instances()[i].flags & INSTANCE_EMITS) && from[base]) roles[i] |= ROLE_LIGHT;
        }
    }
    std::vector<double> weights;
    for (const auto& source : sources_)
        weights.push_back(double(source.pmf));
    const auto cdf = make_cdf(weights);
    for (std::size_t k = 0; k < cdf.size(); ++k)
        sources_[k].pmf = float(cdf_probability(cdf, k));
    RESTAGE_CHECK(fill<std::uint32_t>(device_, roles_, roles, "roles in caustics"));
    RESTAGE_CHECK(fill<shared::PhotonSource>(device_, source_buffer_, sources_, "sources of photons"));
    RESTAGE_CHECK(fill<shared::CdfEntry>(device_, cdf_, cdf, "distribution of photons"));
    RESTAGE_CHECK(fill<shared::CasterSphere>(device_, caster_buffer_, casters_, "casters of caustics"));
    if (active() && !deposits_) {
        RESTAGE_TRY(deposits_, device_.create_buffer(2 * WAVE_PATHS * sizeof(shared::Photon), gpu::BufferKind::readback,
                                                     "photons of a wave"));
    }
    is_caster_ = std::move(casters);
    head_.center = glm::vec3(world.empty() ? glm::dvec3(0) : world.center());
    head_.scene_radius = world.empty() ? 1.f : float(world.radius() * 1.001);
    head_.source_count = std::uint32_t(sources_.size());
    head_.caster_count = std::uint32_t(casters_.size());
    return upload(head_);
}

double CausticPhotons::caster_area() const {
    double sum = 0; // of the spheres' disks
    for (const auto& c : casters_)
        sum += std::numbers::pi * double(c.radius) * c.radius;
    return sum;
}

void CausticPhotons::add_source(std::uint32_t light, double power) {
    if (power > 0 && std::isfinite(power)) sources_.push_back({light, float(std::min(power, 1e30))});
}

void CausticPhotons::add_environment(const GpuScene& scene) {
    for (std::uint32_t i = 0; i < scene.lights().size(); ++i)
        if ((scene.lights()[i].kind & 255u) == LIGHT_ENVIRONMENT)
            add_source(i, double(scene.light_nodes()[scene.lights()[i].node].intensity) * caster_area());
}

// Lights by what they send towards the casters, roughly.
void CausticPhotons::find_sources(const GpuScene& scene, const std::function<bool(const shared::LightNode&)>& pays) {
    const auto& lights = scene.lights();
    const double shadow = caster_area();
    const auto casters_seen = [&](const glm::vec3& p) {
        double sum = 0;
        for (const auto& c : casters_)
            sum += solid_angle(c.radius, glm::distance(c.center, p));
        return std::min(sum, 4 * std::numbers::pi);
    };
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
        const shared::LightData& light = lights[i];
        const std::uint32_t kind = light.kind & 255u;
        const shared::LightNode& node = scene.light_nodes()[light.node];
        double power = 0;
        if (kind == LIGHT_ENVIRONMENT) continue;
        if (kind >= LIGHT_LAMP && shared::lamp_is_parallel(kind - LIGHT_LAMP)) {
            power = brightness(light.value, scene.features().spectral) * shadow;
        } else if (kind >= LIGHT_LAMP) {
            power = brightness(light.value, scene.features().spectral) * casters_seen(light.a);
        } else if (!(light.kind & LIGHT_PAIR_END) && pays(node)) {
            const glm::vec3 center = kind == LIGHT_QUADRIC ? node.center : light.a + (light.b + light.c) / 3.f;
            const double area =
                kind == LIGHT_QUADRIC ? double(node.radius) * node.radius * 4 * std::numbers::pi : double(light.area);
            power = brightness(light.value, scene.features().spectral) * area * casters_seen(center);
        }
        add_source(i, power);
    }
}

void CausticPhotons::begin(std::uint32_t map, std::uint32_t seed, std::uint32_t paths) {
    if (seed != seed_) first_radius_ = 0;
    map_ = map;
    seed_ = seed;
    whole_ = false;
    photons_.clear();
    head_.per_photon = 1.f / float(paths);
    head_.seed = shared::pcg_hash(map ^ shared::pcg_hash(seed ^ 0x6c8e9cf5u));
    head_.hero = hero_of(map, seed);
}

Result<void> CausticPhotons::next_wave(std::uint32_t first_path) {
    shared::PhotonMap head = head_;
    head.first_path = first_path;
    return upload(head);
}

void CausticPhotons::collect(std::span<const std::uint32_t> paths) {
    const auto deposits = deposits_.span<shared::Photon>();
    for (const std::uint32_t i : paths)
        if (deposits[i].power.x >= 0) photons_.push_back(deposits[i]);
}

// The radius of map 0, by the distances between its photons: where most of them are there are many, and little blur is
// needed.
float CausticPhotons::nearby() const {
    if (photons_.size() <= neighbours) return 0.01f * head_.scene_radius;
    std::vector<float> distances(std::min(probes, photons_.size()));
    jobs_.parallel_for(distances.size(), 8, [&](std::size_t begin, std::size_t end, unsigned) {
        std::vector<float> all(photons_.size());
        for (std::size_t k = begin; k < end; ++k) {
            const glm::vec3 p = photons_[k * photons_.size() / distances.size()].p;
            std::ranges::transform(photons_, all.begin(), [&](const auto& q) {
                const glm::vec3 d = q.p - p;
                return glm::dot(d, d);
            });
            std::ranges::nth_element(all, all.begin() + neighbours);
            distances[k] = std::sqrt(all[neighbours]);
        }
    });
    std::ranges::nth_element(distances, distances.begin() + std::ptrdiff_t(distances.size() / 2));
    return std::clamp(distances[distances.size() / 2], 1e-6f * head_.scene_radius, 0.05f * head_.scene_radius);
}

float CausticPhotons::radius_of(std::uint32_t map) const {
    double square = double(first_radius_) * first_radius_;
    for (std::uint32_t m = 1; m <= map; ++m)
        square *= (m + alpha) / (m + 1.0);
    return float(std::sqrt(square));
}

Result<void> CausticPhotons::finish(const GpuScene& scene, const EmbreeScene& embree) {
    if (map_ == 0 && !(first_radius_ > 0)) first_radius_ = nearby();
    shared::PhotonMap head = head_;
    head.radius = radius_of(map_);
    const auto images = PhotonBorders{scene, embree, is_caster_}.images(photons_, head.radius, jobs_);
    photons_.insert(photons_.end(), images.begin(), images.end());
    head.count = std::uint32_t(photons_.size());
    // By cells of two radii: a counting sort by the hash of the cell.
    const std::uint32_t buckets = std::bit_ceil(std::max(head.count, 64u));
    head.cell_mask = buckets - 1;
    const float per_cell = 0.5f / head.radius;
    std::vector<std::uint32_t> bucket(photons_.size()), first(buckets + 1);
    for (std::size_t i = 0; i < photons_.size(); ++i) {
        const glm::vec3 cell = glm::floor(photons_[i].p * per_cell);
        bucket[i] = shared::photon_cell_hash(int(cell.x), int(cell.y), int(cell.z)) & head.cell_mask;
        ++first[bucket[i] + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<shared::Photon> sorted(photons_.size());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < photons_.size(); ++i)
        sorted[next[bucket[i]]++] = photons_[i];
    RESTAGE_CHECK(fill<shared::Photon>(device_, photon_buffer_, sorted, "photons"));
    RESTAGE_CHECK(fill<std::uint32_t>(device_, cells_, first, "cells of photons"));
    whole_ = true;
    return upload(head);
}

Result<void> CausticPhotons::upload(shared::PhotonMap head) {
    head.photons = photon_buffer_.address();
    head.cells = cells_.address();
    head.roles = roles_.address();
    head.deposits = deposits_.address();
    head.sources = source_buffer_.address();
    head.source_cdf = cdf_.address();
    head.casters = caster_buffer_.address();
    return fill<shared::PhotonMap>(device_, record_, std::span(&head, 1), "photon map");
}

} // namespace restage::render
