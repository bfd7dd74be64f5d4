// SPDX-License-Identifier: Apache-2.0
#include "render/photon_borders.hpp"

#include "render/hit_normal.hpp"
#include "shared/hash.h"
#include "shared/octahedral.h"

#include <cmath>
#include <glm/packing.hpp>
#include <numbers>
#include <optional>

namespace restage::render {
namespace {

// Lengths in radii of the disk. With four rays a straight border is at most 45 degrees from one of them.
constexpr float reach = std::numbers::sqrt2_v<float>;
constexpr float height = 0.15f;     // above the surface, where rays start
constexpr int halvings = 5;         // of the way to an edge
constexpr float chord = 0.25f;      // angle between the two points that tell where an edge runs
constexpr int casters_passed = 4;   // by one ray

// As in shaders/path/photons.glsl: what is gathered together with a photon.
constexpr float gather_height = 0.5f, gather_cosine = 0.5f;

struct Line { // a border in the tangent plane
    glm::vec3 normal; // unit, away from the photon
    float distance;
    bool solid = false; // behind it a solid covers the surface
};

glm::vec3 unpacked_direction(std::uint32_t packed) {
    return shared::octahedral_to_direction(glm::dvec2(glm::unpackSnorm2x16(packed)) * 0.5 + 0.5);
}

class Surroundings { // of one photon
  public:
    Surroundings(const PhotonBorders& borders, const shared::Photon& photon, float radius)
        : b_(borders), p_(photon.p), n_(unpacked_direction(photon.normal)), r_(radius) {
        const glm::vec3 other = std::abs(n_.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
        x_ = glm::normalize(glm::cross(n_, other));
        y_ = glm::cross(n_, x_);
        turn_ = 0.5f * std::numbers::pi_v<float> * shared::hash_unit(shared::hash_add(0x9e3779b9u, photon.p));
    }

    // Different ones closer than the radius.
    std::vector<Line> lines() const {
        std::vector<Line> found;
        for (int k = 0; k < 4; ++k) {
            const auto line = line_towards(turn_ + 0.5f * std::numbers::pi_v<float> * float(k));
            if (!line || !(line->distance < r_)) continue;
            bool known = false;
            for (const Line& other : found)
                known |= glm::dot(other.normal, line->normal) > 0.9f;
            if (!known) found.push_back(*line);
        }
        return found;
    }

    glm::vec3 mirrored(const glm::vec3& p, const Line& line) const {
        return p + line.normal * (2 * (line.distance - glm::dot(p - p_, line.normal)));
    }

    // Whether photons there would be gathered with this one's neighbours.
    bool is_surface(const glm::vec3& p) const {
        const auto hit = cast(p + n_ * (height * r_), -n_, (height + gather_height) * r_);
        return hit && is_parallel(hit_normal(b_.scene, b_.embree, *hit));
    }

  private:
    bool is_parallel(const glm::vec3& normal) const { return std::abs(glm::dot(normal, n_)) >= gather_cosine; }

    // The nearest hit; casters are passed, unless they may lie on the surface.
    std::optional<shared::RayHit> cast(const glm::vec3& origin, const glm::vec3& direction, float length) const {
        alignas(16) shared::RayHit ray{};
        ray.origin = origin;
        ray.direction = direction;
        ray.mask = ~0u;
        for (int k = 0; k < casters_passed; ++k) {
            ray.tfar = length;
            ray.geom = ray.inst = NONE;
            b_.embree.intersect(ray);
            if (ray.inst == NONE) return std::nullopt;
            if (!b_.casters[ray.inst] || is_parallel(hit_normal(b_.scene, b_.embree, ray))) return ray;
            ray.tnear = ray.tfar + 1e-4f * r_;
        }
        return std::nullopt;
    }

    std::optional<Line> line_towards(float angle) const {
        const glm::vec3 along = std::cos(angle) * x_ + std::sin(angle) * y_;
        // To the surface at `reach`, and beyond as far as it may curve away.
        const glm::vec3 start = p_ + n_ * (height * r_), towards = glm::normalize(reach * along - height * n_);
        const auto hit = cast(start, towards, 1.2f * reach * r_);
        if (!hit) return edge_towards(angle);
        const glm::vec3 normal = hit_normal(b_.scene, b_.embree, *hit), q = start + towards * hit->tfar - p_;
        if (is_parallel(normal))
            return std::abs(glm::dot(q, n_)) <= gather_height * r_ ? std::nullopt : edge_towards(angle);
        glm::vec3 across = glm::normalize(normal - n_ * glm::dot(normal, n_));
        if (glm::dot(across, along) < 0) across = -across;
        const float distance = glm::dot(normal, q) / glm::dot(normal, across);
        if (!(distance > 0)) return std::nullopt;
        return Line{across, distance, is_solid(*hit, towards, normal)};
    }

    // Whether the ray is inside a closed mesh behind this hit, close to it.
    bool is_solid(const shared::RayHit& hit, const glm::vec3& direction, const glm::vec3& normal) const {
        const glm::vec3 behind = hit.origin + direction * hit.tfar + glm::normalize(direction + n_) * (1e-3f * r_);
        const auto next = cast(behind, n_, 1e30f);
        if (!next || next->inst != hit.inst) return false;
        return (glm::dot(hit_normal(b_.scene, b_.embree, *next), n_) > 0) != (glm::dot(normal, direction) > 0);
    }

    // How far the surface goes, at most `reach`.
    float extent(const glm::vec3& along) const {
        if (is_surface(p_ + along * (reach * r_))) return reach * r_;
        float near = 0, far = reach * r_;
        for (int k = 0; k < halvings; ++k) {
            const float middle = 0.5f * (near + far);
            (is_surface(p_ + along * middle) ? near : far) = middle;
        }
        return 0.5f * (near + far);
    }

    std::optional<Line> edge_towards(float angle) const {
        const auto point = [&](float a) {
            const glm::vec3 along = std::cos(a) * x_ + std::sin(a) * y_;
            const float distance = extent(along);
            return distance < reach * r_ ? std::optional(along * distance) : std::nullopt;
        };
        const auto first = point(angle);
        if (!first) return std::nullopt;
        auto second = point(angle + chord);
        if (!second) second = point(angle - chord);
        if (!second) return std::nullopt;
        const glm::vec3 across = glm::cross(*second - *first, n_);
        const float length = glm::length(across);
        if (!(length > 0)) return std::nullopt;
        const float distance = glm::dot(*first, across) / length;
        return Line{across / (distance < 0 ? -length : length), std::abs(distance)};
    }

    const PhotonBorders& b_;
    glm::vec3 p_, n_, x_, y_;
    float r_, turn_;
};

void add_images(const PhotonBorders& borders, const shared::Photon& photon, float radius,
                std::vector<shared::Photon>& out) {
    const Surroundings around(borders, photon, radius);
    const std::vector<Line> lines = around.lines();
    std::vector<char> missing(lines.size());
    const auto add = [&](const glm::vec3& p) {
        out.push_back(photon);
        out.back().p = p;
    };
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const glm::vec3 p = around.mirrored(photon.p, lines[i]);
        missing[i] = lines[i].solid || !around.is_surface(p);
        if (missing[i]) add(p);
        for (std::size_t j = 0; j < i; ++j) // in a corner, what lies behind both
            if (missing[i] && missing[j] && std::abs(glm::dot(lines[i].normal, lines[j].normal)) < 0.5f)
                add(around.mirrored(p, lines[j]));
    }
}

} // namespace

std::vector<shared::Photon> PhotonBorders::images(std::span<const shared::Photon> photons, float radius,
                                                  Jobs& jobs) const {
    constexpr std::size_t chunk = 256;
    std::vector<std::vector<shared::Photon>> parts((photons.size() + chunk - 1) / chunk);
    jobs.parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t k = begin; k < end; ++k)
            for (const auto& photon : photons.subspan(k * chunk, std::min(chunk, photons.size() - k * chunk)))
                add_images(*this, photon, radius, parts[k]);
    });
    std::vector<shared::Photon> all;
    for (const auto& part : parts)
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

} // namespace restage::render
