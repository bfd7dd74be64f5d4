// SPDX-License-Identifier: Apache-2.0
// Denoisers: a constant picture of any size is unchanged, with all guides, some or none; non-finite pixels
// do no harm; it can be cancelled; the same picture twice gives the same bytes.
#include "check/steps.hpp"
#include "check/workplace.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace restage::check {
namespace {

enum Guides : unsigned { none = 0, albedo = 1, normal = 2, both = 3 };
constexpr std::size_t canary = 64; // floats past the output that must stay untouched
constexpr float canary_value = -12345.5f;

struct Picture {
    std::uint32_t width, height;
    std::vector<float> color, albedo, normal, out;
    Picture(std::uint32_t w, std::uint32_t h, float level)
        : width(w),
          height(h),
          color(std::size_t{w} * h * 3, level),
          albedo(color.size(), 0.5f),
          normal(color.size(), 0.f),
          out(color.size() + canary, canary_value) {
        for (std::size_t i = 2; i < normal.size(); i += 3)
            normal[i] = 1;
    }
    plugin::DenoiseJob job(unsigned guides, plugin::DenoiseQuality quality = plugin::DenoiseQuality::fast) {
        plugin::DenoiseJob job{};
        job.width = width, job.height = height;
        job.color = color.data(), job.output = out.data();
        job.albedo = guides & Guides::albedo ? albedo.data() : nullptr;
        job.normal = guides & Guides::normal ? normal.data() : nullptr;
        job.quality = quality, job.threads = 1;
        return job;
    }
    bool overrun() const {
        return std::any_of(out.end() - canary, out.end(), [](float x) { return x != canary_value; });
    }
    std::string describe(unsigned guides) const {
        static constexpr const char* with[] = {"no guides", "albedo only", "normals only", "guides"};
        return fmt::format("{}x{} pixels with {}", width, height, with[guides & 3]);
    }
};

struct Change { // relative to a constant level
    double mean = 0, rms = 0, pixel = 0;
};

struct Lab {
    Subject& s;
    const plugin::Denoiser& d = *s.denoiser;
    std::size_t runs = 0;

    // "" or what is wrong.
    std::string run(const plugin::DenoiseJob& job, const Picture& p, const std::string& what) {
        const std::vector<float> before = p.color;
        s.doing("run() of " + what);
        ++runs;
        const auto done = d.run(job);
        s.alive();
        if (!done) return what + ": refused: " + done.error().message;
        if (p.overrun()) return what + ": it writes past the end of its output";
        if (job.output != job.color && std::memcmp(before.data(), p.color.data(), before.size() * sizeof(float)) != 0)
            return what + ": it changes its input picture";
        const float* out = job.output;
        for (std::size_t i = 0; i < p.color.size(); ++i)
            if (!std::isfinite(out[i]) || out[i] < 0)
                return fmt::format("{}: pixel ({}, {}) is {}", what, i / 3 % p.width, i / 3 / p.width, out[i]);
        return "";
    }
};

Change change(const float* out, std::size_t count, float level) {
    Change c;
    for (std::size_t i = 0; i < count; ++i) {
        const double off = (double(out[i]) - level) / std::max(double(level), 0.01);
        c.mean += off, c.rms += off * off, c.pixel = std::max(c.pixel, std::abs(off));
    }
    c.mean = std::abs(c.mean / double(count)), c.rms = std::sqrt(c.rms / double(count));
    return c;
}

std::string unavailable(const Subject& s) {
    const auto usable = s.denoiser->available();
    return usable ? "" : "not available here: " + usable.error().message;
}

} // namespace

Result<StepResult> check_denoise(Subject& s) {
    if (const std::string why = unavailable(s); !why.empty()) return StepResult::skip(why);
    Lab lab{s};
    Change worst;
    std::string worst_at;
    for (const float level : {0.f, 0.01f, 0.5f, 1.f, 20.f})
        for (const unsigned guides : {both, none}) {
            Picture p(96, 64, level);
            const std::string what = fmt::format("a constant picture of {}, {}", level, p.describe(guides));
            if (const std::string bad = lab.run(p.job(guides), p, what); !bad.empty()) return StepResult::failed(bad);
            const Change c = change(p.out.data(), p.color.size(), level);
            worst.rms = std::max(worst.rms, c.rms), worst.pixel = std::max(worst.pixel, c.pixel);
            if (c.mean > worst.mean) worst.mean = c.mean, worst_at = what;
        }
    std::vector<Figure> figures = {{"largest change of the mean", 100 * worst.mean, "%"},
                                   {"largest RMS change", 100 * worst.rms, "%"},
                                   {"worst pixel", 100 * worst.pixel, "%"}};
    if (worst.mean > 0.01 || worst.rms > 0.05)
        return StepResult::failed(fmt::format("{} changes by {:.2g} % in the mean, {:.2g} % RMS at the worst", worst_at,
                                              100 * worst.mean, 100 * worst.rms),
                                  figures);
    return StepResult::passed(figures);
}

