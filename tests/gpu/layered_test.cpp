// SPDX-License-Identifier: Apache-2.0
// Coated materials against brute force (layered_reference.hpp): the distribution of the light that leaves, bin by bin,
// from eval and from sample; and the closed form of the smooth clear coat against its integral in double precision.
#include "gpu/bench.hpp"
#include "gpu/layered_reference.hpp"

#include <catch2/catch_test_macros.hpp>

using namespace restage;
using namespace restage::test;
namespace ref = restage::test::reference;
using scene::ParamSet;
using scene::Value;

namespace {

ParamSet params_of(const ref::LayeredModel& m) {
    ParamSet set;
    set.set("thickness", Value::number(static_cast<float>(m.thickness)));
    set.set("g", Value::number(static_cast<float>(m.g)));
    const float albedo = static_cast<float>(m.albedo);
    set.set("albedo", Value::color(albedo, albedo, albedo));
    set.set("max_depth", Value::integer(m.max_depth));
    set.set("remap", Value::choice("none"));
    const float u = static_cast<float>(m.coat.x), v = static_cast<float>(m.coat.y), eta = static_cast<float>(m.eta);
    if (!m.metal) {
        const float r = static_cast<float>(m.reflectance);
        set.set("reflectance", Value::color(r, r, r));
        set.set("uroughness", Value::number(u)), set.set("vroughness", Value::number(v)),
            set.set("eta", Value::number(eta));
        return set;
    }
    set.set("interface_uroughness", Value::number(u)), set.set("interface_vroughness", Value::number(v));
    set.set("interface_eta", Value::number(eta));
    const float n = static_cast<float>(m.ior.real() * m.eta), k = static_cast<float>(m.ior.imag() * m.eta);
    set.set("conductor_eta", Value::color(n, n, n)), set.set("conductor_k", Value::color(k, k, k));
    set.set("conductor_uroughness", Value::number(static_cast<float>(m.base.x)));
    set.set("conductor_vroughness", Value::number(static_cast<float>(m.base.y)));
    return set;
}

struct Estimate { // a mean with its variance
    double sum = 0, squares = 0;
    void add(double x) { sum += x, squares += x * x; }
    double mean(double n) const { return sum / n; }
    double variance(double n) const { return std::max(0.0, squares / n - sum / n * (sum / n)) / n; }
};
double sigmas(const Estimate& a, double na, const Estimate& b, double nb) {
    return std::abs(a.mean(na) - b.mean(nb)) / std::sqrt(a.variance(na) + b.variance(nb) + 1e-10);
}

constexpr int rows = 6, columns = 4, bins = rows * columns; // of the upper hemisphere, equal solid angles
int bin_of(double x, double y, double z) {
    const double phi = std::atan2(y, x) / (2 * ref::pi);
    return std::clamp(static_cast<int>(z * rows), 0, rows - 1) * columns +
           std::clamp(static_cast<int>((phi < 0 ? phi + 1 : phi) * columns), 0, columns - 1);
}

void against_brute_force(BsdfLab& lab, const ref::LayeredModel& m, Engine& e, double& chi2, int& terms) {
    constexpr int walks = 100000, draws = 1 << 16, points = 2048;
    const double z = uniform(e, 0.25f, 1.f);
    const Vec3 wo = direction(static_cast<float>(z), uniform(e, 0, 6.3f));
    std::array<Estimate, bins> brute{}, sampled{}, evaluated{};
    Estimate brute_delta, sampled_delta;
    ref::Random random{std::mt19937_64(e())};
    for (int i = 0; i < walks; ++i)
        if (const auto exit = ref::layered_walk(m, {wo[0], wo[1], wo[2]}, random)) {
            if (exit->delta)
                brute_delta.add(exit->weight);
            else
                brute[static_cast<std::size_t>(bin_of(exit->wi.x, exit->wi.y, exit->wi.z))].add(exit->weight);
        }
    std::vector<BsdfJob> jobs;
    for (int i = 0; i < draws; ++i)
        jobs.push_back({.wo = wo, .u = unit3(e), .seed = e()});
    for (int b = 0; b < bins; ++b)
        for (int p = 0; p < points; ++p)
            jobs.push_back(
                {.wo = wo,
                 .wi = direction((static_cast<float>(b / columns) + unit(e)) / rows,
                                 2 * std::numbers::pi_v<float> * (static_cast<float>(b % columns) + unit(e)) / columns),
                 .seed = e()});
    const ParamSet set = params_of(m);
    const auto answers = lab.run({&set, 1}, jobs);
    for (std::size_t i = 0; i < draws; ++i) {
        const BsdfAnswer& a = answers[i];
        if (a.flags & delta)
            sampled_delta.add(luminance(a.weight));
        else if (a.flags)
            sampled[static_cast<std::size_t>(bin_of(a.wi[0], a.wi[1], a.wi[2]))].add(luminance(a.weight));
    }
    const double solid = 2 * ref::pi / bins;
    double total_brute = 0, total_eval = 0, var = 0, worst = sigmas(brute_delta, walks, sampled_delta, draws);
    for (std::size_t b = 0; b < bins; ++b) {
        for (std::size_t p = 0; p < points; ++p)
            evaluated[b].add(luminance(answers[draws + b * points + p].eval) * solid);
        const double s1 = sigmas(brute[b], walks, sampled[b], draws),
                     s2 = sigmas(brute[b], walks, evaluated[b], points);
        worst = std::max({worst, s1, s2});
        if (brute[b].mean(walks) * walks > 30) chi2 += s1 * s1 + s2 * s2, terms += 2;
        total_brute += brute[b].mean(walks), total_eval += evaluated[b].mean(points);
        var += brute[b].variance(walks) + evaluated[b].variance(points);
    }
    INFO(describe(set) << "\n  wo.z " << z << ": brute force " << total_brute << ", eval " << total_eval << " +- "
                       << std::sqrt(var) << "; worst bin " << worst << " sigma");
    CHECK(worst < 5.5);
    CHECK(std::abs(total_brute - total_eval) <= 4.5 * std::sqrt(var));
}

} // namespace

