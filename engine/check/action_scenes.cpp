// SPDX-License-Identifier: Apache-2.0
#include "check/action_scenes.hpp"

#include "check/export_scenes.hpp"
#include "scene/bounds.hpp"
#include "scene/edits.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::check {

using namespace scene;

namespace {

using Ids = std::vector<Id<Instance>>;

std::shared_ptr<const MeshData> mesh_of(std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles) {
    auto data = std::make_shared<MeshData>();
    data->positions = std::move(positions), data->triangles = std::move(triangles);
    compute_bounds(*data);
    return data;
}

// A height field of cells * cells * 2 triangles, z up.
std::shared_ptr<const MeshData> hills(std::uint32_t cells) {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (std::uint32_t y = 0; y <= cells; ++y)
        for (std::uint32_t x = 0; x <= cells; ++x) {
            const glm::vec2 at = 20.f * glm::vec2(x, y) / float(cells) - 10.f;
            positions.push_back({at.x, at.y, std::sin(at.x) * std::cos(0.7f * at.y)});
        }
    for (std::uint32_t y = 0; y < cells; ++y)
        for (std::uint32_t x = 0; x < cells; ++x) {
            const std::uint32_t a = y * (cells + 1) + x, b = a + cells + 1;
            triangles.push_back({a, a + 1, b + 1});
            triangles.push_back({a, b + 1, b});
        }
    return mesh_of(std::move(positions), std::move(triangles));
}

ActionScene meadow() {
    ActionScene made{.name = "hills with a tree and a stone", .scene = {}, .selections = {}};
    const auto add = [&]<class T>(T item) {
        const Id<T> id = table<T>(made.scene).next();
        apply(made.scene, insert(made.scene, std::move(item), "check"));
        return id;
    };
    const auto grass = add(Material{.name = "grass", .type = "diffuse"});
    const auto ground = add(Mesh{.name = "hills", .data = hills(40)});
    const auto corner = add(Mesh{.name = "corner",
                                 .data = mesh_of({{0, 0, 0}, {0.3f, 0, 0}, {0, 0.3f, 0}, {0, 0, 1}},
                                                 {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}})});
    const auto tree = add(Group{.name = "tree"});
    const auto up = [](double z) { return glm::translate(glm::dmat4(1), glm::dvec3(0, 0, z)); };
    const auto object = [&](const char* name, Id<Mesh> mesh, Id<Group> group, double z) {
        return add(Instance{.name = name, .mesh = mesh, .material = grass, .group = group, .object_to_world = up(z)});
    };
    const auto trunk = object("trunk", corner, tree, 2), crown = object("crown", corner, tree, 3);
    const auto stone = object("stone", corner, {}, 2), surface = object("hills", ground, {}, 0);
    const auto camera = add(Camera{.name = "camera", .camera_to_world = up(30)});
    apply(made.scene, *set_active_camera(made.scene, camera));
    made.selections = {{stone, surface}, {trunk, crown, stone, surface}};
    return made;
}

// Each with different objects.
std::vector<Ids> selections(Engine& e, const Scene& scene) {
    Ids all;
    scene.instances.each([&](Id<Instance> id, const Instance&) { all.push_back(id); });
    std::vector<Ids> found;
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{2}, all.size()}) {
        if (size > all.size()) continue;
        Ids ids = all;
        for (std::size_t i = ids.size(); i > 1; --i)
            std::swap(ids[i - 1], ids[e() % i]);
        ids.resize(size);
        if (std::ranges::find(found, ids) == found.end()) found.push_back(std::move(ids));
    }
    return found;
}

} // namespace

std::vector<ActionScene> action_scenes(Engine& e) {
    std::vector<ActionScene> all{{"a scene with every kind of thing", everything_scene(), {}},
                                 meadow(),
                                 {"a scene without objects", empty_scene(), {}}};
    for (ActionScene& one : all)
        for (Ids& ids : selections(e, one.scene))
            if (std::ranges::find(one.selections, ids) == one.selections.end())
                one.selections.push_back(std::move(ids));
    return all;
}

} // namespace restage::check
