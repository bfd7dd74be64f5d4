// SPDX-License-Identifier: Apache-2.0
// measured at MERL's full resolution: tabulated closed forms, read by the plugin and looked up by the GPU, against the
// forms themselves in double precision; and the quality of its samples.
#include "gpu/bench.hpp"
#include "gpu/bsdf_reference.hpp"
#include "merl_file.hpp"
#include "temporary_folder.hpp"

#include <catch2/catch_test_macros.hpp>

#include <algorithm>
#include <cstdio>

using namespace restage;
using namespace restage::test;
namespace ref = restage::test::reference;
using ref::V;

namespace {

// Directions of a half vector in the x-z plane and a difference: Rusinkiewicz 1998.
struct Pair {
    V wi, wo;
};
Pair directions(double theta_h, double theta_d, double phi_d) {
    const auto turned = [&](V v) {
        const double c = std::cos(theta_h), s = std::sin(theta_h);
        return V{c * v.x + s * v.z, v.y, c * v.z - s * v.x};
    };
    const double s = std::sin(theta_d), x = s * std::cos(phi_d), y = s * std::sin(phi_d), z = std::cos(theta_d);
    return {turned({x, y, z}), turned({-x, -y, z})};
}

constexpr std::complex<double> metal(0.2, 3.9);

double cook_torrance(V wo, V wi, double alpha) { // f, without the cosine
    return ref::microfacet_reflection(wo, wi, {alpha, alpha}, metal) / wi.z;
}

struct Errors {
    double median, most_of, worst; // relative; most_of: 99 %
};

// Both directions at least `least` above the horizon (cosine).
Errors compare(const std::string& file, const std::function<double(V, V)>& f, double alpha, double least) {
    Bench& bench = Bench::get();
    BsdfLab lab(bench, bench.material("measured"));
    scene::ParamSet set;
    set.set("filename", scene::Value::table(file));
    Engine e(5);
    std::vector<BsdfJob> jobs;
    while (jobs.size() < 20000) { // half vectors in the lobe, and anywhere
        const Vec3 wo = random_direction(e, static_cast<float>(least));
        Vec3 wi = random_direction(e, static_cast<float>(least));
        if (alpha > 0 && jobs.size() % 2) {
            const double u = unit(e), t = alpha * std::sqrt(u / (1 - 0.999 * u)), phi = 6.2831853 * unit(e);
            const V h = ref::normalize({t * std::cos(phi), t * std::sin(phi), 1}), o{wo[0], wo[1], wo[2]};
            const V i = h * (2 * ref::dot(o, h)) - o;
            if (i.z < least) continue;
            wi = {static_cast<float>(i.x), static_cast<float>(i.y), static_cast<float>(i.z)};
        }
        jobs.push_back({.wo = wo, .wi = wi});
    }
    const auto answers = lab.run({&set, 1}, jobs);
    std::vector<double> errors;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const auto v = [](const Vec3& w) { return ref::normalize({w[0], w[1], w[2]}); };
        const double expected = f(v(jobs[i].wo), v(jobs[i].wi)) * jobs[i].wi[2];
        if (expected > 0) errors.push_back(std::abs(answers[i].eval[1] - expected) / expected);
    }
    std::sort(errors.begin(), errors.end());
    return {errors[errors.size() / 2], errors[errors.size() * 99 / 100], errors.back()};
}

void write(const std::string& file, const MerlCounts& n, double alpha) { // alpha 0: Lambert, 0.7
    REQUIRE(write_file_atomic(file, merl_bytes(n, [&](double h, double d, double p, int) {
                                  if (alpha == 0) return 0.7 / ref::pi;
                                  const auto [wi, wo] = directions(h, d, p);
                                  return wi.z > 0 && wo.z > 0 ? cook_torrance(wo, wi, alpha) : -1.0;
                              })));
}

} // namespace

