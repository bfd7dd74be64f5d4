// SPDX-License-Identifier: Apache-2.0
#include "render/filter_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace restage::render {

double filter_value(const scene::Filter& f, int axis, double x) {
    using scene::FilterKind;
    const double r = f.radius[axis];
    x = std::abs(x);
    if (x > r) return 0;
    switch (f.kind) {
        case FilterKind::box:
            return 1;
        case FilterKind::triangle:
            return r - x;
        case FilterKind::gaussian: { // pbrt 4ed, 8.8.4
            const double s = f.params.x;
            return std::max(0.0, std::exp(-x * x / (2 * s * s)) - std::exp(-r * r / (2 * s * s)));
        }
        case FilterKind::mitchell: { // Mitchell and Netravali 1988, eq. 8, stretched to the radius
            const double b = f.params.x, c = f.params.y;
            const double t = 2 * x / r;
            if (t <= 1) return ((12 - 9 * b - 6 * c) * t * t * t + (-18 + 12 * b + 6 * c) * t * t + (6 - 2 * b)) / 6;
            return ((-b - 6 * c) * t * t * t + (6 * b + 30 * c) * t * t + (-12 * b - 48 * c) * t + (8 * b + 24 * c)) /
                   6;
        }
        case FilterKind::sinc: { // Lanczos-windowed; pbrt 4ed, 8.8.5
            const auto sinc = [](double v) {
                v *= std::numbers::pi;
                return std::abs(v) < 1e-6 ? 1.0 : std::sin(v) / v;
            };
            return sinc(x) * sinc(x / f.params.x);
        }
    }
    return 0;
}

FilterTable make_filter_table(const scene::Filter& f) {
    constexpr std::uint32_t n = 256;
    constexpr int steps = 16; // midpoint rule within an entry
    FilterTable table;
    table.entries = n;
    table.data.resize(2 * (n + 1) + 2 * n);
    for (int axis = 0; axis < 2; ++axis) {
        const double r = f.radius[axis];
        float* cdf = &table.data[axis * (n + 1)];
        float* sign = &table.data[2 * (n + 1) + axis * n];
        std::vector<double> mass(n);
        double positive = 0, net = 0;
        for (std::uint32_t i = 0; i < n; ++i) {
            double sum = 0;
            for (int k = 0; k < steps; ++k)
                sum += filter_value(f, axis, (2 * (i + (k + 0.5) / steps) / n - 1) * r);
            mass[i] = std::abs(sum);
            sign[i] = sum < 0 ? -1.f : 1.f;
            positive += mass[i];
            net += sum;
        }
        double running = 0;
        for (std::uint32_t i = 0; i < n; ++i) {
            cdf[i] = float(running / positive);
            running += mass[i];
        }
        cdf[n] = 1;
        table.weight[axis] = float(positive / net);
    }
    return table;
}

} // namespace restage::render
