// SPDX-License-Identifier: Apache-2.0
// sample, pdf and eval are consistent: chi-square of samples against pdf, the integral of pdf, weight = eval / pdf.
#include "check/neighbourhood.hpp"
#include "check/steps.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace restage::check {
namespace {

constexpr double family_alpha = 0.01;

std::string not_for(const Subject& s) {
    if (!s.table().has_code()) return "has no GLSL";
    if (s.table().stochastic) return "stochastic: see step expectation";
    return "";
}

std::string name_case(const DensityCase& c) { return "with " + where(c.config, c.wo); }

} // namespace

Result<StepResult> check_chi_square(Subject& s) {
    if (const std::string why = not_for(s); !why.empty()) return StepResult::skip(why);
    RESTAGE_TRY(const std::vector<DensityResult>* const all, s.densities());
    std::size_t tests = 0, failed = 0, worst = 0, again = 0;
    double least = 2, draws = 0, unresolved = 0, terms = 0, evaluations = 0;
    for (std::size_t i = 0; i < all->size(); ++i) {
        const DensityResult& r = (*all)[i];
        if (r.bad_samples > 0)
            return StepResult::failed(fmt::format(
                "{} of {} samples have an invalid direction (not finite, or not a unit vector), or a weight that is "
                "not finite\n  {}",
                r.bad_samples, r.draws, name_case(s.density_cases()[i])));
        if (r.bad_pdf > 0)
            return StepResult::failed(fmt::format("pdf is not finite, or negative, in {} directions\n  {}", r.bad_pdf,
                                                  name_case(s.density_cases()[i])));
        draws += r.draws, unresolved = std::max(unresolved, r.unresolved), evaluations += double(r.evaluations);
        if (r.spread == 0 && r.pdf_integral < 1e-6) continue; // delta lobes only
        ++tests, terms += double(r.chi.terms), again += r.again;
        if (r.chi.p < least) least = r.chi.p, worst = i;
    }
    if (tests == 0) return StepResult::skip("all its lobes are delta");
    const double threshold = sidak(family_alpha, tests);
    for (const DensityResult& r : *all)
        failed += (r.spread > 0 || r.pdf_integral >= 1e-6) && r.chi.p < threshold;
    std::vector<Figure> figures = {{"configurations", double(tests)},
                                   {"measured again", double(again)},
                                   {"samples of each", draws / double(all->size())},
                                   {"bins compared, mean", terms / double(tests)},
                                   {"least p", least},
                                   {"threshold (Sidak)", threshold},
                                   {"largest fraction of pdf left unresolved", unresolved}};
    if (failed == 0) return StepResult::passed(figures);
    const DensityResult& r = (*all)[worst];
    return StepResult::failed(
        fmt::format("samples do not follow pdf: chi-square {:.1f} over {} bins, p = {:.2g} < {:.2g} ({} of {} "
                    "configurations fail)\n  {}\n  worst bin: {}",
                    r.chi.statistic, r.chi.terms, r.chi.p, threshold, failed, tests,
                    name_case(s.density_cases()[worst]), r.worst),
        figures);
}

Result<StepResult> check_integral(Subject& s) {
    if (const std::string why = not_for(s); !why.empty()) return StepResult::skip(why);
    RESTAGE_TRY(const std::vector<DensityResult>* const all, s.densities());
    const double sigmas = two_sided_sigma(sidak(family_alpha, all->size()));
    double worst = -1, largest = 0, least_spread = 1;
    std::string text;
    for (std::size_t i = 0; i < all->size(); ++i) {
        const DensityResult& r = (*all)[i];
        const double off = r.integral_off(sigmas);
        largest = std::max(largest, std::abs(r.pdf_integral - r.spread));
        least_spread = std::min(least_spread, r.spread);
        if (off <= 1 || off <= worst) continue;
        worst = off;
        text = fmt::format(
            "pdf integrates to {:.5f} (+- {:.1g}), but {:.5f} of the samples are neither delta nor "
            "absorbed\n  {}",
            r.pdf_integral, r.pdf_error, r.spread, name_case(s.density_cases()[i]));
    }
    std::vector<Figure> figures = {{"configurations", double(all->size())},
                                   {"largest difference", largest},
                                   {"most delta or absorbed", 1 - least_spread}};
    return worst > 0 ? StepResult::failed(text, figures) : StepResult::passed(figures);
}

