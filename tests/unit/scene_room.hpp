// SPDX-License-Identifier: Apache-2.0
// The small scene used by the tests of scene/.
#pragma once

#include "scene/bounds.hpp"
#include "scene/edits.hpp"
#include "scene/tables.hpp"

#include <limits>
#include <memory>

namespace restage::test {

inline std::shared_ptr<scene::MeshData> triangle() {
    auto data = std::make_shared<scene::MeshData>();
    data->positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
    data->triangles = {{0, 1, 2}};
    scene::compute_bounds(*data);
    return data;
}

struct Room { // two chairs and a lamp in groups, two materials, one camera
    scene::Scene scene;
    scene::Id<scene::Mesh> mesh;
    scene::Id<scene::Material> oak, steel;
    scene::Id<scene::Group> room, chairs;
    scene::Id<scene::Instance> chair, chair2, lamp;
    scene::Id<scene::Camera> camera;

    template <class T>
    scene::Id<T> add(T item) {
        const scene::Id<T> id = scene::table<T>(scene).next();
        scene::apply(scene, scene::insert(scene, std::move(item), "add"));
        return id;
    }
    Room() {
        mesh = add(scene::Mesh{.name = "triangle", .data = triangle()});
        oak = add(scene::Material{.name = "oak", .type = "diffuse"});
        steel = add(scene::Material{.name = "steel", .type = "conductor"});
        room = add(scene::Group{.name = "room"});
        chairs = add(scene::Group{.name = "chairs", .parent = room});
        chair = add(scene::Instance{.name = "chair", .mesh = mesh, .material = oak, .group = chairs});
        chair2 = add(scene::Instance{.name = "chair 2", .mesh = mesh, .material = oak, .group = chairs});
        lamp = add(scene::Instance{.name = "lamp", .mesh = mesh, .material = steel, .group = room});
        camera = add(scene::Camera{.name = "camera"});
        scene::apply(scene, *scene::set_active_camera(scene, camera));
    }
};

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

} // namespace restage::test
