// SPDX-License-Identifier: Apache-2.0
// Primitives: vertices with morph targets and skins in their first pose, tangents, vertex colours as pictures.
#include "common/tangents.hpp"
#include "importer.hpp"

#include <algorithm>
#include <cmath>

namespace restage::gltf {

namespace {

// Strips and fans as triangles, glTF 2.0, 3.7.2.1.
std::vector<std::uint32_t> as_triangles(const std::vector<std::uint32_t>& in, int mode) {
    std::vector<std::uint32_t> out;
    if (mode == TINYGLTF_MODE_TRIANGLES || mode < 0) {
        out.assign(in.begin(), in.begin() + static_cast<std::ptrdiff_t>(in.size() / 3 * 3));
        return out;
    }
    for (std::size_t i = 2; i < in.size(); ++i) {
        const std::size_t a = mode == TINYGLTF_MODE_TRIANGLE_FAN ? 0 : i - 2 + i % 2;
        const std::size_t b = mode == TINYGLTF_MODE_TRIANGLE_FAN ? i - 1 : i - 1 - i % 2;
        out.insert(out.end(), {in[a], in[b], in[i]});
    }
    return out;
}

template <class T, std::size_t N>
void gather(std::vector<T>& values, const std::vector<std::uint32_t>& order) { // N numbers per vertex
    std::vector<T> result;
    result.reserve(order.size() * N);
    for (const std::uint32_t i : order)
        result.insert(result.end(), values.begin() + static_cast<std::ptrdiff_t>(N * i),
                      values.begin() + static_cast<std::ptrdiff_t>(N * (i + 1)));
    values = std::move(result);
}

void unshare(MeshBuffer& mesh) { // each corner becomes a separate vertex
    gather<float, 3>(mesh.positions, mesh.indices);
    if (!mesh.normals.empty()) gather<float, 3>(mesh.normals, mesh.indices);
    if (!mesh.uvs.empty()) gather<float, 2>(mesh.uvs, mesh.indices);
    if (!mesh.uvs2.empty()) gather<float, 2>(mesh.uvs2, mesh.indices);
    if (!mesh.tangents.empty()) gather<float, 4>(mesh.tangents, mesh.indices);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        mesh.indices[i] = static_cast<std::uint32_t>(i);
}

// Size of the picture that holds the vertex colours of so many triangles, 2 x 2 texels each.
std::uint32_t picture_columns(std::uint32_t triangles) {
    return static_cast<std::uint32_t>(std::ceil(std::sqrt(double(triangles))));
}

Vec3 vec3(const std::vector<float>& v, std::size_t i) { return {v[3 * i], v[3 * i + 1], v[3 * i + 2]}; }
void set(std::vector<float>& v, std::size_t i, Vec3 p) {
    for (std::size_t c = 0; c < 3; ++c)
        v[3 * i + c] = static_cast<float>(p[c]);
}

} // namespace

void Importer::morph(const tinygltf::Primitive& p, const std::string& who, int node, int mesh, MeshBuffer& buffer) {
    const auto& own = model_.nodes[static_cast<std::size_t>(node)].weights;
    const auto& weights = own.empty() ? model_.meshes[static_cast<std::size_t>(mesh)].weights : own;
    if (p.targets.empty()) return;
    report_.approximated(who + ": morph targets", "the shape of the first moment is kept");
    for (std::size_t t = 0; t < p.targets.size() && t < weights.size(); ++t) {
        if (weights[t] == 0) continue;
        for (const auto& [name, accessor] : p.targets[t]) {
            std::vector<float>* values = name == "POSITION"  ? &buffer.positions
                                         : name == "NORMAL"  ? &buffer.normals
                                         : name == "TANGENT" ? &buffer.tangents
                                                             : nullptr;
            if (!values || values->empty()) continue;
            const auto delta = read_floats(model_, accessor, 3, who + ": morph target " + std::to_string(t));
            const std::size_t width = name == "TANGENT" ? 4 : 3; // of the vertex; the sign of a tangent stays
            if (delta.size() / 3 != values->size() / width)
                throw ImportError{who + ": morph target " + std::to_string(t) + " has another number of vertices"};
            for (std::size_t i = 0; i < delta.size(); ++i)
                (*values)[i / 3 * width + i % 3] += static_cast<float>(weights[t]) * delta[i];
        }
    }
}

// Vertices in world space, in the skeleton's current pose (glTF 2.0, 3.7.3.1).
void Importer::pose(const tinygltf::Primitive& p, const std::string& who, int node, MeshBuffer& buffer) {
    const int index = model_.nodes[static_cast<std::size_t>(node)].skin;
    const auto& skin = at(model_.skins, index, "skin", who);
    const std::size_t vertices = buffer.vertex_count();
    const auto joints = read_integers(model_, p.attributes.at("JOINTS_0"), 4, who + ": JOINTS_0");
    const auto weights = read_floats(model_, p.attributes.at("WEIGHTS_0"), 4, who + ": WEIGHTS_0");
    if (joints.size() != 4 * vertices || weights.size() != 4 * vertices)
        throw ImportError{who + ": joints or weights for another number of vertices"};
    if (p.attributes.contains("JOINTS_1")) report_.approximated(who, "only four joints per vertex are used");
    std::vector<Matrix> matrices(skin.joints.size());
    std::vector<float> inverse;
    if (skin.inverseBindMatrices >= 0)
        inverse = read_floats(model_, skin.inverseBindMatrices, 16, "skin " + std::to_string(index));
    for (std::size_t j = 0; j < matrices.size(); ++j) {
        at(model_.nodes, skin.joints[j], "node", "skin " + std::to_string(index));
        Matrix bind;
        if (inverse.size() >= 16 * (j + 1)) std::copy_n(&inverse[16 * j], 16, bind.m.begin());
        matrices[j] = world_[static_cast<std::size_t>(skin.joints[j])] * bind;
    }
    for (std::size_t i = 0; i < vertices; ++i) {
        Vec3 position{}, normal{}, tangent{};
        double total = 0;
        for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) {
            if (weights[k] == 0) continue;
            if (joints[k] >= matrices.size())
                throw ImportError{who + ": vertex " + std::to_string(i) + " is bound to joint " +
                                  std::to_string(joints[k]) + " of " + std::to_string(matrices.size())};
            const double w = static_cast<double>(weights[k]);
            position = position + transform_point(matrices[joints[k]], vec3(buffer.positions, i)) * w;
            if (!buffer.normals.empty())
                normal = normal + transform_vector(matrices[joints[k]], vec3(buffer.normals, i)) * w;
            if (!buffer.tangents.empty())
                tangent =
                    tangent + transform_vector(matrices[joints[k]], {buffer.tangents[4 * i], buffer.tangents[4 * i + 1],
                                                                     buffer.tangents[4 * i + 2]}) *
                                  w;
            total += w;
        }
        if (total > 0 && !buffer.tangents.empty())
            for (std::size_t c = 0; c < 3; ++c)
                buffer.tangents[4 * i + c] = static_cast<float>(normalized(tangent)[c]);
        if (total > 0) set(buffer.positions, i, position * (1 / total));
        if (total > 0 && !buffer.normals.empty()) set(buffer.normals, i, normalized(normal));
    }
}

