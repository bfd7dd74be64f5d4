// SPDX-License-Identifier: Apache-2.0
#include "check/neighbourhood.hpp"

#include <algorithm>
#include <cmath>

namespace restage::check {
namespace {

constexpr double step = 5e-7; // eight ulps of 1

// Moved by a tangent vector and renormalised, staying on its side of the surface.
Vec3 moved(const Vec3& w, int direction) {
    const double x = w[0], y = w[1], z = w[2];
    // Towards the pole and around it.
    const double s = std::max(std::hypot(x, y), 1e-12);
    const double across[3] = {x * z / s, y * z / s, -s}, around[3] = {-y / s, x / s, 0};
    const double* t = direction < 2 ? across : around;
    const double sign = direction % 2 ? -step : step;
    double v[3] = {x + sign * t[0], y + sign * t[1], z + sign * t[2]};
    if (v[2] * z <= 0) v[2] = z;
    const double n = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    return {static_cast<float>(v[0] / n), static_cast<float>(v[1] / n), static_cast<float>(v[2] / n)};
}

} // namespace

Result<std::vector<Neighbourhood>> neighbourhoods(Subject& s, std::span<const scene::ParamSet> configs,
                                                  std::span<const BsdfJob> jobs, std::span<const BsdfAnswer> answers,
                                                  std::span<const std::size_t> which) {
    std::vector<Neighbourhood> result(which.size());
    if (which.empty()) return result;
    constexpr std::size_t each = 16; // 4 moves of wo and 4 of wi, in both directions
    std::vector<BsdfJob> around;
    for (const std::size_t i : which)
        for (std::size_t k = 0; k < each; ++k) {
            const int move = static_cast<int>(k % 4);
            BsdfJob job = jobs[i];
            job.wi = answers[i].wi;
            (k % 8 < 4 ? job.wi : job.wo) = moved(k % 8 < 4 ? job.wi : job.wo, move);
            if (k >= 8) std::swap(job.wo, job.wi);
            around.push_back(job);
        }
    RESTAGE_TRY(BsdfLab* const lab, s.lab());
    RESTAGE_TRY(const std::vector<BsdfAnswer> moved_answers, lab->run(configs, around));
    for (std::size_t n = 0; n < which.size(); ++n) {
        const BsdfAnswer& a = answers[which[n]];
        for (std::size_t k = 0; k < each; ++k) {
            const BsdfAnswer& b = moved_answers[n * each + k];
            for (std::size_t c = 0; c < 3; ++c) {
                double& out = k < 8 ? result[n].value : result[n].reverse;
                out = std::max(out, std::abs(double(b.eval[c]) - (k < 8 ? a.eval_sampled[c] : a.eval_reverse[c])));
            }
            if (k < 8) result[n].pdf = std::max(result[n].pdf, std::abs(double(b.pdf) - a.pdf_sampled));
        }
    }
    return result;
}

} // namespace restage::check