TEST_CASE("coateddiffuse: eval and sample against brute force", "[materials]") {
    Bench& bench = Bench::get();
    BsdfLab lab(bench, bench.material("coateddiffuse"));
    Engine e(21);
    double chi2 = 0;
    int terms = 0;
    const ref::LayeredModel models[] = {
        {.coat = {0, 0}, .reflectance = 0.8},
        {.coat = {0.1, 0.1}, .reflectance = 0.8},
        {.coat = {0.3, 0.3}, .eta = 1.8, .reflectance = 0.6},
        {.coat = {0.6, 0.2}, .reflectance = 0.9},
        {.coat = {0.2, 0.2}, .max_depth = 3, .reflectance = 1},
        {.coat = {0, 0}, .thickness = 0.5, .albedo = 0.7, .g = 0.4, .reflectance = 0.5},
        {.coat = {0.3, 0.3}, .thickness = 1.5, .albedo = 0.9, .g = -0.5, .max_depth = 20, .reflectance = 0.8},
        {.coat = {0.2, 0.4}, .eta = 1.2, .thickness = 0.2, .albedo = 1, .reflectance = 0},
    };
    for (const ref::LayeredModel& m : models)
        against_brute_force(lab, m, e, chi2, terms);
    INFO("chi2 " << chi2 << " of " << terms);
    CHECK(chi2 < terms + 5 * std::sqrt(2.0 * terms));
}

