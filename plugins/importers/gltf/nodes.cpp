// SPDX-License-Identifier: Apache-2.0
// The node hierarchy: a node with several things below it becomes a group, each primitive of its mesh an instance.
#include "importer.hpp"

#include <algorithm>
#include <cmath>

namespace restage::gltf {

namespace {

constexpr int deepest = 512; // nodes below each other

Matrix rotation(double x, double y, double z, double w) { // of a unit quaternion; others are normalised
    const double n = x * x + y * y + z * z + w * w, s = n > 0 ? 2 / n : 0;
    Matrix m;
    m.set_column(0, {1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)});
    m.set_column(1, {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)});
    m.set_column(2, {s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)});
    return m;
}

Matrix placed(Vec3 t, const Matrix& turned, Vec3 scale) { // T * R * S, glTF 2.0, 3.5.3
    Matrix m = turned;
    for (int c = 0; c < 3; ++c)
        m.set_column(c, turned.column(c) * scale[static_cast<std::size_t>(c)]);
    m.set_column(3, t);
    return m;
}

Matrix local_transform(const tinygltf::Node& node, const std::string& who) {
    Matrix m;
    if (node.matrix.size() == 16) {
        std::copy_n(node.matrix.begin(), 16, m.m.begin());
    } else {
        const auto vec = [](const std::vector<double>& v, double otherwise) {
            return v.size() == 3 ? Vec3{v[0], v[1], v[2]} : Vec3{otherwise, otherwise, otherwise};
        };
        const auto& q = node.rotation;
        m = placed(vec(node.translation, 0), q.size() == 4 ? rotation(q[0], q[1], q[2], q[3]) : Matrix(),
                   vec(node.scale, 1));
    }
    if (!is_affine(m)) throw ImportError{who + ": its transform is not finite, or not affine"};
    return m;
}

} // namespace

std::string Importer::node_name(int index) const {
    const auto& node = model_.nodes[static_cast<std::size_t>(index)];
    if (!node.name.empty()) return node.name;
    if (node.mesh >= 0 && static_cast<std::size_t>(node.mesh) < model_.meshes.size())
        if (const std::string& name = model_.meshes[static_cast<std::size_t>(node.mesh)].name; !name.empty())
            return name;
    return "node " + std::to_string(index);
}

// The root nodes: those of the default scene; without scenes, those without a parent (3.5.1).
std::vector<int> Importer::choose_roots() {
    std::vector<std::string> names;
    for (const auto& scene : model_.scenes)
        names.push_back(scene.name);
    tell_choices("scene", names, 2);
    const std::optional<int> wanted = asked("scene", names);
    if (model_.scenes.empty()) {
        std::vector<char> child(model_.nodes.size());
        for (const auto& node : model_.nodes)
            for (const int c : node.children)
                if (c >= 0 && static_cast<std::size_t>(c) < child.size()) child[static_cast<std::size_t>(c)] = 1;
        std::vector<int> roots;
        for (std::size_t i = 0; i < child.size(); ++i)
            if (!child[i]) roots.push_back(static_cast<int>(i));
        if (roots.empty()) throw ImportError{"the file holds no scene and no root node"};
        report_.kept("scene", "the file names none; its " + std::to_string(roots.size()) + " root nodes are shown");
        return roots;
    }
    int index = wanted.value_or(model_.defaultScene);
    if (index < 0) {
        index = 0;
        while (index + 1 < static_cast<int>(model_.scenes.size()) &&
               model_.scenes[static_cast<std::size_t>(index)].nodes.empty())
            ++index;
        if (model_.scenes.size() > 1)
            report_.kept("scene " + quote(scene_name(index)),
                         "the file names no default; the first non-empty one is opened");
    }
    const auto& scene = at(model_.scenes, index, "scene", "the file");
    for (std::size_t i = 0; i < model_.scenes.size(); ++i)
        if (static_cast<int>(i) != index && !model_.scenes[i].nodes.empty())
            report_.dropped("scene " + quote(scene_name(static_cast<int>(i))),
                            wanted ? "the file contains several; another one was requested"
                                   : "the file contains several; its default one is opened (import option scene)");
    return scene.nodes;
}

std::string Importer::scene_name(int index) const {
    const std::string& name = model_.scenes[static_cast<std::size_t>(index)].name;
    return name.empty() ? std::to_string(index) : name;
}

void Importer::find_transforms(int index, const Matrix& parent, bool hidden, int depth) {
    const std::string who = "node " + std::to_string(index);
    const auto& node = at(model_.nodes, index, "node", "the scene");
    auto& visits = visits_[static_cast<std::size_t>(index)];
    if (visits++ > 0) throw ImportError{who + " occurs in the hierarchy twice, or below itself"};
    if (depth > deepest) throw ImportError{who + ": nodes lie more than " + std::to_string(deepest) + " deep"};
    world_[static_cast<std::size_t>(index)] = parent * local_transform(node, who);
    if (const auto v = node.extensions.find("KHR_node_visibility"); v != node.extensions.end() && v->second.IsObject())
        hidden |=
            v->second.Has("visible") && v->second.Get("visible").IsBool() && !v->second.Get("visible").Get<bool>();
    hidden_[static_cast<std::size_t>(index)] = hidden;
    for (const int child : node.children)
        find_transforms(child, world_[static_cast<std::size_t>(index)], hidden, depth + 1);
}

