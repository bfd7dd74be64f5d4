// SPDX-License-Identifier: Apache-2.0
#include "check/pictures.hpp"

#include "base/base64.hpp"
#include "base/file.hpp"
#include "io/image_file.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace restage::check {

namespace fs = std::filesystem;
using scene::ParamSet;
using scene::Value;

namespace {

constexpr double pi = std::numbers::pi;

Result<std::string> image_tag(const scene::PixelData& image, const fs::path& folder, const std::string& caption) {
    const fs::path file = folder / "restage-check-picture.png";
    RESTAGE_CHECK(io::write_png(file.string(), image));
    RESTAGE_TRY(const std::string png, read_file(file));
    std::error_code ignored;
    fs::remove(file, ignored);
    return fmt::format(
        "<figure><img src=\"data:image/png;base64,{}\" width=\"{}\" "
        "height=\"{}\"><figcaption>{}</figcaption></figure>\n",
        encode_base64(png), image.width, image.height, caption);
}

// In the plane of incidence, from the front's left horizon over the pole and around the back.
Result<std::string> polar_plot(BsdfLab& lab, const ParamSet& set, const Vec3& wo, std::uint32_t seed) {
    constexpr int bins = 180;
    constexpr std::size_t draws = 1 << 20;
    constexpr double half_band = 0.05; // sine of the latitude above the plane
    RESTAGE_TRY(const std::vector<BsdfDrawn> samples, lab.draw(set, wo, seed, draws));
    std::vector<double> counted(bins), expected(bins);
    const double step = 2 * pi / bins, band = step * 2 * half_band;
    double lost = 0;
    for (const BsdfDrawn& d : samples) {
        if (d.flags == 0 || (d.flags & delta)) {
            lost += 1;
            continue;
        }
        if (std::abs(d.wi[1]) > half_band) continue;
        const double angle = std::atan2(d.wi[0], d.wi[2]) + pi;
        counted[static_cast<std::size_t>(std::min(angle / step, bins - 1.0))] += 1 / (double(draws) * band);
    }
    constexpr int across = 5, along = 8;
    std::vector<Vec3> wi;
    for (int b = 0; b < bins; ++b)
        for (int i = 0; i < across * along; ++i) {
            const double angle = (b + (i / across + 0.5) / along) * step - pi;
            const double y = half_band * ((i % across + 0.5) / across * 2 - 1), r = std::sqrt(1 - y * y);
            wi.push_back({static_cast<float>(r * std::sin(angle)), static_cast<float>(y),
                          static_cast<float>(r * std::cos(angle))});
        }
    RESTAGE_TRY(const std::vector<BsdfLooked> looked, lab.look(set, wo, wi, lab.table().stochastic ? 64 : 1));
    for (std::size_t i = 0; i < looked.size(); ++i)
        expected[i / (across * along)] += looked[i].pdf / (across * along);
    double most = 1e-9;
    for (int b = 0; b < bins; ++b)
        most = std::max({most, counted[std::size_t(b)], expected[std::size_t(b)]});
    // Square roots, so that a lobe's base is visible next to its peak.
    const auto point = [&](int b, double value) {
        const double angle = (b + 0.5) * step - pi, r = 140 * std::sqrt(value / most);
        return fmt::format("{:.1f},{:.1f} ", 160 + r * std::sin(angle), 160 - r * std::cos(angle));
    };
    std::string bars, line;
    for (int b = 0; b < bins; ++b) {
        if (counted[std::size_t(b)] > 0)
            bars += fmt::format("<path d=\"M160,160 L{}\"/>", point(b, counted[std::size_t(b)]));
        line += point(b, expected[std::size_t(b)]);
    }
    return fmt::format(
        "<figure><svg width=\"320\" height=\"320\" viewBox=\"0 0 320 320\"><circle cx=\"160\" cy=\"160\" r=\"140\" "
        "fill=\"none\" stroke=\"#ccc\"/><path d=\"M10,160 H310\" stroke=\"#888\"/><g stroke=\"#e9a23b\" "
        "stroke-width=\"3\">{}</g><polygon points=\"{}\" fill=\"none\" stroke=\"#1f4e8c\" stroke-width=\"1.5\"/>"
        "<path d=\"M160,160 L{:.1f},{:.1f}\" stroke=\"#c00\" stroke-dasharray=\"4 3\"/></svg><figcaption>{}; wo {} "
        "(red).<br>Orange: samples, blue: pdf, square roots, largest {:.3g} 1/sr; {:.1f} % of the samples are delta or "
        "absorbed.</figcaption></figure>\n",
        bars, line, 160 + 150.0 * wo[0], 160 - 150.0 * wo[2], describe(set), degrees(wo), most,
        100 * lost / double(draws));
}

// A plain sky: bright above, ground below, and a round lamp, 14 degrees from centre to edge.
Vec3 sky(const Vec3& w) {
    const float up = 0.5f + 0.5f * w[1];
    const bool lamp = w[0] * -0.5f + w[1] * 0.6f + w[2] * 0.6245f > 0.97f;
    if (lamp) return {5, 4.8f, 4.4f};
    if (w[1] < 0) {
        const bool dark = (static_cast<int>(std::floor(4 * w[0] / std::max(-w[1], 0.05f))) +
                           static_cast<int>(std::floor(4 * w[2] / std::max(-w[1], 0.05f)))) &
                          1;
        return dark ? Vec3{0.12f, 0.11f, 0.1f} : Vec3{0.35f, 0.33f, 0.3f};
    }
    return {0.3f + 0.3f * up, 0.4f + 0.3f * up, 0.5f + 0.4f * up};
}

// A distant sphere, one bounce: transmitted light is looked up in the sky as it leaves the front.
template <class Light>
Result<scene::PixelData> ball(BsdfLab& lab, const ParamSet& set, int size, int samples, std::uint32_t seed, bool power,
                              Light&& light) {
    Engine e(seed);
    std::vector<BsdfJob> jobs;
    struct Frame {
        Vec3 t, b, n;
    };
    std::vector<std::pair<std::size_t, Frame>> pixels;
    scene::PixelData image{.width = std::uint32_t(size), .height = std::uint32_t(size), .channels = 3};
    for (int i = 0; i < size * size; ++i) {
        const float x = (2.f * (i % size) + 1) / size - 1, y = 1 - (2.f * (i / size) + 1) / size;
        const float r2 = (x * x + y * y) * 1.05f;
        const Vec3 behind = light(Vec3{x * 0.3f, y * 0.3f, -0.95f});
        image.values.insert(image.values.end(), behind.begin(), behind.end());
        if (r2 >= 1) continue;
        const Vec3 n{x * 1.0247f, y * 1.0247f, std::sqrt(1 - r2)};
        const float s = std::max(std::hypot(n[0], n[2]), 1e-6f);
        const Vec3 t{n[2] / s, 0, -n[0] / s};
        const Vec3 b{n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]};
        pixels.push_back({std::size_t(i), {t, b, n}});
        for (int k = 0; k < samples; ++k)
            jobs.push_back({.wo = {t[2], b[2], n[2]}, .u = unit3(e), .seed = e()});
    }
    RESTAGE_TRY(const std::vector<BsdfAnswer> answers, lab.run({&set, 1}, jobs));
    for (std::size_t p = 0; p < pixels.size(); ++p) {
        const Frame& f = pixels[p].second;
        Vec3 sum{};
        for (std::size_t k = 0; k < std::size_t(samples); ++k) {
            const BsdfAnswer& a = answers[p * std::size_t(samples) + k];
            if (a.flags == 0) continue;
            Vec3 w{};
            for (std::size_t c = 0; c < 3; ++c)
                w[c] = f.t[c] * a.wi[0] + f.b[c] * a.wi[1] + f.n[c] * a.wi[2];
            const Vec3 l = light(w);
            for (std::size_t c = 0; c < 3; ++c)
                sum[c] += l[c] * a.weight[c] * (power ? a.eta * a.eta : 1) / static_cast<float>(samples);
        }
        std::copy(sum.begin(), sum.end(), image.values.begin() + static_cast<std::ptrdiff_t>(pixels[p].first * 3));
    }
    return image;
}

