// SPDX-License-Identifier: Apache-2.0
// One set of parameters and one wo: a million samples against the density and the value that the material states.
// For materials whose eval and pdf are functions; of stochastic ones see expectation.hpp.
#pragma once

#include "check/configs.hpp"
#include "check/sphere_cells.hpp"
#include "check/statistics.hpp"

#include <string>

namespace restage::check {

struct DensityCase {
    scene::ParamSet config;
    Vec3 wo{};
    std::uint32_t seed = 0;
};

struct DensityResult {
    double draws = 0;
    ChiSquare chi;           // samples against pdf
    std::string worst;       // the cell that differs most: where, expected and counted
    double worst_sigma = 0;
    double spread = 0;       // share of samples that are neither delta nor absorbed
    double pdf_integral = 0, pdf_error = 0;
    double unresolved = 0;   // share of pdf in cells whose integral stayed uncertain
    Mean weight[3];          // of the spread samples, over all draws
    double eval_integral[3] = {}, eval_error = 0; // bound on each channel's
    bool again = false;      // it is the second, longer measurement of a suspicious case
    double bad_pdf = 0;      // directions whose pdf is not finite or negative (then nothing else is said)
    double bad_samples = 0;  // samples whose direction is none, or whose weight is not finite
    std::size_t evaluations = 0;
    double eval_side[2] = {}, carried_side[2] = {}; // luminance: reflected, transmitted; by eval and by samples

    // How far integrals are from what samples say, over what `sigmas` standard errors and the integral's own error
    // allow.
    double integral_off(double sigmas) const; // of pdf: what is neither delta nor absorbed
    double reach_off(double sigmas) const;    // of eval: what samples carry; of the worst channel
};

Result<DensityResult> measure_density(BsdfLab& lab, Jobs& jobs, const DensityCase& c, std::size_t draws);

} // namespace restage::check
