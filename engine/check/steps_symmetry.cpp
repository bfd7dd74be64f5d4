// SPDX-License-Identifier: Apache-2.0
// Reciprocity, and that a rough surface converges to the smooth one as its roughness goes to 0.
#include "check/neighbourhood.hpp"
#include "check/steps.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace restage::check {

using scene::ParamSet;

// Helmholtz, with Veach's eta^2 (1997, Eq. 5.12): f(wo,wi) eta_i^2 / eta_o^2 = f(wi,wo) in radiance transport.
Result<StepResult> check_reciprocity(Subject& s) {
    if (!s.table().has_code()) return StepResult::skip("has no GLSL");
    if (s.table().nonreciprocal) return StepResult::skip("NONRECIPROCAL is declared");
    if (s.table().stochastic) return check_mean_reciprocity(s);
    RESTAGE_TRY(BsdfLab* const lab, s.lab());
    Engine e = s.random("reciprocity");
    const std::size_t sets = s.size(1000, 250);
    std::vector<ParamSet> configs;
    for (std::size_t i = 0; i < sets; ++i)
        configs.push_back(i % 2 ? wide_config(s.table(), e) : random_config(s.table(), e));
    std::vector<BsdfJob> jobs(s.size(300'000, 40'000));
    for (BsdfJob& job : jobs)
        job = {.wo = random_direction(e), .u = unit3(e), .config = static_cast<std::uint32_t>(e() % sets)};
    RESTAGE_TRY(const std::vector<BsdfAnswer> answers, lab->run(configs, jobs));
    constexpr double tolerance = 1e-3;
    std::vector<std::size_t> suspects;
    std::vector<double> off;
    std::size_t compared = 0, symmetric = 0;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const BsdfAnswer& a = answers[i];
        if (a.flags == 0 || (a.flags & delta) || a.wi[2] == 0 || jobs[i].wo[2] == 0) continue;
        ++compared;
        const double co = std::abs(jobs[i].wo[2]), ci = std::abs(a.wi[2]);
        double worst = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            // Times both cosines: the difference in exchanged energy.
            const double there = double(a.eval_sampled[c]) * a.eta * a.eta * co, back = double(a.eval_reverse[c]) * ci;
            worst = std::max(worst, std::abs(there - back) - tolerance * std::max({there, back, 1e-6}));
        }
        if (worst <= 0) continue;
        suspects.push_back(i), off.push_back(worst);
        symmetric +=
            std::abs(luminance(a.eval_sampled) - luminance(a.eval_reverse)) < 1e-3f * luminance(a.eval_sampled);
    }
    if (compared == 0) return StepResult::skip("all its lobes are delta");
    RESTAGE_TRY(const std::vector<Neighbourhood> around, neighbourhoods(s, configs, jobs, answers, suspects));
    std::size_t bad = 0;
    std::string text;
    for (std::size_t k = 0; k < suspects.size(); ++k) {
        const std::size_t i = suspects[k];
        const BsdfAnswer& a = answers[i];
        const double co = std::abs(jobs[i].wo[2]), ci = std::abs(a.wi[2]);
        if (off[k] <= around[k].value * a.eta * a.eta * co + around[k].reverse * ci) continue;
        if (bad++ > 0) continue;
        text = fmt::format("f(wo, wi) is {:.6g}, f(wi, wo) is {:.6g} (luminance{})\n  with {}; wi {} ({})",
                           luminance(a.eval_sampled) / ci * a.eta * a.eta, luminance(a.eval_reverse) / co,
                           (a.flags & transmit) ? ", eta^2 undone" : "", where(configs[jobs[i].config], jobs[i].wo),
                           describe(a.wi), degrees(a.wi));
    }
    std::vector<Figure> figures = {{"pairs", double(compared)},
                                   {"beyond 1e-3 by rounding of directions alone", double(suspects.size() - bad)}};
    if (bad == 0) return StepResult::passed(figures);
    StepResult result = StepResult::failed(fmt::format("{} ({} of {} pairs)", text, bad, compared), figures);
    if (symmetric * 10 > suspects.size() * 9)
        result.cause = "eval itself is symmetric: it lacks the factor |cos wi| (eval returns f * |cos wi|)";
    return result;
}

