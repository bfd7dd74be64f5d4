// SPDX-License-Identifier: Apache-2.0
// The pbrt importer's colours against known values.
#include "spectrum.hpp"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>

using namespace restage::pbrt;

namespace {

void check_near(Rgb a, Rgb b, double tolerance) {
    CHECK(std::abs(a.r - b.r) < tolerance);
    CHECK(std::abs(a.g - b.g) < tolerance);
    CHECK(std::abs(a.b - b.b) < tolerance);
}

Spectrum constant(double value) {
    Spectrum s;
    s.fill(value);
    return s;
}

Spectrum named(const char* name) {
    const auto s = named_spectrum(name);
    REQUIRE(s);
    return *s;
}

} // namespace

TEST_CASE("pbrt spectra: the observer and its whites", "[pbrt]") {
    const auto equal = to_xyz(constant(1)); // E has x = y = 1/3
    CHECK(equal[1] == Catch::Approx(1).margin(1e-12));
    CHECK(equal[0] == Catch::Approx(1).margin(2e-3));
    CHECK(equal[2] == Catch::Approx(1).margin(2e-3));
    check_near(rgb_of_light(named("stdillum-D65")), {1, 1, 1}, 1e-3); // D65 is the white of sRGB
    const auto xy = [](const char* name) {
        const auto xyz = to_xyz(named(name));
        const double sum = xyz[0] + xyz[1] + xyz[2];
        return std::pair(xyz[0] / sum, xyz[1] / sum);
    };
    // CIE 15:2004, table T.3; but D50 as in pbrt-v4, whose table is not CIE's
    struct {
        const char* name;
        double x, y;
    } whites[] = {{"stdillum-A", 0.44758, 0.40745},   {"stdillum-D50", 0.33682, 0.35799},
                  {"stdillum-D65", 0.31272, 0.32903}, {"stdillum-F2", 0.3721, 0.3751},
                  {"stdillum-F7", 0.3129, 0.3292},    {"stdillum-F11", 0.3805, 0.3769},
                  {"illum-acesD60", 0.32168, 0.33767}};
    for (const auto& white : whites) {
        INFO(white.name);
        const auto [x, y] = xy(white.name);
        CHECK(std::abs(x - white.x) < 1e-3);
        CHECK(std::abs(y - white.y) < 1e-3);
    }
    for (const char* name : {"stdillum-F1", "stdillum-F3", "stdillum-F4", "stdillum-F5", "stdillum-F6", "stdillum-F8",
                             "stdillum-F9", "stdillum-F10", "stdillum-F12"})
        CHECK(to_xyz(named(name))[1] > 0);
    CHECK_FALSE(named_spectrum("stdillum-F13"));
}

TEST_CASE("pbrt spectra: blackbodies", "[pbrt]") {
    // Planckian locus, CIE 1931: 6500 K is x 0.3135, y 0.3237; 2856 K is illuminant A.
    const auto chromaticity = [](double kelvin) {
        const auto xyz = to_xyz(blackbody(kelvin));
        const double sum = xyz[0] + xyz[1] + xyz[2];
        return std::pair(xyz[0] / sum, xyz[1] / sum);
    };
    CHECK(std::abs(chromaticity(6500).first - 0.3135) < 5e-4);
    CHECK(std::abs(chromaticity(6500).second - 0.3237) < 5e-4);
    CHECK(std::abs(chromaticity(2856).first - 0.4476) < 1e-3);
    CHECK(std::abs(chromaticity(2856).second - 0.4074) < 1e-3);
    const Rgb day = rgb_of_light(blackbody(6500));
    check_near(day, {1, 1, 1}, 0.06); // nearly white, a little purple
    CHECK(luminance(day) == Catch::Approx(1).margin(1e-4));
    const Rgb candle = rgb_of_light(blackbody(1900));
    CHECK(candle.r > candle.g);
    CHECK(candle.g > candle.b);
    // The peak is 1: at 5000 K it lies at 580 nm.
    const Spectrum s = blackbody(5000);
    CHECK(s[580 - first_nm] == Catch::Approx(1).margin(1e-4));
    CHECK(rgb_of_light(blackbody(-1)) == Rgb{});
}

