// SPDX-License-Identifier: Apache-2.0
// Many lamps: the time to derive their table and tree, and from moving one of them until the next sample can start.
#include "bench.hpp"
#include "render/light_table.hpp"
#include "render/light_tree.hpp"
#include "scene/edit.hpp"
#include "scenes.hpp"

namespace restage::bench {

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
        Json tables = Json::array(), trees = Json::array(), moves = Json::array();
        for (int i = 0; i < std::max(o.runs, 3); ++i) {
            render::LightTable table;
            const Seconds made =
                time([&] { table = render::make_light_table(scene, glm::dvec3(0), glm::vec3(0), emitter); });
            tables.push_back(made.wall);
            std::vector<shared::LightNode> leaves;
            for (const auto& node : table.nodes)
                if (node.lights > 0) leaves.push_back(node);
            trees.push_back(time([&] { render::make_light_tree(std::move(leaves)); }).wall);
            const auto id = lamps[std::size_t(i * 37 + 11) % lamps.size()];
            Instance moved = scene.instances[id];
            const Instance before = moved;
            moved.object_to_world[3].y += 0.5;
            const Seconds sync = time([&] {
                apply(scene, Edit{"move", {Change<Instance>{id, before, moved}}});
                check(renderer->sync(scene));
            });
            moves.push_back(sync.wall);
            check(renderer->trace(1));
        }
        rows.push_back({{"lamps", count}, {"table", tables}, {"tree", trees}, {"move", moves}});
    }
    return {{"rows", rows}};
}

} // namespace restage::bench