namespace {

Vec3 turned(const Vec3& w, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {static_cast<float>(c * w[0] - s * w[1]), static_cast<float>(s * w[0] + c * w[1]), w[2]};
}

// For a stochastic material: means of many estimates, at fewer places. Two measurements, as estimates have long tails.
Result<StepResult> check_mean_isotropy(Subject& s) {
    RESTAGE_TRY(BsdfLab* const lab, s.lab());
    Engine e = s.random("isotropy");
    constexpr std::size_t streams = 32;
    const std::size_t sets = s.size(200, 60);
    const double limit = two_sided_sigma(sidak(0.01, sets)) + 2;
    double worst = 0;
    std::vector<scene::ParamSet> configs;
    std::vector<BsdfJob> jobs;
    for (std::uint32_t i = 0; i < sets; ++i) {
        configs.push_back(wide_config(s.table(), e));
        const Vec3 wo = random_direction(e), wi = random_direction(e);
        const double angle = uniform(e, 0.3f, 2.8f);
        for (std::size_t k = 0; k < streams; ++k) {
            jobs.push_back({.wo = wo, .wi = wi, .config = i, .seed = e()});
            jobs.push_back({.wo = turned(wo, angle), .wi = turned(wi, angle), .config = i, .seed = e()});
        }
    }
    for (const std::uint32_t repeats : {s.size(64, 16), s.size(1024, 256)}) {
        RESTAGE_TRY(const std::vector<BsdfAnswer> answers,
                    lab->run(configs, jobs, static_cast<std::uint32_t>(repeats)));
        worst = 0;
        std::string text;
        for (std::size_t i = 0; i < sets; ++i) {
            Mean here, there;
            for (std::size_t k = 0; k < 2 * streams; ++k)
                (k % 2 ? there : here).add(luminance(answers[i * 2 * streams + k].eval));
            const double z = std::abs(here.mean() - there.mean()) /
                             std::sqrt(here.variance() + there.variance() + 1e-12 + std::pow(1e-3 * here.mean(), 2));
            if (z <= worst) continue;
            worst = z;
            const BsdfJob &a = jobs[i * 2 * streams], &b = jobs[i * 2 * streams + 1];
            text = fmt::format(
                "eval is {:.5g} +- {:.2g}, and {:.5g} +- {:.2g} when both directions are rotated about the "
                "normal, but TANGENT is not declared\n  with {}; wi {}; rotated wo {} wi {}",
                here.mean(), here.sigma(), there.mean(), there.sigma(), where(configs[i], a.wo), describe(a.wi),
                describe(b.wo), describe(b.wi));
        }
        if (worst <= limit) break;
        if (repeats == s.size(1024, 256)) return StepResult::failed(text, {{"worst", worst, "sigma"}});
        for (BsdfJob& job : jobs)
            job.seed = e();
    }
    return StepResult::passed({{"pairs", double(sets)}, {"worst", worst, "sigma"}});
}

} // namespace

