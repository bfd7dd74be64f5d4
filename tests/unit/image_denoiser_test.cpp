// SPDX-License-Identifier: Apache-2.0
// Denoiser plugins: every installed one improves a noisy picture and reports progress; oidn without its library
// reports it. The library is fetched by tools/setup, so its absence is a failure here, not a reason to skip.
#include "image_test_files.hpp"
#include "io/services.hpp"
#include "paths.hpp"
#include "plugin/registry.hpp"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

using namespace restage;

namespace {

constexpr unsigned width = 160, height = 96;

struct Pictures {
    std::vector<float> truth, noisy, albedo, normal; // 3 per pixel
};

// A checkered floor under a soft light, with noise as of few samples (exponential, so the mean is right).
Pictures make_pictures() {
    std::mt19937 random(11);
    std::exponential_distribution<float> exponential;
    std::normal_distribution<float> normal;
    Pictures p;
    for (unsigned y = 0; y < height; ++y)
        for (unsigned x = 0; x < width; ++x) {
            const bool dark = (x / 20 + y / 16) % 2;
            const float light = 4 * std::exp(-0.001f * (float(x) - 80) * (float(x) - 80));
            const float noise = exponential(random);
            for (int c = 0; c < 3; ++c) {
                const float albedo = dark ? 0.1f : 0.3f + 0.2f * float(c);
                p.truth.push_back(albedo * light);
                p.noisy.push_back(albedo * light * noise);
                p.albedo.push_back(std::clamp(albedo + 0.05f * normal(random), 0.f, 1.f));
                p.normal.push_back(c == 1 ? 1.f : 0.f);
            }
        }
    return p;
}

double mean_square_error(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += double(a[i] - b[i]) * (a[i] - b[i]);
    return sum / double(a.size());
}

class Plugins {
  public:
    Plugins() : registry_(log_, io::with_services()) {
        const plugin::SearchPath path[] = {{restage::test::build_dir() / "lib/restage/plugins", true}};
        registry_.scan(path);
    }
    const plugin::Denoiser& oidn() {
        const auto entry = registry_.find_denoiser("oidn");
        REQUIRE(entry);
        return *entry->table;
    }
    const plugin::Registry& registry() const { return registry_; }

  private:
    Log log_{[](LogLevel, std::string_view) {}};
    plugin::Registry registry_;
};

class Environment { // a variable, until the end of the test
  public:
    Environment(const char* name, const std::string& value) : name_(name) { setenv(name, value.c_str(), 1); }
    ~Environment() { unsetenv(name_); }

  private:
    const char* name_;
};

plugin::DenoiseJob make_job(const Pictures& p, std::vector<float>& output, plugin::DenoiseQuality quality) {
    return {.width = width,
            .height = height,
            .color = p.noisy.data(),
            .albedo = p.albedo.data(),
            .normal = p.normal.data(),
            .output = output.data(),
            .quality = quality,
            .threads = 2,
            .progress = {}};
}

} // namespace

TEST_CASE("denoiser: every plugin lowers the error of a noisy picture, with guides more than without") {
    Plugins plugins;
    REQUIRE(plugins.registry().denoisers().size() >= 1);
    const Pictures p = make_pictures();
    const double before = mean_square_error(p.noisy, p.truth);
    for (const auto& entry : plugins.registry().denoisers()) {
        CAPTURE(entry.table->type);
        REQUIRE(entry.table->available());
        for (const auto quality :
             {plugin::DenoiseQuality::fast, plugin::DenoiseQuality::balanced, plugin::DenoiseQuality::high}) {
            std::vector<float> guided(p.noisy.size()), blind(p.noisy.size());
            auto job = make_job(p, guided, quality);
            REQUIRE(entry.table->run(job));
            job = make_job(p, blind, quality);
            job.albedo = job.normal = nullptr;
            REQUIRE(entry.table->run(job));
            const double with = mean_square_error(guided, p.truth), without = mean_square_error(blind, p.truth);
            CAPTURE(int(quality), before, with, without);
            CHECK(without < before / 8);
            CHECK(with < without);
            double sum = 0, truth = 0; // brightness is kept
            for (std::size_t i = 0; i < guided.size(); ++i) {
                sum += guided[i];
                truth += p.truth[i];
            }
            CHECK(std::abs(sum / truth - 1) < 0.05);
        }
    }
}

TEST_CASE("denoiser: output may be the input, normals may be the only guide") {
    Plugins plugins;
    const Pictures p = make_pictures();
    std::vector<float> apart(p.noisy.size()), in_place = p.noisy;
    auto job = make_job(p, apart, plugin::DenoiseQuality::fast);
    job.albedo = nullptr;
    REQUIRE(plugins.oidn().run(job));
    job.color = job.output = in_place.data();
    REQUIRE(plugins.oidn().run(job));
    CHECK(mean_square_error(in_place, apart) < 1e-9);
}

TEST_CASE("denoiser: progress runs from 0 to 1 and can stop the job") {
    Plugins plugins;
    const Pictures p = make_pictures();
    std::vector<float> output(p.noisy.size());
    struct Seen {
        std::vector<double> done;
        bool stop = false;
    } seen;
    auto job = make_job(p, output, plugin::DenoiseQuality::high);
    job.progress = [&seen](double done) {
        seen.done.push_back(done);
        return !seen.stop;
    };
    REQUIRE(plugins.oidn().run(job));
    REQUIRE(seen.done.size() >= 3);
    CHECK(std::is_sorted(seen.done.begin(), seen.done.end()));
    CHECK(seen.done.front() < 0.3);
    CHECK(seen.done.back() > 0.9);
    CHECK(seen.done.back() <= 1);
    seen.stop = true;
    const auto stopped = plugins.oidn().run(job);
    REQUIRE_FALSE(stopped);
    CHECK(stopped.error().message == "stopped");
    seen.stop = false;
    CHECK(plugins.oidn().run(job)); // and it works again
}

TEST_CASE("denoiser: a job without a picture is refused") {
    Plugins plugins;
    const Pictures p = make_pictures();
    std::vector<float> output(p.noisy.size());
    auto job = make_job(p, output, plugin::DenoiseQuality::fast);
    job.color = nullptr;
    const auto refused = plugins.oidn().run(job);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message.find("no picture") != std::string::npos);
}

TEST_CASE("denoiser: oidn without its library is unavailable and says why") {
    const test::TemporaryFolder folder;
    {
        const Environment path("RESTAGE_OIDN_PATH", folder / "nowhere");
        Plugins plugins;
        const auto usable = plugins.oidn().available();
        REQUIRE_FALSE(usable);
        CHECK(usable.error().message.find("nowhere") != std::string::npos);
        CHECK(usable.error().message.find("not found") != std::string::npos);
        const Pictures p = make_pictures();
        std::vector<float> output(p.noisy.size());
        const auto job = make_job(p, output, plugin::DenoiseQuality::fast);
        const auto done = plugins.oidn().run(job);
        REQUIRE_FALSE(done);
        CHECK(done.error().message.find("not found") != std::string::npos);
    }
    Plugins again; // the result is not cached after the plugin is unloaded
    CHECK(again.oidn().available());
}