TEST_CASE("measured: Lambert and Cook-Torrance tabulated as MERL does, against the closed forms",
          "[materials][measured]") {
    const TemporaryFolder folder;
    const std::string file = (folder.path() / "t.binary").string();
    write(file, {90, 90, 180}, 0);
    const Errors lambert = compare(file, [](V, V) { return 0.7 / ref::pi; }, 0, 1e-3);
    std::printf("measured, Lambert: relative error median %.2g, 99 %% %.2g, worst %.2g\n", lambert.median,
                lambert.most_of, lambert.worst);
    CHECK(lambert.worst < 5e-7); // weights of eight equal entries, in single precision: 2.2e-7 was measured
    const auto f = [](V wo, V wi) { return cook_torrance(wo, wi, 0.1); };
    write(file, {45, 45, 90}, 0.1);
    const Errors coarse = compare(file, f, 0.1, 0.2);
    write(file, {90, 90, 180}, 0.1);
    const Errors middle = compare(file, f, 0.1, 0.2), low = compare(file, f, 0.1, 0.05);
    std::printf(
        "measured, Cook-Torrance alpha 0.1: median %.2g, 99 %% %.2g, worst %.2g; down to cos 0.05: %.2g, %.2g, %.2g\n",
        middle.median, middle.most_of, middle.worst, low.median, low.most_of, low.worst);
    std::printf("measured, Cook-Torrance at half the resolution: median %.2g, 99 %% %.2g, worst %.2g\n", coarse.median,
                coarse.most_of, coarse.worst);
    CHECK(middle.median < 0.002); // 0.0015, 0.0053 and 0.011 were measured; 0.002, 0.015 and 0.081 down to 0.05
    CHECK(middle.most_of < 0.007);
    CHECK(middle.worst < 0.015);
    CHECK(low.most_of < 0.02);
    // The error is the interpolation's: of second order.
    CHECK(coarse.median > 3 * middle.median);
    CHECK(coarse.median < 5 * middle.median);
}

TEST_CASE("measured: samples of a glossy table against those of the cosine", "[materials][measured]") {
    const TemporaryFolder folder;
    const std::string file = (folder.path() / "t.binary").string();
    write(file, {90, 90, 180}, 0.1);
    Bench& bench = Bench::get();
    const auto entry = bench.material("measured");
    BsdfLab lab(bench, entry);
    scene::ParamSet set;
    set.set("filename", scene::Value::table(file));
    Engine e(6);
    for (const double degrees : {0.0, 30.0, 60.0, 75.0}) {
        const float z = static_cast<float>(std::cos(degrees * ref::pi / 180));
        std::vector<BsdfJob> jobs;
        for (int i = 0; i < 1 << 18; ++i) {
            const float u = unit(e); // a cosine-weighted wi in the same job
            jobs.push_back(
                {.wo = direction(z, 0.3f), .wi = direction(std::sqrt(u), 6.2831853f * unit(e)), .u = unit3(e)});
        }
        double sum[2] = {}, squares[2] = {};
        const auto answers = lab.run({&set, 1}, jobs);
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            const double ours = answers[i].flags ? answers[i].weight[1] : 0,
                         cosine = answers[i].eval[1] * ref::pi / jobs[i].wi[2];
            sum[0] += ours, squares[0] += ours * ours, sum[1] += cosine, squares[1] += cosine * cosine;
        }
        const double n = static_cast<double>(jobs.size());
        double mean[2], variance[2];
        for (int k = 0; k < 2; ++k)
            mean[k] = sum[k] / n, variance[k] = squares[k] / n - mean[k] * mean[k];
        std::printf(
            "measured, glossy table seen at %.0f degrees: albedo %.4f (by the cosine %.4f), variance %.4g against "
            "%.4g: %.0f times less\n",
            degrees, mean[0], mean[1], variance[0], variance[1], variance[1] / variance[0]);
        CHECK(std::abs(mean[0] - mean[1]) < 4 * std::sqrt((variance[0] + variance[1]) / n));
        CHECK(variance[1] > 20 * variance[0]);
    }
}
