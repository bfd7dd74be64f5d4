// SPDX-License-Identifier: Apache-2.0
// The difference of two linear pictures: means, RMSE, relMSE, FLIP, and a statistical test that uses the known
// noise. Pictures have 1, 3 or 4 channels; alpha is ignored; grey counts as R = G = B. Luminance is Rec. 709's.
#pragma once

#include "base/result.hpp"
#include "scene/scene.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace restage::io {

// Luminance of linear sRGB primaries (Rec. 709).
inline constexpr std::array<float, 3> luminance_weights{0.2126f, 0.7152f, 0.0722f};
std::vector<float> luminance(const scene::PixelData&); // one per pixel

// The epsilon in relMSE's denominator: mean((a - b)^2 / (b^2 + 0.01)), as in Mitsuba's and pbrt's papers.
inline constexpr float rel_mse_epsilon = 0.01f;

struct CompareOptions {
    // Fraction of texels, the brightest by luminance of both pictures together, that are scaled down to the limiting
    // luminance: fireflies then count alike. 0 = off; 0.001 is used with the references.
    float clip = 0;
    float exposure = 0; // of FLIP's tone mapping, in stops
};

struct Comparison { // of a picture A to a reference B
    std::array<double, 3> mean_a{}, mean_b{}; // R, G, B
    double luminance_a = 0, luminance_b = 0; // means
    double rmse = 0; // root of the mean over texels and channels of (a - b)^2
    double rel_mse = 0; // mean over texels and channels
    double flip = 0; // mean LDR-FLIP, 0..1
    float clip_luminance = 0; // the luminance resulting from `clip`; 0 = nothing was clipped
};

// An error if the pictures differ in size or have no pixels.
Result<Comparison> compare_images(const scene::PixelData& a, const scene::PixelData& b, const CompareOptions& = {});

// Scales the brightest texels of both pictures down to a common luminance, which is returned (see
// CompareOptions::clip).
float clip_fireflies(scene::PixelData& a, scene::PixelData& b, float share);

// (a - b) / (b + 0.1 mean of b) of the luminance as colour: red where A is brighter, blue where it is darker, full
// colour at +-range, black where they agree.
scene::PixelData difference_image(const scene::PixelData& a, const scene::PixelData& b, float range = 0.5f);

// --- FLIP ---------------------------------------------------------------------------------------------------------

// LDR-FLIP of Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images", per texel, 0..1.
// Pictures: display-referred linear sRGB in [0,1]; values outside are clamped. `pixels_per_degree`: of the observer;
// the default is a 0.7 m wide 3840-pixel screen from 0.7 m.
inline constexpr float flip_pixels_per_degree = 67.0206432f;
std::vector<float> flip_map(const scene::PixelData& reference, const scene::PixelData& test,
                            float pixels_per_degree = flip_pixels_per_degree);

// --- z-test ---------------------------------------------------------------------------------------------------------

// Blocks of block x block pixels (smaller at the right and lower edge). A block's z is the mean difference of luminance
// over its standard error: mean(a - b) / (sqrt(sum(var_a + var_b)) / n). Where both are the same picture plus noise of
// the stated variance, z is close to standard normal: 99.73 % of the blocks then have |z| <= 3.
struct ZTest {
    std::uint32_t columns = 0, rows = 0;
    std::vector<float> z; // one per block
    double threshold = 3; // |z| up to this passes
    double share_passing = 0; // of the blocks
    double worst = 0; // largest |z|
    double rms = 0; // of z over the blocks: 1 if the variances are correct
    // All blocks together: the threshold that a single one of this many blocks exceeds by chance with 1 % probability
    // (Bonferroni), and whether none does. Strict: any single systematic error fails it.
    double family_threshold = 0;
    bool family_passes = false;
};

// Luminance and its variance, per pixel. Variances are of the pixel's value, not of one sample.
struct Estimate {
    std::uint32_t width = 0, height = 0;
    std::vector<float> luminance, variance;
};

// Two independent renderings of the same picture: their mean, and (h1 - h2)^2 / 4 averaged over each block as variance.
Result<Estimate> estimate_of_halves(const scene::PixelData& half1, const scene::PixelData& half2,
                                    std::uint32_t block = 8);

// Variances below this fraction of the squared luminance are rounding noise: they are raised to it.
inline constexpr float variance_floor = 1e-10f;
Result<ZTest> z_test(const Estimate& a, const Estimate& b, double threshold = 3, std::uint32_t block = 8);

// x with P(N(0,1) <= x) = p.
double inverse_normal(double p);

} // namespace restage::io
