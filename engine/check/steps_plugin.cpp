// SPDX-License-Identifier: Apache-2.0
// Steps for every plugin, whatever it provides: manifest, loading with its tables, reloading.
#include "check/steps.hpp"
#include "check/workplace.hpp"
#include "io/services.hpp"

#include "plugin/manifest.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>

namespace restage::check {

namespace fs = std::filesystem;

Result<StepResult> check_manifest(Subject& s) {
    RESTAGE_TRY(const plugin::Manifest m, plugin::read_manifest(s.folder / "plugin.json"));
    for (const fs::path& file : m.files)
        if (!fs::exists(s.folder / file))
            return StepResult::failed((s.folder / "plugin.json").string() + ": \"files\": " + file.string() +
                                      " is missing");
    if (m.licence.empty())
        return StepResult::failed((s.folder / "plugin.json").string() + ": \"licence\" is missing or empty");
    return StepResult::passed({}, fmt::format("{} {}, {}, {}", m.id, m.version, m.kind(), m.licence));
}

Result<StepResult> check_load(Subject& s) {
    const auto start = std::chrono::steady_clock::now();
    if (const auto loaded = s.load(); !loaded) {
        StepResult result = StepResult::failed(loaded.error().message);
        const auto manifest = plugin::read_manifest(s.folder / "plugin.json");
        if (manifest && !manifest->library.empty() && !fs::exists(s.folder / manifest->library))
            result.cause = "the plugin is not built yet, or this is its source folder";
        return result;
    }
    const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    const plugin::Registry& r = s.registry();
    const double tables =
        static_cast<double>(r.materials().size() + r.importers().size() + r.exporters().size() + r.denoisers().size() +
                            r.catalogue()->actions.size() + r.catalogue()->panels.size() + r.catalogue()->skies.size());
    return StepResult::passed({{"load", ms, "ms"}, {"tables", tables}});
}

Result<StepResult> check_reload(Subject& s) {
    constexpr int warm_up = 20, times = 100;
    Resources before;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < warm_up + times; ++i) {
        if (i == warm_up) before = resources();
        Log silent([](LogLevel, std::string_view) {});
        plugin::Registry registry(silent, io::with_services());
        const plugin::SearchPath path[] = {{s.folder, true}};
        registry.scan(path);
        for (const plugin::Entry* e : registry.entries())
            if (e->state == plugin::State::refused)
                return StepResult::failed(fmt::format("refused at load {} of {}: {}", i + 1, times, e->reason));
        s.alive();
    }
    const Resources after = resources();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const auto grown = [](std::size_t a, std::size_t b) { return b > a ? static_cast<double>(b - a) : 0; };
    std::vector<Figure> figures = {{"loads", times},
                                   {"one load", seconds * 1000 / (warm_up + times), "ms"},
                                   {"memory grown", grown(before.resident, after.resident) / 1024, "KiB"}};
    constexpr double most_growth = 1 << 20; // the allocator may keep a few pages
    if (grown(before.resident, after.resident) > most_growth)
        return StepResult::failed(fmt::format("memory grew by {:.1f} MiB in {} loads",
                                              grown(before.resident, after.resident) / (1 << 20), times),
                                  figures);
    if (grown(before.mappings, after.mappings) > times / 2)
        return StepResult::failed(fmt::format("{} mappings remain after {} loads: the library is not unloaded",
                                              grown(before.mappings, after.mappings), times),
                                  figures);
    if (grown(before.files, after.files) > times / 2)
        return StepResult::failed(
            fmt::format("{} files remain open after {} loads", grown(before.files, after.files), times), figures);
    return StepResult::passed(figures);
}

} // namespace restage::check
