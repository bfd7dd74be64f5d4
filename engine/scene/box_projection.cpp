// SPDX-License-Identifier: Apache-2.0
#include "scene/box_projection.hpp"

#include "scene/bounds.hpp"
#include "scene/quadric.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>

namespace restage::scene {

namespace {

int axis_along(const glm::dvec3& v) {
    const glm::dvec3 a = glm::abs(v);
    return a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
}

// Of a side: 2 * axis + (1 if it faces the negative direction).
struct Directions {
    glm::dvec3 u, v;
};
Directions directions(int side, const glm::dvec3& up) {
    const int up_axis = axis_along(up);
    glm::dvec3 normal(0), v(0);
    normal[side / 2] = side % 2 ? -1 : 1;
    if (side / 2 == up_axis)
        v[(up_axis + 1) % 3] = 1; // of the top and the bottom
    else
        v[up_axis] = up[up_axis] < 0 ? -1 : 1;
    return {glm::cross(v, normal), v};
}

// The object's own axes with the world's lengths.
glm::dmat4 lengths_of(const glm::dmat4& object_to_world) {
    glm::dmat4 m(1);
    for (int i = 0; i < 3; ++i)
        m[i][i] = glm::length(glm::dvec3(object_to_world[i]));
    return m;
}

// The direction of the object's own axis that is nearest to `up`.
glm::dvec3 own_up(const glm::dmat4& object_to_world, const glm::dvec3& up) {
    glm::dvec3 along;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 axis(object_to_world[i]);
        along[i] = glm::dot(axis, up) / std::max(glm::length(axis), 1e-300);
    }
    glm::dvec3 own(0);
    const int nearest = axis_along(along);
    own[nearest] = along[nearest] < 0 ? -1 : 1;
    return own;
}

} // namespace

MeshData box_projected(const MeshData& mesh, const glm::dmat4& to_space, double size, const glm::dvec3& up) {
    MeshData made;
    made.lower = mesh.lower;
    made.upper = mesh.upper;
    made.triangles.reserve(mesh.triangles.size());
    std::vector<glm::dvec3> at;
    at.reserve(mesh.positions.size());
    for (const glm::vec3& p : mesh.positions)
        at.emplace_back(to_space * glm::dvec4(glm::dvec3(p), 1));
    Directions sides[6];
    for (int side = 0; side < 6; ++side)
        sides[side] = directions(side, up);
    const bool mirrored = glm::determinant(glm::dmat3(to_space)) < 0;
    std::unordered_map<std::uint64_t, std::uint32_t> vertices; // by original vertex and side
    for (const glm::uvec3& t : mesh.triangles) {
        glm::dvec3 n = glm::cross(at[t.y] - at[t.x], at[t.z] - at[t.x]);
        if (!mesh.normals.empty()) { // they say which side is outside
            const glm::dvec3 shading =
                glm::dvec3(mesh.normals[t.x]) + glm::dvec3(mesh.normals[t.y]) + glm::dvec3(mesh.normals[t.z]);
            const glm::dvec3 a(mesh.positions[t.x]);
            const glm::dvec3 own = glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
            if ((glm::dot(own, shading) < 0) != mirrored) n = -n;
        } else if (mirrored) {
            n = -n;
        }
        const int axis = axis_along(n), side = 2 * axis + (n[axis] < 0 ? 1 : 0);
        glm::uvec3 corners;
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t old = t[i];
            const auto [found, fresh] = vertices.try_emplace(std::uint64_t(old) * 6 + std::uint64_t(side),
                                                             std::uint32_t(made.positions.size()));
            corners[i] = found->second;
            if (!fresh) continue;
            made.positions.push_back(mesh.positions[old]);
            if (!mesh.normals.empty()) made.normals.push_back(mesh.normals[old]);
            if (!mesh.uvs2.empty()) made.uvs2.push_back(mesh.uvs2[old]);
            made.uvs.emplace_back(glm::dot(at[old], sides[side].u) / size, glm::dot(at[old], sides[side].v) / size);
        }
        made.triangles.push_back(corners);
    }
    return made;
}

Result<Edit> project_box(const Scene& scene, std::span<const Id<Instance>> objects, const BoxOptions& options) {
    if (!(options.size > 0) || !std::isfinite(options.size)) return fail("the size of a repetition is not above 0");
    Edit edit;
    std::uint32_t next = scene.meshes.next().value;
    struct Made {
        Id<Mesh> from;
        glm::dmat4 to_space;
        glm::dvec3 up;
        Id<Mesh> mesh;
    };
    std::vector<Made> made;
    std::set<std::string> names;
    scene.meshes.each([&](auto, const Mesh& m) { names.insert(m.name); });
    std::string fixed;
    std::size_t count = 0;
    for (const Id<Instance> id : objects) {
        const Instance* instance = scene.instances.find(id);
        if (!instance) return fail("there is no object with id " + std::to_string(id.value));
        const Mesh* mesh = scene.meshes.find(instance->mesh);
        if (!mesh || !mesh->data || mesh->data->triangles.empty()) continue;
        if (quadric_of(*mesh)) {
            fixed = instance->name;
            continue;
        }
        const glm::dmat4& m = instance->object_to_world;
        const glm::dmat4 to_space = options.world_axes ? m : lengths_of(m);
        const glm::dvec3 up = options.world_axes ? options.up : own_up(m, options.up);
        auto same = std::ranges::find_if(made, [&](const Made& one) {
            return one.from == instance->mesh && one.to_space == to_space && one.up == up;
        });
        if (same == made.end()) {
            Mesh projected = *mesh;
            projected.name = next_name(mesh->name, names);
            projected.data = std::make_shared<const MeshData>(box_projected(*mesh->data, to_space, options.size, up));
            projected.source_file.clear(); // whose coordinates are others
            projected.primitive.clear();
            projected.origin = {};
            made.push_back({instance->mesh, to_space, up, {next++}});
            edit.changes.push_back(Change<Mesh>{made.back().mesh, std::nullopt, std::move(projected)});
            same = std::prev(made.end());
        }
        Instance after = *instance;
        after.mesh = same->mesh;
        edit.changes.push_back(Change<Instance>{id, *instance, std::move(after)});
        edit.label = "Project texture on " + instance->name;
        ++count;
    }
    if (count == 0)
        return fixed.empty()
                   ? fail("there is no mesh to project a texture on")
                   : fail("\"" + fixed + "\" is a sphere, disk or cylinder: its texture coordinates are fixed");
    if (count > 1) edit.label = "Project textures on " + std::to_string(count) + " objects";
    return edit;
}

double covering_size(const Scene& scene, std::span<const Id<Instance>> objects) {
    double size = 0;
    for (const Id<Instance> id : objects)
        if (const Bounds box = world_bounds(scene, id); !box.empty())
            size = std::max({size, box.size().x, box.size().y, box.size().z});
    return size > 0 ? size : 1;
}

bool has_uv(const Mesh& mesh) { return (mesh.data && !mesh.data->uvs.empty()) || quadric_of(mesh).has_value(); }

std::vector<Id<Instance>> without_uv(const Scene& scene, Id<Material> material) {
    std::vector<Id<Instance>> found;
    scene.instances.each([&](Id<Instance> id, const Instance& instance) {
        const Mesh* mesh = scene.meshes.find(instance.mesh);
        if (instance.material == material && !instance.hidden && mesh && mesh->data && !has_uv(*mesh))
            found.push_back(id);
    });
    return found;
}

} // namespace restage::scene