// v upwards. `set` -1: no texture uses them, but the user may add one later.
std::vector<float> Importer::read_uvs(const tinygltf::Primitive& p, const std::string& who, int set,
                                      std::size_t vertices) {
    auto it = p.attributes.find("TEXCOORD_" + std::to_string(std::max(set, 0)));
    if (it == p.attributes.end() && set >= 0) {
        it = p.attributes.find("TEXCOORD_0");
        const std::string name = "TEXCOORD_" + std::to_string(set);
        report_.approximated(who,
                             it == p.attributes.end()
                                 ? "its textures lie on " + name + ", which it lacks: they show one of their corners"
                                 : "a texture lies on " + name + ", which it lacks; it lies on TEXCOORD_0");
        if (it == p.attributes.end()) return std::vector<float>(2 * vertices, 0.f);
    }
    if (it == p.attributes.end()) return {};
    std::vector<float> uvs = read_floats(model_, it->second, 2, who + ": " + it->first);
    for (std::size_t i = 1; i < uvs.size(); i += 2)
        uvs[i] = 1 - uvs[i];
    return uvs;
}

std::optional<MeshBuffer> Importer::read_primitive(const tinygltf::Primitive& p, const std::string& who, int node,
                                                   int mesh, const UvSets& sets, std::vector<float>& colors) {
    if (p.mode >= 0 && p.mode < TINYGLTF_MODE_TRIANGLES) {
        report_.dropped(who, "points and lines have no surface");
        return std::nullopt;
    }
    const auto accessor = [&](const std::string& name) {
        const auto it = p.attributes.find(name);
        return it == p.attributes.end() ? -1 : it->second;
    };
    if (accessor("POSITION") < 0) {
        report_.dropped(who, "it has no positions");
        return std::nullopt;
    }
    MeshBuffer buffer;
    buffer.positions = read_floats(model_, accessor("POSITION"), 3, who + ": POSITION");
    const std::size_t vertices = buffer.vertex_count();
    if (accessor("NORMAL") >= 0) buffer.normals = read_floats(model_, accessor("NORMAL"), 3, who + ": NORMAL");
    if (accessor("TANGENT") >= 0 && !buffer.normals.empty()) // ignored without normals (3.7.2.1)
        buffer.tangents = read_floats(model_, accessor("TANGENT"), 4, who + ": TANGENT");
    buffer.uvs = read_uvs(p, who, sets.texcoord[0], vertices);
    if (sets.texcoord[1] >= 0) buffer.uvs2 = read_uvs(p, who, sets.texcoord[1], vertices);
    if (accessor("COLOR_0") >= 0) colors = read_colors(model_, accessor("COLOR_0"), who + ": COLOR_0");
    if ((!buffer.normals.empty() && buffer.normals.size() != 3 * vertices) ||
        (!buffer.uvs.empty() && buffer.uvs.size() != 2 * vertices) ||
        (!buffer.uvs2.empty() && buffer.uvs2.size() != 2 * vertices) ||
        (!buffer.tangents.empty() && buffer.tangents.size() != 4 * vertices) ||
        (!colors.empty() && colors.size() != 4 * vertices))
        throw ImportError{who + ": its attributes have different numbers of vertices"};
    std::vector<std::uint32_t> order;
    if (p.indices >= 0) {
        order = read_integers(model_, p.indices, 1, who + ": indices");
    } else {
        order.resize(vertices);
        for (std::size_t i = 0; i < vertices; ++i)
            order[i] = static_cast<std::uint32_t>(i);
    }
    for (const std::uint32_t i : order)
        if (i >= vertices)
            throw ImportError{who + ": an index names vertex " + std::to_string(i) + " of " + std::to_string(vertices)};
    buffer.indices = as_triangles(order, p.mode);
    morph(p, who, node, mesh, buffer);
    const bool skinned = model_.nodes[static_cast<std::size_t>(node)].skin >= 0;
    if (skinned && accessor("JOINTS_0") >= 0 && accessor("WEIGHTS_0") >= 0) pose(p, who, node, buffer);
    if (buffer.indices.empty()) {
        report_.dropped(who, "it has no triangles");
        return std::nullopt;
    }
    return buffer;
}

