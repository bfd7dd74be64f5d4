// SPDX-License-Identifier: Apache-2.0
// Shared by the measurements: a stopwatch of wall and CPU time, the plugins of the build tree, a renderer, and errors
// that end the process with a sentence.
#pragma once

#include "io/services.hpp"
#include "plugin/registry.hpp"
#include "render/renderer.hpp"

#include <sys/resource.h>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace restage::bench {

using Json = nlohmann::ordered_json;

[[noreturn]] inline void die(const std::string& message) {
    std::fprintf(stderr, "restage_bench: %s\n", message.c_str());
    std::exit(1);
}
inline void check(const Result<void>& r) {
    if (!r) die(r.error().message);
}
template <class T>
T take(Result<T> r) {
    if (!r) die(r.error().message);
    return std::move(*r);
}

struct Seconds {
    double wall = 0, cpu = 0; // cpu: user and system, all threads of the process
    Seconds operator-(const Seconds& o) const { return {wall - o.wall, cpu - o.cpu}; }
};
inline Seconds now() {
    rusage u{};
    getrusage(RUSAGE_SELF, &u);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
            seconds(u.ru_utime) + seconds(u.ru_stime)};
}
template <class F>
Seconds time(F&& f) {
    const Seconds start = now();
    f();
    return now() - start;
}

struct Plugins {
    Log log;
    plugin::Registry registry{log, io::with_services()};
    Plugins() {
        log.set_threshold(LogLevel::warning);
        registry.scan(plugin::Registry::default_paths());
    }
    render::MaterialLookup lookup() { return render::material_lookup(registry); }
    std::unique_ptr<render::Renderer> renderer(render::RendererOptions options = {}) {
        if (options.tracer.empty()) options.tracer = "embree";
        return take(render::Renderer::create(options, lookup(), log));
    }
};

struct Options { // of all measurements
    int runs = 3;
    bool quick = false;
    unsigned threads = 0;
};

Json measure_rays(const Options&);
Json measure_cutouts(const Options&);
Json measure_edits(const Options&);
Json measure_lamps(const Options&);
Json measure_copies(const Options&);
Json measure_actions(const Options&);
Json measure_features(const Options&, const std::string& variant);
Json measure_multiscatter(const Options&);
Json measure_first_image(const std::string& scene);
// References of `reference_spp` samples in all are kept in `folder`.
Json measure_standard(const Options&, const std::string& scene, const std::string& folder, std::uint32_t reference_spp);

} // namespace restage::bench
