// SPDX-License-Identifier: Apache-2.0
#include "check/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace restage::check {

namespace {

constexpr double fewest_expected = 5;

// Upper regularized incomplete gamma function Q(a, x): its series below a + 1 (Abramowitz and Stegun 6.5.29), else its
// continued fraction (6.5.31) by Lentz's method.
double gamma_q(double a, double x) {
    if (!(x > 0)) return 1;
    const double scale = std::exp(-x + a * std::log(x) - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (double n = a + 1; term > sum * 1e-16; ++n)
            term *= x / n, sum += term;
        return std::max(0.0, 1 - sum * scale);
    }
    constexpr double tiny = std::numeric_limits<double>::min() * 1e10;
    double b = x + 1 - a, c = 1 / tiny, d = 1 / b, h = d;
    for (int i = 1; i < 100000; ++i) {
        const double an = -i * (i - a);
        b += 2;
        d = an * d + b, d = 1 / (std::abs(d) < tiny ? tiny : d);
        c = b + an / c, c = std::abs(c) < tiny ? tiny : c;
        h *= d * c;
        if (std::abs(d * c - 1) < 1e-15) break;
    }
    return std::min(1.0, scale * h);
}

} // namespace

double chi_square_tail(double x, double dof) { return dof > 0 ? gamma_q(0.5 * dof, 0.5 * x) : 1; }

double sidak(double alpha, std::size_t tests) {
    return -std::expm1(std::log1p(-alpha) / static_cast<double>(std::max<std::size_t>(tests, 1)));
}

double two_sided_sigma(double p) {
    double lo = 0, hi = 40; // erfc is monotonic
    for (int i = 0; i < 100; ++i) {
        const double mid = 0.5 * (lo + hi);
        (std::erfc(mid / std::sqrt(2.0)) > p ? lo : hi) = mid;
    }
    return lo;
}

ChiSquare chi_square(std::span<const double> observed, std::span<const double> expected) {
    std::vector<std::size_t> order(expected.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
    ChiSquare result;
    double pool_observed = 0, pool_expected = 0;
    std::size_t in_pool = 0;
    const auto term = [&](double o, double e) { return (o - e) * (o - e) / e; };
    double last_observed = 0, last_expected = 0; // of the last term, for the remainder
    const auto close = [&] {
        last_observed = pool_observed, last_expected = pool_expected;
        result.statistic += term(pool_observed, pool_expected);
        ++result.terms;
        if (in_pool > 1) result.pooled += in_pool;
        pool_observed = pool_expected = 0, in_pool = 0;
    };
    for (const std::size_t i : order) {
        pool_observed += observed[i], pool_expected += expected[i], ++in_pool;
        if (pool_expected >= fewest_expected) close();
    }
    if (in_pool > 0) {
        if (result.terms > 0) {
            result.statistic -= term(last_observed, last_expected);
            result.statistic += term(last_observed + pool_observed, last_expected + pool_expected);
        } else if (pool_expected > 0) {
            result.statistic = term(pool_observed, pool_expected), result.terms = 1;
        } else if (pool_observed > 0) { // samples where none are possible
            result.statistic = std::numeric_limits<double>::infinity(), result.terms = 1, result.p = 0;
            return result;
        }
    }
    // Nothing is normalised: the sum of counts is free as well, so there are as many degrees of freedom as terms.
    result.p = chi_square_tail(result.statistic, static_cast<double>(result.terms));
    return result;
}

double Mean::variance() const {
    if (n < 2) return 0;
    return std::max(0.0, squares / n - mean() * mean()) / (n - 1);
}

double Mean::sigma() const { return std::sqrt(variance()); }

} // namespace restage::check
