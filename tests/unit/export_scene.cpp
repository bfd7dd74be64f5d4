// SPDX-License-Identifier: Apache-2.0
#include "export_scene.hpp"

#include "scene/bounds.hpp"

#include <glm/gtc/matrix_transform.hpp>

namespace restage::test {

using namespace scene;

namespace {

std::shared_ptr<MeshData> grid(int n, float height) { // 2 n^2 triangles with normals and uvs
    auto data = std::make_shared<MeshData>();
    for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(n),
                        v = static_cast<float>(y) / static_cast<float>(n);
            data->positions.emplace_back(u, v, height * u * v);
            data->normals.push_back(glm::normalize(glm::vec3(-height * v, -height * u, 1)));
            data->uvs.emplace_back(u, v);
        }
    const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            data->triangles.emplace_back(at(x, y), at(x + 1, y), at(x + 1, y + 1));
            data->triangles.emplace_back(at(x, y), at(x + 1, y + 1), at(x, y + 1));
        }
    compute_bounds(*data);
    return data;
}

} // namespace

glm::dmat4 place(double x, double turn, glm::dvec3 scale) {
    return glm::scale(
        glm::rotate(glm::translate(glm::dmat4(1), {x, 0.1 * x, -0.3}), turn, glm::normalize(glm::dvec3(1, 2, 3))),
        scale);
}

