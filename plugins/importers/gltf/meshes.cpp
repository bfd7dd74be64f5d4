// SPDX-License-Identifier: Apache-2.0
// Primitives: vertices with morph targets and skins in their first pose, vertex colours as pictures, and the triangles
// that an emissive texture lights apart from those it does not.
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
void gather(std::vector<T>& values, const std::vector<std::uint32_t>& order) { // N numbers a vertex
    std::vector<T> result;
    result.reserve(order.size() * N);
    for (const std::uint32_t i : order)
        result.insert(result.end(), values.begin() + static_cast<std::ptrdiff_t>(N * i),
                      values.begin() + static_cast<std::ptrdiff_t>(N * (i + 1)));
    values = std::move(result);
}

void unshare(MeshBuffer& mesh) { // each corner a vertex of its own
    gather<float, 3>(mesh.positions, mesh.indices);
    if (!mesh.normals.empty()) gather<float, 3>(mesh.normals, mesh.indices);
    if (!mesh.uvs.empty()) gather<float, 2>(mesh.uvs, mesh.indices);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        mesh.indices[i] = static_cast<std::uint32_t>(i);
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
            std::vector<float>* values = name == "POSITION" ? &buffer.positions
                                         : name == "NORMAL" ? &buffer.normals
                                                            : nullptr;
            if (!values || values->empty()) continue;
            const auto delta = read_floats(model_, accessor, 3, who + ": morph target " + std::to_string(t));
            if (delta.size() != values->size())
                throw ImportError{who + ": morph target " + std::to_string(t) + " has another number of vertices"};
            for (std::size_t i = 0; i < delta.size(); ++i)
                (*values)[i] += static_cast<float>(weights[t]) * delta[i];
        }
    }
}

// Vertices in world space, as the skeleton's nodes stand (glTF 2.0, 3.7.3.1).
void Importer::pose(const tinygltf::Primitive& p, const std::string& who, int node, MeshBuffer& buffer) {
    const int index = model_.nodes[static_cast<std::size_t>(node)].skin;
    const auto& skin = at(model_.skins, index, "skin", who);
    const std::size_t vertices = buffer.vertex_count();
    const auto joints = read_integers(model_, p.attributes.at("JOINTS_0"), 4, who + ": JOINTS_0");
    const auto weights = read_floats(model_, p.attributes.at("WEIGHTS_0"), 4, who + ": WEIGHTS_0");
    if (joints.size() != 4 * vertices || weights.size() != 4 * vertices)
        throw ImportError{who + ": joints or weights for another number of vertices"};
    if (p.attributes.contains("JOINTS_1")) report_.approximated(who, "only four joints a vertex are used");
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
        Vec3 position{}, normal{};
        double total = 0;
        for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) {
            if (weights[k] == 0) continue;
            if (joints[k] >= matrices.size())
                throw ImportError{who + ": vertex " + std::to_string(i) + " hangs on joint " +
                                  std::to_string(joints[k]) + " of " + std::to_string(matrices.size())};
            const double w = static_cast<double>(weights[k]);
            position = position + transform_point(matrices[joints[k]], vec3(buffer.positions, i)) * w;
            if (!buffer.normals.empty())
                normal = normal + transform_vector(matrices[joints[k]], vec3(buffer.normals, i)) * w;
            total += w;
        }
        if (total > 0) set(buffer.positions, i, position * (1 / total));
        if (total > 0 && !buffer.normals.empty()) set(buffer.normals, i, normalized(normal));
    }
}