TEST_CASE("coatedconductor: eval and sample against brute force", "[materials]") {
    Bench& bench = Bench::get();
    BsdfLab lab(bench, bench.material("coatedconductor"));
    Engine e(22);
    double chi2 = 0;
    int terms = 0;
    const std::complex<double> copper(0.2 / 1.5, 3.9 / 1.5);
    const ref::LayeredModel models[] = {
        {.coat = {0, 0}, .metal = true, .ior = copper, .base = {0, 0}},
        {.coat = {0, 0}, .metal = true, .ior = copper, .base = {0.3, 0.3}},
        {.coat = {0.3, 0.3}, .metal = true, .ior = copper, .base = {0, 0}},
        {.coat = {0.3, 0.3}, .metal = true, .ior = copper, .base = {0.2, 0.5}},
        {.coat = {0.15, 0.4},
         .eta = 2,
         .thickness = 0.1,
         .max_depth = 20,
         .metal = true,
         .ior = {1.1, 2},
         .base = {0.4, 0.4}},
        {.coat = {0, 0}, .thickness = 0.5, .albedo = 0.8, .g = 0.5, .metal = true, .ior = copper, .base = {0, 0}},
        {.coat = {0.3, 0.3},
         .thickness = 0.8,
         .albedo = 0.8,
         .g = 0.3,
         .metal = true,
         .ior = copper,
         .base = {0.3, 0.3}},
    };
    for (const ref::LayeredModel& m : models)
        against_brute_force(lab, m, e, chi2, terms);
    INFO("chi2 " << chi2 << " of " << terms);
    CHECK(chi2 < terms + 5 * std::sqrt(2.0 * terms));
}

TEST_CASE("coateddiffuse: the closed form of a smooth clear coat against its integral", "[materials]") {
    Bench& bench = Bench::get();
    BsdfLab lab(bench, bench.material("coateddiffuse"));
    Engine e(23);
    std::vector<ref::LayeredModel> models;
    std::vector<ParamSet> configs;
    for (int i = 0; i < 300; ++i) {
        models.push_back({.eta = uniform(e, 1.05f, 2.5f),
                          .thickness = i % 2 ? uniform(e, 0.001f, 0.1f) : uniform(e, 0.001f, 3.f),
                          .max_depth = static_cast<int>(1 + e() % 30),
                          .reflectance = uniform(e)});
        configs.push_back(params_of(models.back()));
    }
    // K by 4000 midpoints on each side of the critical angle
    std::vector<double> returned;
    for (const ref::LayeredModel& m : models) {
        const double critical = std::sqrt(1 - 1 / (m.eta * m.eta));
        double k = 0;
        for (int part = 0; part < 2; ++part)
            for (int i = 0; i < 4000; ++i) {
                const double lo = part ? critical : 0, width = (part ? 1 - critical : critical) / 4000;
                const double mu = lo + (i + 0.5) * width;
                const double f = part ? ref::fresnel(mu, 1 / m.eta) : 1;
                k += 2 * mu * f * std::exp(-2 * m.thickness / mu) * width;
            }
        returned.push_back(k);
    }
    std::vector<BsdfJob> jobs(6000);
    for (BsdfJob& job : jobs)
        job = {.wo = random_direction(e, 0.01f), .wi = random_direction(e, 0.01f), .config = e() % 300, .seed = e()};
    const auto answers = lab.run(configs, jobs);
    double worst = 0;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const ref::LayeredModel& m = models[jobs[i].config];
        const auto passes = [&](float z) {
            const double inside = std::sqrt(1 - (1 - static_cast<double>(z) * z) / (m.eta * m.eta));
            return (1 - ref::fresnel(z, m.eta)) * std::exp(-m.thickness / inside);
        };
        double series = 0;
        for (int k = 0; 2 * k < m.max_depth; ++k) // events 0, 2, 4, ... are at the base
            series += std::pow(m.reflectance * returned[jobs[i].config], k);
        const double expected = passes(jobs[i].wo[2]) * passes(jobs[i].wi[2]) * m.reflectance /
                                (ref::pi * m.eta * m.eta) * series * jobs[i].wi[2];
        const double error = std::abs(answers[i].eval[0] - expected) / (expected + 1e-6);
        worst = std::max(worst, error);
        if (error > 1e-3)
            UNSCOPED_INFO("relative error " << error << ", expected " << expected << "\n  "
                                            << describe(jobs[i], answers[i]) << "\n  "
                                            << describe(configs[jobs[i].config]));
    }
    CHECK(worst < 1e-3);
}
