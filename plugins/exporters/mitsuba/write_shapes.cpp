// SPDX-License-Identifier: Apache-2.0
// Instances. What occurs once is a PLY with a transform; what occurs several times, alike but for the place, is a
// shapegroup and instances of it. Emitters are written one by one: Mitsuba does not instance them.
#include "exporter.hpp"

#include "common/text.hpp"

#include <algorithm>
#include <cmath>

namespace restage::mitsuba_out {

namespace {

bool is_missing(const RestageMesh& mesh) { return std::string_view(mesh.primitive).starts_with("missing "); }

// Everything but the transform; equal = may share a group.
std::string signature(const RestageInstance& i) {
    return std::to_string(i.mesh) + " " + std::to_string(i.material) + " " + std::to_string(i.alpha_texture) + " " +
           number(i.alpha) + " " + std::to_string(i.flags);
}

bool shareable(const RestageInstance& i) { return !(i.flags & (RESTAGE_INSTANCE_EMITS | RESTAGE_INSTANCE_HIDDEN)); }

Matrix place_of(const RestageInstance& i) {
    Matrix m;
    std::copy(i.object_to_world, i.object_to_world + 16, m.begin());
    return m;
}

} // namespace

// Winding agrees with the shading normals, which decide about the outside here (scene_io.h, invariant 2).
std::string Exporter::mesh_file(RestageHandle handle) {
    std::string& file = mesh_files_[handle];
    if (!file.empty()) return file;
    RestageMesh mesh{};
    in_.mesh(in_.ctx, handle, &mesh);
    const std::string what = std::string("mesh \"") + mesh.name + "\"";
    if (mesh.uvs2) approximated(what, "Mitsuba reads one set of texture coordinates; the second is left out");
    std::vector<std::uint32_t> indices(mesh.indices, mesh.indices + std::size_t{mesh.triangle_count} * 3);
    std::size_t mirrored = 0;
    for (std::size_t t = 0; t < mesh.triangle_count; ++t) {
        const std::uint32_t* v = &indices[3 * t];
        if (mesh.tangents) mirrored += mesh.tangents[4 * std::size_t{v[0]} + 3] < 0;
        if (!mesh.normals) continue;
        const auto at = [&](const float* list, std::size_t corner, std::size_t k) {
            return static_cast<double>(list[3 * std::size_t{v[corner]} + k]);
        };
        double along = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t k1 = (k + 1) % 3, k2 = (k + 2) % 3;
            const auto edge = [&](std::size_t corner, std::size_t axis) {
                return at(mesh.positions, corner, axis) - at(mesh.positions, 0, axis);
            };
            const double cross = edge(1, k1) * edge(2, k2) - edge(1, k2) * edge(2, k1);
            along += cross * (at(mesh.normals, 0, k) + at(mesh.normals, 1, k) + at(mesh.normals, 2, k));
        }
        if (along < 0) std::swap(indices[3 * t + 1], indices[3 * t + 2]);
    }
    if (mirrored > 0)
        approximated(what, "texture coordinates of " + std::to_string(mirrored) + " of its " +
                               std::to_string(mesh.triangle_count) +
                               " triangles are mirrored; without tangents Mitsuba turns a normal map's y over there");
    mesh.indices = indices.data();
    return file = places_.of_mesh(mesh);
}

void Exporter::finish_shape(Xml& xml, const RestageInstance& i, bool flipped) {
    const std::string what = std::string("instance \"") + i.name + "\"";
    report_kept(*i.origin, what);
    if (flipped) xml.flag("flip_normals", true);
    xml.ref(cut_out(i.material, i));
    if (i.has_medium_interface && (i.interior || i.exterior)) dropped(what, "media are not written");
    if (!(i.flags & RESTAGE_INSTANCE_EMITS)) return;
    xml.open("emitter", "area");
    xml.rgb("radiance", {i.emission[0], i.emission[1], i.emission[2]});
    xml.close();
    if (i.flags & RESTAGE_INSTANCE_TWO_SIDED)
        approximated("the light of \"" + std::string(i.name) + "\"", "Mitsuba's area lights shine from one side only");
    if (i.alpha_texture || i.alpha < 1)
        approximated("the light of \"" + std::string(i.name) + "\"",
                     "Mitsuba's lamps also shine, visibly, where alpha makes holes");
    RestageMaterialDesc m{};
    if ((i.flags & RESTAGE_INSTANCE_EMITS_BY_MATERIAL) && in_.material(in_.ctx, i.material, &m)) {
        const Values v(m.values, m.value_count);
        if (v.ref("radiance") || v.ref("emission_color"))
            approximated("the light of \"" + std::string(i.name) + "\"", "the mean of its texture is written");
    }
}

