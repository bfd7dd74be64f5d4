// SPDX-License-Identifier: Apache-2.0
#include "spectrum.hpp"
#include "spectrum_data.hpp"

#include <algorithm>
#include <cmath>

namespace restage::pbrt {

namespace {

Spectrum resample(Curve curve) {
    Spectrum out;
    for (int nm = first_nm; nm <= last_nm; ++nm) {
        const double x = std::clamp(double(nm - curve.first) / curve.step, 0.0, double(curve.count - 1));
        const int i = std::min(static_cast<int>(x), curve.count - 2);
        const double t = x - i;
        out[static_cast<std::size_t>(nm - first_nm)] =
            (1 - t) * double(curve.values[i]) + t * double(curve.values[i + 1]);
    }
    return out;
}

struct Observer {
    Spectrum x = resample(cie_x()), y = resample(cie_y()), z = resample(cie_z());
    double y_integral = 0;
    Observer() {
        for (const double value : y)
            y_integral += value;
    }
};

const Observer& observer() {
    static const Observer instance;
    return instance;
}

const Spectrum& d65() {
    static const Spectrum instance = resample(named_curve("stdillum-D65"));
    return instance;
}

using Matrix3 = std::array<std::array<double, 3>, 3>;

std::array<double, 3> multiply(const Matrix3& m, std::array<double, 3> v) {
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return out;
}

// IEC 61966-2-1, primaries of ITU-R BT.709, white D65 (0.3127, 0.3290).
constexpr Matrix3 srgb_from_xyz = {
    {{3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}}};
// RGB to XYZ: SMPTE RP 431-2 primaries with D65, ITU-R BT.2020, SMPTE ST 2065-1 (white D60).
constexpr Matrix3 xyz_from_p3 = {
    {{0.4865709, 0.2656677, 0.1982173}, {0.2289746, 0.6917385, 0.0792869}, {0.0, 0.0451134, 1.0439444}}};
constexpr Matrix3 xyz_from_rec2020 = {
    {{0.6369580, 0.1446169, 0.1688810}, {0.2627002, 0.6779981, 0.0593017}, {0.0, 0.0280727, 1.0609851}}};
constexpr Matrix3 xyz_from_aces = {
    {{0.9525523959, 0.0, 0.0000936786}, {0.3439664498, 0.7281660966, -0.0721325464}, {0.0, 0.0, 1.0088251844}}};
// Bradford adaptation from ACES D60 to D65 (Lam 1985; Lindbloom's matrices).
constexpr Matrix3 d65_from_d60 = {
    {{0.9872240, -0.0061133, 0.0159533}, {-0.0075984, 1.0018615, 0.0053300}, {0.0030726, -0.0050960, 1.0816806}}};

} // namespace

std::optional<Spectrum> from_pairs(const std::vector<double>& pairs, Ends ends) {
    if (pairs.empty() || pairs.size() % 2 != 0) return std::nullopt;
    for (std::size_t i = 2; i < pairs.size(); i += 2)
        if (!(pairs[i] > pairs[i - 2])) return std::nullopt;
    Spectrum out;
    std::size_t at = 0; // index of the pair at or before nm
    for (int nm = first_nm; nm <= last_nm; ++nm) {
        while (at + 2 < pairs.size() && pairs[at + 2] <= nm)
            at += 2;
        double value = pairs[at + 1];
        if (nm < pairs.front() || nm > pairs[pairs.size() - 2]) {
            value = ends == Ends::zero ? 0 : (nm < pairs.front() ? pairs[1] : pairs.back());
        } else if (at + 2 < pairs.size()) {
            const double t = (nm - pairs[at]) / (pairs[at + 2] - pairs[at]);
            value = (1 - t) * pairs[at + 1] + t * pairs[at + 3];
        }
        out[static_cast<std::size_t>(nm - first_nm)] = value;
    }
    return out;
}

std::optional<Spectrum> named_spectrum(std::string_view name) {
    if (const Curve curve = named_curve(name); curve.count > 0) return resample(curve);
    if (const float index = named_glass(name); index > 0) {
        Spectrum out;
        out.fill(double(index));
        return out;
    }
    return std::nullopt;
}

std::optional<Spectrum> named_dispersion(std::string_view name) {
    if (!(named_glass(name) > 0)) return std::nullopt;
    Spectrum out;
    for (int nm = first_nm; nm <= last_nm; ++nm)
        out[static_cast<std::size_t>(nm - first_nm)] = glass_index(name, nm);
    return out;
}

std::string to_pairs(const Spectrum& s) {
    std::string out;
    const auto add = [&](std::size_t i) {
        out += (out.empty() ? "" : " ") + std::to_string(first_nm + static_cast<int>(i)) + " " +
               shortest(static_cast<double>(static_cast<float>(s[i])));
    };
    const auto straight = [&](std::size_t a, std::size_t b) {
        for (std::size_t i = a + 1; i < b; ++i) {
            const double t = static_cast<double>(i - a) / static_cast<double>(b - a);
            if (std::abs((1 - t) * s[a] + t * s[b] - s[i]) > 1e-6 * (std::abs(s[a]) + std::abs(s[b]))) return false;
        }
        return true;
    };
    for (std::size_t a = 0; a + 1 < s.size();) {
        add(a);
        std::size_t b = a + 1;
        while (b + 1 < s.size() && straight(a, b + 1))
            ++b;
        a = b;
    }
    add(s.size() - 1);
    return out;
}

std::string spectrum_line(std::string_view id, Rgb value, const Spectrum& spectrum) {
    std::string line = "=spectrum:" + std::string(id);
    for (const double x : {value.r, value.g, value.b})
        line += " " + shortest(static_cast<double>(static_cast<float>(x)));
    return line + " " + to_pairs(spectrum) + "\n";
}

Spectrum blackbody(double kelvin) {
    Spectrum out{};
    if (!(kelvin > 0)) return out;
    constexpr double c = 299792458, h = 6.62606957e-34, kb = 1.3806488e-23;
    const auto planck = [&](double metre) {
        return 2 * h * c * c / (std::pow(metre, 5) * std::expm1(h * c / (metre * kb * kelvin)));
    };
    const double peak = planck(2.8977721e-3 / kelvin); // Wien's displacement law
    for (int nm = first_nm; nm <= last_nm; ++nm)
        out[static_cast<std::size_t>(nm - first_nm)] = planck(nm * 1e-9) / peak;
    return out;
}

std::array<double, 3> to_xyz(const Spectrum& emitted) {
    const Observer& o = observer();
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < emitted.size(); ++i) {
        sum[0] += emitted[i] * o.x[i];
        sum[1] += emitted[i] * o.y[i];
        sum[2] += emitted[i] * o.z[i];
    }
    for (double& value : sum)
        value /= o.y_integral;
    return sum;
}

