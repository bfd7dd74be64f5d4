// SPDX-License-Identifier: Apache-2.0
// Valid numbers only, for random and extreme parameters, grazing directions, directions in the surface plane,
// mirror and refracted directions, the ends of [0, 1).
#include "check/steps.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace restage::check {

using scene::ParamSet;
using scene::Value;

namespace {

bool finite(const Vec3& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }
bool not_negative(const Vec3& v) { return finite(v) && v[0] >= 0 && v[1] >= 0 && v[2] >= 0; }

std::string bad_value(const char* what, const Vec3& v) {
    return fmt::format("{} is {}: not finite, or negative", what, describe(v));
}

// The problem with an answer, or "".
std::string problem(const Subject& s, const BsdfJob& job, const BsdfAnswer& a) {
    const bool transmissive = s.table().transmissive;
    if (!not_negative(a.eval)) return bad_value("eval(wo, wi)", a.eval);
    if (!not_negative(a.eval_sampled)) return bad_value("eval(wo, sampled wi)", a.eval_sampled);
    if (!not_negative(a.eval_reverse)) return bad_value("eval(sampled wi, wo)", a.eval_reverse);
    if (!(a.pdf >= 0) || !std::isfinite(a.pdf)) return fmt::format("pdf is {}: not finite, or negative", a.pdf);
    if (!not_negative(a.albedo)) return bad_value("albedo", a.albedo);
    if (std::max({a.albedo[0], a.albedo[1], a.albedo[2]}) > 1.01f)
        return fmt::format("albedo is {}, above 1", describe(a.albedo));
    if (!transmissive && job.wo[2] * job.wi[2] <= 0 && luminance(a.eval) > 0)
        return "eval is not 0 on the other side, but TRANSMISSIVE is not declared";
    if (a.flags == 0) return "";
    if (!finite(a.wi) || std::abs(std::hypot(a.wi[0], a.wi[1], a.wi[2]) - 1) > 1e-3f)
        return fmt::format("the sampled direction {} is not a unit vector", describe(a.wi));
    if (!not_negative(a.weight)) return bad_value("the weight of a sample", a.weight);
    if (!(a.sample_pdf > 0) || !std::isfinite(a.sample_pdf))
        return fmt::format("the density of a sample is {}: not above 0, or not finite", a.sample_pdf);
    if (!(a.eta > 0.1f && a.eta < 10)) return fmt::format("eta of a sample is {}, which is implausible", a.eta);
    const std::uint32_t side = a.flags & (reflect | transmit);
    if (side != (a.wi[2] * job.wo[2] > 0 ? reflect : transmit))
        return fmt::format("the flags of a sample ({}) do not say on which side of the surface {} is", a.flags,
                           describe(a.wi));
    if (side == transmit && !s.table().transmissive) return "a sample transmits, but TRANSMISSIVE is not declared";
    return "";
}

// Each line at an end of its range, or close to it: alpha -> 0, eta -> 1, k -> 0.
ParamSet extreme_config(const model::Material& table, Engine& e) {
    ParamSet set = random_config(table, e);
    for (const model::Param& p : table.params) {
        const float steps[] = {0.f, 1e-20f, 1e-12f, 1e-7f, 1e-6f, 1e-5f, 1e-4f, 1e-3f};
        const float step = steps[e() % std::size(steps)];
        const bool up = e() % 3 != 0;
        const float x = up ? p.min + step : p.max - step;
        if (p.type == model::ParamType::number) set.set(p.id, Value::number(std::clamp(x, p.min, p.max)));
        if (p.type == model::ParamType::color && e() % 2) {
            const float c = std::clamp(x, p.min, p.max);
            set.set(p.id, Value::color(c, e() % 2 ? c : p.max, c));
        }
    }
    keep_sum(table, set);
    return set;
}

} // namespace

Result<StepResult> check_sound(Subject& s) {
    if (!s.table().has_code()) return StepResult::skip("has no GLSL");
    RESTAGE_TRY(BsdfLab* const lab, s.lab());
    Engine e = s.random("sound");
    const std::size_t sets = s.size(4000, 1000), count = s.size(600'000, 60'000);
    std::vector<ParamSet> configs;
    for (std::size_t i = 0; i < sets; ++i)
        configs.push_back(i == 0 ? ParamSet{} : i % 2 ? random_config(s.table(), e) : extreme_config(s.table(), e));
    const float edges[] = {0.f, 1e-20f, 1e-7f, 1e-5f, 1e-3f, 0.9999999f, 1.f};
    const auto any_direction = [&] {
        if (e() % 4) return random_direction(e);
        const float z = edges[e() % std::size(edges)] * (e() % 2 ? 1.f : -1.f);
        return direction(z,
                         e() % 2 ? uniform(e, 0, 6.3f) : static_cast<float>(e() % 4) * std::numbers::pi_v<float> / 2);
    };
    std::vector<BsdfJob> jobs(count);
    for (BsdfJob& job : jobs) {
        job = {.wo = any_direction(),
               .wi = any_direction(),
               .u = unit3(e),
               .config = static_cast<std::uint32_t>(e() % sets),
               .seed = e()};
        for (float& x : job.u)
            if (e() % 16 == 0) x = e() % 2 ? 0.f : 0.99999994f; // the ends of [0, 1)
        if (e() % 8 == 0) // mirrored, straight through, and back: where lobes peak
            job.wi = {-job.wo[0], -job.wo[1], e() % 2 ? job.wo[2] : -job.wo[2]};
        else if (e() % 16 == 0)
            job.wi = job.wo;
    }
    RESTAGE_TRY(const std::vector<BsdfAnswer> answers, lab->run(configs, jobs));
    std::size_t bad = 0;
    std::string first;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const std::string p = problem(s, jobs[i], answers[i]);
        if (p.empty() || bad++ > 0) continue;
        const BsdfJob& job = jobs[i];
        first = fmt::format("{}\n  with {}; wi {}; u {}", p, where(configs[job.config], job.wo), describe(job.wi),
                            describe(job.u));
    }
    std::vector<Figure> figures = {{"configurations", double(sets)}, {"directions", double(count)}};
    if (bad > 0) return StepResult::failed(fmt::format("{} ({} of {} results are wrong)", first, bad, count), figures);
    return StepResult::passed(figures);
}

} // namespace restage::check
