// SPDX-License-Identifier: Apache-2.0
#include "render/photon_map.hpp"

#include "render/cdf_table.hpp"
#include "render/point_grid.hpp"
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
constexpr std::size_t probes = 256;     // photons whose neighbours are looked for
constexpr std::size_t neighbours = 5;   // photons within the first radius, at the median photon
constexpr double most_gain = 16, least_needed = 1.0 / 16;
constexpr std::uint32_t maps_together = 8;
// From where photons pay (PhotonPilot::Findings). They take about a third more time for a sample. What paths never find
// is worth more than time.
constexpr double found_pays = 0.25, never_pays = 0.001;
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

// Photons of a map, if they start everywhere.
std::uint32_t started_everywhere(std::uint32_t pixels) {
    const std::uint32_t enough = std::max(65536u, std::min(pixels / 4, 16 * WAVE_PATHS));
    return std::clamp(2 * pixels, 4096u, enough) / 64 * 64;
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
    return std::clamp(started_everywhere(pixels) / std::max(2 * pixels, 1u), 1u, 16u);
}

std::uint32_t CausticPhotons::paths_per_map(std::uint32_t pixels) const {
    const double gain = std::clamp(starts_.gain, 1.0, most_gain);
    return std::max(std::uint32_t(started_everywhere(pixels) * needed_ / gain) / 64 * 64, 64u);
}

