// SPDX-License-Identifier: Apache-2.0
// Skies of plugins: the sun in the image, values accepted and refused by the host, edits, projects and --set, for every
// available sky plugin.
#include "document/assign.hpp"
#include "document/sky.hpp"
#include "io/scene_compare.hpp"
#include "io/sky.hpp"
#include "project_room.hpp"
#include "scene/edits.hpp"
#include "scene/sky.hpp"

#include <restage/sky.h>

#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_floating_point.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <filesystem>
#include <numbers>

namespace fs = std::filesystem;

namespace {

using namespace restage;
using namespace restage::scene;
using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::WithinAbs;
using test::Fixture;

constexpr double pi = std::numbers::pi;

PixelData black(std::uint32_t width) {
    return {
        .width = width, .height = width, .channels = 3, .values = std::vector<float>(3 * std::size_t{width} * width)};
}

glm::dvec3 energy(const PixelData& p) { // the integral over the sphere
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < p.values.size(); ++i)
        sum[int(i % 3)] += p.values[i];
    return sum * (4 * pi / (double(p.width) * p.width));
}

const Image& sky_image(const Scene& s) { return s.images[s.environment.value->image]; }

} // namespace

TEST_CASE("a sun's energy is in the image, for any size, resolution and position", "[skies]") {
    for (const double radius : {0.0005, 0.00465, 0.02, 0.5, pi / 2})
        for (const std::uint32_t width : {1u, 16u, 100u, 512u})
            for (const glm::dvec3& to :
                 {glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1), glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0),
                  glm::dvec3(0.3, -0.5, 0.8), glm::dvec3(-0.6, 0.6, -0.1)}) {
                const io::Sun sun{glm::normalize(to), {100, 50, 1}, radius};
                PixelData picture = black(width);
                io::draw_sun(picture, sun);
                const glm::dvec3 wanted = glm::dvec3(sun.radiance) * (2 * pi * (1 - std::cos(radius)));
                INFO(radius << " " << width);
                CHECK(glm::length(energy(picture) - wanted) < 1e-4 * glm::length(wanted));
            }
    // And it is in the right place: the image's centre of light is the sun's direction.
    for (const glm::dvec3& to : {glm::dvec3(0.3, -0.5, 0.8), glm::dvec3(0.01, 0.02, -1), glm::dvec3(1, 1e-9, 0)}) {
        const io::Sun sun{glm::normalize(to), {1, 1, 1}, 0.02};
        PixelData picture = black(512);
        io::draw_sun(picture, sun);
        glm::dvec3 centre(0);
        for (std::uint32_t y = 0; y < 512; ++y)
            for (std::uint32_t x = 0; x < 512; ++x)
                centre += double(picture.values[3 * (512 * std::size_t{y} + x)]) *
                          io::octahedral_direction(512, x + 0.5, y + 0.5);
        CHECK(glm::length(glm::normalize(centre) - sun.direction) < 5e-4);
        CHECK(*std::max_element(picture.values.begin(), picture.values.end()) <= 1.1f);
    }
}

TEST_CASE("the map is bijective and equal-area, with +z in the middle", "[skies]") {
    CHECK(io::octahedral_direction(4, 2, 2) == glm::dvec3(0, 0, 1));
    CHECK(io::octahedral_direction(4, 0, 0).z == -1);
    CHECK(glm::length(io::octahedral_direction(4, 4, 2) - glm::dvec3(1, 0, 0)) < 1e-12);
    CHECK(glm::length(io::octahedral_direction(4, 2, 4) - glm::dvec3(0, 1, 0)) < 1e-12);
    glm::dvec3 mean(0);
    glm::dmat3 second(0);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            const glm::dvec3 w = io::octahedral_direction(128, x + 0.5, y + 0.5);
            CHECK(std::abs(glm::length(w) - 1) < 1e-12);
            mean += w / (128. * 128);
            second += glm::outerProduct(w, w) / (128. * 128);
        }
    CHECK(glm::length(mean) < 1e-12);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            CHECK_THAT(second[i][j], WithinAbs(i == j ? 1. / 3 : 0, 1e-4));
}

