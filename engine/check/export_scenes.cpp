// SPDX-License-Identifier: Apache-2.0
#include "check/export_scenes.hpp"

#include "check/configs.hpp"
#include "scene/bounds.hpp"
#include "scene/edits.hpp"

#include <glm/gtc/matrix_transform.hpp>

namespace restage::check {

using namespace scene;

namespace {

struct Building {
    Scene scene;
    template <class T>
    Id<T> add(T item) {
        const Id<T> id = table<T>(scene).next();
        apply(scene, insert(scene, std::move(item), "check"));
        return id;
    }
};

std::shared_ptr<const MeshData> square(bool normals, bool uvs) {
    auto data = std::make_shared<MeshData>();
    data->positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    if (normals) data->normals.assign(4, {0, 0, 1});
    if (uvs) data->uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    data->triangles = {{0, 1, 2}, {0, 2, 3}};
    compute_bounds(*data);
    return data;
}

} // namespace

Scene everything_scene() {
    Building b;
    const auto plain = b.add(Mesh{.name = "plain", .data = square(false, false)});
    const auto full = b.add(Mesh{.name = "with \"everything\"", .data = square(true, true)});
    const auto gone = b.add(Mesh{.name = "gone", .data = square(false, false)});
    PixelData pixels{.width = 2, .height = 2, .channels = 3, .values = std::vector<float>(12, 0.25f)};
    const auto image = b.add(Image{.name = "in memory", .data = std::make_shared<PixelData>(pixels)});
    b.add(Image{.name = "missing", .path = "/nowhere/missing.png"});
    const auto texture = b.add(Texture{.name = "Fläche 板", .type = "imagemap", .image = image});
    Texture checks{.name = "checks", .type = "checkerboard"};
    checks.params.set("tex1", Value{.type = model::ParamType::color, .texture = texture});
    checks.params.set("uscale", Value::number(4));
    const auto checker = b.add(std::move(checks));
    b.add(Texture{.name = "strange", .type = "no such texture", .is_float = true});
    Material matte{.name = "matte", .type = "diffuse"};
    matte.params.set("reflectance", Value{.type = model::ParamType::color, .texture = checker});
    const auto diffuse = b.add(std::move(matte));
    Material strange{.name = "of a missing plugin", .type = "nosuchmaterial"};
    strange.params.set("gloss", Value::number(0.5f));
    strange.params.set("mode", Value::choice("soft"));
    const auto unknown = b.add(std::move(strange));
    const auto fog = b.add(Medium{.name = "fog", .sigma_a = glm::vec3(0.1f), .sigma_s = glm::vec3(0.2f), .g = 0.3f});
    const auto room = b.add(Group{.name = "room"});
    const auto inner = b.add(Group{.name = "", .parent = room});
    const auto at = [](double x) { return glm::translate(glm::dmat4(1), glm::dvec3(x, 0, 1e-3 * x)); };
    b.add(Instance{.name = "floor", .mesh = plain, .material = diffuse});
    const auto removed = b.add(Instance{.name = "removed", .mesh = gone, .material = diffuse});
    b.add(Instance{.name = "floor", .mesh = full, .material = unknown, .group = inner, .object_to_world = at(2)});
    b.add(Instance{.name = "lamp",
                   .mesh = plain,
                   .material = diffuse,
                   .group = room,
                   .object_to_world = glm::scale(at(4), glm::dvec3(-1, 2, 3)),
                   .emission = Emission{.radiance = {1, 2, 3}, .two_sided = true},
                   .reverse_orientation = true});
    b.add(Instance{.name = "glass",
                   .mesh = full,
                   .material = diffuse,
                   .media = MediumInterface{.interior = fog, .exterior = {}},
                   .alpha = 0.5f});
    b.add(Instance{.name = "hidden", .mesh = full, .material = diffuse, .hidden = true});
    apply(b.scene, *remove_instances(b.scene, std::vector{removed}));
    apply(b.scene, *remove(b.scene, gone));
    for (const LightKindRow& row : light_kinds)
        b.add(Light{.name = "light", .kind = row.kind, .light_to_world = at(1)});
    const auto first = b.add(Camera{.name = "first", .lens_radius = 0.1f, .focal_distance = 4});
    b.add(Camera{.name = "second", .screen_window = glm::vec4(-1, 1, -0.5f, 0.5f)});
    apply(b.scene, *set_active_camera(b.scene, first));
    apply(b.scene, set_environment(b.scene, Environment{.name = "sky", .image = image, .hidden_from_camera = true}));
    apply(b.scene, set_film(b.scene, Film{.width = 64,
                                          .height = 32,
                                          .crop = {0.25f, 1, 0, 0.5f},
                                          .filter = {FilterKind::gaussian, {1.5f, 1.5f}, {0.5f, 0}}}));
    return b.scene;
}

Scene empty_scene() {
    Building b;
    const auto camera = b.add(Camera{.name = "camera"});
    apply(b.scene, *set_active_camera(b.scene, camera));
    return b.scene;
}

// Shows wrong matrices, indices and digits: nothing is symmetric, and no number has few digits.
Scene geometry_scene() {
    Building b;
    auto data = std::make_shared<MeshData>();
    data->positions = {{0, 0, 0}, {1.2345678f, 0, 0.1f}, {0.3f, 2.7182818f, 0}, {0.1f, 0.2f, 3.1415927f}};
    data->triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}};
    compute_bounds(*data);
    const auto mesh = b.add(Mesh{.name = "corner", .data = data});
    const auto grey = b.add(Material{.name = "grey", .type = "diffuse"});
    const auto group = b.add(Group{.name = "group"});
    const auto at = [](double x, double y, double z) { return glm::translate(glm::dmat4(1), glm::dvec3(x, y, z)); };
    b.add(Instance{.name = "first", .mesh = mesh, .material = grey});
    b.add(Instance{.name = "turned",
                   .mesh = mesh,
                   .material = grey,
                   .group = group,
                   .object_to_world = glm::rotate(at(5.1, -2.3, 0.7), 1.1, glm::dvec3(0.36, 0.48, 0.8))});
    b.add(Instance{.name = "mirrored",
                   .mesh = mesh,
                   .material = grey,
                   .group = group,
                   .object_to_world = glm::scale(at(-3.3, 4.4, 1.9), glm::dvec3(-1, 2.5, 0.3))});
    const auto camera = b.add(Camera{.name = "camera", .camera_to_world = at(0, 0, -10)});
    apply(b.scene, *set_active_camera(b.scene, camera));
    return b.scene;
}

std::vector<ParamSet> option_sets(const model::Exporter& exporter) {
    std::vector<ParamSet> sets{{}};
    for (const model::Param& p : exporter.options) {
        const auto with = [&](Value v) {
            ParamSet set;
            set.set(p.id, std::move(v));
            sets.push_back(std::move(set));
        };
        if (p.type == model::ParamType::choice)
            for (std::size_t k = 0; k < choices(p); ++k)
                with(Value::choice(choice(p, k)));
        if (p.type == model::ParamType::boolean)
            for (const bool on : {false, true})
                with(Value::boolean(on));
        if (p.type == model::ParamType::number)
            for (const float x : {p.min, p.max})
                with(Value::number(x));
        if (p.type == model::ParamType::integer)
            for (const int x : {p.int_min, p.int_max})
                with(Value::integer(x));
    }
    return sets;
}

} // namespace restage::check
