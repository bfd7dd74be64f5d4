// SPDX-License-Identifier: Apache-2.0
// Preetham, Shirley, Smits 1999, A Practical Analytic Model for Daylight, appendix 2 (A.2): Perez' five parameters for
// luminance and chromaticity as functions of turbidity, and the zenith's chromaticity. Its zenith luminance is not
// used: it is twice that of measured clear skies, and ten times at sunset (Zotti, Wilkie, Purgathofer 2007, A Critical
// Review of the Preetham Skylight Model). The level is that of sky_illuminance().
#include "sunsky/daylight.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace restage::sunsky {

namespace {

constexpr double pi = std::numbers::pi;

// Illuminance after sunset [lx]: 400 at sunset, 3.4 at 6 degrees below, 0.008 at 12
// (Seidelmann 1992, Explanatory Supplement to the Astronomical Almanac, 9.311).
double twilight(double elevation) {
    if (elevation >= 0) return 400;
    const double down = std::min(-elevation * 180 / pi, 18.0);
    const double decades = down < 6 ? 2.07 * down / 6 : 2.07 + 2.63 * (down - 6) / 6;
    return 400 * std::pow(10, -decades);
}

// Fraction of the sun's disk that is above the horizon.
double risen(double elevation) {
    const double h = std::clamp(elevation / sun_radius, -1.0, 1.0);
    return 0.5 + (std::asin(h) + h * std::sqrt(1 - h * h)) / pi;
}

double zenith_chromaticity(const double (&m)[3][4], double turbidity, double theta) {
    const double t[3] = {turbidity * turbidity, turbidity, 1};
    const double p[4] = {theta * theta * theta, theta * theta, theta, 1};
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j)
            sum += t[i] * m[i][j] * p[j];
    return sum;
}

} // namespace

Direction direction_of(double azimuth, double elevation) {
    return {std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth), std::sin(elevation)};
}

double Perez::at(double cos_theta, double gamma, double cos_gamma) const {
    return (1 + a * std::exp(b / cos_theta)) * (1 + c * std::exp(d * gamma) + e * cos_gamma * cos_gamma);
}

Daylight::Daylight(const DaylightParams& params) : params_(params) {
    const double t = std::clamp(params.turbidity, least_turbidity, most_turbidity);
    const double elevation = std::clamp(params.elevation, -pi / 2, pi / 2);
    const double theta = pi / 2 - std::max(elevation, 0.0); // of the sun, from the zenith
    to_sun_ = direction_of(params.azimuth, elevation);
    shown_sun_ = direction_of(params.azimuth, std::max(elevation, 0.0));
    luminance_ = {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771,
                  -0.0670 * t + 0.3703};
    x_ = {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989, -0.0033 * t + 0.0452};
    y_ = {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537, -0.0109 * t + 0.0529};
    static constexpr double zenith_x[3][4] = {
        {0.00166, -0.00375, 0.00209, 0}, {-0.02903, 0.06377, -0.03202, 0.00394}, {0.11693, -0.21196, 0.06052, 0.25886}};
    static constexpr double zenith_y[3][4] = {
        {0.00275, -0.00610, 0.00317, 0}, {-0.04214, 0.08970, -0.04153, 0.00516}, {0.15346, -0.26756, 0.06670, 0.26688}};
    zenith_[1] = zenith_chromaticity(zenith_x, t, theta) / x_.at(1, theta, std::cos(theta));
    zenith_[2] = zenith_chromaticity(zenith_y, t, theta) / y_.at(1, theta, std::cos(theta));

    if (params.sun && elevation > -sun_radius) {
        disk_ = rgb_from_xyz(sun_xyz(elevation, t));
        const double solid_angle = 2 * pi * (1 - std::cos(sun_radius));
        for (std::size_t k = 0; k < 3; ++k) {
            disk_[k] *= risen(elevation);
            from_sun_[k] = disk_[k] * solid_angle * std::max(std::sin(elevation), 0.0);
        }
    }
    // The midpoint rule over sin^2 of the elevation and azimuth: equal steps of cos(theta) d(omega).
    constexpr int rows = 32, columns = 64;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const double z = std::sqrt((i + 0.5) / rows);
            const Color light = sky(direction_of(params.azimuth + 2 * pi * (j + 0.5) / columns, std::asin(z)));
            for (std::size_t k = 0; k < 3; ++k)
                from_sky_[k] += light[k] * pi / (rows * columns);
        }
    const double luminous = 0.2126729 * from_sky_[0] + 0.7151522 * from_sky_[1] + 0.0721750 * from_sky_[2];
    const double level = (sky_illuminance(elevation, t) + twilight(elevation)) / luminous;
    zenith_[0] *= level;
    for (double& light : from_sky_)
        light *= level;
    for (std::size_t k = 0; k < 3; ++k)
        ground_[k] = params.albedo[k] * (from_sky_[k] + from_sun_[k]) / pi; // matte
}

Color Daylight::sky(const Direction& w) const {
    const double cos_theta = std::max(w.z, 1e-3); // at the horizon itself exp(b / cos) is 0
    const double cos_gamma = std::clamp(w.x * shown_sun_.x + w.y * shown_sun_.y + w.z * shown_sun_.z, -1.0, 1.0);
    const double gamma = std::acos(cos_gamma);
    const double luminance = std::max(zenith_[0] * luminance_.at(cos_theta, gamma, cos_gamma), 0.0);
    const double x = zenith_[1] * x_.at(cos_theta, gamma, cos_gamma);
    const double y = std::max(zenith_[2] * y_.at(cos_theta, gamma, cos_gamma), 0.05);
    return rgb_from_xyz({luminance * x / y, luminance, luminance * (1 - x - y) / y});
}

Color Daylight::at(const Direction& w) const { return w.z >= 0 ? sky(w) : ground_; }

} // namespace restage::sunsky
