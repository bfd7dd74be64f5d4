// SPDX-License-Identifier: Apache-2.0
// Objects and groups: an instance for each material of a shape, its corners joined into vertices, smoothing groups.
#include "common/baked_colors.hpp"
#include "common/strokes.hpp"
#include "importer.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace restage::obj {

namespace {

struct Key { // equal keys = the same vertex
    int vertex, coordinate, normal;
    std::uint64_t smoothing; // of a corner without a normal: 0 = flat
    std::size_t face;        // of a flat corner among smooth ones: not shared
    bool operator==(const Key&) const = default;
};
struct KeyHash {
    std::size_t operator()(const Key& c) const {
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

Vec3 point(const Model& model, int vertex) {
    const float* p = &model.vertices[3 * static_cast<std::size_t>(vertex)];
    return {p[0], p[1], p[2]};
}

Vec3 face_cross(const Model& model, const Corner* corners) { // its length is twice the area
    const Vec3 p = point(model, corners[0].vertex);
    return cross(point(model, corners[1].vertex) - p, point(model, corners[2].vertex) - p);
}

} // namespace

// A vertex of a smoothing group gets the mean normal of the group's faces around it, each counting by the angle of its
// corner, so that the way a polygon is cut does not matter (Thuermer and Wuethrich 1998).
void Importer::smooth() {
    for (const Shape& shape : model_.shapes)
        for (std::size_t face = 0; face < shape.materials.size(); ++face) {
            const std::uint32_t group = shape.smoothing[face];
            const Corner* corners = &shape.corners[3 * face];
            if (group == 0) continue;
            const Vec3 normal = normalized(face_cross(model_, corners), {0, 0, 0});
            for (int c = 0; c < 3; ++c) {
                if (corners[c].normal >= 0) continue;
                const Vec3 p = point(model_, corners[c].vertex);
                const Vec3 a = normalized(point(model_, corners[(c + 1) % 3].vertex) - p);
                const Vec3 b = normalized(point(model_, corners[(c + 2) % 3].vertex) - p);
                Vec3& sum = smoothed_[smoothing_key(group, corners[c].vertex)];
                sum = sum + normal * std::acos(std::clamp(dot(a, b), -1.0, 1.0));
            }
        }
}

MeshBuffer Importer::mesh(const Shape& in, int material, std::vector<std::uint32_t>& vertices) const {
    bool any_normal = false, any_uv = false;
    for (std::size_t face = 0; face < in.materials.size(); ++face)
        if (in.materials[face] == material) {
            any_normal = any_normal || in.smoothing[face] != 0;
            for (std::size_t c = 3 * face; c < 3 * face + 3; ++c) {
                any_normal = any_normal || in.corners[c].normal >= 0;
                any_uv = any_uv || in.corners[c].coordinate >= 0;
            }
        }
    MeshBuffer result;
    std::unordered_map<Key, std::uint32_t, KeyHash> known;
    for (std::size_t face = 0; face < in.materials.size(); ++face) {
        if (in.materials[face] != material) continue;
        const Corner* corners = &in.corners[3 * face];
        const Vec3 flat = face_cross(model_, corners);
        if (!(length(flat) > 0)) continue; // has no area
        for (int c = 0; c < 3; ++c) {
            const Corner& i = corners[c];
            const std::uint32_t group = i.normal < 0 ? in.smoothing[face] : 0;
            const bool own = any_normal && i.normal < 0 && group == 0;
            const Key key{i.vertex, i.coordinate, i.normal, group, own ? face + 1 : 0};
            const auto [it, fresh] = known.try_emplace(key, result.vertex_count());
            result.indices.push_back(it->second);
            if (!fresh) continue;
            vertices.push_back(static_cast<std::uint32_t>(i.vertex));
            const float* p = &model_.vertices[3 * static_cast<std::size_t>(i.vertex)];
            result.positions.insert(result.positions.end(), p, p + 3);
            if (any_uv) {
                const auto at = 2 * static_cast<std::size_t>(std::max(i.coordinate, 0));
                const bool has = i.coordinate >= 0;
                result.uvs.push_back(has ? model_.coordinates[at] : 0);
                result.uvs.push_back(has ? model_.coordinates[at + 1] : 0);
            }
            if (any_normal) {
                Vec3 normal = flat;
                if (i.normal >= 0) {
                    const float* n = &model_.normals[3 * static_cast<std::size_t>(i.normal)];
                    normal = {n[0], n[1], n[2]};
                } else if (group != 0) {
                    normal = smoothed_.at(smoothing_key(group, i.vertex));
                }
                normal = normalized(normal, normalized(flat));
                for (const double x : normal)
                    result.normals.push_back(static_cast<float>(x));
            }
        }
    }
    return result;
}

// Vertices with colours (v x y z r g b) show them if the material has no picture; else the picture wins.
MadeMaterial Importer::colored(MeshBuffer& buffer, const std::vector<std::uint32_t>& vertices, int id,
                               const std::string& name) {
    const auto rgb = [&](std::uint32_t vertex) {
        const float* c = &model_.colors[3 * std::size_t{vertices[vertex]}];
        return Rgb{srgb_to_linear(double(c[0])), srgb_to_linear(double(c[1])), srgb_to_linear(double(c[2]))};
    };
    const auto white = [&](std::uint32_t i) { return rgb(i) == Rgb{1, 1, 1}; };
    if (model_.colors.empty() || std::all_of(buffer.indices.begin(), buffer.indices.end(), white)) return material(id);
    const Mtl* mtl = id < 0 ? nullptr : find(model_.materials[static_cast<std::size_t>(id)].first);
    if (mtl && !mtl->textures.empty()) {
        report_.dropped("object " + quote(name) + ": vertex colours", "its material has textures, which are shown");
        return material(id);
    }
    const std::vector<std::uint32_t> corners = buffer.indices; // bake_colors replaces them
    const RestageHandle image = bake_colors(out_, name + " colours", buffer,
                                            [&](std::size_t t, std::size_t c) { return rgb(corners[3 * t + c]); });
    if (!image) {
        report_.dropped("object " + quote(name) + ": vertex colours",
                        "it has too many triangles for a picture of them");
        return material(id);
    }
    report_.kept("object " + quote(name) + ": vertex colours", "as a texture");
    (void)material(id); // it is used
    Mtl plain;
    return make_material(mtl ? *mtl : plain, image);
}

void Importer::object(const MeshBuffer& buffer, const MadeMaterial& made, const Object& what) {
    const RestageHandle handle = buffer.push(out_, what.name, "");
    if (!handle || !made.material) return; // the host has reported why
    RestageInstance instance{};
    instance.name = what.name.c_str();
    instance.mesh = handle;
    instance.material = made.material;
    instance.group = what.group;
    instance.alpha_texture = made.alpha_texture;
    instance.alpha = made.alpha;
    if (made.emits) instance.flags = RESTAGE_INSTANCE_EMITS | RESTAGE_INSTANCE_TWO_SIDED;
    for (std::size_t i = 0; i < 3; ++i)
        instance.emission[i] = static_cast<float>(made.emission[i]);
    const Matrix to_world = placement_.of(translation(model_.origin));
    std::copy_n(to_world.m.begin(), 16, instance.object_to_world);
    if (!out_.instance(out_.ctx, &instance)) return;
    bounds_.add(buffer.bounds(), to_world);
    triangles_ += buffer.triangle_count();
    ++objects_;
}

void Importer::shape(const Shape& shape) {
    const std::set<int> used(shape.materials.begin(), shape.materials.end());
    const std::string name = shape.name.empty() ? path_.stem().string() : shape.name;
    RestageHandle group = 0;
    if (used.size() > 1 && !merge_) {
        const RestageGroup g = {.name = name.c_str(), .parent = 0};
        group = out_.group(out_.ctx, &g);
    }
    for (const int id : used) {
        std::vector<std::uint32_t> vertices;
        MeshBuffer buffer = mesh(shape, id, vertices);
        if (buffer.indices.empty()) {
            report_.dropped("object " + quote(name), "its faces have no area", shape.line);
            continue;
        }
        const std::string own_name =
            group && id >= 0 ? name + "/" + model_.materials[static_cast<std::size_t>(id)].first : name;
        const MadeMaterial made = colored(buffer, vertices, id, own_name);
        if (merge_)
            gather(std::move(buffer), made, id, own_name);
        else
            object(buffer, made, {own_name, group});
    }
}

// Triangles with and without normals or coordinates are separated, as a mesh has them for all of its vertices.
void Importer::gather(MeshBuffer buffer, const MadeMaterial& made, int id, const std::string& name) {
    const std::array<std::uint32_t, 3> key{made.material, !buffer.normals.empty(), !buffer.uvs.empty()};
    const auto [at, fresh] = gathered_at_.try_emplace(key, gathered_.size());
    if (fresh) {
        const std::string own = id >= 0 ? model_.materials[static_cast<std::size_t>(id)].first : name;
        gathered_.push_back({std::move(buffer), made, own});
        return;
    }
    MeshBuffer& all = gathered_[at->second].mesh;
    const std::uint32_t first = all.vertex_count();
    const auto append = [](std::vector<float>& to, const std::vector<float>& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    append(all.positions, buffer.positions), append(all.normals, buffer.normals), append(all.uvs, buffer.uvs);
    for (const std::uint32_t i : buffer.indices)
        all.indices.push_back(first + i);
}

void Importer::merged() {
    for (const Gathered& g : gathered_)
        object(g.mesh, g.material, {g.name, 0});
}

void Importer::strokes() {
    const auto add = [&](const Strokes& strokes, const char* what, std::size_t count) {
        if (strokes.mesh.indices.empty()) return;
        stroked_ = true;
        object(strokes.mesh, material(-1), {path_.stem().string() + " " + what, 0});
        report_.approximated(what,
                             "the file has no faces; its " + std::to_string(count) + " " + what + " get a radius of " +
                                 std::to_string(strokes.radius) +
                                 (strokes.step > 1 ? ", every " + std::to_string(strokes.step) + "th of them" : ""));
    };
    add(thick_lines(model_.vertices, model_.lines), "lines", model_.lines.size() / 2);
    add(thick_points(model_.vertices, model_.points), "points", model_.points.size());
}

} // namespace restage::obj
