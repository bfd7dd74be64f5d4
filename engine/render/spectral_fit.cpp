// SPDX-License-Identifier: Apache-2.0
#include "render/spectral_fit.hpp"

#include "render/cie.hpp"
#include "shared/spectral.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace restage::render {
namespace {

constexpr std::size_t samples = std::tuple_size_v<cie::Curve>;
constexpr int lanes = 8; // colours fitted together
using Lanes = std::array<float, lanes>;

// The observer's view of D65.
struct Viewer {
    std::array<std::array<float, 3>, samples> weight{}; // XYZ of a spectrum that is linear between the samples
    glm::dvec3 white{0};
    glm::dmat3 rgb_from_xyz{1};
    Viewer() {
        std::array<glm::dvec3, samples> sum{};
        for (int nm = cie::first_nm; nm <= cie::last_nm; ++nm) {
            const glm::dvec3 seen = cie::at(cie::d65, nm) * glm::dvec3(cie::at(cie::x_bar, nm), cie::at(cie::y_bar, nm),
                                                                       cie::at(cie::z_bar, nm));
            white += seen;
            const std::size_t i = std::min(std::size_t(nm - cie::first_nm) / cie::step_nm, samples - 2);
            const double t = double(nm - cie::first_nm) / cie::step_nm - double(i);
            sum[i] += (1 - t) * seen;
            sum[i + 1] += t * seen;
        }
        for (std::size_t i = 0; i < samples; ++i)
            for (int k = 0; k < 3; ++k)
                weight[i][std::size_t(k)] = float(sum[i][k] / white.y);
        white /= white.y;
        // IEC 61966-2-1's primaries, scaled so that white is (1, 1, 1)
        glm::dmat3 xyz_from_rgb(glm::dvec3(0.64, 0.33, 0.03) / 0.33, glm::dvec3(0.30, 0.60, 0.10) / 0.60,
                                glm::dvec3(0.15, 0.06, 0.79) / 0.06);
        const glm::dvec3 scale = glm::inverse(xyz_from_rgb) * white;
        for (int k = 0; k < 3; ++k)
            xyz_from_rgb[k] *= scale[k];
        rgb_from_xyz = glm::inverse(xyz_from_rgb);
    }
};

const Viewer& viewer() {
    static const Viewer instance;
    return instance;
}

// CIE L*a*b* and its derivative by XYZ.
struct Lab {
    glm::dvec3 lab;
    glm::dmat3 slope; // column k: by component k of XYZ
};
Lab lab_of(const glm::dvec3& xyz) {
    const glm::dvec3 white = viewer().white;
    glm::dvec3 f, df;
    for (int k = 0; k < 3; ++k) {
        constexpr double edge = 6.0 / 29;
        const double x = std::max(xyz[k] / white[k], 0.0), root = std::cbrt(x);
        const bool curved = root > edge;
        f[k] = curved ? root : x / (3 * edge * edge) + 4.0 / 29;
        df[k] = (curved ? 1 / (3 * root * root) : 1 / (3 * edge * edge)) / white[k];
    }
    return {{116 * f.y - 16, 500 * (f.x - f.y), 200 * (f.y - f.z)},
            {glm::dvec3(0, 500 * df.x, 0), glm::dvec3(116, -500, 200) * df.y, glm::dvec3(0, 0, -200 * df.z)}};
}

// Colours that are improved together; coefficients are those of a variable from 0 to 1.
struct Fit {
    std::array<glm::dvec3, lanes> goal; // L*a*b*
    std::array<glm::dvec3, lanes> c{};
};

// XYZ of the lanes' spectra, and its derivatives by their coefficients.
void see(const Fit& fit, std::array<Lanes, 3>& xyz, std::array<std::array<Lanes, 3>, 3>& by) {
    xyz = {};
    by = {};
    std::array<Lanes, 3> c{};
    for (std::size_t j = 0; j < lanes; ++j)
        for (int k = 0; k < 3; ++k)
            c[std::size_t(k)][j] = float(fit.c[j][k]);
    for (std::size_t i = 0; i < samples; ++i) {
        const float t = float(i) / float(samples - 1);
        const auto& w = viewer().weight[i];
        for (std::size_t j = 0; j < lanes; ++j) {
            const float x = (c[0][j] * t + c[1][j]) * t + c[2][j];
            const float r = 1 / std::sqrt(1 + x * x);
            const float s = 0.5f + 0.5f * x * r, slope = 0.5f * r * r * r;
            for (std::size_t k = 0; k < 3; ++k) {
                const float d = w[k] * slope;
                xyz[k][j] += w[k] * s;
                by[k][0][j] += d * t * t;
                by[k][1][j] += d * t;
                by[k][2][j] += d;
            }
        }
    }
}

constexpr double largest = 1000; // of a coefficient: a reflectance of 2.5e-7, or an edge of less than a nanometre

// Gauss-Newton in L*a*b*, as in the authors' code: bright saturated colours have no exact solution. A step that leads
// away is halved.
void improve(Fit& fit) {
    std::array<Lanes, 3> xyz;
    std::array<std::array<Lanes, 3>, 3> by;
    std::array<glm::dvec3, lanes> best = fit.c, step{};
    std::array<double, lanes> error;
    error.fill(1e30);
    std::array<bool, lanes> done{};
    for (int round = 0; round < 20; ++round) {
        see(fit, xyz, by);
        bool all = true;
        for (std::size_t j = 0; j < lanes; ++j) {
            if (done[j]) continue;
            const Lab now = lab_of({xyz[0][j], xyz[1][j], xyz[2][j]});
            const glm::dvec3 missing = fit.goal[j] - now.lab;
            const double e = glm::dot(missing, missing);
            if (e < error[j]) {
                error[j] = e;
                best[j] = fit.c[j];
                glm::dmat3 xyz_by;
                for (int column = 0; column < 3; ++column)
                    for (int row = 0; row < 3; ++row)
                        xyz_by[column][row] = double(by[std::size_t(row)][std::size_t(column)][j]);
                const glm::dmat3 slope = now.slope * xyz_by;
                done[j] = e < 1e-6 || !(std::abs(glm::determinant(slope)) > 1e-15);
                step[j] = done[j] ? glm::dvec3(0) : glm::inverse(slope) * missing;
            } else {
                step[j] *= 0.5;
            }
            all = all && done[j];
            fit.c[j] = best[j] + step[j];
            const glm::dvec3 a = glm::abs(fit.c[j]);
            fit.c[j] *= std::min(1.0, largest / std::max({a.x, a.y, a.z, 1.0}));
        }
        if (all) break;
    }
    fit.c = best;
}

double smoothstep(double x) { return x * x * (3 - 2 * x); }

} // namespace

