// SPDX-License-Identifier: Apache-2.0
#include "render/photon_pilot.hpp"

#include "render/point_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace restage::render {
namespace {

constexpr std::size_t probes = 64;   // of distances
constexpr std::size_t together = 16; // camera paths, of neighbouring pixels

float mean(const glm::vec3& c) { return (c.x + c.y + c.z) / 3; }

std::uint32_t depth_of(const shared::PathState& path) { return path.flags & PATH_DEPTH_MASK; }

} // namespace

// By a delta lobe, or through a lamp without a surface.
bool PhotonPilot::goes_on(const Hit& hit, const shared::PathState& path) {
    return (path.flags & PATH_SPECULAR) != 0 || depth_of(path) == hit.depth;
}

void PhotonPilot::begin(std::uint32_t paths) { hits_.assign(paths, {}); }

void PhotonPilot::before_bounce(std::span<const std::uint32_t> active) {
    const auto rays = wave_.rays();
    const auto paths = wave_.paths();
    for (const std::uint32_t i : active) {
        const shared::RayHit& ray = rays[i];
        hits_[i] = {};
        if (ray.tfar > 0 && ray.inst != NONE)
            hits_[i] = {ray.origin + ray.direction * ray.tfar, ray.inst, depth_of(paths[i]), mean(paths[i].throughput)};
    }
}

void PhotonPilot::after_camera_bounce(std::span<const std::uint32_t> active) {
    const auto rays = wave_.rays();
    const auto paths = wave_.paths();
    for (const std::uint32_t i : active) {
        const bool lives = rays[i].tfar > 0;
        if (hits_[i].instance == NONE || (lives && goes_on(hits_[i], paths[i]))) continue;
        vertices_.push_back({hits_[i].p, i, lives ? std::abs(mean(paths[i].throughput)) : 0.f});
    }
}

void PhotonPilot::end_camera() {
    const auto paths = wave_.paths();
    light_.resize(hits_.size());
    for (std::size_t i = 0; i < light_.size(); ++i)
        light_[i] = mean(paths[i].radiance);
}

void PhotonPilot::photons_started(std::span<const shared::Photon> deposits) {
    const auto rays = wave_.rays();
    const auto paths = wave_.paths();
    starts_.resize(hits_.size());
    for (std::size_t i = 0; i < starts_.size(); ++i)
        starts_[i] = {deposits[i].direction, rays[i].tfar > 0 ? mean(paths[i].radiance) : 0.f, deposits[i].power.y};
}

void PhotonPilot::after_photon_bounce(std::span<const std::uint32_t> active, std::span<const char> casters) {
    const auto rays = wave_.rays();
    const auto paths = wave_.paths();
    const auto shadows = wave_.shadows();
    for (const std::uint32_t i : active) {
        shadows[i].tfar = -1; // kernels of paths look for light
        const Hit& hit = hits_[i];
        if (hit.instance == NONE) continue;
        const bool lives = rays[i].tfar > 0, straight = lives && goes_on(hit, paths[i]);
        const bool passes = casters[hit.instance] != 0;
        if (straight && (passes || depth_of(paths[i]) == hit.depth)) continue;
        rays[i].tfar = -1;
        if (hit.depth > 0 && !straight && (lives || !passes))
            deposits_.push_back({hit.p, i, starts_[i].power * hit.throughput});
    }
}

// At a vertex, by the photons around it, as if the surface were diffuse. Of a light of radiance L a path brings L times
// its throughput or nothing, so the mean of the square is that times the mean.
std::vector<PhotonPilot::Carried> PhotonPilot::carried(float least) const {
    const auto place = [&](std::size_t i) { return deposits_[i].p; };
    const float radius = std::max(spacing(deposits_.size(), place, 10, 0.5, probes), least);
    const PointGrid grid(deposits_.size(), radius, place);
    const double per_power = 1 / (double(starts_.size()) * std::numbers::pi * std::numbers::pi * radius * radius);
    std::vector<Carried> all(light_.size());
    for (const Vertex& v : vertices_)
        grid.near(v.p, [&](std::uint32_t i) {
            const Deposit& d = deposits_[i];
            if (!(glm::distance(d.p, v.p) < radius)) return;
            const double light = v.throughput * d.power * per_power, radiance = starts_[d.photon].radiance;
            Carried& of_path = all[v.path];
            (radiance > 0 ? of_path.found : of_path.never) += light;
            of_path.found_squared += light * v.throughput * radiance;
        });
    return all;
}

PhotonPilot::Findings PhotonPilot::findings(float least) const {
    Findings all;
    std::vector<char> seen(starts_.size());
    if (!deposits_.empty() && !vertices_.empty()) {
        mark_seen(least, seen);
        const std::vector<Carried> by_path = carried(least);
        const std::size_t paths = std::min(together, light_.size()), parts = light_.size() / paths;
        for (std::size_t part = 0; part < parts; ++part) {
            Carried c;
            double light = 0, variance = 0;
            for (std::size_t k = part * paths; k < (part + 1) * paths; ++k) {
                c.found += by_path[k].found / double(paths);
                c.never += by_path[k].never / double(paths);
                c.found_squared += by_path[k].found_squared / double(paths);
                light += double(light_[k]) / double(paths);
                if (k == part * paths) continue;
                const double step = double(light_[k]) - light_[k - 1]; // neighbours: less of it is the picture's
                variance += 0.5 * step * step / double(paths - 1);
            }
            const double carried = c.found + c.never;
            if (!(carried > 0)) continue;
            if (c.found > 0) all.found += c.found_squared / (c.found_squared + variance) / double(parts);
            all.never += c.never / (carried + std::max(light, 0.0)) / double(parts);
            all.photons += carried * carried / (carried * carried + variance) / double(parts);
        }
    }
    for (std::size_t i = 0; i < starts_.size(); ++i)
        all.tries.push_back({starts_[i].cell, seen[i] != 0});
    return all;
}

// Photons that fell so near to a vertex that a path may meet them.
void PhotonPilot::mark_seen(float least, std::span<char> seen) const {
    const auto place = [&](std::size_t i) { return vertices_[i].p; };
    const float distance = std::max(spacing(vertices_.size(), place, 4, 0.9, probes), least);
    const PointGrid grid(vertices_.size(), distance, place);
    for (const Deposit& d : deposits_) {
        bool near = false;
        grid.near(d.p, [&](std::uint32_t i) { near |= glm::distance(vertices_[i].p, d.p) < distance; });
        if (near) seen[d.photon] = 1;
    }
}

} // namespace restage::render