Everything::Everything(bool v4) {
    auto pixels = std::make_shared<PixelData>();
    *pixels = {4, 2, 3, {}};
    for (int i = 0; i < 24; ++i)
        pixels->values.push_back(static_cast<float>(i) / 7);
    const auto picture = add(Image{.name = "wood", .encoding = scene::Encoding::linear, .data = pixels});
    auto square = std::make_shared<PixelData>();
    *square = {4, 4, 3, std::vector<float>(48, 0.3f)};
    const auto sky = add(Image{.name = "sky", .encoding = scene::Encoding::linear, .data = square});

    Texture wood{.name = "wood", .type = "imagemap", .image = picture};
    wood.params.set("wrap", Value::choice("clamp"));
    wood.params.set("uscale", Value::number(1.7f));
    const auto wood_id = add(wood);
    Texture tiles{.name = "tiles", .type = "checkerboard"};
    tiles.params.set("tex1", {.type = model::ParamType::color, .texture = wood_id});
    tiles.params.set("tex2", Value::color(0.1f, 0.2f, 0.7f));
    tiles.params.set("vdelta", Value::number(0.3f));
    const auto tiles_id = add(tiles);
    Texture half{.name = "half", .type = "constant", .is_float = true};
    half.params.set("value", Value::color(0.3f, 0.3f, 0.3f));
    const auto half_id = add(half);
    Texture dim{.name = "dim", .type = "scale"};
    dim.params.set("tex", {.type = model::ParamType::color, .texture = tiles_id});
    dim.params.set("scale", Value::color(0.6f, 0.6f, 0.6f));
    const auto dim_id = add(dim);
    Texture blend{.name = "blend", .type = "mix", .is_float = true};
    blend.params.set("tex1", {.type = model::ParamType::color, .texture = half_id});
    blend.params.set("tex2", Value::color(0.9f, 0.9f, 0.9f));
    blend.params.set("amount", Value::number(0.25f));
    const auto blend_id = add(blend);

    const auto red = material("red \"oak\"", "diffuse", {{"reflectance", Value::color(0.7f, 0.1f, 1.f / 3)}});
    const auto tiled = material("tiled", "diffuse",
                                {{"reflectance", {.type = model::ParamType::color, .texture = dim_id}},
                                 {"bump", {.type = model::ParamType::texture, .texture = blend_id}}});
    std::vector<Id<Material>> all{red, tiled};
    if (v4) {
        all.push_back(material("gold", "conductor",
                               {{"eta", Value::color(0.14f, 0.37f, 1.44f)},
                                {"k", Value::color(3.9f, 2.4f, 1.6f)},
                                {"uroughness", Value::number(0.1f)},
                                {"vroughness", {.type = model::ParamType::number, .texture = half_id}}}));
        all.push_back(material("tin", "conductor",
                               {{"use_reflectance", Value::boolean(true)},
                                {"reflectance", Value::color(0.8f, 0.8f, 0.9f)},
                                {"remap", Value::choice("none")},
                                {"uroughness", Value::number(0.2f)}}));
        all.push_back(material("glass", "dielectric", {{"eta", Value::number(1.33f)}}));
        all.push_back(
            material("pane", "dielectric", {{"thin", Value::boolean(true)}, {"remap", Value::choice("none")}}));
        all.push_back(material("varnish", "coateddiffuse",
                               {{"reflectance", Value::color(0.2f, 0.3f, 0.4f)},
                                {"uroughness", Value::number(0.3f)},
                                {"albedo", Value::color(0.1f, 0, 0)},
                                {"g", Value::number(0.2f)},
                                {"max_depth", Value::integer(7)}}));
        all.push_back(material("lacquer", "coatedconductor",
                               {{"conductor_eta", Value::color(1.1f, 0.9f, 0.6f)},
                                {"interface_uroughness", Value::number(0.05f)},
                                {"conductor_uroughness", Value::number(0.3f)}}));
        all.push_back(material("leaf", "diffusetransmission", {{"transmittance", Value::color(0.1f, 0.4f, 0.1f)}}));
    } else {
        all.push_back(material("matte", "diffuse", {{"sigma", Value::number(20)}}));
        all.push_back(material("metal", "conductor",
                               {{"eta", Value::color(0.14f, 0.37f, 1.44f)},
                                {"remap", Value::choice("v3")},
                                {"uroughness", Value::number(0.1f)}}));
        all.push_back(material("green glass", "dielectric",
                               {{"transmittance", Value::color(0.5f, 1, 0.5f)}, {"remap", Value::choice("v3")}}));
        all.push_back(
            material("paint", "substrate", {{"kd", Value::color(0.1f, 0.2f, 0.3f)}, {"remap", Value::choice("v3")}}));
        all.push_back(material("plastic", "plastic", {{"roughness", Value::number(0.05f)}}));
        all.push_back(material("mirror", "mirror", {}));
        all.push_back(material("uber", "uber",
                               {{"opacity", Value::color(0.5f, 0.5f, 0.5f)},
                                {"kr", Value::color(0.1f, 0.1f, 0.1f)},
                                {"remap", Value::choice("v3")}}));
        all.push_back(material("paper", "translucent", {{"transmit", Value::color(0.2f, 0.2f, 0.1f)}}));
    }
    all.push_back(material("both", "mix",
                           {{"first", {.type = model::ParamType::material, .material = all[2]}},
                            {"second", {.type = model::ParamType::material, .material = red}},
                            {"amount", Value::number(0.3f)}}));
    all.push_back(material("nothing", "interface", {}));

    const auto small = add(Mesh{.name = "tri", .data = grid(1, 0.5f)});
    const auto big = add(Mesh{.name = "cloth/1", .data = grid(20, 0.3f)});
    const auto once = add(Mesh{.name = "lone", .data = grid(2, 0.1f)});
    for (std::size_t i = 0; i < all.size(); ++i)
        instance("piece", small, all[i], static_cast<double>(i), 0.1 * static_cast<double>(i));
    for (int i = 0; i < 3; ++i) // instances of one object
        instance("cloth", big, red, i / 3.0, i / 7.0);
    const auto fog = add(Medium{.name = "tea", .sigma_a = {0.1f, 0.2f, 0.3f}});
    const auto pair = add(Group{.name = "pair"}), pair2 = add(Group{.name = "pair 2"});
    for (const auto& [group, x] : {std::pair{pair, 5.0}, {pair2, 9.0}})
        for (int i = 0; i < 2; ++i)
            add(Instance{.name = "member",
                         .mesh = big,
                         .material = tiled,
                         .group = group,
                         .object_to_world = place(x, 0.4) * place(i, 0.2 * i)});
    add(Instance{.name = "lamp",
                 .mesh = once,
                 .material = red,
                 .object_to_world = place(3, 1),
                 .emission = Emission{{17.f / 3, 2, 1}, true},
                 .reverse_orientation = true});
    add(Instance{.name = "cup",
                 .mesh = big,
                 .material = all.back(),
                 .object_to_world = place(4, 2, {-1, 1, 2}),
                 .media = MediumInterface{fog, {}},
                 .alpha_texture = blend_id,
                 .alpha_mask = !v4});
    add(Instance{.name = "veil",
                 .mesh = small,
                 .material = red,
                 .object_to_world = place(6, 1),
                 .alpha = 0.4f,
                 .alpha_mask = !v4});

    add(Light{.name = "bulb", .value = {1, 2, 3}, .light_to_world = place(2, 1)});
    add(Light{.name = "spot",
              .kind = scene::LightKind::spot,
              .value = {5, 5, 1},
              .light_to_world = place(1, 2),
              .cone_angle = 25,
              .cone_delta = 4,
              .falloff = v4 ? scene::Falloff::smooth : scene::Falloff::quartic});
    add(Light{
        .name = "sun", .kind = scene::LightKind::distant, .value = {1, 1, 0.3f}, .light_to_world = place(0, 0.7)});
    apply(scene,
          set_environment(scene, Environment{.name = "sky",
                                             .image = v4 ? sky : picture,
                                             .mapping = v4 ? scene::Mapping::octahedral : scene::Mapping::equirect,
                                             .scale = glm::vec3(0.7f),
                                             .light_to_world = glm::rotate(glm::dmat4(1), 0.3, {1, 0, 0})}));
    const auto camera = add(Camera{.name = "camera",
                                   .camera_to_world = place(-4, 0.5),
                                   .fov = 36.4f,
                                   .screen_window = glm::vec4(-1.5, 1.5, -1, 1),
                                   .lens_radius = 0.01f,
                                   .focal_distance = 3.3f});
    apply(scene, *set_active_camera(scene, camera));
    apply(scene,
          set_film(scene, Film{.width = 320,
                               .height = 200,
                               .crop = {0.25f, 0.75f, 0, 1},
                               .filter = {.kind = FilterKind::gaussian, .radius = {1.5f, 2}, .params = {0.4f, 0}},
                               .exposure = 0.7f}));
    apply(scene, set_settings(scene, Settings{.max_depth = 13, .samples = 48}));
}

} // namespace restage::test