TEST_CASE("a coarse sky has the energy of the fine one", "[skies]") {
    PixelData fine = black(512);
    io::draw_sun(fine, {glm::normalize(glm::dvec3(1, 2, 3)), {1, 2, 3}, 0.01});
    const PixelData coarse = io::coarse_sky(fine, 32);
    CHECK(coarse.width == 32);
    CHECK(glm::length(energy(coarse) - energy(fine)) < 1e-6 * glm::length(energy(fine)));
    CHECK(io::coarse_sky(coarse, 32).values == coarse.values);
}

TEST_CASE("every sky plugin sets a scene's sky as one undo step, and projects keep its values", "[skies]") {
    const Fixture f;
    const auto catalogue = f.registry.catalogue();
    REQUIRE(!catalogue->skies.empty());
    for (const plugin::SkyEntry& sky : catalogue->skies) {
        INFO(sky.table->type);
        document::Session session(f.registry);
        f.opened(session);
        const std::size_t images = session.scene().images.live();
        const glm::dvec3 up(0, 1, 0);
        REQUIRE(session.edit(document::plugin_sky(session.scene(), f.registry, sky.table->type, {}, up)));
        REQUIRE(session.scene().environment.value);
        const Environment first = *session.scene().environment.value;
        CHECK(first.sky == sky.table->type);
        CHECK(first.mapping == scene::Mapping::octahedral);
        CHECK(glm::length(glm::dmat3(first.light_to_world) * glm::dvec3(0, 0, 1) - up) < 1e-12);
        CHECK(session.scene().images.live() == images + 1);

        // A value: the image is replaced in place; rotation and strength are kept.
        Environment turned = first;
        turned.scale = glm::vec3(2);
        turned.light_to_world = scene::upright_sky({1, 0, 0});
        REQUIRE(session.edit(set_environment(session.scene(), turned)));
        CHECK(session.scene().environment.value->sky == sky.table->type);
        ParamSet values;
        for (const model::Param& line : sky.table->params)
            if (line.type == model::ParamType::number) {
                values.set(line.id, Value::number(0.75f * line.min + 0.25f * line.max));
                break;
            }
        REQUIRE(session.edit(document::plugin_sky(session.scene(), f.registry, sky.table->type, values, up)));
        const Environment second = *session.scene().environment.value;
        CHECK(second.image == first.image);
        CHECK(second.scale == glm::vec3(2));
        CHECK(second.light_to_world == turned.light_to_world);
        CHECK(second.sky_params == values);
        CHECK(session.scene().images.live() == images + 1);

        // A project does not need its image, and gives the same pixels.
        const std::string path = f.at("sky.restage");
        REQUIRE(session.save_project(path));
        CHECK(fs::file_size(path) < 40000);
        document::Session again(f.registry);
        REQUIRE(again.open(path));
        REQUIRE(again.scene().environment.value);
        CHECK(again.scene().environment.value->sky_params == values);
        CHECK(sky_image(again.scene()).data->values == sky_image(session.scene()).data->values);
        CHECK(again.report().count(io::Fate::approximated) == session.report().count(io::Fate::approximated));
        CHECK(io::structural_differences(session.scene(), again.scene(), f.registry, {.names = true}).empty());

        // Without the plugin: a coarse image of it, and nothing is lost.
        plugin::Registry none(const_cast<Log&>(f.log));
        fs::create_directories(f.folder / "plugins");
        for (const char* needed : {"importer-pbrt", "material-diffuse", "material-conductor"})
            fs::create_directory_symlink(restage::test::build_dir() / "lib/restage/plugins" / needed,
                                         f.folder / "plugins" / needed);
        none.scan(std::vector<plugin::SearchPath>{{f.folder / "plugins", true}});
        document::Session without(none);
        REQUIRE(without.open(path));
        CHECK(without.scene().environment.value->sky_params == values);
        CHECK(sky_image(without.scene()).data->width == 32);
        CHECK(glm::length(energy(*sky_image(without.scene()).data) - energy(*sky_image(session.scene()).data)) <
              1e-3 * glm::length(energy(*sky_image(session.scene()).data)));
        CHECK(std::ranges::any_of(without.report().entries, [](const io::ReportEntry& e) {
            return e.note.find("its plugin is missing; a coarse saved picture replaces it") != std::string::npos;
        }));
        REQUIRE(without.save_project(f.at("sky2.restage")));
        document::Session back(f.registry);
        REQUIRE(back.open(f.at("sky2.restage")));
        CHECK(sky_image(back.scene()).data->values == sky_image(session.scene()).data->values);

        // Undo restores it, and another sky removes the image.
        while (session.undo()) {
        }
        CHECK(session.scene().images.live() == images);
        while (session.redo()) {
        }
        CHECK(*session.scene().environment.value == second);
        Environment plain = second;
        plain.image = {};
        REQUIRE(session.edit(set_environment(session.scene(), plain)));
        CHECK(session.scene().environment.value->sky.empty());
        CHECK(session.scene().images.live() == images);
        REQUIRE(session.undo());
        REQUIRE(session.edit(set_environment(session.scene(), std::nullopt)));
        CHECK(session.scene().images.live() == images);
    }
}