Result<void> CausticPhotons::start(const GpuScene& scene, std::vector<char> casters, bool all) {
    started_ = true;
    whole_ = false;
    first_radius_ = 0;
    needed_ = 1;
    sources_.clear();
    casters_.clear();
    head_ = {};
    head_.samples_per_map = 1;
    runs_ = {{0, 1, -1}};
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
    RESTAGE_CHECK(use(PhotonStarts(sources_.size())));
    RESTAGE_CHECK(fill<shared::PhotonRun>(device_, run_buffer_, runs_, "maps of photons"));
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

Result<void> CausticPhotons::use(PhotonStarts starts) {
    starts_ = std::move(starts);
    head_.start_rows = starts_.rows;
    head_.start_side = starts_.side;
    return fill<shared::CdfEntry>(device_, start_buffer_, starts_.cdf, "starts of photons");
}

Result<void> CausticPhotons::begin_pilot() { return begin_maps({0, 1}, 0, pilot_paths); }

Result<void> CausticPhotons::learn(const GpuScene& scene, const PhotonPilot& pilot, bool all) {
    const auto findings = pilot.findings(1e-6f * (head_.scene_radius + glm::length(head_.center)));
    if (!all && findings.found < found_pays && findings.never < never_pays)
        return start(scene, std::vector<char>(is_caster_.size()), all);
    PhotonStarts starts(sources_.size());
    starts.learn(findings.tries);
    // The least variance for the time, if that of paths is 1, of photons x / n, and their time in proportion to n: n is
    // as the root of x.
    needed_ = std::clamp(std::sqrt(findings.photons), least_needed, 1.0);
    return use(std::move(starts));
}

Result<void> CausticPhotons::begin_maps(const Maps& maps, std::uint32_t seed, std::uint32_t paths) {
    if (seed != seed_) first_radius_ = 0;
    seed_ = seed;
    whole_ = false;
    maps_ = maps;
    paths_ = paths;
    photons_.assign(maps.count, {});
    runs_.assign(maps.count, {});
    for (std::uint32_t k = 0; k < maps.count; ++k)
        runs_[k] = {shared::pcg_hash((maps.first + k) ^ shared::pcg_hash(seed ^ 0x6c8e9cf5u)), 1,
                    hero_of(maps.first + k, seed)};
    head_.paths = paths;
    RESTAGE_CHECK(fill<shared::PhotonRun>(device_, run_buffer_, runs_, "maps of photons"));
    return next_wave(0);
}

// Maps 2^k to 2^(k + 1), or parts of these: short waves, of photons and of samples, are mostly waiting.
CausticPhotons::Maps CausticPhotons::maps_with(std::uint32_t map, std::uint32_t pixels) const {
    const std::uint32_t most = std::bit_floor(std::clamp(WAVE_PATHS / paths_per_map(pixels), 1u, maps_together));
    const std::uint32_t count = std::min(std::bit_floor(std::max(map, 1u)), most);
    return {map / count * count, count};
}

Result<void> CausticPhotons::begin(const Maps& maps, std::uint32_t seed, std::uint32_t pixels) {
    head_.samples_per_map = samples_per_map(pixels);
    return begin_maps(maps, seed, paths_per_map(pixels));
}

Result<void> CausticPhotons::next_wave(std::uint64_t first_path) {
    first_path_ = first_path;
    shared::PhotonMap head = head_;
    head.first_path = std::uint32_t(first_path);
    return upload(head);
}

void CausticPhotons::collect(std::span<const std::uint32_t> paths) {
    const auto deposits = deposits_.span<shared::Photon>();
    for (const std::uint32_t i : paths)
        if (deposits[i].power.x >= 0) photons_[(first_path_ + i) / paths_].push_back(deposits[i]);
}

// By the distances between photons: where most of them are there are many, and little blur is needed.
float CausticPhotons::nearby(std::span<const shared::Photon> photons) const {
    if (photons.size() <= neighbours) return 0.01f * head_.scene_radius;
    const float distance =
        spacing(photons.size(), [&](std::size_t i) { return photons[i].p; }, neighbours, 0.5, probes);
    return std::clamp(distance, 1e-6f * head_.scene_radius, 0.05f * head_.scene_radius);
}

float CausticPhotons::radius_of(std::uint32_t map) const {
    double square = double(first_radius_) * first_radius_;
    for (std::uint32_t m = 1; m <= map; ++m)
        square *= (m + alpha) / (m + 1.0);
    return float(std::sqrt(square));
}

Result<void> CausticPhotons::finish(const GpuScene& scene, const EmbreeScene& embree) {
    if (maps_.first == 0 && !(first_radius_ > 0)) first_radius_ = nearby(photons_[0]) * float(std::pow(needed_, 0.25));
    const PhotonBorders borders{scene, embree, is_caster_};
    std::size_t most = 0;
    for (std::uint32_t k = 0; k < maps_.count; ++k) {
        runs_[k].radius = radius_of(maps_.first + k);
        const auto images = borders.images(photons_[k], runs_[k].radius, jobs_);
        photons_[k].insert(photons_[k].end(), images.begin(), images.end());
        most = std::max(most, photons_[k].size());
    }
    head_.cell_mask = PointGrid::mask_for(most);
    std::vector<shared::Photon> sorted;
    std::vector<std::uint32_t> cells{0};
    for (std::uint32_t k = 0; k < maps_.count; ++k) {
        const auto& photons = photons_[k];
        const PointGrid grid(photons.size(), head_.cell_mask, 2 * runs_[k].radius,
                             [&](std::size_t i) { return photons[i].p; });
        const auto before = std::uint32_t(sorted.size());
        for (std::size_t c = 1; c < grid.first.size(); ++c)
            cells.push_back(before + grid.first[c]);
        for (const std::uint32_t i : grid.order)
            sorted.push_back(photons[i]);
    }
    photons_.clear();
    RESTAGE_CHECK(fill<shared::Photon>(device_, photon_buffer_, sorted, "photons"));
    RESTAGE_CHECK(fill<std::uint32_t>(device_, cells_, cells, "cells of photons"));
    RESTAGE_CHECK(fill<shared::PhotonRun>(device_, run_buffer_, runs_, "maps of photons"));
    whole_ = true;
    shared::PhotonMap head = head_;
    head.count = std::uint32_t(sorted.size());
    head.first_map = maps_.first;
    head.per_photon = 1.f / float(paths_);
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
    head.starts = start_buffer_.address();
    head.runs = run_buffer_.address();
    return fill<shared::PhotonMap>(device_, record_, std::span(&head, 1), "photon map");
}

} // namespace restage::render
