// SPDX-License-Identifier: Apache-2.0
// Camera moves: a turn around the scene, and the path through cameras.
#include "query/camera_path.hpp"

#include <catch2/catch_test_macros.hpp>
#include <glm/gtc/matrix_transform.hpp>

using namespace restage;

namespace {

scene::Camera camera(const glm::dvec3& at, double turn, float fov = 40, bool mirrored = false) {
    scene::Camera made{.name = "c", .fov = fov};
    made.camera_to_world = glm::rotate(glm::translate(glm::dmat4(1), at), glm::radians(turn), glm::dvec3(0, 1, 0));
    if (mirrored) made.camera_to_world[0] = -made.camera_to_world[0];
    return made;
}

bool near(const glm::dvec3& a, const glm::dvec3& b, double by = 1e-9) { return glm::length(a - b) < by; }
glm::dvec3 place(const scene::Camera& c) { return glm::dvec3(c.camera_to_world[3]); }
glm::dvec3 ahead(const scene::Camera& c) { return glm::dvec3(c.camera_to_world[2]); }

} // namespace

TEST_CASE("a camera path goes through its cameras, each stretch as long as the others", "[query]") {
    const std::vector<scene::Camera> through{camera({0, 0, 0}, 0), camera({4, 0, 0}, 90, 60), camera({4, 2, 4}, 180)};
    const auto path = query::camera_path(through, 9);
    REQUIRE(path.size() == 9);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK((path[4 * i].camera_to_world == through[i].camera_to_world));
        CHECK(path[4 * i].fov == through[i].fov);
    }
    CHECK(near(ahead(path[2]), {std::sqrt(0.5), 0, std::sqrt(0.5)})); // half way from 0 to 90 degrees
    CHECK(path[2].fov == 50);
    // Without corners: the way into the second camera is the way out of it.
    const auto fine = query::camera_path(through, 2001);
    const glm::dvec3 in = place(fine[1000]) - place(fine[999]), out = place(fine[1001]) - place(fine[1000]);
    CHECK(near(in, out, 0.01 * glm::length(in))); // the steps are short
    for (const scene::Camera& c : fine)
        CHECK(std::abs(glm::determinant(glm::dmat3(c.camera_to_world)) - 1) < 1e-9);
}

TEST_CASE("a camera path turns the shorter way, and keeps a mirrored picture mirrored", "[query]") {
    const std::vector<scene::Camera> through{camera({0, 0, 0}, 170, 40, true), camera({0, 0, 2}, -170, 40, true)};
    const auto path = query::camera_path(through, 3);
    CHECK(near(ahead(path[1]), {0, 0, -1}));
    CHECK(near(place(path[1]), {0, 0, 1}));
    CHECK(std::abs(glm::determinant(glm::dmat3(path[1].camera_to_world)) + 1) < 1e-9);
}

TEST_CASE("camera paths of one camera, one frame, or none", "[query]") {
    const std::vector<scene::Camera> one{camera({1, 2, 3}, 20)};
    for (const scene::Camera& c : query::camera_path(one, 4))
        CHECK((near(place(c), {1, 2, 3}) && near(ahead(c), ahead(one[0]))));
    const std::vector<scene::Camera> two{one[0], camera({5, 2, 3}, 0)};
    CHECK(near(place(query::camera_path(two, 1).at(0)), {1, 2, 3}));
    CHECK(query::camera_path({}, 4).empty());
}