TEST_CASE("invalid values of a sky are refused by name", "[skies]") {
    const Fixture f;
    const Scene s;
    const auto refusal = [&](const char* type, const char* id, Value value) {
        ParamSet values;
        values.set(id, std::move(value));
        const auto edit = document::plugin_sky(s, f.registry, type, values, {0, 1, 0});
        return edit ? std::string() : edit.error().message;
    };
    CHECK_THAT(refusal("sunski", "x", {}), ContainsSubstring("there is no sky \"sunski\"; known: sunsky"));
    CHECK_THAT(refusal("sunsky", "elevatoin", Value::number(3)), ContainsSubstring("known: mode, azimuth, elevation"));
    CHECK_THAT(refusal("sunsky", "elevation", Value::number(91)), ContainsSubstring("out of its range, -18"));
    CHECK_THAT(refusal("sunsky", "mode", Value::choice("moon")), ContainsSubstring("direction|place"));
}

TEST_CASE("a scene gets a plugin's sky and its values by --set", "[skies]") {
    const Fixture f;
    document::Session session(f.registry);
    f.opened(session);
    const auto set = [&](const char* assignment) {
        const auto done = document::assign(session, assignment);
        return done ? std::string() : done.error().message;
    };
    CHECK_THAT(set("sky.elevation=20"), ContainsSubstring("the sky has type, scale, rotation and hidden_from_camera"));
    CHECK(set("sky.type=sunsky").empty());
    const auto before = sky_image(session.scene()).data;
    CHECK(set("sky.elevation=20").empty());
    CHECK(set("sky.sun=false").empty());
    CHECK(session.scene().environment.value->sky_params.number("elevation", 0) == 20);
    CHECK(sky_image(session.scene()).data->values != before->values);
    CHECK(sky_image(session.scene()).data->width == 512); // without a sun that requires more
    CHECK(before->width == 1024);
    CHECK(set("sky.rotation=30").empty());
    CHECK_THAT(set("sky.elevation=200"), ContainsSubstring("out of its range"));
    CHECK_THAT(set("sky.type=dome"), ContainsSubstring("there is no sky \"dome\""));
    CHECK_THAT(set("sky.colour=1"), ContainsSubstring("mode, azimuth"));
}

TEST_CASE("generating a sky can be cancelled", "[skies]") {
    const Fixture f;
    for (const plugin::SkyEntry& sky : f.registry.catalogue()->skies) {
        int calls = 0;
        const auto made = io::make_sky(sky, {}, [&](float, std::string_view) { return ++calls < 3; });
        REQUIRE(!made);
        CHECK(made.error().cancelled());
        CHECK(calls < 6);
    }
}
