// SPDX-License-Identifier: Apache-2.0
#include "check/sphere_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace restage::check {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;
constexpr int half_rows = SphereCells::rows / 2;
constexpr double smallest_side = 2e-5; // [rad] below this, float directions are too coarse

struct Place {
    double a, phi;
    bool upper;
};

Place place_of(const Vec3& w) {
    const double x = w[0], y = w[1], z = w[2], c = std::abs(z);
    double phi = std::atan2(y, x);
    if (phi < 0) phi += two_pi;
    // Near the pole x and y are precise, near the horizon z.
    const double a = c > 0.7 ? (x * x + y * y) / (1 + c) : 1 - c;
    return {std::clamp(a, 0.0, 1.0), phi >= two_pi ? 0 : phi, z >= 0};
}

bool is_small(const CellRect& r) {
    const double sine = std::sqrt(std::max(r.a1 * (2 - r.a1), 1e-30)); // at its outer edge
    return (r.a1 - r.a0) / sine < smallest_side && sine * (r.phi1 - r.phi0) < smallest_side;
}

// In half, across the longer side.
struct Halves {
    CellRect part[2];
    bool along_a;
};
Halves halves(const CellRect& r) {
    const double a = 0.5 * (r.a0 + r.a1), phi = 0.5 * (r.phi0 + r.phi1), sine = std::sqrt(a * (2 - a));
    if ((r.a1 - r.a0) / sine > sine * (r.phi1 - r.phi0))
        return {{{r.a0, a, r.phi0, r.phi1, r.upper}, {a, r.a1, r.phi0, r.phi1, r.upper}}, true};
    return {{{r.a0, r.a1, r.phi0, phi, r.upper}, {r.a0, r.a1, phi, r.phi1, r.upper}}, false};
}

// Three-point Gauss rule on [0, 1].
constexpr double gauss_at[3] = {0.11270166537925831, 0.5, 0.88729833462074169};
constexpr double gauss_weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
constexpr std::size_t points = 9;

} // namespace

Vec3 CellRect::at(double u, double v) const {
    const double a = a0 + u * (a1 - a0), phi = phi0 + v * (phi1 - phi0), sine = std::sqrt(a * (2 - a));
    return {static_cast<float>(sine * std::cos(phi)), static_cast<float>(sine * std::sin(phi)),
            static_cast<float>(upper ? 1 - a : a - 1)};
}

SphereCells::SphereCells(std::span<const Vec3> pilot, std::size_t most) {
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            const bool upper = r < half_rows;
            const int i = upper ? r : r - half_rows;
            nodes_.push_back({{double(i) / half_rows, double(i + 1) / half_rows, two_pi * c / columns,
                               two_pi * (c + 1) / columns, upper}});
        }
    std::vector<std::vector<Vec3>> inside(nodes_.size());
    for (const Vec3& w : pilot) {
        const Place p = place_of(w);
        const int row = std::min(static_cast<int>(p.a * half_rows), half_rows - 1) + (p.upper ? 0 : half_rows);
        const int column = std::min(static_cast<int>(p.phi / two_pi * columns), columns - 1);
        inside[static_cast<std::size_t>(row * columns + column)].push_back(w);
    }
    for (std::size_t i = 0; i < inside.size(); ++i)
        split(i, inside[i], most, 0);
}

void SphereCells::split(std::size_t node, std::vector<Vec3>& inside, std::size_t most, int depth) {
    const CellRect rect = nodes_[node].rect;
    if (inside.size() <= most || depth >= 60 || is_small(rect)) {
        nodes_[node].leaf = static_cast<std::int32_t>(leaves_.size());
        leaves_.push_back(rect);
        return;
    }
    const std::size_t first = nodes_.size();
    nodes_[node].child = static_cast<std::int32_t>(first);
    const Halves h = halves(rect);
    for (const CellRect& r : h.part)
        nodes_.push_back({r});
    std::array<std::vector<Vec3>, 2> parts;
    for (const Vec3& w : inside) {
        const Place p = place_of(w);
        parts[(h.along_a ? p.a >= h.part[0].a1 : p.phi >= h.part[0].phi1) ? 1 : 0].push_back(w);
    }
    inside.clear();
    inside.shrink_to_fit();
    for (std::size_t i = 0; i < 2; ++i)
        split(first + i, parts[i], most, depth + 1);
}

std::size_t SphereCells::find(const Vec3& w) const {
    const Place p = place_of(w);
    const int row = std::min(static_cast<int>(p.a * half_rows), half_rows - 1) + (p.upper ? 0 : half_rows);
    const int column = std::min(static_cast<int>(p.phi / two_pi * columns), columns - 1);
    auto node = static_cast<std::size_t>(row * columns + column);
    while (nodes_[node].leaf < 0) {
        const auto child = static_cast<std::size_t>(nodes_[node].child);
        const Halves h = halves(nodes_[node].rect);
        node = child + ((h.along_a ? p.a >= h.part[0].a1 : p.phi >= h.part[0].phi1) ? 1 : 0);
    }
    return static_cast<std::size_t>(nodes_[node].leaf);
}

