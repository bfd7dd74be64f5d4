// SPDX-License-Identifier: Apache-2.0
// Preetham, Shirley, Smits 1999, A Practical Analytic Model for Daylight, appendix 1: the extinction formulas are those
// of Leckner and Angstrom as Iqbal 1983 gives them (An Introduction to Solar Radiation, chapter 6), and so are the
// absorption coefficients.
#include "sunsky/sunlight.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace restage::sunsky {

namespace {

constexpr int first = 380, step = 10, count = 38; // [nm], up to 750

// Radiance of the sun above the atmosphere [100 W/(m^2 sr nm)]: Preetham 1999, table 2.
constexpr double sun_spectrum[count] = {165.5, 162.3, 211.2, 258.8, 258.2, 242.3, 267.6, 296.6, 305.4, 300.6,
                                        306.6, 288.3, 287.1, 278.2, 271.0, 272.3, 263.6, 255.0, 250.6, 253.1,
                                        253.5, 251.3, 246.3, 241.7, 236.8, 232.1, 228.2, 223.4, 219.7, 215.3,
                                        211.0, 207.3, 202.4, 198.7, 194.3, 190.7, 186.3, 182.6};
// Ozone [1/cm], Iqbal 1983, table 6.13.2, every 10 nm from 450.
constexpr double ozone[] = {0.003, 0.006, 0.009, 0.014, 0.021, 0.03,  0.04, 0.048, 0.063, 0.075, 0.085,
                            0.103, 0.12,  0.12,  0.115, 0.125, 0.12,  0.09, 0.079, 0.067, 0.057, 0.048,
                            0.036, 0.028, 0.023, 0.018, 0.014, 0.011, 0.01, 0.009, 0.007};
// Water vapour, every 10 nm from 690: the same table.
constexpr double water[] = {0.016, 0.024, 0.0125, 1.0, 0.87, 0.061, 0.001};

template <std::size_t N>
double listed(const double (&list)[N], int from, int wavelength) {
    const int i = (wavelength - from) / step;
    return wavelength < from || i >= int(N) ? 0 : list[i];
}

// CIE 1931 colour matching functions as sums of lobes: Wyman, Sloan, Shirley 2013, Simple Analytic Approximations to
// the CIE XYZ Color Matching Functions, JCGT 2(2), Eq. 4.
double lobe(double x, double mean, double below, double above) {
    const double t = (x - mean) * (x < mean ? below : above);
    return std::exp(-0.5 * t * t);
}
Color matching(double w) {
    return {0.362 * lobe(w, 442.0, 0.0624, 0.0374) + 1.056 * lobe(w, 599.8, 0.0264, 0.0323) -
                0.065 * lobe(w, 501.1, 0.0490, 0.0382),
            0.821 * lobe(w, 568.8, 0.0213, 0.0247) + 0.286 * lobe(w, 530.9, 0.0613, 0.0322),
            1.217 * lobe(w, 437.0, 0.0845, 0.0278) + 0.681 * lobe(w, 459.0, 0.0385, 0.0725)};
}

// Transmittances of the atmosphere at one wavelength, by cause.
struct Passes {
    double molecules, aerosol, ozone_and_water;
    double all() const { return molecules * aerosol * ozone_and_water; }
};
// Iqbal 1983: Rayleigh 6.3.4, aerosol 6.6.2, ozone 6.5.1, water 6.5.4; mixed gases absorb beyond 750 nm only.
Passes passes(int wavelength, double m, double turbidity) {
    const double um = wavelength / 1000.0;
    const double beta = 0.04608 * turbidity - 0.04586;
    const double w = 2 * m * listed(water, 690, wavelength); // 2 cm of precipitable water
    return {std::exp(-0.008735 * std::pow(um, -4.08) * m), std::exp(-beta * std::pow(um, -1.3) * m),
            std::exp(-listed(ozone, 450, wavelength) * 0.35 * m - 0.2385 * w / std::pow(1 + 20.07 * w, 0.45))};
}

// Relative optical mass, Kasten 1965 as in Preetham.
double air_mass(double elevation) {
    const double zenith = std::numbers::pi / 2 - std::max(elevation, 0.0);
    return 1 / (std::cos(zenith) + 0.15 * std::pow(93.885 - zenith * 180 / std::numbers::pi, -1.253));
}

// The sun's radiance times share(wavelength).
template <class F>
Color xyz(F&& share) {
    Color sum{};
    for (int i = 0; i < count; ++i) {
        const int wavelength = first + i * step;
        const Color by = matching(wavelength);
        const double radiance = 100 * sun_spectrum[i] * share(wavelength); // [W/(m^2 sr nm)]
        for (std::size_t k = 0; k < 3; ++k)
            sum[k] += 683 * by[k] * radiance * step; // 683 lm/W
    }
    return sum;
}

} // namespace

Color rgb_from_xyz(const Color& c) {
    return {std::max(0.0, 3.2404542 * c[0] - 1.5371385 * c[1] - 0.4985314 * c[2]),
            std::max(0.0, -0.9692660 * c[0] + 1.8760108 * c[1] + 0.0415560 * c[2]),
            std::max(0.0, 0.0556434 * c[0] - 0.2040259 * c[1] + 1.0572252 * c[2])};
}

Color sun_xyz(double elevation, double turbidity) {
    const double m = air_mass(elevation);
    return xyz([&](int wavelength) { return passes(wavelength, m, turbidity).all(); });
}

Color sun_xyz_above_atmosphere() {
    return xyz([](int) { return 1.0; });
}

// Iqbal 1983, model C (Bird and Hulstrom 1981), 7.6.6 and 7.6.7, here per wavelength: half of the light scattered by
// molecules reaches the ground, and 84 % of that scattered by the aerosol, which absorbs a tenth of its extinction.
double sky_illuminance(double elevation, double turbidity) {
    const double m = air_mass(elevation);
    const double solid_angle = 2 * std::numbers::pi * (1 - std::cos(sun_radius));
    const double level = solid_angle * std::sin(std::max(elevation, 0.0)) / (1 - m + std::pow(m, 1.02));
    return level * xyz([&](int wavelength) {
               const Passes p = passes(wavelength, m, turbidity);
               const double unabsorbed = 1 - 0.1 * (1 - p.aerosol); // by the aerosol
               return 0.79 * p.ozone_and_water * unabsorbed *
                      (0.5 * (1 - p.molecules) + 0.84 * (1 - p.aerosol / unabsorbed));
           })[1];
}

} // namespace restage::sunsky