// A texture of 2 x 2 texels per triangle, read at their centres: bilinear filtering of c0, c1, c2 and c1 + c2 - c0 is
// the linear interpolation over the triangle.
RestageHandle Importer::color_picture(const std::string& name, const std::vector<float>& colors, bool alpha,
                                      const MeshBuffer& buffer) {
    const std::uint32_t triangles = buffer.triangle_count(), columns = picture_columns(triangles);
    const std::uint32_t width = 2 * columns, height = 2 * ((triangles + columns - 1) / columns);
    return add_pixels(out_, name, width, height, alpha ? 1 : 3, [&](std::size_t pixel, unsigned channel) {
        const std::size_t x = pixel % width, y = pixel / width, triangle = y / 2 * columns + x / 2;
        if (triangle >= triangles) return 0.0;
        const auto c = [&](std::size_t corner) {
            return static_cast<double>(colors[4 * buffer.indices[3 * triangle + corner] + (alpha ? 3 : channel)]);
        };
        const std::size_t texel = x % 2 + 2 * (y % 2);
        return texel < 3 ? c(texel) : c(1) + c(2) - c(0);
    });
}

// Varying ones become pictures on a separate set of texture coordinates; corners are then no longer shared.
VertexColor Importer::vertex_color(const tinygltf::Primitive& p, const std::string& who,
                                   const std::vector<float>& colors, const UvSets& sets, MeshBuffer& buffer) {
    VertexColor result;
    if (colors.empty()) return result;
    std::array<double, 4> mean{};
    bool same = true, same_alpha = true;
    for (std::size_t i = 0; i < colors.size(); ++i) {
        mean[i % 4] += static_cast<double>(colors[i]) / static_cast<double>(colors.size() / 4);
        (i % 4 == 3 ? same_alpha : same) &= colors[i] == colors[i % 4];
    }
    const bool blends = p.material >= 0 &&
                        model_.materials[static_cast<std::size_t>(p.material)].alphaMode != "OPAQUE" &&
                        !model_.materials[static_cast<std::size_t>(p.material)].alphaMode.empty();
    const auto value = [&](std::size_t c, bool even) { return even ? static_cast<double>(colors[c]) : mean[c]; };
    result.factor = {value(0, same), value(1, same), value(2, same)};
    if (blends) result.alpha = value(3, same_alpha);
    if (same && (same_alpha || !blends)) return result;
    result.set = sets.texcoord[0] < 0 ? 0 : 1;
    const std::uint32_t triangles = buffer.triangle_count(), columns = picture_columns(triangles);
    if (columns > 8192 || (result.set == 1 && sets.texcoord[1] >= 0)) {
        report_.approximated(who + ": vertex colours",
                             columns > 8192
                                 ? "their mean is used: there are " + std::to_string(triangles) + " triangles"
                                 : std::string("their mean is used: textures lie on two sets of texture "
                                               "coordinates already"));
        return result;
    }
    if (!same) {
        result.factor = {1, 1, 1};
        result.image = color_picture(who + " colours", colors, false, buffer);
    }
    if (!same_alpha && blends) {
        result.alpha = 1;
        result.alpha_image = color_picture(who + " alpha", colors, true, buffer);
    }
    unshare(buffer);
    std::vector<float>& uvs = result.set == 0 ? buffer.uvs : buffer.uvs2;
    uvs.clear();
    const double width = 2 * columns, height = 2 * ((triangles + columns - 1) / columns);
    for (std::uint32_t t = 0; t < triangles; ++t)
        for (std::uint32_t corner = 0; corner < 3; ++corner) {
            const double x = t % columns * 2 + corner % 2 + 0.5, y = t / columns * 2 + corner / 2 + 0.5;
            uvs.push_back(static_cast<float>(x / width));
            uvs.push_back(static_cast<float>(1 - y / height));
        }
    report_.kept(who + ": vertex colours", "as a texture on separate texture coordinates");
    return result;
}