std::optional<MeshBuffer> Importer::read_primitive(const tinygltf::Primitive& p, const std::string& who, int node,
                                                   int mesh, const UvPlan& plan, std::vector<float>& colors) {
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
    std::string set = "TEXCOORD_" + std::to_string(plan.set);
    if (accessor(set) < 0) set = "TEXCOORD_0";
    if (accessor(set) >= 0) buffer.uvs = read_floats(model_, accessor(set), 2, who + ": " + set);
    if (accessor("COLOR_0") >= 0) colors = read_colors(model_, accessor("COLOR_0"), who + ": COLOR_0");
    if ((!buffer.normals.empty() && buffer.normals.size() != 3 * vertices) ||
        (!buffer.uvs.empty() && buffer.uvs.size() != 2 * vertices) ||
        (!colors.empty() && colors.size() != 4 * vertices))
        throw ImportError{who + ": its attributes have different numbers of vertices"};
    for (std::size_t i = 0; i < buffer.uvs.size(); i += 2) {
        const UvTransform& t = plan.baked;
        const double u = static_cast<double>(buffer.uvs[i]), v = static_cast<double>(buffer.uvs[i + 1]);
        buffer.uvs[i] = static_cast<float>(t.a * u + t.b * v + t.x);
        buffer.uvs[i + 1] = static_cast<float>(1 - (t.c * u + t.d * v + t.y)); // v upwards
    }
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

// A texture of 2 x 2 texels a triangle, read at their centres: bilinear filtering of c0, c1, c2 and c1 + c2 - c0 is the
// linear interpolation over the triangle. Corners are no longer shared.
VertexColor Importer::vertex_color(const tinygltf::Primitive& p, const std::string& who,
                                   const std::vector<float>& colors, MeshBuffer& buffer) {
    VertexColor result;
    if (colors.empty()) return result;
    const auto rgb = [&](std::size_t i) { return Rgb{colors[4 * i], colors[4 * i + 1], colors[4 * i + 2]}; };
    Rgb mean{};
    bool same = true;
    for (std::size_t i = 0; i < colors.size() / 4; ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            mean[c] += rgb(i)[c] / static_cast<double>(colors.size() / 4);
        same = same && rgb(i) == rgb(0);
    }
    const bool textured = [&] {
        if (p.material < 0) return false;
        const auto& m = model_.materials[static_cast<std::size_t>(p.material)];
        return m.pbrMetallicRoughness.baseColorTexture.index >= 0 || m.normalTexture.index >= 0 ||
               m.pbrMetallicRoughness.metallicRoughnessTexture.index >= 0 || m.emissiveTexture.index >= 0;
    }();
    const std::uint32_t triangles = buffer.triangle_count();
    const auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(double(triangles))));
    const std::uint32_t rows = (triangles + columns - 1) / columns;
    if (same || textured || columns > 8192) {
        result.factor = same ? rgb(0) : mean;
        if (!same)
            report_.approximated(who + ": vertex colours", "their mean is used: the material has textures already");
        return result;
    }
    std::vector<std::uint32_t> corners = buffer.indices;
    const std::uint32_t width = 2 * columns, height = 2 * rows;
    result.image = add_pixels(out_, who + " colours", width, height, 3, [&](std::size_t pixel, unsigned channel) {
        const std::size_t x = pixel % width, y = pixel / width, triangle = y / 2 * columns + x / 2;
        if (triangle >= triangles) return 0.0;
        const auto c = [&](std::size_t corner) { return rgb(corners[3 * triangle + corner])[channel]; };
        const std::size_t texel = x % 2 + 2 * (y % 2);
        return texel < 3 ? c(texel) : c(1) + c(2) - c(0);
    });
    unshare(buffer);
    buffer.uvs.clear();
    for (std::uint32_t t = 0; t < triangles; ++t)
        for (std::uint32_t corner = 0; corner < 3; ++corner) {
            const double x = t % columns * 2 + corner % 2 + 0.5, y = t / columns * 2 + corner / 2 + 0.5;
            buffer.uvs.push_back(static_cast<float>(x / width));
            buffer.uvs.push_back(static_cast<float>(1 - y / height));
        }
    report_.kept(who + ": vertex colours", "as a texture; the object has no other texture coordinates");
    return result;
}

