// SPDX-License-Identifier: Apache-2.0
// The cost of `multiscatter`: the two boxes of the Cornell box in each material that supports it, at alpha 0.5, without
// and with it.
#include "bench.hpp"
#include "scenes.hpp"

namespace restage::bench {
namespace {

using namespace scene;

struct Row {
    std::string name, type;
    ParamSet params;
};

std::vector<Row> rows(const plugin::Registry& registry) {
    std::vector<Row> out;
    for (const auto& entry : registry.materials()) {
        bool has = false;
        ParamSet params;
        for (std::uint32_t i = 0; i < entry.table->params.size(); ++i) {
            const model::Param& p = entry.table->params[i];
            const std::string_view id = p.id;
            has = has || id == "multiscatter";
            if (id == "remap") params.set(p.id, Value::choice("none"));
            if (id == "uroughness" || id == "vroughness") params.set(p.id, Value::number(0.5f));
            if (id == "roughness") params.set(p.id, Value::number(0.7071f)); // principled's is the root of alpha
        }
        if (!has) continue;
        out.push_back({entry.table->type, entry.table->type, params});
        if (std::string_view(entry.table->type) == "principled")
            for (const char* id : {"metallic", "transmission"}) {
                ParamSet more = params;
                more.set(id, Value::number(1));
                out.push_back({std::string(entry.table->type) + ", " + id, entry.table->type, more});
            }
    }
    return out;
}

} // namespace

Json measure_multiscatter(const Options& o) {
    Plugins plugins;
    Json out = Json::object();
    for (const Row& row : rows(plugins.registry)) {
        Json& figures = out[row.name] = Json::object();
        const auto with = [&](bool on) {
            Scene scene = cornell();
            const auto id = scene.materials.next();
            Material m{.name = row.name, .type = row.type, .params = row.params};
            m.params.set("multiscatter", Value::boolean(on));
            scene.materials.set(id, m, ++scene.clock);
            for (std::uint32_t i = 0; i < 2; ++i) { // the boxes are the last
                const Id<Instance> box{scene.instances.size() - i};
                Instance changed = scene.instances[box];
                changed.material = id;
                scene.instances.set(box, changed, ++scene.clock);
            }
            return scene;
        };
        const std::unique_ptr<render::Renderer> renderers[] = {plugins.renderer({.threads = o.threads}),
                                                               plugins.renderer({.threads = o.threads})};
        for (const bool on : {false, true}) {
            check(renderers[on]->sync(with(on)));
            check(renderers[on]->trace(1));
        }
        const std::uint32_t spp = o.quick ? 4 : 16;
        for (int run = 0; run < o.runs; ++run) // alternating
            for (const bool on : {false, true}) {
                renderers[on]->reset();
                const Seconds t = time([&] { check(renderers[on]->trace(spp)); });
                figures[on ? "with" : "without"].push_back({{"wall", t.wall / spp}, {"cpu", t.cpu / spp}});
            }
    }
    return out;
}

} // namespace restage::bench