Rgb xyz_to_rgb(std::array<double, 3> xyz) {
    const auto rgb = multiply(srgb_from_xyz, xyz);
    return {rgb[0], rgb[1], rgb[2]};
}

Rgb rgb_equal_energy(const Spectrum& spectrum) { return xyz_to_rgb(to_xyz(spectrum)); }

Rgb rgb_of_light(const Spectrum& emitted) {
    const auto xyz = to_xyz(emitted);
    if (!(xyz[1] > 0)) return {};
    return xyz_to_rgb({xyz[0] / xyz[1], 1, xyz[2] / xyz[1]});
}

Rgb rgb_of_reflectance(const Spectrum& reflectance) {
    Spectrum lit;
    for (std::size_t i = 0; i < lit.size(); ++i)
        lit[i] = reflectance[i] * d65()[i];
    const Rgb seen = xyz_to_rgb(to_xyz(lit));
    static const Rgb white = xyz_to_rgb(to_xyz(d65()));
    return {seen.r / white.r, seen.g / white.g, seen.b / white.b};
}

double luminance_mean(const Spectrum& spectrum) { return to_xyz(spectrum)[1]; }

Rgb to_srgb(Rgb color, ColorSpace space, bool adapt_white) {
    if (space == ColorSpace::srgb) return color;
    const std::array<double, 3> in{color.r, color.g, color.b};
    switch (space) {
        case ColorSpace::dci_p3:
            return xyz_to_rgb(multiply(xyz_from_p3, in));
        case ColorSpace::rec2020:
            return xyz_to_rgb(multiply(xyz_from_rec2020, in));
        default:
            break;
    }
    const auto xyz = multiply(xyz_from_aces, in);
    return xyz_to_rgb(adapt_white ? multiply(d65_from_d60, xyz) : xyz);
}

double fresnel_normal(double eta, double k) {
    return ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k);
}

ComplexIndex rgb_of_metal(const Spectrum& eta, const Spectrum& k) {
    Spectrum reflectance;
    for (std::size_t i = 0; i < eta.size(); ++i)
        reflectance[i] = fresnel_normal(eta[i], k[i]);
    const Rgb goal = rgb_of_reflectance(reflectance);
    const Rgb mean = rgb_of_reflectance(eta);
    ComplexIndex out;
    const auto solve = [](double r, double n, double& eta_out, double& k_out) {
        r = std::clamp(r, 0.0, 0.999); // saturated metals leave the sRGB gamut: red gold exceeds 1
        n = std::max(n, 1e-3);
        // R = ((n-1)^2 + k^2) / ((n+1)^2 + k^2), solved for k.
        const double k2 = (r * (n + 1) * (n + 1) - (n - 1) * (n - 1)) / (1 - r);
        eta_out = n;
        k_out = std::sqrt(std::max(k2, 0.0));
        // No k makes an index of n reflect so little: take the real index on the same side of 1 that does.
        if (k2 < 0) eta_out = n > 1 ? (1 + std::sqrt(r)) / (1 - std::sqrt(r)) : (1 - std::sqrt(r)) / (1 + std::sqrt(r));
    };
    solve(goal.r, mean.r, out.eta.r, out.k.r);
    solve(goal.g, mean.g, out.eta.g, out.k.g);
    solve(goal.b, mean.b, out.eta.b, out.k.b);
    return out;
}

} // namespace restage::pbrt
