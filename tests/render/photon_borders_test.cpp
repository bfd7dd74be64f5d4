// SPDX-License-Identifier: Apache-2.0
// Photons near borders: where as many arrive everywhere, as many are found everywhere.
#include "render/photon_borders.hpp"
#include "render/checks.hpp"
#include "shared/octahedral.h"

#include <catch2/generators/catch_generators.hpp>
#include <glm/packing.hpp>
#include <numbers>
#include <random>

using namespace restage;
using namespace restage::tests;

namespace {

constexpr float radius = 0.1f;
constexpr int per_disk = 1600; // photons

std::uint32_t packed(glm::dvec3 direction) {
    return glm::packSnorm2x16(glm::vec2(shared::direction_to_octahedral(direction) * 2.0 - 1.0));
}

// Photons from above onto the floor z = 0, as many per area everywhere within [-0.5, 0.5]^2 where `lit`; with their
// images.
struct Floor {
    std::vector<shared::Photon> photons;

    template <class Lit>
    Floor(const SceneBuilder& b, Lit&& lit, scene::Id<scene::Instance> caster = {}) {
        const auto renderer = make_renderer("embree");
        Jobs jobs(2);
        render::GpuScene scene(renderer->device(), jobs, plugins().lookup());
        const auto changes = scene.sync(b.scene);
        REQUIRE(changes.has_value());
        auto embree = render::EmbreeScene::create(1, {});
        REQUIRE(embree.has_value());
        REQUIRE((*embree)->update(scene, *changes).has_value());
        std::vector<char> casters(scene.instances().size());
        if (caster) casters[caster.value] = 1;
        std::mt19937 random(7);
        std::uniform_real_distribution<float> place(-0.5f, 0.5f);
        const int count = int(per_disk / (std::numbers::pi * radius * radius));
        for (int i = 0; i < count; ++i) {
            const glm::vec3 p(place(random), place(random), 0);
            if (lit(p))
                photons.push_back({p - glm::vec3(scene.origin()), packed({0, 0, 1}), glm::vec4(1), packed({0, 0, 1})});
        }
        const auto images = render::PhotonBorders{scene, **embree, casters}.images(photons, radius, jobs);
        photons.insert(photons.end(), images.begin(), images.end());
        for (auto& photon : photons)
            photon.p += glm::vec3(scene.origin());
    }

    double density(glm::vec3 p) const { // 1: that of the floor
        double sum = 0;
        for (const auto& photon : photons)
            sum += glm::distance(photon.p, p) < radius ? 1.0 / per_disk : 0.0;
        return sum;
    }
    void check(glm::vec3 p, double expected = 1) const {
        const double found = density(p);
        INFO("at " << p.x << ' ' << p.y << ": " << found);
        CHECK(std::abs(found - expected) <
              0.2); // four standard deviations in a corner, where each photon counts four times
    }
};

void floor_to(SceneBuilder& b, float x, float y = 2) {
    b.instance(b.quad({-2, -2, 0}, {x, -2, 0}, {x, y, 0}, {-2, y, 0}), b.diffuse(0.5f, 0.5f, 0.5f));
}
void wall(SceneBuilder& b, float x, float height = 1) {
    b.instance(b.quad({x, -2, 0}, {x, 2, 0}, {x, 2, height}, {x, -2, height}), b.diffuse(0.5f, 0.5f, 0.5f));
}

} // namespace

TEST_CASE("photon borders: nothing is added to a plane") {
    SceneBuilder b;
    floor_to(b, 2);
    const Floor floor(b, [](glm::vec3) { return true; });
    CHECK(floor.photons.size() == std::size_t(int(per_disk / (std::numbers::pi * radius * radius))));
}

TEST_CASE("photon borders: a floor is as bright at its wall, at its edge and in its corner") {
    SceneBuilder b;
    const bool edge = GENERATE(false, true), corner = GENERATE(false, true); // corner: a second wall
    INFO("edge " << edge << ", corner " << corner);
    floor_to(b, 0.2f, corner ? 0.1f : 2.f);
    if (!edge) wall(b, 0.2f);
    if (corner)
        b.instance(b.quad({-2, 0.1f, 0}, {2, 0.1f, 0}, {2, 0.1f, 1}, {-2, 0.1f, 1}), b.diffuse(0.5f, 0.5f, 0.5f));
    const Floor floor(b, [&](glm::vec3 p) { return p.x < 0.2f && (!corner || p.y < 0.1f); });
    for (const float away : {0.f, 0.03f, 0.06f, 0.12f, 0.3f})
        for (const float along : {0.01f, 0.05f, 0.2f})
            floor.check({0.2f - away, 0.1f - along, 0});
}

TEST_CASE("photon borders: at a box that stands on a floor") {
    SceneBuilder b;
    floor_to(b, 2);
    b.instance(cube(b), b.diffuse(0.5f, 0.5f, 0.5f),
               glm::translate(glm::dmat4(1), glm::dvec3(1, 0, 0.5)) * glm::scale(glm::dmat4(1), {0.8, 2, 0.5}));
    const Floor floor(b, [](glm::vec3 p) { return p.x < 0.2f; });
    for (const float away : {0.f, 0.03f, 0.06f, 0.12f, 0.3f})
        floor.check({0.2f - away, 0, 0});
}

TEST_CASE(
    "photon borders: light behind a thin wall, and behind a step lower than a tenth of the disk, stays what it is") {
    SceneBuilder b;
    floor_to(b, 2);
    wall(b, 0.2f, GENERATE(1.f, 0.01f));
    const Floor floor(b, [](glm::vec3) { return true; });
    for (const float away : {-0.05f, 0.f, 0.03f, 0.06f})
        floor.check({0.2f - away, 0, 0});
}

TEST_CASE("photon borders: a caster is none") {
    SceneBuilder b;
    floor_to(b, 2);
    const auto box =
        b.instance(cube(b), b.material("dielectric"),
                   glm::translate(glm::dmat4(1), glm::dvec3(1, 0, 0.5)) * glm::scale(glm::dmat4(1), {0.8, 2, 0.5}));
    const Floor floor(b, [](glm::vec3) { return true; }, box);
    for (const float away : {-0.03f, 0.f, 0.03f, 0.06f})
        floor.check({0.2f - away, 0, 0});
}