Result<Quadrature> integrate(const SphereCells& cells, Jobs& jobs, const QuadratureOptions& options) {
    Quadrature result;
    result.cells.resize(cells.size());
    struct Part {
        std::size_t cell;
        CellRect rect;
        double share; // of the cell's tolerance
    };
    std::vector<Part> parts;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        CellRect rect = cells.cell(i);
        // Next to the horizon densities end at lines that move with wo, too close for any quadrature point to see them.
        // The error must not be the same in every column: each divides its cell differently (the golden
        // ratio spreads them evenly).
        if (rect.a1 == 1)
            for (int k = 0; k < 10; ++k) {
                CellRect far = rect;
                const double part = 0.35 + 0.3 * std::fmod(static_cast<double>(i) / std::numbers::phi, 1.0);
                rect.a0 = far.a1 = rect.a0 + part * (1 - rect.a0);
                parts.push_back({i, far, 0.5});
            }
        parts.push_back({i, rect, 0.5});
    }
    bool doubted = !options.doubtful;
    while (!parts.empty()) {
        std::vector<Vec3> directions(parts.size() * points);
        jobs.parallel_for(parts.size(), 1 << 12, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t i = begin; i < end; ++i)
                for (std::size_t k = 0; k < points; ++k)
                    directions[i * points + k] = parts[i].rect.at(gauss_at[k / 3], gauss_at[k % 3]);
        });
        RESTAGE_TRY(const std::vector<Integrand> values, options.evaluate(directions));
        result.evaluations += directions.size();
        std::vector<Integrand> sums(parts.size());
        std::vector<double> estimate(cells.size()); // of each cell: the reference of its tolerance
        for (std::size_t i = 0; i < cells.size(); ++i)
            estimate[i] = result.cells[i].value[0];
        for (std::size_t i = 0; i < parts.size(); ++i) {
            for (std::size_t k = 0; k < points; ++k)
                for (std::size_t c = 0; c < integrands; ++c)
                    sums[i][c] += values[i * points + k][c] * gauss_weight[k / 3] * gauss_weight[k % 3] *
                                  parts[i].rect.solid_angle();
            estimate[parts[i].cell] += sums[i][0];
        }
        std::vector<Part> next;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const Part& part = parts[i];
            const Integrand* f = &values[i * points];
            const double area = part.rect.solid_angle();
            // Two lower-order rules on the same points; the true error is far below their difference if f is smooth.
            const auto error_of = [&](std::size_t c) {
                const double center = f[4][c] * area, corners = 0.25 * (f[0][c] + f[2][c] + f[6][c] + f[8][c]) * area;
                return 0.25 * std::max(std::abs(sums[i][c] - center), std::abs(sums[i][c] - corners));
            };
            const double error = error_of(0);
            double others = 0;
            for (std::size_t c = 1; c < integrands; ++c)
                others = std::max(others, error_of(c));
            const bool fine = error <= options.tolerance(estimate[part.cell]) * part.share &&
                              (options.others_tolerance == 0 || others <= options.others_tolerance * part.share);
            if (fine || is_small(part.rect) || result.evaluations + next.size() * points > options.most) {
                for (std::size_t c = 0; c < integrands; ++c)
                    result.cells[part.cell].value[c] += sums[i][c];
                // If f is not smooth, and cannot be refined, the rules' difference is the error.
                result.cells[part.cell].error += fine ? error : 4 * error;
                result.cells[part.cell].others_error += fine ? others : 4 * others;
                result.certain = result.certain && fine;
                continue;
            }
            for (const CellRect& r : halves(part.rect).part)
                next.push_back({part.cell, r, 0.7 * part.share}); // errors of parts rarely share one sign
        }
        parts = std::move(next);
        if (!parts.empty() || doubted) continue;
        doubted = true;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (!options.doubtful(i, result.cells[i].value[0])) continue;
            if (result.evaluations + parts.size() * points > options.most) break;
            result.cells[i] = {};
            std::vector<CellRect> fine{cells.cell(i)};
            for (int level = 0; level < 6; ++level) {
                std::vector<CellRect> finer;
                for (const CellRect& r : fine)
                    for (const CellRect& half : halves(r).part)
                        finer.push_back(half);
                fine = std::move(finer);
            }
            for (const CellRect& r : fine)
                parts.push_back({i, r, 0.125});
        }
    }
    return result;
}

} // namespace restage::check
