// SPDX-License-Identifier: Apache-2.0
// Lights placed for a highlight.
#include "scene/edits_light.hpp"

#include "scene_room.hpp"

#include <catch2/catch_test_macros.hpp>
#include <glm/gtc/matrix_transform.hpp>

using namespace restage;
using namespace restage::scene;

namespace {

constexpr glm::dvec3 at{1, 2, 3};
const glm::dvec3 toward = glm::normalize(glm::dvec3(1, -2, 2));
glm::dvec3 place(const Light& l) { return l.light_to_world[3]; }
glm::dvec3 aim(const Light& l) { return glm::normalize(glm::dvec3(l.light_to_world[2])); }
bool near(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-9; }

} // namespace

TEST_CASE("a light goes around a point, at its distance, and shines towards it") {
    test::Room r;
    const glm::dmat4 start = glm::translate(glm::dmat4(1), at + glm::dvec3(0, 0, 5));
    const auto spot = r.add(Light{.name = "spot", .kind = LightKind::spot, .light_to_world = start});
    const auto edit = light_from(r.scene, spot, at, toward);
    REQUIRE(edit);
    CHECK(edit->label == "Highlight by spot");
    apply(r.scene, *edit);
    CHECK(near(place(r.scene.lights[spot]), at + 5.0 * toward));
    CHECK(near(aim(r.scene.lights[spot]), -toward));
    CHECK(std::abs(glm::determinant(glm::dmat3(r.scene.lights[spot].light_to_world)) - 1) < 1e-9);
    apply(r.scene, *light_from(r.scene, spot, at, -toward)); // all the way round
    CHECK(near(place(r.scene.lights[spot]), at - 5.0 * toward));
    CHECK(near(aim(r.scene.lights[spot]), toward));
    CHECK_FALSE(light_from(r.scene, spot, place(r.scene.lights[spot]), toward)); // from where?
    CHECK_FALSE(light_from(r.scene, Id<Light>{99}, at, toward));
}

TEST_CASE("a sun only turns, a point light only moves") {
    test::Room r;
    const auto sun = r.add(Light{.name = "sun", .kind = LightKind::distant});
    apply(r.scene, *light_from(r.scene, sun, at, toward));
    CHECK(near(aim(r.scene.lights[sun]), -toward));
    CHECK(near(place(r.scene.lights[sun]), glm::dvec3(0)));
    const auto bulb = r.add(Light{.name = "bulb"});
    apply(r.scene, *light_from(r.scene, bulb, at, toward));
    CHECK(near(place(r.scene.lights[bulb]), at + glm::length(at) * toward));
}

TEST_CASE("lamps go around a point together") {
    test::Room r;
    apply(r.scene, *set_transform(r.scene, r.chair2, glm::translate(glm::dmat4(1), glm::dvec3(4, 0, 0))));
    const auto centre = [&] {
        Bounds box = world_bounds(r.scene, r.chair);
        box.add(world_bounds(r.scene, r.chair2));
        return box.center();
    };
    const glm::dvec3 up(0, 0, 1), on = centre() - 2.0 * up; // straight below
    const Id<Instance> both[] = {r.chair, r.chair2};
    const auto edit = light_from(r.scene, both, on, -up);
    REQUIRE(edit);
    CHECK(edit->label == "Highlight by 2 objects");
    apply(r.scene, *edit);
    CHECK(near(centre(), on - 2.0 * up));
    CHECK_FALSE(light_from(r.scene, std::span<const Id<Instance>>(), on, up));
}
