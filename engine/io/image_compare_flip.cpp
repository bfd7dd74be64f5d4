// SPDX-License-Identifier: Apache-2.0
// LDR-FLIP: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem, Fairchild: "FLIP: A Difference Evaluator for
// Alternating Images", PACMCGIT 3(2), 2020. Section numbers are the paper's. Checked against the authors' program in
// tests/scripts/test_flip.py.

#include "io/image_compare.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace restage::io {

namespace {

constexpr float q_c = 0.7f, p_c = 0.4f, p_t = 0.95f; // colour: exponent and the two points of the error map (4.1)
constexpr float q_f = 0.5f, w = 0.082f;              // features: exponent, width of an edge [degrees] (4.2)

using Plane = std::vector<glm::vec3>;
using Kernel = std::vector<float>; // 2 r + 1 weights

struct Size {
    int width, height;
    std::size_t count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

// --- colour spaces (of the supplement; D65 as the matrix's own white)
// -------------------------------------------------

const glm::mat3 rgb_to_xyz = glm::transpose(glm::dmat3(10135552. / 24577794, 8788810. / 24577794, 4435075. / 24577794,
                                                       2613072. / 12288897, 8788810. / 12288897, 887015. / 12288897,
                                                       1425312. / 73733382, 8788810. / 73733382, 70074185. / 73733382));
const glm::vec3 white = rgb_to_xyz * glm::vec3(1);

glm::vec3 rgb_to_ycxcz(glm::vec3 rgb) { // linearised CIELab, opponent
    const glm::vec3 v = rgb_to_xyz * rgb / white;
    return {116 * v.y - 16, 500 * (v.x - v.y), 200 * (v.y - v.z)};
}

glm::vec3 ycxcz_to_rgb(glm::vec3 c) {
    const float y = (c.x + 16) / 116;
    return glm::inverse(rgb_to_xyz) * (glm::vec3(y + c.y / 500, y, y - c.z / 200) * white);
}

glm::vec3 rgb_to_lab(glm::vec3 rgb) {
    constexpr float delta = 6.f / 29;
    const glm::vec3 v = rgb_to_xyz * rgb / white;
    const auto f = [](float t) {
        return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.f / 29;
    };
    return {116 * f(v.y) - 16, 500 * (f(v.x) - f(v.y)), 200 * (f(v.y) - f(v.z))};
}

// Colour differences look larger in the light than in the dark (4.1.3).
glm::vec3 hunt(glm::vec3 lab) { return {lab.x, 0.01f * lab.x * lab.y, 0.01f * lab.x * lab.z}; }

float hyab(glm::vec3 a, glm::vec3 b) { // Abasi et al. 2020
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// --- separable filters
// ---------------------------------------------------------------------------------------------------

// f(-r) .. f(r)
template <class F>
Kernel sample_kernel(int radius, F&& f) {
    Kernel kernel;
    for (int x = -radius; x <= radius; ++x)
        kernel.push_back(f(static_cast<float>(x)));
    return kernel;
}

float sum(const Kernel& kernel) {
    float result = 0;
    for (const float v : kernel)
        result += v;
    return result;
}

// Convolves each channel with its own kernel along one axis; edge texels are repeated.
Plane filter(const Plane& in, Size size, const std::array<Kernel, 3>& kernels, bool horizontal) {
    const int radius = static_cast<int>(kernels[0].size() / 2);
    const int last = (horizontal ? size.width : size.height) - 1;
    Plane out(in.size());
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            glm::vec3 result(0);
            for (int i = -radius; i <= radius; ++i) {
                const int at = std::clamp((horizontal ? x : y) + i, 0, last);
                const int from = horizontal ? y * size.width + at : at * size.width + x;
                const auto k = static_cast<std::size_t>(i + radius);
                result += glm::vec3(kernels[0][k], kernels[1][k], kernels[2][k]) * in[static_cast<std::size_t>(from)];
            }
            out[static_cast<std::size_t>(y * size.width + x)] = result;
        }
    return out;
}

// Visual acuity: contrast sensitivity as sums of two Gaussians per channel (4.1.1, Table 1).
Plane blur_to_acuity(const Plane& ycxcz, Size size, float ppd) {
    struct Csf {
        float a1, b1, a2, b2;
    };
    static constexpr Csf csf[3] = {{1, 0.0047f, 0, 1e-5f}, {1, 0.0053f, 0, 1e-5f}, {34.1f, 0.04f, 13.5f, 0.025f}};
    constexpr float pi = std::numbers::pi_v<float>;
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04f / (2 * pi * pi)) * ppd));
    // a sqrt(pi/b) exp(-pi^2 (x^2 + y^2) / b) is a product of functions of x and of y; the sum of two of them is
    // filtered in two passes and added. Both are normalised by the common sum.
    std::array<std::array<Kernel, 3>, 2> gauss; // first, second term
    std::array<glm::vec3, 2> weight{glm::vec3(0), glm::vec3(0)};
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const float a[2] = {csf[channel].a1, csf[channel].a2}, b[2] = {csf[channel].b1, csf[channel].b2};
        for (std::size_t term = 0; term < 2; ++term) {
            Kernel kernel =
                sample_kernel(radius, [&](float x) { return std::exp(-pi * pi * x * x / (ppd * ppd * b[term])); });
            const float total = sum(kernel);
            weight[term][static_cast<int>(channel)] = a[term] * std::sqrt(pi / b[term]) * total * total;
            for (float& v : kernel)
                v /= total;
            gauss[term][channel] = std::move(kernel);
        }
    }
    const glm::vec3 norm = weight[0] + weight[1];
    Plane first = filter(filter(ycxcz, size, gauss[0], true), size, gauss[0], false);
    const Plane second = filter(filter(ycxcz, size, gauss[1], true), size, gauss[1], false);
    for (std::size_t i = 0; i < first.size(); ++i)
        first[i] = (first[i] * weight[0] + second[i] * weight[1]) / norm;
    return first;
}

