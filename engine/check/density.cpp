// SPDX-License-Identifier: Apache-2.0
#include "check/density.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace restage::check {
namespace {

constexpr std::size_t pilot_draws = 1 << 16;
constexpr std::size_t most_in_cell = 160; // of the pilot's samples: 0.24 %
constexpr std::size_t most_evaluations = 3'000'000;
// Allowed error of an expected count, in its standard deviations: adds at most 1 % to chi-square.
constexpr double integral_sigma = 0.1;

bool is_direction(const Vec3& w) { // anything else is not on the sphere
    const double length = std::hypot(double(w[0]), double(w[1]), double(w[2]));
    return length > 0.5 && length < 2;
}
bool is_spread(const BsdfDrawn& s) { return s.flags != 0 && (s.flags & delta) == 0 && is_direction(s.wi); }

std::string say_cell(const SphereCells& cells, std::size_t i, double expected, double counted) {
    const Vec3 w = cells.cell(i).at(0.5, 0.5);
    return fmt::format("{} samples around wi {}, {:.1f} expected by pdf", counted, describe(w), expected);
}

} // namespace

double DensityResult::integral_off(double sigmas) const {
    // Delta and absorbed samples are the remainder to 1.
    const double sigma = std::sqrt(std::max(spread * (1 - spread), 1 / draws) / draws);
    return std::abs(pdf_integral - spread) / (sigmas * sigma + pdf_error + 1e-4);
}

double DensityResult::reach_off(double sigmas) const {
    double most = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double carried = weight[k].mean(), meant = eval_integral[k];
        const double allowed = sigmas * weight[k].sigma() + eval_error + 2e-3 * std::max(carried, meant) + 1e-4;
        most = std::max(most, std::abs(carried - meant) / allowed);
    }
    return most;
}

Result<DensityResult> measure_density(BsdfLab& lab, Jobs& jobs, const DensityCase& c, std::size_t draws) {
    DensityResult result;
    result.draws = static_cast<double>(draws);
    RESTAGE_TRY(const std::vector<BsdfDrawn> pilot, lab.draw(c.config, c.wo, c.seed * 2 + 1, pilot_draws));
    std::vector<Vec3> directions;
    for (const BsdfDrawn& s : pilot)
        if (is_spread(s)) directions.push_back(s.wi);
    const SphereCells cells(directions, most_in_cell);

    RESTAGE_TRY(const std::vector<BsdfDrawn> samples, lab.draw(c.config, c.wo, c.seed * 2, draws));
    std::vector<double> observed(cells.size()), expected(cells.size());
    std::vector<std::uint32_t> found(samples.size()); // the search dominates the CPU work
    jobs.parallel_for(samples.size(), 1 << 14, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i)
            if (is_spread(samples[i])) found[i] = static_cast<std::uint32_t>(cells.find(samples[i].wi));
    });
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const BsdfDrawn& s = samples[i];
        const bool spread = is_spread(s);
        result.bad_samples +=
            s.flags != 0 && (!is_direction(s.wi) || !std::isfinite(s.weight[0] + s.weight[1] + s.weight[2]));
        result.spread += spread / result.draws;
        if (spread) observed[found[i]] += 1;
        for (std::size_t k = 0; k < 3; ++k)
            result.weight[k].add(spread ? double(s.weight[k]) : 0);
        if (spread) result.carried_side[s.wi[2] * c.wo[2] > 0 ? 0 : 1] += luminance(s.weight) / result.draws;
    }

    const auto evaluate = [&](std::span<const Vec3> wi) -> Result<std::vector<Integrand>> {
        RESTAGE_TRY(const std::vector<BsdfLooked> looked, lab.look(c.config, c.wo, wi));
        std::vector<Integrand> values(looked.size());
        for (std::size_t i = 0; i < looked.size(); ++i) {
            const BsdfLooked& l = looked[i];
            const bool sound = std::isfinite(l.pdf) && l.pdf >= 0;
            if (!sound) result.bad_pdf += 1;
            const bool there = std::isfinite(luminance(l.eval));
            values[i] = {sound ? double(l.pdf) : 0, there ? double(l.eval[0]) : 0, there ? double(l.eval[1]) : 0,
                         there ? double(l.eval[2]) : 0};
        }
        return values;
    };
    const auto tolerance = [&](double p) { return integral_sigma * std::sqrt(p * result.draws + 1) / result.draws; };
    const auto doubtful = [&](std::size_t cell, double value) {
        const double n = value * result.draws;
        return std::abs(observed[cell] - n) > 2.5 * std::sqrt(n + 1);
    };
    // Of eval, to 0.01 % of all light in each cell with a hundredth of it.
    double carried = 0;
    for (const Mean& m : result.weight)
        carried = std::max(carried, m.mean());
    const double eval_tolerance = 1e-6 * std::max(carried, 0.05);
    RESTAGE_TRY(const Quadrature q, integrate(cells, jobs,
                                              {.evaluate = evaluate,
                                               .tolerance = tolerance,
                                               .most = most_evaluations,
                                               .doubtful = doubtful,
                                               .others_tolerance = eval_tolerance}));
    result.evaluations = q.evaluations;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const CellIntegral& cell = q.cells[i];
        expected[i] = cell.value[0] * result.draws;
        result.pdf_integral += cell.value[0], result.pdf_error += cell.error;
        for (std::size_t k = 0; k < 3; ++k)
            result.eval_integral[k] += cell.value[k + 1];
        result.eval_error += cell.others_error;
        result.eval_side[cells.cell(i).upper == (c.wo[2] > 0) ? 0 : 1] +=
            0.2126 * cell.value[1] + 0.7152 * cell.value[2] + 0.0722 * cell.value[3];
        // What quadrature cannot resolve (a discontinuity finer than float directions) is no evidence on the samples.
        if (cell.error * result.draws > 0.5 * std::sqrt(expected[i] + 1)) {
            result.unresolved += cell.value[0];
            observed[i] = expected[i] = 0;
            continue;
        }
        const double sigma = std::abs(observed[i] - expected[i]) / std::sqrt(expected[i] + 1);
        if (sigma > result.worst_sigma) {
            result.worst_sigma = sigma;
            result.worst = say_cell(cells, i, expected[i], observed[i]);
        }
    }
    result.chi = chi_square(observed, expected);
    return result;
}

} // namespace restage::check