// A whole one, turned and scaled alike in all directions, without textures (whose coordinates differ).
bool Exporter::sphere(Xml& xml, const RestageInstance& i, const RestageMesh& mesh, const std::string& id) {
    const std::string_view primitive = mesh.primitive;
    if (!primitive.starts_with("sphere") || primitive.find('\n') != primitive.npos) return false;
    const double* m = i.object_to_world;
    RestageMaterialDesc material{};
    in_.material(in_.ctx, i.material, &material);
    bool plain =
        !i.alpha_texture && primitive.find("zm") == primitive.npos && primitive.find("phimax") == primitive.npos;
    for (std::uint32_t k = 0; k < material.value_count; ++k)
        plain = plain && RESTAGE_AT(RestageValue, material.values, k).ref == 0;
    const double size = std::cbrt(std::abs(determinant(m)));
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b) {
            const double product = m[4 * a] * m[4 * b] + m[4 * a + 1] * m[4 * b + 1] + m[4 * a + 2] * m[4 * b + 2];
            plain = plain && std::abs(product - (a == b ? size * size : 0)) <= 1e-5 * size * size;
        }
    double radius = 0; // of the triangles, which lie on it
    for (std::size_t v = 0; v < mesh.vertex_count; ++v) {
        const float* p = mesh.positions + 3 * v;
        radius = std::max(radius, std::hypot(double(p[0]), double(p[1]), double(p[2])));
    }
    if (!plain || radius == 0) return false;
    xml.open("shape", "sphere", id);
    xml.point("center", {m[12], m[13], m[14]});
    xml.put("radius", static_cast<float>(radius * size));
    finish_shape(xml, i, (i.flags & RESTAGE_INSTANCE_REVERSE_ORIENTATION) != 0);
    xml.close();
    return true;
}

void Exporter::shape(Xml& xml, const RestageInstance& i, bool in_group, const std::string& id) {
    RestageMesh mesh{};
    in_.mesh(in_.ctx, i.mesh, &mesh);
    if (!in_group && sphere(xml, i, mesh, id)) return;
    for (const char* exact : {"sphere", "disk", "cylinder"})
        if (std::string_view(mesh.primitive).starts_with(exact))
            approximated(std::string("instance \"") + i.name + "\"",
                         std::string("this ") + exact + " is written as triangles");
    xml.open("shape", "ply", id);
    xml.put("filename", std::string_view(mesh_file(i.mesh)));
    if (!mesh.normals) xml.flag("face_normals", true);
    const bool turns = !in_group && determinant(i.object_to_world) < 0; // Mitsuba takes edges after the transform
    if (!in_group && !is_identity(i.object_to_world)) xml.matrix("to_world", place_of(i));
    finish_shape(xml, i, ((i.flags & RESTAGE_INSTANCE_REVERSE_ORIENTATION) != 0) != turns);
    xml.close();
}

bool Exporter::shapes() {
    const std::uint32_t instances = in_.count(in_.ctx, RESTAGE_KIND_INSTANCE);
    RestageInstance i{};
    RestageMesh mesh{};
    std::map<std::string, unsigned> uses;
    for (RestageHandle h = 1; h <= instances; ++h)
        if (in_.instance(in_.ctx, h, &i) && shareable(i)) ++uses[signature(i)];
    for (RestageHandle h = 1; h <= instances; ++h) {
        if (h % 64 == 0 &&
            !in_.progress(in_.ctx, 0.1f + 0.8f * static_cast<float>(h) / static_cast<float>(instances), "shapes"))
            return false;
        if (!in_.instance(in_.ctx, h, &i) || !in_.mesh(in_.ctx, i.mesh, &mesh)) continue;
        const std::string what = std::string("instance \"") + i.name + "\"";
        if (i.flags & RESTAGE_INSTANCE_HIDDEN) {
            dropped(what, "it is hidden, and left out");
            continue;
        }
        if (is_missing(mesh)) {
            dropped(what, "it stands for something that could not be read, and is left out");
            continue;
        }
        if (mesh.triangle_count == 0) {
            dropped(what, "it has no triangles");
            continue;
        }
        const std::string id = unique_id("shape", i.name);
        if (!shareable(i) || uses[signature(i)] < 2 || !inverse(i.object_to_world)) {
            shape(shapes_, i, false, id);
            continue;
        }
        std::string& group = groups_[signature(i)];
        if (group.empty()) {
            group = unique_id("group", mesh.name);
            shapes_.open("shape", "shapegroup", group);
            shape(shapes_, i, true, "");
            shapes_.close();
        }
        shapes_.open("shape", "instance", id);
        shapes_.ref(group);
        shapes_.matrix("to_world", place_of(i));
        shapes_.close();
    }
    return true;
}

} // namespace restage::mitsuba_out
