// SPDX-License-Identifier: Apache-2.0
// One parameter set and one wo: a million samples against the density and the value that the material states.
// For materials whose eval and pdf are deterministic; for stochastic ones see steps_expectation.cpp.
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
    double spread = 0;       // fraction of samples that are neither delta nor absorbed
    double pdf_integral = 0, pdf_error = 0;
    double unresolved = 0;   // fraction of pdf in cells whose integral stayed uncertain
    Mean weight[3];          // of the spread samples, over all draws
    double eval_integral[3] = {}, eval_error = 0; // bound on each channel's
    bool again = false;      // this is the second, longer measurement of a suspicious case
    double bad_pdf = 0;      // directions with a negative or non-finite pdf (then nothing else is reported)
    double bad_samples = 0;  // samples with an invalid direction or a non-finite weight
    std::size_t evaluations = 0;
    double eval_side[2] = {}, carried_side[2] = {}; // luminance: reflected, transmitted; by eval and by samples

    // Difference of integrals and samples, beyond what `sigmas` standard errors and the integral's own error
    // allow.
    double integral_off(double sigmas) const; // of pdf: the fraction neither delta nor absorbed
    double reach_off(double sigmas) const;    // of eval: the light samples carry; worst channel
};

Result<DensityResult> measure_density(BsdfLab& lab, Jobs& jobs, const DensityCase& c, std::size_t draws);

} // namespace restage::check
