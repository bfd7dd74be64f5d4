// SPDX-License-Identifier: Apache-2.0
// Unused features must be free: the Cornell box alone; with an unreachable object of every material type; and also with
// every feature that shaders are specialised for.
#include "bench.hpp"
#include "render/scene_builder.hpp"
#include "scenes.hpp"

namespace restage::bench {
namespace {

using namespace scene;

struct Hidden { // adds things under the floor of the Cornell box: paths leave through the front, upwards of it
    Scene& scene;
    int count = 0;

    Id<Material> material(std::string type, ParamSet params = {}) {
        const auto id = scene.materials.next();
        scene.materials.set(id, Material{.name = type, .type = type, .params = std::move(params)}, ++scene.clock);
        return id;
    }
    void show(Id<Material> m) {
        const auto box = scene.instances[Id<Instance>{scene.instances.size()}].mesh;
        glm::dmat4 at = glm::translate(glm::dmat4(1), glm::dvec3(-0.8 + 0.1 * count++, -1.2, -0.5));
        const auto id = scene.instances.next();
        scene.instances.set(
            id,
            Instance{.name = "hidden", .mesh = box, .material = m, .object_to_world = glm::scale(at, glm::dvec3(0.03))},
            ++scene.clock);
    }
};

void add_every_type(Scene& scene, const plugin::Registry& registry) {
    Hidden hidden{scene};
    for (const auto& entry : registry.materials()) {
        ParamSet params;
        if (entry.table->mix) {
            Value v{.type = model::ParamType::material};
            v.material = Id<Material>{1};
            params.set("first", v);
            params.set("second", v);
        }
        hidden.show(hidden.material(entry.table->type, params));
    }
}

// Environment (nearly black), lens (nearly a pinhole), a medium, a tabulated filter, a textured and bumped diffuse.
void add_every_feature(Scene& scene) {
    scene.environment = {Environment{.name = "night", .scale = glm::vec3(1e-9f)}, ++scene.clock};
    Camera camera = scene.cameras[scene.active_camera.value];
    camera.lens_radius = 1e-6f;
    camera.focal_distance = 4;
    scene.cameras.set(scene.active_camera.value, camera, ++scene.clock);
    scene.media.set(scene.media.next(), Medium{.name = "fog", .sigma_a = glm::vec3(0.1f)}, ++scene.clock);
    Film film = scene.film.value;
    film.filter = {.kind = FilterKind::gaussian, .radius = glm::vec2(1.5f), .params = glm::vec2(0.5f)};
    scene.film = {film, ++scene.clock};
    const auto texture = scene.textures.next();
    Texture constant{.name = "grey", .type = "constant"};
    constant.params.set("value", Value::color(.5f, .5f, .5f));
    scene.textures.set(texture, constant, ++scene.clock);
    Value v = Value::color(.5f, .5f, .5f);
    v.texture = texture;
    Value bump = Value::number(0);
    bump.texture = texture;
    ParamSet params;
    params.set("reflectance", v);
    params.set("bump", bump);
    Hidden hidden{scene, 20};
    hidden.show(hidden.material("diffuse", params));
}

} // namespace

Json measure_features(const Options& o, const std::string& variant) {
    Plugins plugins;
    Scene scene = cornell();
    if (variant == "types" || variant == "all") add_every_type(scene, plugins.registry);
    if (variant == "features" || variant == "all") add_every_feature(scene);
    const auto renderer = plugins.renderer({.threads = o.threads});
    const Seconds first = time([&] {
        check(renderer->sync(scene));
        check(renderer->trace(1));
    });
    Json runs = Json::array();
    const std::uint32_t spp = o.quick ? 4 : 16;
    for (int i = 0; i < o.runs; ++i) {
        renderer->reset();
        const Seconds t = time([&] { check(renderer->trace(spp)); });
        runs.push_back({{"wall", t.wall / spp}, {"cpu", t.cpu / spp}});
    }
    return {{"variant", variant},
            {"types", renderer->gpu_scene().types().size()},
            {"spirv_bytes", renderer->stats().shader_bytes},
            {"first_sample_wall", first.wall},
            {"first_sample_cpu", first.cpu},
            {"seconds_a_sample", runs}};
}

} // namespace restage::bench
