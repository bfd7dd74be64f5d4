// SPDX-License-Identifier: Apache-2.0
// Surfaces are sampled into a grid of voxels; two objects touch when a voxel of one is, or is next to, one of the
// other.
#include "query/touching.hpp"

#include "scene/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace restage::query {

namespace {

using scene::Bounds;
using InstanceId = scene::Id<scene::Instance>;

constexpr double largest = 2.5;       // times the size of the selection
constexpr double voxel_share = 0.006; // voxel side, relative to that size

std::uint64_t key(const glm::i64vec3& v) {
    constexpr std::uint64_t mask = (1u << 21) - 1;
    return (std::uint64_t(v.x) & mask) | (std::uint64_t(v.y) & mask) << 21 | (std::uint64_t(v.z) & mask) << 42;
}

using Voxels = std::unordered_set<std::uint64_t>;

glm::i64vec3 voxel_of(const glm::dvec3& p, double side) { return glm::i64vec3(glm::floor(p / side)); }

// visit(voxel) for samples of the surface no further apart than a voxel's side. Stops when it returns true.
template <class F>
bool sample(const scene::MeshData& mesh, const glm::dmat4& m, double side, F&& visit) {
    for (const glm::uvec3& t : mesh.triangles) {
        glm::dvec3 p[3];
        for (int i = 0; i < 3; ++i)
            p[i] = glm::dvec3(m * glm::dvec4(glm::dvec3(mesh.positions[t[i]]), 1));
        const glm::dvec3 a = p[1] - p[0], b = p[2] - p[0];
        const int n = 1 + int(std::min(std::max({glm::length(a), glm::length(b), glm::length(b - a)}) / side, 2000.0));
        for (int i = 0; i <= n; ++i)
            for (int j = 0; i + j <= n; ++j)
                if (visit(voxel_of(p[0] + a * (double(i) / n) + b * (double(j) / n), side))) return true;
    }
    return false;
}

bool near(const Bounds& a, const Bounds& b, double slack) {
    return glm::all(glm::lessThanEqual(a.lower, b.upper + slack)) &&
           glm::all(glm::lessThanEqual(b.lower, a.upper + slack));
}

} // namespace

std::vector<InstanceId> touching(const scene::Scene& s, std::span<const InstanceId> ids,
                                 const std::function<bool(InstanceId)>& skip) {
    const std::unordered_set<InstanceId> chosen(ids.begin(), ids.end());
    struct Thing {
        InstanceId id;
        Bounds box;
    };
    std::vector<Thing> reached, others;
    Bounds all;
    s.instances.each([&](InstanceId id, const scene::Instance& instance) {
        const Bounds box = scene::world_bounds(s, id);
        if (box.empty() || (!chosen.contains(id) && (instance.hidden || (skip && skip(id))))) return;
        (chosen.contains(id) ? reached : others).push_back({id, box});
        if (chosen.contains(id)) all.add(box);
    });
    std::vector<InstanceId> found;
    const double size = glm::length(all.size()), side = size * voxel_share;
    if (all.empty() || side <= 0) return found;
    std::erase_if(others, [&](const Thing& thing) { return glm::length(thing.box.size()) > largest * size; });

    const auto mesh_of = [&](InstanceId id) -> const scene::MeshData& { return *s.meshes[s.instances[id].mesh].data; };
    for (std::size_t next = 0; next < reached.size(); ++next) { // grows
        const Thing from = reached[next];
        if (std::none_of(others.begin(), others.end(),
                         [&](const Thing& thing) { return near(thing.box, from.box, 2 * side); }))
            continue;
        Voxels own, around; // its voxels, and those with their neighbours, for a single lookup
        sample(mesh_of(from.id), s.instances[from.id].object_to_world, side, [&](const glm::i64vec3& v) {
            if (own.insert(key(v)).second)
                for (int i = 0; i < 27; ++i)
                    around.insert(key(v + glm::i64vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
            return false;
        });
        std::erase_if(others, [&](const Thing& thing) {
            if (!near(thing.box, from.box, 2 * side)) return false;
            if (!sample(mesh_of(thing.id), s.instances[thing.id].object_to_world, side,
                        [&](const glm::i64vec3& v) { return around.contains(key(v)); }))
                return false;
            found.push_back(thing.id);
            reached.push_back(thing);
            return true;
        });
    }
    return found;
}

} // namespace restage::query
