// SPDX-License-Identifier: Apache-2.0
#include "render/environment_map.hpp"

#include "render/cdf_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace restage::render {
namespace {

// Like environment_texel in shaders/lib/environment.glsl.
std::size_t texel(int width, int height, scene::Mapping mapping, int x, int y) {
    if (mapping == scene::Mapping::octahedral) {
        if (x < 0 || x >= width) x = x < 0 ? -1 - x : 2 * width - 1 - x, y = height - 1 - y;
        if (y < 0 || y >= height) x = width - 1 - x, y = y < 0 ? -1 - y : 2 * height - 1 - y;
    } else {
        x = (x + width) % width;
        y = std::clamp(y, 0, height - 1);
    }
    return std::size_t(y) * std::size_t(width) + std::size_t(x);
}

void make_tables(EnvironmentMap& map, scene::Mapping mapping) {
    const int w = int(map.width), h = int(map.height);
    std::vector<double> rows(std::size_t(h) + 1), cells(std::size_t(w) + 1);
    map.columns.reserve(rows.size() * cells.size());
    for (int y = 0; y <= h; ++y) {
        const float y0 = y == 0 ? 0.5f : 0.f, y1 = y == h ? 0.5f : 1.f, my = 0.5f * (y0 + y1); // part within the image
        const auto column = [&](int x) { // density at the cell's middle height
            const float a = map.texels[texel(w, h, mapping, x, y - 1)].w, b = map.texels[texel(w, h, mapping, x, y)].w;
            return a + (b - a) * my;
        };
        float left = column(-1);
        rows[std::size_t(y)] = 0;
        for (int x = 0; x <= w; ++x) {
            const float x0 = x == 0 ? 0.5f : 0.f, x1 = x == w ? 0.5f : 1.f;
            const float right = column(x);
            // the integral of a bilinear function is its value in the middle times the area
            cells[std::size_t(x)] =
                double(left + (right - left) * 0.5f * (x0 + x1)) * double(x1 - x0) * double(y1 - y0);
            rows[std::size_t(y)] += cells[std::size_t(x)];
            left = right;
        }
        auto table = make_cdf(cells);
        table.resize(cells.size()); // all zero: never drawn
        map.columns.insert(map.columns.end(), table.begin(), table.end());
    }
    map.rows = make_cdf(rows);
}

// Share of the power in the brightest `angle` sr. weight: of each texel [luminance times its row's solid angle], all in
// units of which `total` are the sphere.
double brightest(const std::vector<double>& weights, const std::function<double(std::size_t)>& solid_angle,
                 double total, double angle) {
    struct Bin {
        double power = 0, angle = 0;
    };
    constexpr int per_octave = 8, octaves = 64; // of luminance
    std::array<Bin, per_octave * octaves> bins;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (!(weights[i] > 0)) continue;
        const double texel = solid_angle(i), level = std::log2(weights[i] / texel);
        Bin& bin = bins[std::size_t(std::clamp((level + octaves / 2.0) * per_octave, 0.0, double(bins.size() - 1)))];
        bin.power += weights[i];
        bin.angle += texel;
    }
    double all = 0, sum = 0, left = angle * total / (4 * std::numbers::pi);
    for (std::size_t k = bins.size(); k-- > 0;) {
        const Bin& bin = bins[k];
        all += bin.power;
        if (!(left > 0) || !(bin.angle > 0)) continue;
        sum += bin.power * std::min(1.0, left / bin.angle);
        left -= bin.angle;
    }
    return all > 0 ? sum / all : 0;
}

} // namespace

EnvironmentMap make_environment_map(const scene::PixelData* image, scene::Mapping mapping, bool compensate) {
    EnvironmentMap map;
    if (!image || image->width == 0 || image->height == 0) {
        map.mean = glm::vec3(1);
        return map;
    }
    map.width = image->width;
    map.height = image->height;
    const std::size_t n = std::size_t(map.width) * map.height;
    map.texels.resize(n);
    std::vector<double> weights(n);
    glm::dvec3 sum(0);
    double total = 0;
    // Of a row's texels, up to a factor; exact: the difference of the cosines at its edges.
    const auto solid_angle = [&](std::size_t y) {
        return mapping == scene::Mapping::equirect ? std::cos(std::numbers::pi * double(y) / map.height) -
                                                         std::cos(std::numbers::pi * double(y + 1) / map.height)
                                                   : 1.0;
    };
    for (std::uint32_t y = 0; y < map.height; ++y) {
        const double row = solid_angle(y);
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const std::size_t i = std::size_t(y) * map.width + x;
            const float* v = &image->values[i * image->channels];
            glm::vec3 c = image->channels >= 3 ? glm::vec3(v[0], v[1], v[2]) : glm::vec3(v[0]);
            for (int k = 0; k < 3; ++k)
                if (!(std::isfinite(c[k]) && c[k] >= 0)) {
                    c[k] = 0;
                    ++map.mended;
                }
            map.texels[i] = glm::vec4(c, 0);
            weights[i] = row * (0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z);
            sum += row * glm::dvec3(c);
            total += row;
        }
    }
    map.mean = glm::vec3(sum / total);
    const double mean = 0.2126 * map.mean.x + 0.7152 * map.mean.y + 0.0722 * map.mean.z;
    if (!(mean > 0)) {
        map.texels.clear();
        return map;
    }
    map.focus = float(brightest(weights, [&](std::size_t i) { return solid_angle(i / map.width); }, total, 0.1));
    if (compensate) {
        std::vector<double> brighter(n);
        double left = 0;
        for (std::size_t i = 0; i < n; ++i)
            left += brighter[i] = std::max(0.0, weights[i] - mean * solid_angle(i / map.width));
        if (left > 1e-6 * mean * total) weights = std::move(brighter); // else it is constant
    }
    double all = 0;
    for (double w : weights)
        all += w;
    for (std::size_t i = 0; i < n; ++i)
        map.texels[i].w = float(weights[i] / all * double(n));
    make_tables(map, mapping);
    return map;
}

} // namespace restage::render
