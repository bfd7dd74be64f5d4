// SPDX-License-Identifier: Apache-2.0
// Shadow catchers: their layers in pictures, and the floor that is laid below a scene.
#include "render/catcher.hpp"
#include "scene/bounds.hpp"
#include "scene/edits.hpp"
#include "scene/shadow_floor.hpp"
#include "scene_room.hpp"

#include <array>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <glm/gtc/matrix_transform.hpp>

using namespace restage;
using namespace restage::scene;
using Catch::Approx;

namespace {

// A catcher in half shadow, one that an object's light brightens, an unlit one, half a catcher, and none.
render::FilmImage five() {
    render::FilmImage image = render::FilmImage::blank(5, 1);
    image.caught = {1, 1, 1, 0.5f, 0};
    image.coverage = {1, 1, 1, 1, 0.25f};
    image.without = {glm::vec3(2), glm::vec3(2), glm::vec3(0), glm::vec3(1), glm::vec3(0)};
    image.shade = {glm::vec3(-1), glm::vec3(1, 0, 0), glm::vec3(0), glm::vec3(-1), glm::vec3(0)};
    image.backdrop = {glm::vec3(3), glm::vec3(3), glm::vec3(3), glm::vec3(1), glm::vec3(0)};
    image.color = {glm::vec3(3), glm::vec3(3), glm::vec3(3), glm::vec3(5), glm::vec3(7)}; // without shadows
    return image;
}

} // namespace

TEST_CASE("catcher: what is behind is multiplied by the ratio of light, and alpha is what it lacks") {
    const render::FilmImage bare = five();
    render::FilmImage image = bare;
    render::add_shadows(image, render::shadow_ratios(image));
    CHECK((image.color[0] == glm::vec3(1.5f)));
    CHECK((image.color[1] == glm::vec3(4.5f, 3, 3)));
    CHECK((image.color[2] == glm::vec3(3)));
    CHECK((image.color[3] == glm::vec3(4)));
    CHECK((image.color[4] == glm::vec3(7)));
    const std::array alpha{0.5f, 0.f, 0.f, 1.f, 0.25f};
    for (std::size_t i = 0; i < alpha.size(); ++i)
        CHECK(image.opacity()[i] == Approx(alpha[i]).margin(1e-6));
    render::remove_shadows(image);
    for (std::size_t i = 0; i < alpha.size(); ++i)
        CHECK(glm::length(image.color[i] - bare.color[i]) < 1e-6f);

    image.expose(2); // scales what is radiance, not how much is caught
    CHECK(image.caught[3] == 0.5f);
    CHECK((image.backdrop[0] == glm::vec3(6)));
    CHECK((render::shadow_ratios(image)[0] == glm::vec3(0.5f)));
}

TEST_CASE("catcher: the floor lies below what is visible, across any axis, as one edit") {
    for (const glm::dvec3& up : {glm::dvec3(0, 0, 1), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, -1)}) {
        test::Room r;
        const Scene before = r.scene;
        const Bounds box = world_bounds(r.scene);
        REQUIRE_FALSE(box.empty());
        auto made = add_shadow_floor(r.scene, up, "diffuse");
        REQUIRE(made);
        CHECK(made->edit.label == "Add shadow catcher floor");
        apply(r.scene, made->edit);
        const Instance& floor = r.scene.instances[made->floor];
        CHECK(floor.catcher);
        const Bounds at = world_bounds(r.scene, made->floor);
        const double height = glm::dot(at.center(), up);
        const double lowest = glm::dot(box.center(), up) - 0.5 * std::abs(glm::dot(box.size(), up));
        CHECK(height < lowest);
        CHECK(height > lowest - 1e-3 * box.radius());
        CHECK(std::abs(glm::dot(at.size(), up)) < 1e-6 * box.radius());
        CHECK(at.radius() > 20 * box.radius());
        // A second one lies where the first does: catchers do not count.
        auto again = add_shadow_floor(r.scene, up, "diffuse");
        REQUIRE(again);
        apply(r.scene, again->edit);
        CHECK(glm::dot(world_bounds(r.scene, again->floor).center(), up) == Approx(height));
        apply(r.scene, inverse(again->edit));
        apply(r.scene, inverse(made->edit));
        CHECK(r.scene.instances.live() == before.instances.live());
    }
    CHECK_FALSE(add_shadow_floor(Scene{}, {0, 0, 1}, "diffuse"));
}

TEST_CASE("catcher: the flag is set for several objects as one edit") {
    test::Room r;
    std::vector<Id<Instance>> ids;
    r.scene.instances.each([&](Id<Instance> id, const Instance&) { ids.push_back(id); });
    const auto edit = set_catcher(r.scene, ids, true);
    REQUIRE(edit);
    apply(r.scene, *edit);
    for (const auto id : ids)
        CHECK(r.scene.instances[id].catcher);
    CHECK_FALSE(set_catcher(r.scene, std::array{Id<Instance>{99}}, true));
}
