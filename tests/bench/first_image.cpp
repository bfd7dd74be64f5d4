// SPDX-License-Identifier: Apache-2.0
// Breakdown of the time to a file's first picture: one sample per pixel at 640x360.
#include "bench.hpp"
#include "io/import.hpp"

namespace restage::bench {

Json measure_first_image(const std::string& path) {
    Json row;
    const Seconds start = now();
    Seconds last = start;
    const auto lap = [&](const char* name) {
        const Seconds t = now();
        row[name] = {{"wall", (t - last).wall}, {"cpu", (t - last).cpu}};
        last = t;
    };
    Plugins plugins;
    lap("plugins");
    auto imported = take(io::import_scene(path, plugins.registry));
    scene::Scene& scene = imported.scene;
    lap("import");
    scene.film.value.width = 640;
    scene.film.value.height = 360;
    scene.film.version = ++scene.clock;
    const auto renderer = plugins.renderer();
    lap("device");
    check(renderer->sync(scene));
    lap("upload and acceleration structures");
    check(renderer->trace(1));
    lap("shaders and the first sample");
    check(renderer->trace(1));
    lap("one more sample, not part of the sum");
    row["meshes"] = scene.meshes.live();
    row["spirv_bytes"] = renderer->stats().shader_bytes;
    return row;
}

} // namespace restage::bench
