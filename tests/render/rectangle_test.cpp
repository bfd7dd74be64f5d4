// SPDX-License-Identifier: Apache-2.0
// Rectangles by solid angle, against double precision.
#include "kernel_lab.hpp"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <glm/glm.hpp>
#include <random>

using namespace restage;
using tests::lab;

namespace {

// Of the part from (x0, y0) to (x1, y1) of the plane z away.
double solid_angle(double x0, double y0, double x1, double y1, double z) {
    const auto corner = [&](double x, double y) { return std::atan2(x * y, z * std::sqrt(x * x + y * y + z * z)); };
    return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
}

struct Seen {
    glm::vec3 corner, b, c, p;
    glm::vec2 u;
};
struct Answer {
    float solid_angle;
    glm::vec2 place;
};

struct View { // in double
    double x0, y0, lx, ly, z;
    explicit View(const Seen& s) {
        const glm::dvec3 b(s.b), c(s.c), d = glm::dvec3(s.corner) - glm::dvec3(s.p);
        lx = glm::length(b);
        ly = glm::length(c);
        x0 = glm::dot(d, b) / lx;
        y0 = glm::dot(d, c) / ly;
        z = std::abs(glm::dot(d, glm::cross(b, c))) / (lx * ly);
    }
    double part(double u0, double v0, double u1, double v1) const {
        return solid_angle(x0 + u0 * lx, y0 + v0 * ly, x0 + u1 * lx, y0 + v1 * ly, z);
    }
};

Seen random_view(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto vector = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
    Seen s{};
    s.corner = vector();
    s.b = vector() * std::pow(10.f, unit(random));
    s.c = glm::normalize(glm::cross(s.b, vector())) * std::pow(10.f, unit(random));
    s.p = vector() * std::pow(10.f, unit(random));
    return s;
}

std::vector<Answer> ask(const std::vector<Seen>& seen) {
    return lab().run<Answer, Seen>(
        "#include \"lib/rectangle.glsl\"\nstruct Seen { vec3 corner, b, c, p; vec2 u; };\n"
        "struct Answer { float solid_angle; vec2 place; };",
        "Seen", "Answer",
        "RectangleView v = rectangle_view(x.corner, x.b, x.c, x.p); result.solid_angle = v.solid_angle;"
        "result.place = rectangle_sample(v, x.u);",
        seen);
}

} // namespace

TEST_CASE("rectangles: the solid angle agrees with double precision") {
    std::mt19937 random(4);
    std::vector<Seen> seen;
    for (int i = 0; i < 20000; ++i)
        seen.push_back(random_view(random));
    const auto answers = ask(seen);
    double worst = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const double right = View(seen[i]).part(0, 0, 1, 1);
        if (right >= 1e-2) worst = std::max(worst, std::abs(answers[i].solid_angle - right) / right);
    }
    INFO("worst relative error " << worst);
    CHECK(worst < 2e-3);
}

TEST_CASE("rectangles: points are uniform in solid angle") {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    constexpr int cells = 8, draws = 1 << 15;
    double sum = 0;
    int views = 0;
    while (views < 24) {
        const Seen view = random_view(random);
        const View exact(view);
        const double whole = exact.part(0, 0, 1, 1);
        if (whole < 1e-2) continue;
        ++views;
        std::vector<Seen> seen(draws, view);
        for (Seen& s : seen)
            s.u = {unit(random), unit(random)};
        std::vector<double> count(cells * cells);
        for (const Answer& a : ask(seen)) {
            REQUIRE((a.place.x >= 0 && a.place.x <= 1 && a.place.y >= 0 && a.place.y <= 1));
            ++count[std::size_t(std::min(cells - 1, int(a.place.y * cells)) * cells +
                                std::min(cells - 1, int(a.place.x * cells)))];
        }
        double chi = 0, rest = 0, rest_count = 0;
        int degrees = 0;
        for (int k = 0; k < cells * cells; ++k) {
            const double u = k % cells, v = k / cells; // NOLINT(bugprone-integer-division): a row
            rest += draws / whole * exact.part(u / cells, v / cells, (u + 1) / cells, (v + 1) / cells);
            rest_count += count[std::size_t(k)];
            if (rest < 20) continue;
            chi += (rest_count - rest) * (rest_count - rest) / rest;
            ++degrees;
            rest = rest_count = 0;
        }
        INFO("solid angle " << whole << ": chi-square " << chi << " of " << degrees);
        CHECK(chi < degrees + 6 * std::sqrt(2.0 * degrees) + 6);
        sum += (chi - degrees) / std::sqrt(2.0 * degrees);
    }
    CHECK(std::abs(sum) < 4 * std::sqrt(double(views)));
}