// --- colour (4.1)
// ----------------------------------------------------------------------------------------------------------

Plane perceived_lab(const Plane& ycxcz, Size size, float ppd) {
    Plane result = blur_to_acuity(ycxcz, size, ppd);
    for (auto& c : result)
        c = hunt(rgb_to_lab(glm::clamp(ycxcz_to_rgb(c), 0.f, 1.f)));
    return result;
}

// Spreads the errors that matter over most of the range (4.1.4).
float redistribute(float error, float most) {
    const float knee = p_c * most;
    return error < knee ? p_t / knee * error : p_t + (error - knee) / (most - knee) * (1 - p_t);
}

// --- features (4.2)
// ----------------------------------------------------------------------------------------------------------

struct Features {
    std::vector<float> edges, points;
};

// Lengths of the gradient, and of the second derivatives, of luminance at the scale of a visible edge.
Features detect_features(const Plane& ycxcz, Size size, float ppd) {
    const float sigma = 0.5f * w * ppd;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    Kernel smooth = sample_kernel(radius, [&](float x) { return std::exp(-x * x / (2 * sigma * sigma)); });
    const auto at = [&](float x) { return std::exp(-x * x / (2 * sigma * sigma)); };
    Kernel edge = sample_kernel(radius, [&](float x) { return -x * at(x); });
    Kernel point = sample_kernel(radius, [&](float x) { return (x * x / (sigma * sigma) - 1) * at(x); });
    const float total = sum(smooth);
    for (float& v : smooth)
        v /= total;
    for (Kernel* kernel : {&edge, &point}) { // the positive weights sum to 1, the negative ones to -1
        float positive = 0, negative = 0;
        for (const float v : *kernel)
            (v > 0 ? positive : negative) += v;
        for (float& v : *kernel)
            v /= v > 0 ? positive : -negative;
    }
    Plane grey(ycxcz.size()); // three equal channels: smooth, edge and point filter at once
    for (std::size_t i = 0; i < grey.size(); ++i)
        grey[i] = glm::vec3((ycxcz[i].x + 16) / 116);
    const Plane across = filter(filter(grey, size, {edge, point, smooth}, true), size, {smooth, smooth, smooth}, false);
    const Plane down = filter(filter(grey, size, {smooth, smooth, smooth}, true), size, {edge, point, smooth}, false);
    Features features;
    for (std::size_t i = 0; i < grey.size(); ++i) {
        features.edges.push_back(std::hypot(across[i].x, down[i].x));
        features.points.push_back(std::hypot(across[i].y, down[i].y));
    }
    return features;
}

} // namespace

std::vector<float> flip_map(const scene::PixelData& reference, const scene::PixelData& test, float pixels_per_degree) {
    assert(reference.width == test.width && reference.height == test.height);
    const Size size{static_cast<int>(test.width), static_cast<int>(test.height)};
    const auto opponent = [&](const scene::PixelData& image) {
        Plane plane(size.count());
        for (std::size_t i = 0; i < plane.size(); ++i) {
            const float* v = &image.values[i * image.channels];
            plane[i] =
                rgb_to_ycxcz(glm::clamp(image.channels < 3 ? glm::vec3(v[0]) : glm::vec3(v[0], v[1], v[2]), 0.f, 1.f));
        }
        return plane;
    };
    const Plane a = opponent(reference), b = opponent(test);
    const Plane lab_a = perceived_lab(a, size, pixels_per_degree), lab_b = perceived_lab(b, size, pixels_per_degree);
    const Features features_a = detect_features(a, size, pixels_per_degree);
    const Features features_b = detect_features(b, size, pixels_per_degree);
    const float most = std::pow(hyab(hunt(rgb_to_lab({0, 1, 0})), hunt(rgb_to_lab({0, 0, 1}))), q_c);

    std::vector<float> errors(size.count());
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const float color = redistribute(std::pow(hyab(lab_a[i], lab_b[i]), q_c), most);
        const float edge = std::abs(features_a.edges[i] - features_b.edges[i]);
        const float point = std::abs(features_a.points[i] - features_b.points[i]);
        const float feature = std::pow(std::max(edge, point) / std::numbers::sqrt2_v<float>, q_f);
        errors[i] = std::pow(color, 1 - feature); // (4.3)
    }
    return errors;
}

} // namespace restage::io
