// SPDX-License-Identifier: Apache-2.0
// Rays per second among cards arranged like leaves: opaque, cut out by a texture with native code, and by the same
// texture without it, whose hits are decided on the device.
#include "bench.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <random>

namespace restage::bench {
namespace {

scene::Scene cards(bool cut_out, int count) {
    scene::Scene s;
    const auto put = [&](auto& table, auto item) {
        const auto id = table.next();
        table.set(id, std::move(item), ++s.clock);
        return id;
    };
    scene::MeshData quad{.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
                         .uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                         .triangles = {{0, 1, 2}, {0, 2, 3}}};
    quad.lower = glm::vec3(-1, -1, 0), quad.upper = glm::vec3(1, 1, 0);
    const auto mesh = put(s.meshes, scene::Mesh{.name = "card", .data = std::make_shared<scene::MeshData>(quad)});
    scene::ParamSet green;
    green.set("reflectance", scene::Value::color(.3f, .6f, .2f));
    const auto material = put(s.materials, scene::Material{.name = "leaf", .type = "diffuse", .params = green});
    scene::ParamSet squares;
    for (const char* id : {"uscale", "vscale"})
        squares.set(id, scene::Value::number(6));
    scene::Id<scene::Texture> alpha;
    if (cut_out)
        alpha = put(s.textures,
                    scene::Texture{.name = "alpha", .type = "checkerboard", .is_float = true, .params = squares});
    std::mt19937 random(7);
    const auto unit = [&] { return double(random() >> 8) / double(1 << 24); };
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 at(8 * unit() - 4, 8 * unit() - 4, 8 * unit() - 4);
        const glm::dvec3 axis = glm::normalize(glm::dvec3(unit(), unit(), unit()) - 0.5);
        const glm::dmat4 place =
            glm::scale(glm::rotate(glm::translate(glm::dmat4(1), at), 6.28 * unit(), axis), glm::dvec3(0.3));
        put(s.instances,
            scene::Instance{
                .name = "leaf", .mesh = mesh, .material = material, .object_to_world = place, .alpha_texture = alpha});
    }
    s.environment = {scene::Environment{.name = "sky", .scale = glm::vec3(1)}, ++s.clock};
    scene::Camera camera;
    camera.camera_to_world[3] = glm::dvec4(0, 0, -12, 1);
    camera.fov = 40;
    s.active_camera = {put(s.cameras, camera), ++s.clock};
    s.film.value.width = 256;
    s.film.value.height = 256;
    s.film.version = ++s.clock;
    s.settings.value.max_depth = 4;
    return s;
}

} // namespace

Json measure_cutouts(const Options& o) {
    Plugins plugins;
    Json out;
    for (const std::string kind : {"opaque", "native", "glsl"}) {
        render::MaterialLookup lookup = plugins.lookup();
        if (kind == "glsl")
            lookup.textures = [cached = std::shared_ptr<const plugin::TextureSource>(),
                               find = lookup.textures](const std::string& type) mutable {
                auto found = find(type);
                if (found && !cached)
                    cached = std::make_shared<const plugin::TextureSource>(*found->table, found->folder,
                                                                           found->source->glsl());
                if (found) found->source = cached, found->table = &cached->texture();
                return found;
            };
        const auto renderer =
            take(render::Renderer::create({.tracer = "embree", .threads = o.threads}, lookup, plugins.log));
        check(renderer->sync(cards(kind != "opaque", 2000)));
        check(renderer->trace(1)); // compiles
        Json runs = Json::array();
        for (int i = 0; i < o.runs; ++i) {
            renderer->reset();
            renderer->reset_stats();
            const Seconds frame = time([&] { check(renderer->trace(o.quick ? 1 : 4)); });
            const auto& stats = renderer->stats();
            const double n = double(stats.rays + stats.shadow_rays);
            double sum = 0;
            const auto film = renderer->image();
            for (const auto& c : film.color)
                sum += double(c.y) / double(film.color.size());
            runs.push_back({{"mrays_wall", n / frame.wall * 1e-6}, {"mrays_cpu", n / frame.cpu * 1e-6}, {"mean", sum}});
        }
        out[kind] = runs;
    }
    return out;
}

} // namespace restage::bench
