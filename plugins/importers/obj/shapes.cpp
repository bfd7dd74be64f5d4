// SPDX-License-Identifier: Apache-2.0
// Objects and groups: an instance for each material of a shape, its corners joined into vertices, smoothing groups.
#include "importer.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace restage::obj {

namespace {

struct Corner { // what makes two corners the same vertex
    int vertex, coordinate, normal;
    std::uint64_t smoothing; // of a corner without a normal: 0 = flat
    std::size_t face;        // of a flat corner among smooth ones: it is nobody else's
    bool operator==(const Corner&) const = default;
};
struct CornerHash {
    std::size_t operator()(const Corner& c) const {
        std::uint64_t h = static_cast<std::uint32_t>(c.vertex);
        for (const std::uint64_t x :
             {std::uint64_t(c.coordinate) + 1, std::uint64_t(c.normal) + 1, c.smoothing, std::uint64_t(c.face)})
            h = (h ^ x) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
        return static_cast<std::size_t>(h);
    }
};

std::uint64_t smoothing_key(unsigned group, int vertex) {
    return std::uint64_t{group} << 32 | static_cast<std::uint32_t>(vertex);
}

unsigned smoothing_group(const tinyobj::mesh_t& mesh, std::size_t face) {
    return face < mesh.smoothing_group_ids.size() ? mesh.smoothing_group_ids[face] : 0;
}

Vec3 point(const tinyobj::attrib_t& attributes, int vertex) {
    const float* p = &attributes.vertices[3 * static_cast<std::size_t>(vertex)];
    return {p[0], p[1], p[2]};
}

Vec3 face_cross(const tinyobj::attrib_t& a, const tinyobj::index_t* corners) { // twice the area long
    const Vec3 p = point(a, corners[0].vertex_index);
    return cross(point(a, corners[1].vertex_index) - p, point(a, corners[2].vertex_index) - p);
}

} // namespace

// A vertex of a smoothing group gets the mean normal of the group's faces around it, each counting by the angle of its
// corner, so that the way a polygon is cut does not matter (Thuermer and Wuethrich 1998).
void Importer::smooth() {
    for (const auto& shape : shapes_)
        for (std::size_t face = 0; face < shape.mesh.indices.size() / 3; ++face) {
            const unsigned group = smoothing_group(shape.mesh, face);
            const tinyobj::index_t* corners = &shape.mesh.indices[3 * face];
            if (group == 0) continue;
            const Vec3 normal = normalized(face_cross(attributes_, corners), {0, 0, 0});
            for (int c = 0; c < 3; ++c) {
                if (corners[c].normal_index >= 0) continue;
                const Vec3 p = point(attributes_, corners[c].vertex_index);
                const Vec3 a = normalized(point(attributes_, corners[(c + 1) % 3].vertex_index) - p);
                const Vec3 b = normalized(point(attributes_, corners[(c + 2) % 3].vertex_index) - p);
                Vec3& sum = smoothed_[smoothing_key(group, corners[c].vertex_index)];
                sum = sum + normal * std::acos(std::clamp(dot(a, b), -1.0, 1.0));
            }
        }
}

MeshBuffer Importer::mesh(const tinyobj::shape_t& shape, int material) const {
    const tinyobj::mesh_t& in = shape.mesh;
    bool any_normal = false, any_uv = false;
    for (std::size_t face = 0; face < in.material_ids.size(); ++face)
        if (in.material_ids[face] == material) {
            any_normal = any_normal || smoothing_group(in, face) != 0;
            for (std::size_t c = 3 * face; c < 3 * face + 3; ++c) {
                any_normal = any_normal || in.indices[c].normal_index >= 0;
                any_uv = any_uv || in.indices[c].texcoord_index >= 0;
            }
        }
    MeshBuffer result;
    std::unordered_map<Corner, std::uint32_t, CornerHash> known;
    for (std::size_t face = 0; face < in.material_ids.size(); ++face) {
        if (in.material_ids[face] != material) continue;
        const tinyobj::index_t* corners = &in.indices[3 * face];
        const Vec3 flat = face_cross(attributes_, corners);
        if (!(length(flat) > 0)) continue; // has no area
        for (int c = 0; c < 3; ++c) {
            const tinyobj::index_t& i = corners[c];
            const unsigned group = i.normal_index < 0 ? smoothing_group(in, face) : 0;
            const bool own = any_normal && i.normal_index < 0 && group == 0;
            const Corner key{i.vertex_index, i.texcoord_index, i.normal_index, group, own ? face + 1 : 0};
            const auto [it, fresh] = known.try_emplace(key, result.vertex_count());
            result.indices.push_back(it->second);
            if (!fresh) continue;
            const float* p = &attributes_.vertices[3 * static_cast<std::size_t>(i.vertex_index)];
            result.positions.insert(result.positions.end(), p, p + 3);
            if (any_uv) {
                const auto at = 2 * static_cast<std::size_t>(std::max(i.texcoord_index, 0));
                const bool has = i.texcoord_index >= 0;
                result.uvs.push_back(has ? attributes_.texcoords[at] : 0);
                result.uvs.push_back(has ? attributes_.texcoords[at + 1] : 0);
            }
            if (any_normal) {
                Vec3 normal = flat;
                if (i.normal_index >= 0) {
                    const float* n = &attributes_.normals[3 * static_cast<std::size_t>(i.normal_index)];
                    normal = {n[0], n[1], n[2]};
                } else if (group != 0) {
                    normal = smoothed_.at(smoothing_key(group, i.vertex_index));
                }
                normal = normalized(normal, normalized(flat));
                for (const double x : normal)
                    result.normals.push_back(static_cast<float>(x));
            }
        }
    }
    return result;
}

void Importer::shape(const tinyobj::shape_t& shape) {
    const std::set<int> used(shape.mesh.material_ids.begin(), shape.mesh.material_ids.end());
    const std::string name = shape.name.empty() ? path_.stem().string() : shape.name;
    const auto line = lines_.shapes.find(shape.name);
    const std::uint32_t at = line == lines_.shapes.end() ? 0 : line->second;
    RestageHandle group = 0;
    if (used.size() > 1) {
        const RestageGroup g = {.text = {name.c_str(), "", ""}, .parent = 0};
        group = out_.group(out_.ctx, &g);
    }
    for (const int id : used) {
        const MeshBuffer buffer = mesh(shape, id);
        if (buffer.indices.empty()) {
            report_.dropped("object " + quote(name), "its faces have no area", at);
            continue;
        }
        const MadeMaterial& made = material(id);
        const std::string own_name =
            group && id >= 0 ? name + "/" + materials_[static_cast<std::size_t>(id)].name : name;
        const RestageHandle handle = buffer.push(out_, own_name, "");
        if (!handle || !made.material) continue; // the host has said why
        RestageInstance instance{};
        instance.text = {own_name.c_str(), "", ""};
        instance.mesh = handle;
        instance.material = made.material;
        instance.group = group;
        instance.alpha_texture = made.alpha_texture;
        instance.alpha = made.alpha;
        if (made.emits) instance.flags = RESTAGE_INSTANCE_EMITS | RESTAGE_INSTANCE_TWO_SIDED;
        for (std::size_t i = 0; i < 3; ++i)
            instance.emission[i] = static_cast<float>(made.emission[i]);
        std::copy_n(Matrix().m.begin(), 16, instance.object_to_world);
        if (!out_.instance(out_.ctx, &instance)) continue;
        bounds_.add(buffer.bounds(), Matrix());
        triangles_ += buffer.triangle_count();
        ++objects_;
    }
}

} // namespace restage::obj