Result<StepResult> check_reach(Subject& s) {
    if (const std::string why = not_for(s); !why.empty()) return StepResult::skip(why);
    RESTAGE_TRY(const std::vector<DensityResult>* const all, s.densities());
    const double sigmas = two_sided_sigma(sidak(family_alpha, 3 * all->size()));
    double worst = 1, largest = 0, uncertain = 0;
    std::string text;
    for (std::size_t i = 0; i < all->size(); ++i) {
        const DensityResult& r = (*all)[i];
        for (std::size_t k = 0; k < 3; ++k)
            largest = std::max(largest, std::abs(r.weight[k].mean() - r.eval_integral[k]));
        uncertain = std::max(uncertain, r.eval_error);
        const double off = r.reach_off(sigmas);
        if (off <= worst) continue;
        worst = off;
        const auto both = [](const double* side) { return side[0] + side[1]; };
        text = fmt::format(
            "samples carry {:.4f} of the light (reflected {:.4f}, transmitted {:.4f}), eval over the "
            "whole sphere {:.4f} (reflected {:.4f}, transmitted {:.4f}; +- {:.1g}): BSDF and light "
            "sampling give different pictures\n  {}",
            both(r.carried_side), r.carried_side[0], r.carried_side[1], both(r.eval_side), r.eval_side[0],
            r.eval_side[1], r.eval_error, name_case(s.density_cases()[i]));
    }
    std::vector<Figure> figures = {{"configurations", double(all->size())},
                                   {"largest difference", largest},
                                   {"largest error of the integral of eval", uncertain}};
    return text.empty() ? StepResult::passed(figures) : StepResult::failed(text, figures);
}

Result<StepResult> check_weight(Subject& s) {
    if (const std::string why = not_for(s); !why.empty()) return StepResult::skip(why);
    RESTAGE_TRY(BsdfLab* const lab, s.lab());
    Engine e = s.random("weight");
    const std::size_t sets = s.size(2000, 500);
    std::vector<scene::ParamSet> configs;
    for (std::size_t i = 0; i < sets; ++i)
        configs.push_back(random_config(s.table(), e));
    std::vector<BsdfJob> jobs(s.size(400'000, 40'000));
    for (BsdfJob& job : jobs)
        job = {.wo = random_direction(e), .u = unit3(e), .config = static_cast<std::uint32_t>(e() % sets)};
    RESTAGE_TRY(const std::vector<BsdfAnswer> answers, lab->run(configs, jobs));
    constexpr double tolerance = 1e-3;
    struct Suspect {
        std::size_t job;
        double off_pdf, off_value; // beyond the tolerance
    };
    std::vector<Suspect> suspects;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const BsdfAnswer& a = answers[i];
        if (a.flags == 0 || (a.flags & delta)) continue;
        ++compared;
        double off_value = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double f = double(a.weight[c]) * a.sample_pdf;
            off_value = std::max(off_value, std::abs(a.eval_sampled[c] - f) - tolerance * std::max<double>(f, 1e-6));
        }
        const double off_pdf = std::abs(a.pdf_sampled - a.sample_pdf) - tolerance * a.sample_pdf;
        if (off_value > 0 || off_pdf > 0) suspects.push_back({i, off_pdf, off_value});
    }
    if (compared == 0) return StepResult::skip("all its lobes are delta");
    // A direction is only known to its last digits: changes of eval and pdf when wo and wi move by eight ulps
    // (5e-7) do not count. This tolerates sharp lobes and grazing angles, nothing else.
    RESTAGE_TRY(const std::vector<Neighbourhood> around, neighbourhoods(s, configs, jobs, answers, [&] {
                    std::vector<std::size_t> which;
                    for (const Suspect& x : suspects)
                        which.push_back(x.job);
                    return which;
                }()));
    std::size_t bad = 0;
    std::string text;
    for (std::size_t k = 0; k < suspects.size(); ++k) {
        const Suspect& x = suspects[k];
        if (x.off_pdf <= around[k].pdf && x.off_value <= around[k].value) continue;
        if (bad++ > 0) continue;
        const BsdfAnswer& a = answers[x.job];
        const bool pdf = x.off_pdf > around[k].pdf;
        text = pdf ? fmt::format("a sample says its density is {:.6g}, pdf says {:.6g}", a.sample_pdf, a.pdf_sampled)
                   : fmt::format("weight * pdf of a sample is {:.6g} (luminance), eval is {:.6g}",
                                 luminance(a.weight) * a.sample_pdf, luminance(a.eval_sampled));
        text += fmt::format("\n  with {}; u {}; its wi {} ({})", where(configs[jobs[x.job].config], jobs[x.job].wo),
                            describe(jobs[x.job].u), describe(a.wi), degrees(a.wi));
    }
    std::vector<Figure> figures = {{"samples", double(compared)},
                                   {"beyond 1e-3 by rounding of directions alone", double(suspects.size() - bad)}};
    if (bad > 0) return StepResult::failed(fmt::format("{} ({} of {} samples)", text, bad, compared), figures);
    return StepResult::passed(figures);
}

} // namespace restage::check
