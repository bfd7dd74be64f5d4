// SPDX-License-Identifier: Apache-2.0
// Arrays along a path.
#include "scene/path_array.hpp"
#include "scene/arrange.hpp"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <vector>

using namespace restage::scene;
using Catch::Approx;

namespace {

glm::dvec3 moved(const glm::dmat4& m, const glm::dvec3& p) { return glm::dvec3(m * glm::dvec4(p, 1)); }
bool close(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-9; }

} // namespace

TEST_CASE("a path goes through its points, with and without a curve", "[arrange]") {
    const std::vector<glm::dvec3> points = {{0, 0, 0}, {4, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 1, 3}};
    const auto straight = path_through(points, false);
    REQUIRE(straight.size() == 4); // equal ones are left out
    CHECK(length_of(straight) == Approx(4 + 3 + std::sqrt(17.0)));
    const auto smooth = path_through(points, true);
    CHECK(smooth.size() > 50);
    for (const glm::dvec3& p : points) {
        double nearest = 1e9;
        for (const glm::dvec3& q : smooth)
            nearest = std::min(nearest, glm::length(p - q));
        CHECK(nearest < 1e-9);
    }
    for (std::size_t i = 1; i + 1 < smooth.size(); ++i) // no corners
        CHECK(glm::dot(glm::normalize(smooth[i] - smooth[i - 1]), glm::normalize(smooth[i + 1] - smooth[i])) > 0.9);
    CHECK(path_through(std::span(points).first(2), true).size() == 2);
}

TEST_CASE("copies stand at equal distances along a path, and turn with it", "[arrange]") {
    const std::vector<glm::dvec3> corner = {{1, 0, 0}, {5, 0, 0}, {5, 0, 4}};
    const glm::dvec3 &start = corner[0], ahead(2, 0, 0);
    const auto by_count = path_array(corner, {.count = 5});
    REQUIRE(by_count.size() == 4);
    CHECK(close(moved(by_count[0], start), {3, 0, 0}));
    CHECK(close(moved(by_count[2], start), {5, 0, 2}));
    CHECK(close(moved(by_count[3], start), {5, 0, 4}));
    CHECK(close(moved(by_count[0], ahead) - moved(by_count[0], start), {1, 0, 0}));
    CHECK(close(moved(by_count[3], ahead) - moved(by_count[3], start), {0, 0, 1})); // as the path there
    const auto kept = path_array(corner, {.count = 5, .turn = false});
    CHECK(close(moved(kept[3], ahead) - moved(kept[3], start), {1, 0, 0}));
    const auto spaced = path_array(corner, {.spacing = 3});
    REQUIRE(spaced.size() == 2);
    CHECK(close(moved(spaced[1], start), {5, 0, 2}));
    CHECK(path_array(corner, {.spacing = 4}).size() == 2); // the last one at the end
    CHECK(path_array(corner, {.count = 1}).empty());
    CHECK(path_array(std::vector<glm::dvec3>{{1, 2, 3}}, {.count = 5}).empty());
    CHECK(path_array(corner, {.spacing = 1e-9}).size() == most_copies);
    // Uphill, things stay upright.
    const std::vector<glm::dvec3> hill = {{0, 0, 0}, {1, 0, 0}, {2, 1, 1}};
    const auto up = path_array(hill, {.count = 3});
    CHECK(close(glm::dvec3(up.back()[1]), {0, 1, 0}));
}