// The frame of normal maps: the file's tangents, else computed by MikkTSpace's rules from the normal map's coordinates.
void Importer::tangents(const tinygltf::Primitive& p, const std::string& who, const MadeMaterial& made,
                        MeshBuffer& buffer) {
    if (!made.needs_tangents) {
        buffer.tangents.clear();
        return;
    }
    if (!buffer.tangents.empty()) {
        const bool finite =
            std::all_of(buffer.tangents.begin(), buffer.tangents.end(), [](float x) { return std::isfinite(x); });
        if (finite) return;
        report_.approximated(who + ": TANGENT", "not all are finite; they are recomputed");
        buffer.tangents.clear();
    }
    if (made.normal.index < 0 && !p.attributes.contains("TEXCOORD_0")) return; // the engine's brushing direction
    const std::vector<float>& lies = made.uv.find(made.normal.set) == 1 ? buffer.uvs2 : buffer.uvs;
    if (lies.empty()) return;
    const UvTransform& t = made.normal.transform;
    std::vector<float> uv(lies.size());
    for (std::size_t i = 0; i < lies.size(); i += 2) {
        const double u = static_cast<double>(lies[i]), v = 1 - static_cast<double>(lies[i + 1]);
        uv[i] = static_cast<float>(t.a * u + t.b * v + t.x);
        uv[i + 1] = static_cast<float>(1 - (t.c * u + t.d * v + t.y));
    }
    make_tangents(buffer, std::move(uv));
}

std::optional<Importer::Piece> Importer::primitive(int mesh, std::size_t index, int node) {
    const auto& m = model_.meshes[static_cast<std::size_t>(mesh)];
    tinygltf::Primitive p = m.primitives[index];
    p.material = material_of(p);
    const auto& n = model_.nodes[static_cast<std::size_t>(node)];
    const bool shared = n.skin < 0 && n.weights.empty();
    const auto key = std::pair(mesh, index);
    if (const auto it = pieces_.find(key); shared && it != pieces_.end()) return it->second;
    std::string name = m.name.empty() ? "mesh " + std::to_string(mesh) : m.name;
    const std::string who = "mesh " + quote(name) + ", primitive " + std::to_string(index);
    if (m.primitives.size() > 1) name += " " + std::to_string(index + 1);
    std::vector<float> colors;
    std::optional<Piece> piece;
    const UvSets sets = uv_sets(p.material);
    if (auto buffer = read_primitive(p, who, node, mesh, sets, colors)) {
        const VertexColor color = vertex_color(p, who, colors, sets, *buffer);
        const MadeMaterial& made = material(p.material, color);
        tangents(p, who, made, *buffer);
        piece = Piece{buffer->push(out_, name, ""), buffer->bounds(), &made};
    }
    if (shared) pieces_[key] = piece;
    return piece;
}

} // namespace restage::gltf