// Without TANGENT the frame's x axis is arbitrary: dependence on it would vary between triangles.
Result<StepResult> check_isotropy(Subject& s) {
    if (!s.table().has_code()) return StepResult::skip("has no GLSL");
    if (s.table().tangent) return StepResult::skip("TANGENT is declared");
    if (s.table().stochastic) return check_mean_isotropy(s);
    RESTAGE_TRY(BsdfLab* const lab, s.lab());
    Engine e = s.random("isotropy");
    const std::size_t sets = s.size(500, 100);
    std::vector<ParamSet> configs;
    for (std::size_t i = 0; i < sets; ++i)
        configs.push_back(i == 0 ? ParamSet{} : i % 2 ? wide_config(s.table(), e) : random_config(s.table(), e));
    std::vector<BsdfJob> jobs(s.size(100'000, 20'000));
    for (BsdfJob& job : jobs)
        job = {.wo = random_direction(e),
               .wi = random_direction(e),
               .u = unit3(e),
               .config = static_cast<std::uint32_t>(e() % sets)};
    RESTAGE_TRY(const std::vector<BsdfAnswer> sampled, lab->run(configs, jobs));
    std::vector<BsdfJob> turned_jobs = jobs;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const BsdfAnswer& a = sampled[i];
        // Half of them in the lobes.
        if (i % 2 && a.flags != 0 && !(a.flags & delta) && std::isfinite(a.wi[0] + a.wi[1] + a.wi[2]))
            jobs[i].wi = a.wi;
        const double angle = uniform(e, 0.3f, 6.f);
        turned_jobs[i].wo = turned(jobs[i].wo, angle), turned_jobs[i].wi = turned(jobs[i].wi, angle);
    }
    RESTAGE_TRY(const std::vector<BsdfAnswer> here, lab->run(configs, jobs));
    RESTAGE_TRY(const std::vector<BsdfAnswer> there, lab->run(configs, turned_jobs));
    // Rotation rounds: changes of eval and pdf from the last digits of wi do not count.
    std::vector<std::size_t> suspects;
    std::vector<double> off;
    constexpr double tolerance = 1e-3;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const double a = luminance(here[i].eval), b = luminance(there[i].eval);
        const double p = here[i].pdf, q = there[i].pdf;
        const double worst = std::max(std::abs(a - b) - tolerance * std::max({a, b, 1e-5}),
                                      std::abs(p - q) - tolerance * std::max({p, q, 1e-5}));
        if (worst > 0) suspects.push_back(i), off.push_back(worst);
    }
    std::vector<BsdfAnswer> at = here; // neighbourhoods() perturbs the sampled directions
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        at[i].wi = jobs[i].wi, at[i].eval_sampled = here[i].eval, at[i].pdf_sampled = here[i].pdf;
        at[i].eval_reverse = here[i].eval;
    }
    RESTAGE_TRY(const std::vector<Neighbourhood> around, neighbourhoods(s, configs, jobs, at, suspects));
    std::size_t bad = 0;
    std::string text;
    for (std::size_t k = 0; k < suspects.size(); ++k) {
        const std::size_t i = suspects[k];
        if (off[k] <= 2 * std::max(around[k].value, around[k].pdf)) continue;
        if (bad++ > 0) continue;
        text = fmt::format(
            "eval is {:.6g} and pdf {:.6g}; when both directions are rotated about the normal, {:.6g} and "
            "{:.6g}, but TANGENT is not declared\n  with {}; wi {}; rotated wo {} wi {}",
            luminance(here[i].eval), here[i].pdf, luminance(there[i].eval), there[i].pdf,
            where(configs[jobs[i].config], jobs[i].wo), describe(jobs[i].wi), describe(turned_jobs[i].wo),
            describe(turned_jobs[i].wi));
    }
    std::vector<Figure> figures = {{"pairs", double(jobs.size())},
                                   {"beyond 1e-3 by rounding of directions alone", double(suspects.size() - bad)}};
    if (bad > 0) return StepResult::failed(fmt::format("{} ({} of {} pairs)", text, bad, jobs.size()), figures);
    return StepResult::passed(figures);
}

