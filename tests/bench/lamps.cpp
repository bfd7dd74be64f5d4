// SPDX-License-Identifier: Apache-2.0
// Many lamps: the time to derive their table and tree, and from moving one of them, or another object, until the next
// sample can start; and the latter among many objects.
#include "bench.hpp"
#include "render/light_table.hpp"
#include "render/light_tree.hpp"
#include "scene/edit.hpp"
#include "scenes.hpp"

#include <array>
#include <span>

namespace restage::bench {
namespace {

// The time from moving one of these until the next sample can start: every `step`-th in turn, a sample in between.
Json moves(const Options& o, render::Renderer& renderer, scene::Scene& scene,
           std::span<const scene::Id<scene::Instance>> of, std::size_t step) {
    Json runs = Json::array();
    for (std::size_t i = 0; i < std::size_t(std::max(o.runs, 3)) * 4; ++i) {
        const auto id = of[(i * step + 11) % of.size()];
        const scene::Instance before = scene.instances[id];
        scene::Instance moved = before;
        moved.object_to_world[3].y += 0.5;
        const Seconds sync = time([&] {
            apply(scene, scene::Edit{"move", {scene::Change<scene::Instance>{id, before, moved}}});
            check(renderer.sync(scene));
        });
        runs.push_back(sync.wall);
        check(renderer.trace(1));
    }
    return runs;
}

} // namespace

Json measure_lamps(const Options& o) {
    using namespace scene;
    Plugins plugins;
    Json rows = Json::array();
    for (const std::uint32_t count : {1000u, 10'000u, 100'000u}) {
        if (o.quick && count > 10'000) break;
        std::vector<Id<Instance>> lamps;
        Scene scene = lamp_field(count, lamps);
        const auto renderer = plugins.renderer({.threads = o.threads});
        check(renderer->sync(scene));
        check(renderer->trace(1));
        const auto emitter = [&](Id<Instance> id) -> std::optional<render::Emitter> {
            const auto& instance = scene.instances[id];
            if (!instance.emission) return std::nullopt;
            return render::Emitter{
                .radiance = instance.emission->radiance, .two_sided = false, .varies = false, .mean = {}};
        };
        Json tables = Json::array(), trees = Json::array();
        for (int i = 0; i < std::max(o.runs, 3); ++i) {
            render::LightTable table;
            const Seconds made =
                time([&] { table = render::make_light_table(scene, glm::dvec3(0), glm::vec3(0), emitter); });
            tables.push_back(made.wall);
            std::vector<shared::LightNode> leaves;
            for (const auto& node : table.nodes)
                if (node.lights > 0) leaves.push_back(node);
            trees.push_back(time([&] { render::make_light_tree(std::move(leaves)); }).wall);
        }
        rows.push_back({{"lamps", count},
                        {"table", tables},
                        {"tree", trees},
                        {"move", moves(o, *renderer, scene, lamps, 37)},
                        {"move_far_apart", moves(o, *renderer, scene, lamps, 20011)},
                        {"move_floor", moves(o, *renderer, scene, std::array{Id<Instance>{1}}, 1)}});
    }
    std::vector<Id<Instance>> spheres;
    Scene scene = crowd(o.quick ? 10'000 : 100'000, 5, spheres);
    const auto renderer = plugins.renderer({.threads = o.threads});
    check(renderer->sync(scene));
    check(renderer->trace(1));
    const Json objects = {{"objects", spheres.size()},
                          {"move", moves(o, *renderer, scene, spheres, 37)},
                          {"move_far_apart", moves(o, *renderer, scene, spheres, 20011)}};
    return {{"rows", rows}, {"without_lamps", objects}};
}

} // namespace restage::bench
