// SPDX-License-Identifier: Apache-2.0
// An action of a plugin on a large document: 10,000 copies scattered over hills of 100,352 triangles. Its run, applying
// its edit, undo and redo, updating the renderer, and memory.
#include "document/actions.hpp"
#include "bench.hpp"
#include "scene/bounds.hpp"
#include "scene/edits.hpp"
#include "scenes.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

namespace restage::bench {
namespace {

using namespace scene;

std::shared_ptr<const MeshData> hills(std::uint32_t cells) {
    auto data = std::make_shared<MeshData>();
    for (std::uint32_t z = 0; z <= cells; ++z)
        for (std::uint32_t x = 0; x <= cells; ++x) {
            const glm::vec2 at = 100.f * glm::vec2(x, z) / float(cells) - 50.f;
            data->positions.push_back({at.x, 3 * std::sin(at.x / 7) * std::cos(at.y / 5), at.y});
        }
    for (std::uint32_t z = 0; z < cells; ++z)
        for (std::uint32_t x = 0; x < cells; ++x) {
            const std::uint32_t a = z * (cells + 1) + x, b = a + cells + 1;
            data->triangles.push_back({a, b, a + 1});
            data->triangles.push_back({a + 1, b, b + 1});
        }
    compute_bounds(*data);
    return data;
}

// Peak memory of this process since reset_peak(); 0 if the system does not report it.
std::uint64_t peak_bytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
    return 0;
}
void reset_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

} // namespace

Json measure_actions(const Options& o) {
    Plugins plugins;
    const auto renderer = plugins.renderer({.threads = o.threads});
    std::vector<Id<Instance>> spheres;
    document::Session session(plugins.registry);
    session.adopt(crowd(1, 4, spheres));
    const Id<Mesh> mesh = session.scene().meshes.next();
    take(session.edit(insert(session.scene(), Mesh{.name = "hills", .data = hills(224)}, "add")));
    const Id<Instance> ground = session.scene().instances.next();
    Instance surface{.name = "hills", .mesh = mesh, .material = session.scene().instances[spheres[0]].material};
    take(session.edit(insert(session.scene(), std::move(surface), "add")));
    session.end_gesture();
    const plugin::ActionEntry scatter = take(document::find_action(plugins.registry, "scatter"));
    Json rows = Json::array();
    for (const std::uint32_t count : {10'000u, 100'000u}) {
        io::ActionRun run{.selection = {spheres[0], ground}, .values = {}, .progress = {}};
        run.values.set("count", Value::integer(int(count)));
        Json runs = Json::array();
        for (int i = 0; i < std::max(o.runs, 3); ++i) {
            check(renderer->sync(session.scene()));
            check(renderer->trace(1));
            reset_peak();
            const std::uint64_t before = peak_bytes();
            std::optional<io::ActionResult> made;
            const Seconds ran =
                time([&] { made = take(io::run_action(session.scene(), plugins.registry, scatter, run)); });
            const Seconds applied = time([&] { take(document::apply_action(session, std::move(*made))); });
            const std::uint64_t most = peak_bytes();
            made.reset();
            const Seconds followed = time([&] { check(renderer->sync(session.scene())); });
            check(renderer->trace(1));
            const Seconds undone = time([&] { session.undo(); });
            const Seconds left = time([&] { check(renderer->sync(session.scene())); });
            const Seconds redone = time([&] { session.redo(); });
            session.undo();
            runs.push_back({{"run", ran.wall},
                            {"apply", applied.wall},
                            {"undo", undone.wall},
                            {"redo", redone.wall},
                            {"sync", followed.wall},
                            {"sync_undo", left.wall},
                            {"peak_bytes", most - std::min(most, before)},
                            {"history_bytes", session.history().bytes()}});
        }
        rows.push_back({{"copies", count}, {"runs", runs}});
    }
    return {{"triangles", 2 * 224 * 224}, {"rows", rows}, {"target_run", 1.0}, {"target_undo", 0.1}};
}

} // namespace restage::bench
