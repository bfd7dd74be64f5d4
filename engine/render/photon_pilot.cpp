// SPDX-License-Identifier: Apache-2.0
#include "render/photon_pilot.hpp"

#include "render/point_grid.hpp"

#include <algorithm>
#include <cstdio>
#include <numbers>

namespace restage::render {
namespace {

constexpr std::size_t together = 16; // camera paths, of neighbouring pixels

float mean(const glm::vec3& c) { return (c.x + c.y + c.z) / 3; }

} // namespace

void PhotonPilot::begin(std::uint32_t paths) { hits_.assign(paths, {}); }

void PhotonPilot::before_bounce(std::span<const std::uint32_t> active) {
    const auto rays = wave_.rays();
    const auto paths = wave_.paths();
    for (const std::uint32_t i : active) {
        const shared::RayHit& ray = rays[i];
        hits_[i] = {};
        if (ray.tfar > 0 && ray.inst != NONE)
            hits_[i] = {ray.origin + ray.direction * ray.tfar, ray.inst, paths[i].flags & PATH_DEPTH_MASK,
                        mean(paths[i].throughput)};
    }
}

void PhotonPilot::after_camera_bounce(std::span<const std::uint32_t> active) {
    const auto rays = wave_.rays();
    const auto paths = wave_.paths();
    for (const std::uint32_t i : active) {
        const bool lives = rays[i].tfar > 0;
        if (hits_[i].instance == NONE || (lives && (paths[i].flags & PATH_SPECULAR))) continue;
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
        const bool lives = rays[i].tfar > 0, delta = lives && (paths[i].flags & PATH_SPECULAR);
        const bool caster = casters[hit.instance];
        if (delta && caster) continue;
        rays[i].tfar = -1;
        if (hit.depth > 0 && !delta && (lives || !caster))
            deposits_.push_back({hit.p, i, starts_[i].power * hit.throughput});
    }
}

PhotonPilot::Findings PhotonPilot::findings() const {
    Findings all;
    std::vector<char> seen(starts_.size());
    if (!deposits_.empty() && !vertices_.empty()) {
        const auto vertex = [&](std::size_t i) { return vertices_[i].p; };
        const auto deposit = [&](std::size_t i) { return deposits_[i].p; };
        mark_seen(spacing(vertices_.size(), vertex, 4, 0.9), seen);
        const float radius = spacing(deposits_.size(), deposit, 10, 0.5);
        const PointGrid grid(deposits_.size(), radius, deposit);
        // Radiance that a diffuse vertex would send back. A path that finds it finds all of the light's radiance at
        // once: its square's mean is the product.
        struct Carried {
            double found = 0, found_squared = 0, never = 0;
        };
        std::vector<Carried> carried(light_.size());
        const double per_power = 1 / (double(starts_.size()) * std::numbers::pi * std::numbers::pi * radius * radius);
        for (const Vertex& v : vertices_)
            grid.near(v.p, [&](std::uint32_t i) {
                const Deposit& d = deposits_[i];
                if (glm::distance(d.p, v.p) >= radius) return;
                const double c = v.throughput * d.power * per_power, radiance = starts_[d.photon].radiance;
                Carried& sum = carried[v.path];
                (radiance > 0 ? sum.found : sum.never) += c;
                sum.found_squared += c * v.throughput * radiance;
            });
        double photons = 0, found = 0, never = 0, parts = 0, mean_light = 0;
        for (float l : light_)
            mean_light += l / double(light_.size());
        for (std::size_t first = 0; first + together <= light_.size(); first += together, ++parts) {
            double light = 0, v = 0;
            Carried c;
            for (std::size_t k = first; k < first + together; ++k) {
                light += light_[k] / together;
                if (k > first) v += 0.5 * (light_[k] - light_[k - 1]) * (light_[k] - light_[k - 1]) / (together - 1);
                c.found += carried[k].found / together, c.found_squared += carried[k].found_squared / together,
                    c.never += carried[k].never / together;
            }
            const double all_light = light + c.found + c.never + 0.01 * mean_light;
            const double both = c.found + c.never;
            if (both > 0) photons += both * both / (both * both + v);
            if (c.found_squared > 0) found += c.found_squared / (c.found_squared + v);
            never += c.never / all_light;
        }
        all.found = found / parts, all.photons = photons / parts, all.never = never / parts;
    }
    for (std::size_t i = 0; i < starts_.size(); ++i)
        all.tries.push_back({starts_[i].cell, seen[i] != 0});
    return all;
}

// Photons that fell so near to a vertex that a path may meet them.
void PhotonPilot::mark_seen(float distance, std::span<char> seen) const {
    const PointGrid grid(vertices_.size(), distance, [&](std::size_t i) { return vertices_[i].p; });
    for (const Deposit& d : deposits_) {
        bool near = false;
        grid.near(d.p, [&](std::uint32_t i) { near |= glm::distance(vertices_[i].p, d.p) < distance; });
        if (near) seen[d.photon] = 1;
    }
}

} // namespace restage::render