// Emission is one value an instance. Triangles that the picture leaves dark do not emit; the others emit its mean.
std::vector<Importer::Piece> Importer::by_emission(MeshBuffer buffer, const MadeMaterial& made,
                                                   const std::string& name) {
    const auto piece = [&](const MeshBuffer& part, const std::string& part_name, Rgb emission) {
        return Piece{part.push(out_, part_name, ""), part.bounds(), emission, &made};
    };
    const int index = made.emission_texture ? image_of(made.emission_texture) : -1;
    const Picture* p = index >= 0 && !buffer.uvs.empty() ? picture(index) : nullptr;
    if (!made.emission_texture || (!p && index < 0)) return {piece(buffer, name, made.emission)};
    if (!p) return {piece(buffer, name, {})}; // reported
    bool mirror_u = false, mirror_v = false;
    const Mapping map = mapping(made.emission_texture, made.uv, mirror_u, mirror_v, made.name);
    const auto sample = [&](double u, double v) {
        const double s = u * map.scale_u + map.offset_u, t = 1 - (v * map.scale_v + map.offset_v);
        const auto texel = [](double x, std::uint32_t size) {
            return std::min(static_cast<std::size_t>((x - std::floor(x)) * size), std::size_t{size} - 1);
        };
        const std::size_t pixel = texel(t, p->height) * p->width + texel(s, p->width);
        return Rgb{srgb_to_linear(p->value(pixel, 0)), srgb_to_linear(p->value(pixel, 1)),
                   srgb_to_linear(p->value(pixel, 2))};
    };
    MeshBuffer bright = buffer, dark = buffer;
    bright.indices.clear(), dark.indices.clear();
    Rgb sum{};
    double area = 0;
    for (std::size_t i = 0; i < buffer.indices.size(); i += 3) {
        const std::uint32_t* corner = &buffer.indices[i];
        Rgb mean{};
        constexpr int n = 4; // points of a regular grid inside the triangle
        for (int a = 0; a < n; ++a)
            for (int b = 0; b < n - a; ++b) {
                const double wa = (a + 1.0 / 3) / n, wb = (b + 1.0 / 3) / n, wc = 1 - wa - wb;
                const auto mix = [&](std::size_t c) {
                    return wa * static_cast<double>(buffer.uvs[2 * corner[0] + c]) +
                           wb * static_cast<double>(buffer.uvs[2 * corner[1] + c]) +
                           wc * static_cast<double>(buffer.uvs[2 * corner[2] + c]);
                };
                const Rgb at_point = sample(mix(0), mix(1));
                for (std::size_t c = 0; c < 3; ++c)
                    mean[c] += at_point[c] / (n * (n + 1) / 2);
            }
        MeshBuffer& part = std::max({mean[0], mean[1], mean[2]}) > 0.01 ? bright : dark;
        part.indices.insert(part.indices.end(), corner, corner + 3);
        if (&part == &dark) continue;
        const Vec3 o = buffer.position(corner[0]);
        const double size = length(cross(buffer.position(corner[1]) - o, buffer.position(corner[2]) - o));
        area += size;
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += mean[c] * size;
    }
    for (std::size_t c = 0; c < 3; ++c)
        sum[c] = area > 0 ? sum[c] / area * made.emission[c] : 0;
    report_.approximated(name + ": emissive texture",
                         "triangles emit evenly: the mean of the picture where it is not dark");
    std::vector<Piece> pieces;
    if (!dark.indices.empty()) pieces.push_back(piece(dark, name, {}));
    if (!bright.indices.empty()) pieces.push_back(piece(bright, dark.indices.empty() ? name : name + " (emits)", sum));
    return pieces;
}

std::vector<Importer::Piece> Importer::primitive(int mesh, std::size_t index, int node) {
    const auto& m = model_.meshes[static_cast<std::size_t>(mesh)];
    const auto& p = m.primitives[index];
    const auto& n = model_.nodes[static_cast<std::size_t>(node)];
    const bool shared = n.skin < 0 && n.weights.empty();
    const auto key = std::pair(mesh, index);
    if (const auto it = pieces_.find(key); shared && it != pieces_.end()) return it->second;
    std::string name = m.name.empty() ? "mesh " + std::to_string(mesh) : m.name;
    const std::string who = "mesh " + quote(name) + ", primitive " + std::to_string(index);
    if (m.primitives.size() > 1) name += " " + std::to_string(index + 1);
    std::vector<float> colors;
    std::vector<Piece> pieces;
    if (auto buffer = read_primitive(p, who, node, mesh, uv_plan(p.material), colors)) {
        const VertexColor color = vertex_color(p, who, colors, *buffer);
        const MadeMaterial& made = material(p.material, color);
        if (p.extensions.contains("KHR_materials_variants"))
            report_.dropped(who + ": variants", "the first material is shown");
        pieces = by_emission(std::move(*buffer), made, name);
    }
    if (shared) pieces_[key] = pieces;
    return pieces;
}

} // namespace restage::gltf
