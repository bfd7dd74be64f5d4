// SPDX-License-Identifier: Apache-2.0
// The statistics of the checks, in double precision: the chi-square test, and thresholds for many tests at once.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace restage::check {

// P(X >= x) of a chi-square variable with `dof` degrees of freedom.
double chi_square_tail(double x, double dof);
// `tests` independent tests all pass by chance with probability 1 - alpha if each uses this threshold (Sidak 1967).
double sidak(double alpha, std::size_t tests);
// z with P(|Z| > z) = p, Z standard normal.
double two_sided_sigma(double p);

struct ChiSquare {
    double statistic = 0, p = 1;
    std::size_t terms = 0;  // bins compared, after pooling
    std::size_t pooled = 0; // bins merged because fewer than 5 samples are expected in each
};

// Counts against expected counts, bin by bin. As in Mitsuba's ChiSquareTest, bins are pooled in order of expected count
// until the pool reaches 5; the remainder joins the last one.
ChiSquare chi_square(std::span<const double> observed, std::span<const double> expected);

struct Mean { // of samples, with its standard error
    double sum = 0, squares = 0, n = 0;
    void add(double x) { sum += x, squares += x * x, n += 1; }
    double mean() const { return n > 0 ? sum / n : 0; }
    double variance() const; // of the mean
    double sigma() const; // of the mean
};

} // namespace restage::check