Result<StepResult> check_denoise_sizes(Subject& s) {
    if (const std::string why = unavailable(s); !why.empty()) return StepResult::skip(why);
    Lab lab{s};
    double worst = 0;
    constexpr std::uint32_t sizes[][2] = {{1, 1}, {1, 7}, {5, 1}, {2, 2}, {17, 31}, {63, 65}, {257, 3}, {130, 97}};
    for (const auto& [width, height] : sizes)
        for (const unsigned guides : {both, albedo, normal, none}) {
            Picture p(width, height, 0.5f);
            const std::string what = p.describe(guides);
            if (const std::string bad = lab.run(p.job(guides), p, what); !bad.empty()) return StepResult::failed(bad);
            const Change c = change(p.out.data(), p.color.size(), 0.5f);
            worst = std::max(worst, c.rms);
            if (c.rms > 0.2)
                return StepResult::failed(
                    fmt::format("{}: a constant picture changes by {:.2g} % RMS", what, 100 * c.rms));
        }
    // In place, each quality.
    for (const auto quality :
         {plugin::DenoiseQuality::fast, plugin::DenoiseQuality::balanced, plugin::DenoiseQuality::high}) {
        Picture p(33, 21, 0.5f);
        plugin::DenoiseJob job = p.job(both, quality);
        job.output = p.color.data();
        const std::string what = fmt::format("33x21 pixels in place, quality {}", static_cast<int>(quality));
        if (const std::string bad = lab.run(job, p, what); !bad.empty()) return StepResult::failed(bad);
    }
    return StepResult::passed({{"pictures", double(lab.runs)}, {"largest RMS change", 100 * worst, "%"}});
}

Result<StepResult> check_denoise_robust(Subject& s) {
    if (const std::string why = unavailable(s); !why.empty()) return StepResult::skip(why);
    Lab lab{s};
    Engine e = s.random("robust");
    constexpr float bad_values[] = {std::numeric_limits<float>::quiet_NaN(),
                                    std::numeric_limits<float>::infinity(),
                                    -std::numeric_limits<float>::infinity(),
                                    -1.f,
                                    1e30f,
                                    1e-40f};
    for (const float x : bad_values)
        for (const bool all : {false, true}) {
            Picture p(48, 40, 0.5f);
            for (std::vector<float>* data : {&p.color, &p.albedo, &p.normal})
                for (float& v : *data)
                    if (all || e() % 50 == 0) v = x;
            const std::string what =
                fmt::format("{} in {}, {}", x, all ? "every pixel" : "some pixels", p.describe(both));
            // Refusing, with a reason, is a valid answer.
            s.doing("run() of " + what);
            const auto done = lab.d.run(p.job(both));
            s.alive();
            if (!done && done.error().message == plugin::Denoiser::no_reason)
                return StepResult::failed(what + ": refused without a reason");
            if (p.overrun()) return StepResult::failed(what + ": it writes past the end of its output");
            if (!done) continue;
            for (std::size_t i = 0; i < p.color.size(); ++i)
                if (!std::isfinite(p.out[i]))
                    return StepResult::failed(fmt::format("{}: pixel ({}, {}) of the result is {}", what,
                                                          i / 3 % p.width, i / 3 / p.width, p.out[i]));
        }
    // Bit-identical when run twice; on noise, its real input.
    Picture p(120, 75, 0);
    for (float& v : p.color)
        v = -std::log(1 - unit(e));
    std::vector<float> first;
    for (int k = 0; k < 2; ++k) {
        if (const std::string bad = lab.run(p.job(both, plugin::DenoiseQuality::high), p, "120x75 pixels of noise");
            !bad.empty())
            return StepResult::failed(bad);
        if (k == 0)
            first = p.out;
        else if (first != p.out)
            return StepResult::failed("denoising the same picture twice gives different results");
    }
    // Cancelled at each call.
    struct Stop {
        std::size_t calls, stop_at;
    } stop{0, ~std::size_t{0}};
    plugin::DenoiseJob job = p.job(both);
    job.progress = [&](double) { return ++stop.calls < stop.stop_at; };
    if (const std::string bad = lab.run(job, p, "120x75 pixels, with progress"); !bad.empty())
        return StepResult::failed(bad);
    const std::size_t all = stop.calls;
    for (std::size_t k = 1; k <= all; k += std::max<std::size_t>(all / s.size(64, 8), 1)) {
        stop = {0, k};
        s.doing(fmt::format("run(), stopped at call {} of progress()", k));
        const bool done = lab.d.run(job).has_value();
        s.alive();
        if (done && k < all)
            return StepResult::failed(fmt::format("stopped at call {} of {} of progress(), run() returns 1", k, all));
    }
    return StepResult::passed({{"pictures", double(lab.runs)}, {"calls of progress()", double(all)}},
                              all == 0 ? "it never calls progress(), so it cannot be stopped" : "");
}

Result<StepResult> check_denoise_leaks(Subject& s) {
    if (const std::string why = unavailable(s); !why.empty()) return StepResult::skip(why);
    Lab lab{s};
    Picture p(24, 16, 0.5f);
    std::size_t run = 0;
    return check_nothing_left("run(), to its end and stopped,", [&]() -> Result<> {
        if (const std::string bad = lab.run(p.job(run % 4), p, p.describe(run % 4)); !bad.empty()) return fail(bad);
        plugin::DenoiseJob job = p.job(both);
        std::size_t calls = 0;
        job.progress = [&](double) { return calls++ < run % 3; };
        (void)lab.d.run(job);
        ++run;
        return {};
    });
}

} // namespace restage::check
