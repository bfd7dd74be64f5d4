// SPDX-License-Identifier: Apache-2.0
// The cost of the live picture's copy of a scene: the copy, the first change after it, a walk over all objects, and
// what a frame of a drag does with it, in seconds and in allocations.
#include "allocations.hpp"
#include "base/jobs.hpp"
#include "bench.hpp"
#include "render/gpu_scene.hpp"
#include "scene/edit.hpp"
#include "scenes.hpp"

#include <algorithm>

namespace restage::bench {
namespace {

using namespace scene;

template <class F>
Json cost(int runs, F&& f) { // the median of the times, the last number of allocations
    std::vector<double> seconds;
    std::uint64_t made = 0;
    for (int i = 0; i < runs; ++i) {
        const std::uint64_t before = allocations_made();
        seconds.push_back(time(f).wall);
        made = allocations_made() - before;
    }
    std::ranges::nth_element(seconds, seconds.begin() + runs / 2);
    return {{"seconds", seconds[std::size_t(runs / 2)]}, {"allocations", made}};
}

} // namespace

Json measure_copies(const Options& o) {
    Plugins plugins;
    const auto renderer = plugins.renderer({.threads = o.threads});
    Jobs jobs(o.threads);
    const int runs = std::max(o.runs, 3) * 7;
    Json rows = Json::array();
    for (const std::uint32_t count : {20'000u, 100'000u}) {
        std::vector<Id<Instance>> spheres;
        Scene scene = crowd(count, 4, spheres);
        for (const Id<Instance> id : spheres) { // as in files: too long for the small-string buffer
            Instance named = scene.instances[id];
            named.name = "a sphere of the crowd, number " + std::to_string(id.value);
            scene.instances.set(id, std::move(named), scene.clock);
        }
        render::GpuScene gpu(renderer->device(), jobs, plugins.lookup());
        take(gpu.sync(scene));
        Scene shown = Scene(scene);
        std::uint32_t step = 0;
        const auto move = [&] {
            const Id<Instance> id = spheres[++step * 37 % spheres.size()];
            Instance moved = scene.instances[id];
            moved.object_to_world[3].y += 0.5;
            scene.instances.set(id, std::move(moved), ++scene.clock);
        };
        const Json copy = cost(runs, [&] { shown = Scene(scene); });
        const Json set = cost(runs, [&] {
            move();
            shown = Scene(scene);
        });
        double sum = 0;
        const Json each = cost(runs, [&] {
            scene.instances.each([&](Id<Instance>, const Instance& i) { sum += i.object_to_world[3].x; });
        });
        const Json find = cost(runs, [&] {
            for (std::uint32_t i = 0; i < scene.instances.size(); ++i)
                sum += scene.instances[{i + 1}].object_to_world[3].y;
        });
        if (!(sum == sum)) die("the walk found NaN");
        const Json frame = cost(runs, [&] {
            move();
            shown = Scene(scene);
            take(gpu.sync(shown));
        });
        rows.push_back({{"instances", count},
                        {"copy", copy},
                        {"set_and_copy", set},
                        {"each", each},
                        {"find", find},
                        {"frame", frame}});
    }
    return {{"scenes", rows}};
}

} // namespace restage::bench
