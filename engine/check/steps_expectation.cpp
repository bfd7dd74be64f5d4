// SPDX-License-Identifier: Apache-2.0
// Stochastic materials: eval is an estimate, and pdf a density for MIS that need not be that of the samples. So:
// what samples carry into each cell of the sphere is what eval means there, pdf is a density, light found by both
// strategies with MIS is the light found by one, and the means are reciprocal.
#include "check/steps.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace restage::check {
namespace {

constexpr int rows = 24, columns = 24; // of equal solid angle
constexpr std::size_t bins = rows * columns;
constexpr double family_alpha = 0.01;

std::size_t bin_of(const Vec3& w) {
    const double phi = std::atan2(w[1], w[0]) / (2 * std::numbers::pi);
    const int row = std::clamp(static_cast<int>((w[2] + 1.0) / 2 * rows), 0, rows - 1);
    const int column = std::clamp(static_cast<int>((phi < 0 ? phi + 1 : phi) * columns), 0, columns - 1);
    return static_cast<std::size_t>(row * columns + column);
}

// Jittered, `side` x `side` in each bin.
std::vector<Vec3> points(Engine& e, int side) {
    std::vector<Vec3> w;
    const auto at = [&](int cell, int count, int part) { return (cell + (part + double(unit(e))) / side) / count; };
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c)
            for (int i = 0; i < side * side; ++i)
                w.push_back(direction(static_cast<float>(2 * at(r, rows, i / side) - 1),
                                      static_cast<float>(2 * std::numbers::pi * at(c, columns, i % side))));
    return w;
}

// A smooth light, 0.1 to 2.1, for the comparison of strategies.
double light(const Vec3& w) {
    return 0.1 + std::pow(0.5 + 0.5 * (0.48 * w[0] + 0.36 * w[1] + 0.8 * std::abs(w[2])), 4) * 2;
}

std::string unfit(const Subject& s) {
    if (s.is(RESTAGE_MATERIAL_MIX | RESTAGE_MATERIAL_NULL)) return "has no GLSL of its own";
    if (!s.is(RESTAGE_MATERIAL_STOCHASTIC)) return "not stochastic: chi-square, integral and weight say more";
    return "";
}

struct Effort {
    std::size_t draws = 0;
    int side = 0;              // of the grid of directions in each bin
    std::uint32_t repeats = 1; // of eval in each direction
};

struct Comparison {
    double chi = 0, terms = 0, worst = 0, pdf = 0;
    double spread = 0;     // mean of the relative variance of one eval, luminance
    double mis_off = 0, mis_sigma = 0;
    std::string text;      // of the worst bin
    double chi_sigma() const { return terms > 0 ? (chi - terms) / std::sqrt(2 * terms) : 0; }
};