double smooth_spectrum(const glm::dvec3& c, double nm) {
    const double t = (nm - 595) / 235, x = (c.x * t + c.y) * t + c.z;
    return 0.5 + 0.5 * x / std::sqrt(1 + x * x);
}

glm::dvec3 rgb_of_xyz(const glm::dvec3& xyz) { return viewer().rgb_from_xyz * xyz; }

glm::dvec3 white_rgb_at(double nm) {
    static const double luminance = [] {
        double sum = 0;
        for (int l = cie::first_nm; l <= cie::last_nm; ++l)
            sum += cie::at(cie::d65, l) * cie::at(cie::y_bar, l);
        return sum;
    }();
    return rgb_of_xyz(glm::dvec3(cie::at(cie::x_bar, nm), cie::at(cie::y_bar, nm), cie::at(cie::z_bar, nm)) *
                      (cie::at(cie::d65, nm) / luminance));
}

double d65_at(double nm) { return cie::at(cie::d65, nm); }

double luminance_of(const std::vector<float>& relative) {
    double sum = 0, white = 0;
    for (std::size_t i = 0; i < relative.size(); ++i) {
        const double nm = cie::first_nm + double(i), w = cie::at(cie::d65, nm) * cie::at(cie::y_bar, nm);
        sum += w * double(relative[i]);
        white += w;
    }
    return sum / white;
}

std::vector<glm::vec3> fit_rgb_cube(Jobs& jobs) {
    constexpr std::size_t n = SPECTRAL_CELLS;
    static_assert(n % lanes == 0);
    std::vector<glm::vec3> out(3 * n * n * n);
    const glm::dmat3 xyz_from_rgb = glm::inverse(viewer().rgb_from_xyz);
    const auto column = [&](std::size_t brightest, std::size_t y, std::size_t x) {
        const auto fit_at = [&](Fit& fit, std::size_t z) {
            const double b = smoothstep(smoothstep(double(z) / (n - 1)));
            for (std::size_t j = 0; j < lanes; ++j) {
                glm::dvec3 rgb;
                rgb[int(brightest)] = b;
                rgb[int(brightest + 1) % 3] = b * double(x + j) / (n - 1);
                rgb[int(brightest + 2) % 3] = b * double(y) / (n - 1);
                fit.goal[j] = lab_of(xyz_from_rgb * rgb).lab;
            }
            improve(fit);
            for (std::size_t j = 0; j < lanes; ++j) {
                const glm::dvec3 c = fit.c[j];
                out[((brightest * n + z) * n + y) * n + x + j] =
                    glm::dvec3(c.x / 4, (c.x + c.y) / 2, c.x / 4 + c.y / 2 + c.z);
            }
        };
        // from a colour of middling brightness, where any start converges, to both ends
        Fit up, down;
        for (std::size_t z = n / 5; z < n; ++z)
            fit_at(up, z);
        for (std::size_t z = n / 5 + 1; z-- > 0;)
            fit_at(down, z);
    };
    jobs.parallel_for(3 * n * n / lanes, 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i)
            column(i / (n * n / lanes), i / (n / lanes) % n, i % (n / lanes) * lanes);
    });
    return out;
}

} // namespace restage::render