TEST_CASE("pbrt spectra: reflectances", "[pbrt]") {
    check_near(rgb_of_reflectance(constant(0.3)), {0.3, 0.3, 0.3}, 1e-9);
    // v3 evaluates reflectances under equal energy: a constant is not exactly grey, as in pbrt-v3.
    const Rgb old = rgb_equal_energy(constant(1));
    CHECK(old.r == Catch::Approx(1.2048).margin(2e-3));
    CHECK(old.b == Catch::Approx(0.9087).margin(2e-3));
    // Inline samples: v4 is 0 outside their range, v3 continues.
    const auto band = from_pairs({500, 1, 600, 1}, Ends::zero);
    REQUIRE(band);
    CHECK((*band)[499 - first_nm] == 0);
    CHECK((*band)[550 - first_nm] == 1);
    CHECK((*band)[601 - first_nm] == 0);
    CHECK((*from_pairs({500, 1, 600, 3}, Ends::constant))[0] == 1);
    CHECK((*from_pairs({500, 1, 600, 3}, Ends::constant))[550 - first_nm] == Catch::Approx(2));
    CHECK_FALSE(from_pairs({500, 1, 500, 1}, Ends::zero));
    CHECK_FALSE(from_pairs({500, 1, 600}, Ends::zero));
    CHECK_FALSE(from_pairs({}, Ends::zero));
}

TEST_CASE("pbrt spectra: metals keep their reflectance", "[pbrt]") {
    for (const char* metal : {"Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"}) {
        INFO(metal);
        const Spectrum eta = named(("metal-" + std::string(metal) + "-eta").c_str());
        const Spectrum k = named(("metal-" + std::string(metal) + "-k").c_str());
        Spectrum reflectance;
        for (std::size_t i = 0; i < eta.size(); ++i)
            reflectance[i] = fresnel_normal(eta[i], k[i]);
        const Rgb want = rgb_of_reflectance(reflectance);
        const ComplexIndex index = rgb_of_metal(eta, k);
        const Rgb got{fresnel_normal(index.eta.r, index.k.r), fresnel_normal(index.eta.g, index.k.g),
                      fresnel_normal(index.eta.b, index.k.b)};
        check_near(got, {std::min(want.r, 0.999), want.g, want.b}, 1e-9);
    }
    const ComplexIndex gold = rgb_of_metal(named("metal-Au-eta"), named("metal-Au-k"));
    // Gold: F0 about (1.0, 0.77, 0.34) in linear sRGB (Hoffman, SIGGRAPH 2010 course; Lagarde's tables).
    check_near({fresnel_normal(gold.eta.r, gold.k.r), fresnel_normal(gold.eta.g, gold.k.g),
                fresnel_normal(gold.eta.b, gold.k.b)},
               {1.0, 0.77, 0.34}, 0.03);
    // pbrt-v3's own averages for copper and aluminium, as exporters write them into scenes.
    check_near(rgb_equal_energy(named("metal-Cu-eta")), {0.200438, 0.924033, 1.102212}, 5e-3);
    check_near(rgb_equal_energy(named("metal-Cu-k")), {3.912949, 2.452848, 2.142188}, 5e-3);
    check_near(rgb_equal_energy(named("metal-Al-k")), {9.223869, 6.269523, 4.837001}, 5e-3);
}

TEST_CASE("pbrt spectra: glasses and other colour spaces", "[pbrt]") {
    CHECK(luminance_mean(named("glass-BK7")) == Catch::Approx(1.5168).margin(1e-4));
    CHECK(luminance_mean(named("glass-SF11")) == Catch::Approx(1.7847).margin(1e-4));
    for (const ColorSpace space : {ColorSpace::srgb, ColorSpace::dci_p3, ColorSpace::rec2020, ColorSpace::aces2065_1})
        check_near(to_srgb({1, 1, 1}, space, true), {1, 1, 1}, 1e-3); // white stays white
    CHECK(to_srgb({1, 1, 1}, ColorSpace::aces2065_1, false).r > 1.02); // a light of D60 is warm
    check_near(to_srgb({0, 1, 0}, ColorSpace::rec2020, true), {-0.5876, 1.1329, -0.1006}, 2e-3); // ITU-R BT.2087
}
