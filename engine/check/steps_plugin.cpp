// SPDX-License-Identifier: Apache-2.0
// Steps that every plugin takes, whatever it provides: manifest, loading with its tables, reloading; and those of
// denoisers and importers.
#include "check/steps.hpp"

#include "base/file.hpp"
#include "plugin/manifest.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>

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
    return StepResult::passed({}, fmt::format("{} {}, {}, {}", m.id, m.version, to_string(m.kind), m.licence));
}

Result<StepResult> check_load(Subject& s) {
    const auto start = std::chrono::steady_clock::now();
    if (const auto loaded = s.load(); !loaded) {
        StepResult result = StepResult::failed(loaded.error().message);
        const auto manifest = plugin::read_manifest(s.folder / "plugin.json");
        if (manifest && !manifest->library.empty() && !fs::exists(s.folder / manifest->library))
            result.cause = "the plugin is not built yet, or this is the folder of its sources";
        return result;
    }
    const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    const plugin::Registry& r = s.registry();
    const double tables =
        static_cast<double>(r.materials().size() + r.importers().size() + r.exporters().size() + r.denoisers().size());
    return StepResult::passed({{"load", ms, "ms"}, {"tables", tables}});
}

namespace {

struct Resources {
    std::size_t resident = 0, mappings = 0, files = 0;
};

Resources resources() { // all 0 where there is no /proc: then nothing is compared
    Resources r;
    std::ifstream statm("/proc/self/statm");
    std::size_t total = 0, pages = 0;
    if (statm >> total >> pages) r.resident = pages * 4096;
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);)
        ++r.mappings;
    std::error_code code;
    for (fs::directory_iterator it("/proc/self/fd", code), end; !code && it != end; it.increment(code))
        ++r.files;
    return r;
}

} // namespace

Result<StepResult> check_reload(Subject& s) {
    constexpr int warm_up = 20, times = 100;
    Resources before;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < warm_up + times; ++i) {
        if (i == warm_up) before = resources();
        Log silent([](LogLevel, std::string_view) {});
        plugin::Registry registry(silent);
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
    constexpr double most_growth = 1 << 20; // a page here and there is the allocator's
    if (grown(before.resident, after.resident) > most_growth)
        return StepResult::failed(fmt::format("memory grew by {:.1f} MiB in {} loads",
                                              grown(before.resident, after.resident) / (1 << 20), times),
                                  figures);
    if (grown(before.mappings, after.mappings) > times / 2)
        return StepResult::failed(fmt::format("{} mappings were left behind in {} loads: the library is not unloaded",
                                              grown(before.mappings, after.mappings), times),
                                  figures);
    if (grown(before.files, after.files) > times / 2)
        return StepResult::failed(
            fmt::format("{} files were left open in {} loads", grown(before.files, after.files), times), figures);
    return StepResult::passed(figures);
}

Result<StepResult> check_denoiser(Subject& s) {
    const RestageDenoiser1& d = *s.registry().denoisers()[0].table;
    const char* reason = "";
    if (!d.available(&reason)) return StepResult::skip(std::string("not available here: ") + (reason ? reason : ""));
    constexpr std::uint32_t width = 96, height = 64;
    double worst_mean = 0, worst_rms = 0, worst_pixel = 0;
    std::string worst_at;
    for (const float level : {0.f, 0.01f, 0.5f, 1.f, 20.f}) {
        const std::vector<float> color(width * height * 3, level), albedo(width * height * 3, 0.5f);
        std::vector<float> normal(width * height * 3, 0.f), out(width * height * 3, -1.f);
        for (std::size_t i = 2; i < normal.size(); i += 3)
            normal[i] = 1;
        for (const bool guides : {true, false}) {
            RestageDenoiseJob job{};
            job.size = sizeof job, job.width = width, job.height = height;
            job.color = color.data(), job.output = out.data();
            if (guides) job.albedo = albedo.data(), job.normal = normal.data();
            job.quality = RESTAGE_DENOISE_FAST;
            const std::string what =
                fmt::format("a constant picture of {} {} guides", level, guides ? "with" : "without");
            if (!d.run(&job, &reason)) return StepResult::failed(what + ": " + (reason ? reason : "no reason given"));
            double sum = 0, squares = 0;
            for (const float x : out) {
                if (!std::isfinite(x) || x < 0) return StepResult::failed(fmt::format("{} has a pixel of {}", what, x));
                const double off = (double(x) - level) / std::max(double(level), 0.01);
                sum += off, squares += off * off;
                worst_pixel = std::max(worst_pixel, std::abs(off));
            }
            const double n = static_cast<double>(out.size()), mean = std::abs(sum / n), rms = std::sqrt(squares / n);
            worst_rms = std::max(worst_rms, rms);
            if (mean > worst_mean) worst_mean = mean, worst_at = what;
            s.alive();
        }
    }
    std::vector<Figure> figures = {{"largest change of the mean", 100 * worst_mean, "%"},
                                   {"largest RMS change", 100 * worst_rms, "%"},
                                   {"worst pixel", 100 * worst_pixel, "%"}};
    if (worst_mean > 0.01 || worst_rms > 0.05)
        return StepResult::failed(fmt::format("{} changes by {:.2g} % in the mean, {:.2g} % RMS at the worst", worst_at,
                                              100 * worst_mean, 100 * worst_rms),
                                  figures);
    return StepResult::passed(figures);
}

// Files that are not its own: probing and loading them ends with an answer, not with a crash.
Result<StepResult> check_importer(Subject& s) {
    const RestageImporter1& importer = *s.registry().importers()[0].table;
    std::error_code code;
    const fs::path folder = fs::temp_directory_path() / fmt::format("restage-check-{}", std::random_device{}());
    fs::create_directories(folder, code);
    const struct Remove {
        const fs::path& folder;
        ~Remove() {
            std::error_code ignored;
            fs::remove_all(folder, ignored);
        }
    } remove{folder};
    std::string extension = importer.extensions ? importer.extensions : "";
    extension = extension.substr(0, extension.find_first_of("|,; "));
    Engine e = s.random("importer");
    std::size_t probed = 0;
    for (int i = 0; i < 200; ++i) {
        std::string bytes(i == 0 ? 0 : e() % 4096, '\0');
        for (char& c : bytes)
            c = static_cast<char>(i % 2 ? ' ' + e() % 95 : e() % 256);
        const fs::path file = folder / ("noise." + extension);
        RESTAGE_CHECK(write_file_atomic(file, bytes));
        const int answer = importer.probe(file.string().c_str(), bytes.data(), bytes.size());
        if (answer < 0 || answer > 100)
            return StepResult::failed(
                fmt::format("probe() of {} bytes of noise answers {}, which is not in 0..100", bytes.size(), answer));
        probed += answer > 0;
        s.alive();
    }
    return StepResult::passed({{"files of noise", 200}, {"taken for its own", static_cast<double>(probed)}});
}

} // namespace restage::check
