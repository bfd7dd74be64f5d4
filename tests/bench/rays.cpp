// SPDX-License-Identifier: Apache-2.0
// Rays per second in the room, and the cost of the whole frame relative to Embree alone on the same rays.
#include "bench.hpp"
#include "plain_tracer.hpp"
#include "ray_recorder.hpp"
#include "scenes.hpp"

#include <fmt/format.h>

namespace restage::bench {

Json measure_rays(const Options& o) {
    Plugins plugins;
    const auto renderer = plugins.renderer({.threads = o.threads});
    auto scene = room(5);
    scene.settings.value.caustics = scene::Technique::off; // paths alone, as the loops below
    check(renderer->sync(scene));
    check(renderer->trace(1)); // compiles
    renderer->reset();
    renderer->reset_stats();
    start_recording();
    check(renderer->trace(1));
    const auto rays = stop_recording();
    const auto& stats = renderer->stats();
    if (rays.size() != stats.rays + stats.shadow_rays)
        die(
            fmt::format("{} rays were recorded, but the tracer counts {}: does it call Embree by another function than "
                        "rtcIntersect1 and rtcOccluded1? See ray_recorder.hpp",
                        rays.size(), stats.rays + stats.shadow_rays));
    std::size_t shadows = 0;
    for (const auto& r : rays)
        shadows += r.shadow;

    const PlainTracer tracer(scene);
    Json runs = Json::array();
    const std::uint32_t spp = o.quick ? 1 : 4;
    for (int i = 0; i < o.runs; ++i) {
        renderer->reset();
        renderer->reset_stats();
        const Seconds frame = time([&] { check(renderer->trace(spp)); });
        const Seconds plain = time([&] { trace_plainly(rays, renderer->jobs()); });
        PlainResult cpp;
        const Seconds cpp_time = time([&] { cpp = tracer.trace(spp, renderer->jobs()); });
        const auto film = renderer->image();
        double luminance = 0;
        for (const auto& c : film.color)
            luminance += double(glm::dot(c, glm::vec3(0.2126f, 0.7152f, 0.0722f))) / double(film.color.size());
        const double n = double(stats.rays + stats.shadow_rays);
        runs.push_back({{"rays", stats.rays},
                        {"shadow_rays", stats.shadow_rays},
                        {"wall", frame.wall},
                        {"cpu", frame.cpu},
                        {"mrays_wall", n / frame.wall * 1e-6},
                        {"mrays_cpu", n / frame.cpu * 1e-6},
                        {"share_shading", stats.seconds_shading / stats.seconds},
                        {"share_tracing", stats.seconds_tracing / stats.seconds},
                        {"plain_mrays_wall", double(rays.size()) / plain.wall * 1e-6},
                        {"plain_mrays_cpu", double(rays.size()) / plain.cpu * 1e-6},
                        {"frame_over_plain", frame.cpu / n * double(rays.size()) / plain.cpu},
                        {"cpp_mrays_wall", double(cpp.rays + cpp.shadow_rays) / cpp_time.wall * 1e-6},
                        {"cpp_mrays_cpu", double(cpp.rays + cpp.shadow_rays) / cpp_time.cpu * 1e-6},
                        {"cpp_rays", cpp.rays},
                        {"cpp_shadow_rays", cpp.shadow_rays},
                        {"frame_over_cpp", frame.cpu / cpp_time.cpu},
                        {"mean_luminance", luminance},
                        {"cpp_mean_luminance", cpp.mean_luminance}});
    }
    return {{"samples", spp},
            {"rays_recorded", rays.size()},
            {"shadow_rays_recorded", shadows},
            {"threads", renderer->jobs().threads()},
            {"runs", runs}};
}

} // namespace restage::bench
