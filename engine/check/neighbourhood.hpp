// SPDX-License-Identifier: Apache-2.0
// How much eval and pdf change when directions change in their last digits: the deviation that single precision permits
// in a comparison. Distinguishes rounding from mistakes, instead of one percentage for everything.
#pragma once

#include "check/subject.hpp"

namespace restage::check {

struct Neighbourhood {
    double pdf = 0; // largest change of pdf(wo, sampled wi)
    double value = 0; // largest change of eval(wo, sampled wi), any channel
    double reverse = 0; // likewise of eval(sampled wi, wo)
};

// For the given jobs, at their sampled directions.
Result<std::vector<Neighbourhood>> neighbourhoods(Subject& s, std::span<const scene::ParamSet> configs,
                                                  std::span<const BsdfJob> jobs, std::span<const BsdfAnswer> answers,
                                                  std::span<const std::size_t> which);

} // namespace restage::check