namespace {

ParamSet with_roughness(const model::Material& table, float r) { return rough_config(table, r, r); }

Result<double> delta_share(BsdfLab& lab, const ParamSet& set, const Vec3& wo) {
    RESTAGE_TRY(const std::vector<BsdfDrawn> samples, lab.draw(set, wo, 7, 4096));
    double n = 0;
    for (const BsdfDrawn& d : samples)
        n += (d.flags & delta) != 0;
    return n / static_cast<double>(samples.size());
}

// The light reflected from a few smooth environments: 1, a gradient along each axis, and broad lobes.
constexpr std::size_t environments = 8;
double environment(std::size_t i, const Vec3& w, const Vec3& wo) {
    switch (i) {
        case 0:
            return 1;
        case 1:
            return 0.5 + 0.5 * w[0];
        case 2:
            return 0.5 + 0.5 * w[1];
        case 3:
            return 0.5 + 0.5 * w[2];
        default: { // around the mirrored, the opposite, the up and the sideways direction
            const Vec3 axes[] = {
                {-wo[0], -wo[1], wo[2]}, {-wo[0], -wo[1], -wo[2]}, {0, 0, wo[2] > 0 ? 1.f : -1.f}, {1, 0, 0}};
            const Vec3& a = axes[i - 4];
            return std::exp(10 * (double(w[0]) * a[0] + double(w[1]) * a[1] + double(w[2]) * a[2] - 1));
        }
    }
}

Result<std::array<Mean, environments>> response(BsdfLab& lab, const ParamSet& set, const Vec3& wo, std::uint32_t seed,
                                                std::size_t draws) {
    RESTAGE_TRY(const std::vector<BsdfDrawn> samples, lab.draw(set, wo, seed, draws));
    std::array<Mean, environments> means;
    for (const BsdfDrawn& d : samples)
        for (std::size_t i = 0; i < environments; ++i)
            means[i].add(d.flags == 0 ? 0 : luminance(d.weight) * environment(i, d.wi, wo));
    return means;
}

} // namespace

Result<StepResult> check_limit(Subject& s) {
    if (!s.table().has_code()) return StepResult::skip("has no GLSL");
    if (with_roughness(s.table(), 0).entries().empty()) return StepResult::skip("no parameter is named a roughness");
    RESTAGE_TRY(BsdfLab* const lab, s.lab());
    const Vec3 tilted = from_degrees(40, 20);
    RESTAGE_TRY(const double smooth_delta, delta_share(*lab, with_roughness(s.table(), 0), tilted));
    if (smooth_delta == 0) return StepResult::skip("roughness 0 is not a delta lobe");
    // The smallest roughness without that lobe, by bisection of its logarithm.
    double lo = -12, hi = std::log10(0.5);
    RESTAGE_TRY(const double rough_delta, delta_share(*lab, with_roughness(s.table(), 0.5f), tilted));
    if (rough_delta >= smooth_delta) return StepResult::skip("roughness 0.5 is as much a delta lobe as 0");
    for (int i = 0; i < 24; ++i) {
        const double mid = 0.5 * (lo + hi);
        RESTAGE_TRY(const double d, delta_share(*lab, with_roughness(s.table(), float(std::pow(10, mid))), tilted));
        (d > 0.5 * (smooth_delta + rough_delta) ? lo : hi) = mid;
    }
    const auto threshold = static_cast<float>(std::pow(10, hi) * 1.0001);
    constexpr double tolerance = 0.01;
    double worst = 0;
    Engine e = s.random("limit");
    for (const double theta : {0.0, 40.0, 70.0, 80.0, 140.0, 100.0}) {
        const Vec3 wo = from_degrees(theta, uniform(e, 0, 360));
        const std::size_t draws = s.size(1 << 18, 1 << 15);
        RESTAGE_TRY(const auto smooth, response(*lab, with_roughness(s.table(), 0), wo, e(), draws));
        RESTAGE_TRY(const auto rough, response(*lab, with_roughness(s.table(), threshold), wo, e(), draws));
        for (std::size_t i = 0; i < environments; ++i) {
            const double off = std::abs(smooth[i].mean() - rough[i].mean());
            const double sigma = std::sqrt(smooth[i].variance() + rough[i].variance());
            worst = std::max(worst, off);
            if (off > 5 * sigma + tolerance)
                return StepResult::failed(fmt::format(
                    "the picture jumps where a lobe stops being delta: under smooth light {:.4f} (roughness 0) "
                    "becomes {:.4f} (roughness {:.3g}), +- {:.4f}\n  with wo {} ({})",
                    smooth[i].mean(), rough[i].mean(), threshold, sigma, describe(wo), degrees(wo)));
        }
    }
    return StepResult::passed({{"threshold", threshold, "roughness"}, {"largest difference", worst}});
}

} // namespace restage::check