Result<Comparison> compare(BsdfLab& lab, const DensityCase& c, const Effort& effort) {
    Engine e(c.seed);
    const std::size_t draws = effort.draws;
    const int side = effort.side;
    RESTAGE_TRY(const std::vector<BsdfDrawn> samples, lab.draw(c.config, c.wo, e(), draws));
    const std::vector<Vec3> wi = points(e, side);
    RESTAGE_TRY(const std::vector<BsdfLooked> looked, lab.look(c.config, c.wo, wi, effort.repeats, e()));
    const double n = static_cast<double>(draws), solid = 4 * std::numbers::pi / bins;
    const double pdf_light = 1 / (4 * std::numbers::pi);
    std::vector<Mean> carried(bins), meant(bins);
    Mean plain, by_samples, by_light;
    for (Mean& m : carried)
        m.n = n;
    for (const BsdfDrawn& d : samples) {
        if (d.flags == 0 || (d.flags & delta)) {
            plain.add(0), by_samples.add(0);
            continue;
        }
        const double w = luminance(d.weight), mis = d.pdf / (d.pdf + pdf_light);
        Mean& m = carried[bin_of(d.wi)];
        m.sum += w, m.squares += w * w;
        plain.add(w * light(d.wi)), by_samples.add(w * light(d.wi) * mis);
    }
    Comparison result;
    double variances = 0, relative = 0;
    for (std::size_t i = 0; i < wi.size(); ++i) {
        const BsdfLooked& l = looked[i];
        const double f = luminance(l.eval);
        meant[i / static_cast<std::size_t>(side * side)].add(f * solid);
        result.pdf += l.pdf * solid / (side * side);
        by_light.add(f / pdf_light * light(wi[i]) * pdf_light / (pdf_light + l.pdf));
    }
    for (std::size_t b = 0; b < bins; ++b) {
        const Mean& s = carried[b];
        const Mean& v = meant[b];
        if (v.mean() > 0) relative += v.variance() * v.n / (v.mean() * v.mean()), variances += 1;
        const double variance = s.variance() + v.variance();
        // A bin that a handful of samples reach has no normal distribution yet.
        if (s.mean() * n < 40 && v.mean() * n < 40) continue;
        const double z = (s.mean() - v.mean()) / std::sqrt(variance + 1e-14);
        result.chi += z * z, result.terms += 1;
        if (std::abs(z) > result.worst) {
            result.worst = std::abs(z);
            const std::size_t at = b * static_cast<std::size_t>(side * side);
            result.text = fmt::format("around wi {} samples carry {:.5g} +- {:.2g}, eval means {:.5g} +- {:.2g}",
                                      describe(wi[at]), s.mean(), s.sigma(), v.mean(), v.sigma());
        }
    }
    result.spread = variances > 0 ? relative / variances : 0;
    result.mis_off = by_samples.mean() + by_light.mean() - plain.mean();
    result.mis_sigma = std::sqrt(by_samples.variance() + by_light.variance() + plain.variance());
    return result;
}

} // namespace