bool Importer::shows_something(int index) const {
    const auto& node = model_.nodes[static_cast<std::size_t>(index)];
    return node.mesh >= 0 ||
           std::any_of(node.children.begin(), node.children.end(), [&](int child) { return shows_something(child); });
}

std::vector<Matrix> Importer::placements(int index) {
    const auto& node = model_.nodes[static_cast<std::size_t>(index)];
    const Matrix own = world_[static_cast<std::size_t>(index)];
    const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
    if (extension == node.extensions.end() || !extension->second.IsObject() || !extension->second.Has("attributes"))
        return {own};
    const auto& attributes = extension->second.Get("attributes");
    const std::string who = "node " + std::to_string(index) + ": EXT_mesh_gpu_instancing";
    const auto values = [&](const char* key, int components) {
        const auto accessor = static_cast<int>(number_of(attributes, key, -1));
        return accessor < 0 ? std::vector<float>() : read_floats(model_, accessor, components, who + " " + key);
    };
    const auto t = values("TRANSLATION", 3), r = values("ROTATION", 4), s = values("SCALE", 3);
    const std::size_t count = std::max({t.size() / 3, r.size() / 4, s.size() / 3});
    const auto fits = [&](const std::vector<float>& v, std::size_t n) { return v.empty() || v.size() == n * count; };
    if (!fits(t, 3) || !fits(r, 4) || !fits(s, 3)) throw ImportError{who + ": its attributes have different lengths"};
    std::vector<Matrix> result;
    for (std::size_t i = 0; i < count; ++i) {
        const auto vec = [&](const std::vector<float>& v, double otherwise) {
            return v.empty() ? Vec3{otherwise, otherwise, otherwise} : Vec3{v[3 * i], v[3 * i + 1], v[3 * i + 2]};
        };
        result.push_back(
            own * placed(vec(t, 0), r.empty() ? Matrix() : rotation(r[4 * i], r[4 * i + 1], r[4 * i + 2], r[4 * i + 3]),
                         vec(s, 1)));
    }
    report_.kept(who, std::to_string(count) + " instances");
    return result;
}

void Importer::mesh_node(int index, RestageHandle group, const std::string& name) {
    const auto& node = model_.nodes[static_cast<std::size_t>(index)];
    const auto& mesh = at(model_.meshes, node.mesh, "mesh", "node " + std::to_string(index));
    std::vector<Piece> pieces;
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p)
        if (const auto piece = primitive(node.mesh, p, index)) pieces.push_back(*piece);
    const bool hidden = hidden_[static_cast<std::size_t>(index)] != 0;
    const auto places = placements(index);
    if (pieces.size() * places.size() > 1) {
        const RestageGroup g = {.name = name.c_str(), .parent = group};
        group = out_.group(out_.ctx, &g);
    }
    for (Matrix place : places) {
        // Skinned vertices are in world space; the mesh's node is ignored (glTF 2.0, 3.7.3.3).
        if (node.skin >= 0 && !mesh.primitives.empty() && mesh.primitives[0].attributes.contains("JOINTS_0"))
            place = Matrix();
        if (!(std::abs(determinant(place)) > 0)) {
            report_.dropped("node " + quote(name), "its transform flattens it to nothing");
            continue;
        }
        for (const Piece& piece : pieces) {
            if (!piece.mesh || !piece.material || !piece.material->material) continue; // the host has reported why
            const MadeMaterial& m = *piece.material;
            RestageInstance instance{};
            instance.name = name.c_str();
            instance.mesh = piece.mesh;
            instance.material = m.material;
            instance.group = group;
            instance.alpha_texture = m.alpha_texture;
            instance.alpha = m.alpha;
            instance.interior = m.interior;
            instance.has_medium_interface = m.has_interior;
            if (hidden) instance.flags |= RESTAGE_INSTANCE_HIDDEN;
            if (std::max({m.emission[0], m.emission[1], m.emission[2]}) > 0) {
                instance.flags |=
                    RESTAGE_INSTANCE_EMITS | (m.two_sided ? std::uint32_t(RESTAGE_INSTANCE_TWO_SIDED) : 0u);
                for (std::size_t i = 0; i < 3; ++i)
                    instance.emission[i] = static_cast<float>(std::max(m.emission[i], 0.0));
                ++emitters_;
            }
            std::copy(place.m.begin(), place.m.end(), instance.object_to_world);
            if (!out_.instance(out_.ctx, &instance)) continue;
            (hidden ? hidden_bounds_ : bounds_).add(piece.bounds, place);
            hidden_objects_ += hidden;
            ++objects_;
        }
    }
}

void Importer::node(int index, RestageHandle group) {
    if (!shows_something(index)) return;
    const auto& node = model_.nodes[static_cast<std::size_t>(index)];
    const std::string name = node_name(index);
    progress(0.1f + 0.9f * static_cast<float>(nodes_done_++) / static_cast<float>(model_.nodes.size()),
             "making objects");
    const auto visible =
        std::count_if(node.children.begin(), node.children.end(), [&](int c) { return shows_something(c); });
    if (visible > 0 && (visible > 1 || node.mesh >= 0 || !node.name.empty())) {
        const RestageGroup g = {.name = name.c_str(), .parent = group};
        group = out_.group(out_.ctx, &g);
    }
    if (node.mesh >= 0) mesh_node(index, group, name);
    for (const int child : node.children)
        this->node(child, group);
}

} // namespace restage::gltf