void with_white(const model::Material& table, ParamSet& set) {
    for (const model::Param& p : table.params)
        if (p.type == model::ParamType::color && !set.find(p.id) && p.max == 1) set.set(p.id, Value::color(1, 1, 1));
    keep_sum(table, set);
}

} // namespace

Result<fs::path> write_pictures(Subject& s, const fs::path& folder) {
    std::error_code code;
    fs::create_directories(folder, code);
    if (code) return fail(folder.string() + ": cannot be created: " + code.message());
    RESTAGE_TRY(BsdfLab* const lab, s.lab());
    const std::string type = s.table().type;
    std::string page = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>{0}</title>\n<style>body{{font:14px "
        "sans-serif;max-width:1100px;margin:2em auto}}figure{{display:inline-block;margin:8px;vertical-align:top;"
        "max-width:320px}}figcaption{{font-size:12px;color:#444}}</style>\n<h1>{0}</h1>\n<p>Written by <code>restage "
        "check "
        "{0} --pictures</code>, seed {1}.</p>\n<h2>Samples and pdf, in the plane of incidence</h2>\n",
        type, s.options.seed);
    ParamSet rough = rough_config(s.table(), 0.3f, 0.3f);
    std::vector<ParamSet> sets{{}};
    if (!rough.entries().empty()) sets.push_back(rough);
    for (const ParamSet& set : sets)
        for (const double theta : {40.0, 80.0, 140.0}) {
            RESTAGE_TRY(const std::string plot, polar_plot(*lab, set, from_degrees(theta, 0), s.options.seed));
            page += plot;
        }
    page += "<h2>In a white furnace (every colour 1; background 0.5 times the light)</h2>\n";
    for (ParamSet set : sets) {
        const std::string what = describe(set);
        with_white(s.table(), set);
        RESTAGE_TRY(scene::PixelData image,
                    ball(*lab, set, 160, 64, s.options.seed, true, [](const Vec3&) { return Vec3{1, 1, 1}; }));
        for (float& v : image.values)
            v *= 0.5f;
        RESTAGE_TRY(const std::string tag, image_tag(image, folder, what + ", colours white"));
        page += tag;
    }
    page += "<h2>Under a plain sky, one bounce</h2>\n";
    std::vector<std::pair<std::string, ParamSet>> sweep{{"the defaults", {}}};
    if (!rough.entries().empty())
        for (const float r : {0.f, 0.1f, 0.3f, 0.6f, 1.f})
            sweep.push_back({fmt::format("roughness {:g}", r), rough_config(s.table(), r, r)});
    for (const auto& [caption, set] : sweep) {
        RESTAGE_TRY(const scene::PixelData image, ball(*lab, set, 160, 144, s.options.seed, false, sky));
        RESTAGE_TRY(const std::string tag, image_tag(image, folder, caption));
        page += tag;
    }
    const fs::path file = folder / (type + ".html");
    RESTAGE_CHECK(write_file_atomic(file, page + "</html>\n"));
    return file;
}

} // namespace restage::check