Result<StepResult> check_expectation(Subject& s) {
    if (const std::string why = unfit(s); !why.empty()) return StepResult::skip(why);
    RESTAGE_TRY(BsdfLab* const lab, s.lab());
    Engine e = s.random("expectation");
    std::vector<DensityCase> cases;
    for (const scene::ParamSet& set : config_grid(s.table(), e, s.size(10, 3)))
        for (const double theta : {10.0, 50.0, 80.0, 89.9, 135.0})
            cases.push_back({set, from_degrees(theta, uniform(e, 0, 360)), e()});
    double worst_z = 0, worst_chi = 0, largest_pdf = 0, spread = 0, worst_mis = 0, worst_chi_terms = 1, again = 0;
    std::size_t chi_at = 0, bin_at = 0;
    std::string chi_text, bin_text;
    // Estimates have longer tails than a normal distribution: more sigma than Sidak asks for.
    const double limit_mis = two_sided_sigma(sidak(family_alpha, cases.size())) + 1, limit_chi = limit_mis + 1;
    const double limit_bin = two_sided_sigma(sidak(family_alpha, cases.size() * bins)) + 1.5;
    const Effort first{s.size(1'000'000, 100'000), s.options.quick ? 8 : 16, 1};
    // An estimate whose mean comes from one look in thousands (a sharp coat, far from its mirror direction) seems too
    // small, and its error too, to whoever looks a few hundred times. What is biased is still biased on a longer look.
    const Effort second{first.draws * 4, first.side * 2, 16};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        RESTAGE_TRY(Comparison c, compare(*lab, cases[i], first));
        if (c.chi_sigma() > limit_chi || c.worst > limit_bin) {
            cases[i].seed = e(), again += 1;
            RESTAGE_TRY(c, compare(*lab, cases[i], second));
        }
        const std::string at = "\n  with " + where(cases[i].config, cases[i].wo);
        if (c.pdf > 1.02)
            return StepResult::failed(fmt::format("pdf integrates to {:.3f}: it is no density{}", c.pdf, at));
        const double mis = std::abs(c.mis_off) / (c.mis_sigma + 1e-9);
        if (mis > limit_mis)
            return StepResult::failed(
                fmt::format("MIS with this pdf is biased: {:+.5f} +- {:.5f} against samples "
                            "alone{}",
                            c.mis_off, c.mis_sigma, at));
        worst_mis = std::max(worst_mis, mis), largest_pdf = std::max(largest_pdf, c.pdf), spread += c.spread;
        const double z = c.chi_sigma();
        if (z > worst_chi) worst_chi = z, worst_chi_terms = c.terms, chi_at = i, chi_text = c.text;
        if (c.worst > worst_z) worst_z = c.worst, bin_at = i, bin_text = c.text;
    }
    std::vector<Figure> figures = {{"configurations", double(cases.size())},
                                   {"looked at again", again},
                                   {"worst bin", worst_z, "sigma"},
                                   {"worst sum over bins", worst_chi, "sigma"},
                                   {"largest integral of pdf", largest_pdf},
                                   {"relative variance of one eval, mean", spread / double(cases.size())},
                                   {"MIS against samples alone, worst", worst_mis, "sigma"}};
    if (worst_chi > limit_chi)
        return StepResult::failed(
            fmt::format("samples do not carry what eval means: {:.1f} sigma over {} bins\n  {}\n  "
                        "with {}",
                        worst_chi, worst_chi_terms, chi_text, where(cases[chi_at].config, cases[chi_at].wo)),
            figures);
    if (worst_z > limit_bin)
        return StepResult::failed(fmt::format("samples do not carry what eval means: {:.1f} sigma in one bin\n  {}\n  "
                                              "with {}",
                                              worst_z, bin_text, where(cases[bin_at].config, cases[bin_at].wo)),
                                  figures);
    return StepResult::passed(figures);
}

// Of the means of many estimates, at fewer places.
Result<StepResult> check_mean_reciprocity(Subject& s) {
    RESTAGE_TRY(BsdfLab* const lab, s.lab());
    Engine e = s.random("reciprocity");
    const std::size_t sets = s.size(300, 100);
    constexpr std::size_t streams = 32;
    std::vector<scene::ParamSet> configs;
    std::vector<BsdfJob> jobs;
    for (std::uint32_t i = 0; i < sets; ++i) {
        configs.push_back(wide_config(s.table(), e));
        const Vec3 a = random_direction(e, 0.1f), b = random_direction(e, 0.1f);
        for (std::size_t k = 0; k < streams; ++k) {
            jobs.push_back({.wo = a, .wi = b, .config = i, .seed = e()});
            jobs.push_back({.wo = b, .wi = a, .config = i, .seed = e()});
        }
    }
    RESTAGE_TRY(const std::vector<BsdfAnswer> answers,
                lab->run(configs, jobs, static_cast<std::uint32_t>(s.size(256, 64))));
    double worst = 0;
    std::string text;
    for (std::size_t i = 0; i < sets; ++i) {
        Mean there, back;
        for (std::size_t k = 0; k < 2 * streams; ++k) {
            const std::size_t j = i * 2 * streams + k;
            (k % 2 ? back : there).add(luminance(answers[j].eval) / jobs[j].wi[2]);
        }
        const double z = std::abs(there.mean() - back.mean()) /
                         std::sqrt(there.variance() + back.variance() + 1e-12 + std::pow(1e-3 * there.mean(), 2));
        if (z <= worst) continue;
        worst = z;
        text = fmt::format(
            "f(wo, wi) is {:.5g} +- {:.2g}, f(wi, wo) is {:.5g} +- {:.2g} (luminance, means)\n  with {}; "
            "wi {}",
            there.mean(), there.sigma(), back.mean(), back.sigma(), where(configs[i], jobs[i * 2 * streams].wo),
            describe(jobs[i * 2 * streams].wi));
    }
    std::vector<Figure> figures = {{"pairs", double(sets)}, {"worst", worst, "sigma"}};
    if (worst > two_sided_sigma(sidak(family_alpha, sets)) + 2) return StepResult::failed(text, figures);
    return StepResult::passed(figures);
}

} // namespace restage::check
