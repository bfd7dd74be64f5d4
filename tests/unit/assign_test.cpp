// SPDX-License-Identifier: Apache-2.0
// Changes as text ("oak.reflectance=0.2"), and merging parts of a picture.
#include "document/assign.hpp"
#include "project_room.hpp"
#include "render/film_error.hpp"
#include "view/merge_pictures.hpp"
#include "view/picture.hpp"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cmath>

using namespace restage;
using namespace restage::test;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("name.field=value changes a scene", "[assign]") {
    const Fixture files;
    document::Session session(files.registry);
    files.opened(session);
    const auto set = [&](const char* text) {
        const auto done = document::assign(session, text);
        INFO(text << ": " << (done ? "" : done.error().message));
        CHECK(done);
    };
    const auto refused = [&](const char* text) {
        const auto version = session.version();
        const auto done = document::assign(session, text);
        REQUIRE_FALSE(done);
        CHECK(session.version() == version);
        return done.error().message;
    };
    const Scene& s = session.scene();

    set("oak.reflectance=0.1,0.2,0.3");
    const Material& oak = s.materials[session.find<Material>("oak")];
    CHECK(oak.params.color("reflectance", {}) == std::array{0.1f, 0.2f, 0.3f});
    set("oak.reflectance=0.5");
    CHECK(oak.params.color("reflectance", {}) == std::array{0.5f, 0.5f, 0.5f});
    set("oak.reflectance=checks");
    CHECK(oak.params.texture("reflectance") == session.find<Texture>("checks"));
    set("steel.uroughness=0.25");
    set("steel.type=diffuse");
    CHECK(s.materials[session.find<Material>("steel")].type == "diffuse");
    set("Lamp.emission=3");
    CHECK(s.instances[session.find<Instance>("Lamp")].emission->radiance == glm::vec3(3));
    set("Lamp.catcher=true");
    CHECK(s.instances[session.find<Instance>("Lamp")].catcher);
    set("Lamp.material=oak");
    set("Lamp.emission=none");
    set("Lamp.hidden=true");
    CHECK(s.instances[session.find<Instance>("Lamp")].hidden);
    set("film.exposure=2.5");
    CHECK(s.film.value.exposure == 2.5f);
    set("film.tone=agx");
    set("film.white_balance=3200");
    set("film.bloom=0.25");
    CHECK(s.film.value.development == Development{.tone = ToneCurve::agx, .temperature = 3200, .bloom = 0.25f});
    set("sky.scale=2");
    set("sky.rotation=90");
    set("settings.max_depth=3");
    CHECK(s.settings.value.max_depth == 3);
    std::string camera;
    s.cameras.each([&](auto, const Camera& c) { camera = c.name; });
    set((camera + ".fov=50").c_str());

    CHECK_THAT(refused("oak.reflectance=2"), ContainsSubstring("out of its range"));
    CHECK_THAT(refused("oak.gloss=2"), ContainsSubstring("material \"oak\" has type, reflectance"));
    CHECK_THAT(refused("oak.reflectance=wenge"), ContainsSubstring("there is no texture \"wenge\""));
    CHECK_THAT(refused("oak.reflectance=1,2"), ContainsSubstring("one number or three"));
    CHECK_THAT(refused("oak.reflectance=1,,2"), ContainsSubstring("is not a number"));
    CHECK_THAT(refused("oak.type=velours"), ContainsSubstring("there is no material type \"velours\""));
    CHECK_THAT(refused("ash.reflectance=1"),
               ContainsSubstring("there is no material, object, light or camera \"ash\""));
    CHECK_THAT(refused("film.exposure=nan"), ContainsSubstring("exposure"));
    CHECK_THAT(refused("film.tone=sepia"), ContainsSubstring("srgb, filmic, agx, neutral"));
    CHECK_THAT(refused("film.bloom=2"), ContainsSubstring("a bloom of 2; it must be from 0 to 1"));
    CHECK_THAT(refused("film.shutter=2"), ContainsSubstring("the film has exposure, tone"));
    CHECK_THAT(refused((camera + ".fov=190").c_str()), ContainsSubstring("field of view"));
    CHECK_THAT(refused("settings.samples=-1"), ContainsSubstring("whole number"));
    for (const char* nothing : {"", "oak", "oak=1", ".reflectance=1", "oak.=1", "=.1"})
        CHECK_THAT(refused(nothing), ContainsSubstring("write name.field=value"));
}

namespace {

// The film's values for samples x_1 .. x_n of one pixel, in all channels; its twin is this much brighter.
render::FilmImage film_of(const std::vector<double>& samples, double twin) {
    double sum = 0, square = 0;
    for (const double x : samples)
        sum += x, square += x * x;
    const double n = double(samples.size()), mean = sum / n, variance = (square / n - mean * mean) / (n - 1);
    render::FilmImage film{.width = 1,
                           .height = 1,
                           .samples = std::uint32_t(samples.size()),
                           .color = {glm::vec3(float(mean))},
                           .std_error = {glm::vec3(0)},
                           .luminance_variance = {float(variance)},
                           .sample_error = {glm::vec3(float(std::sqrt(variance)))},
                           .twin = {glm::vec2(mean + twin, std::sqrt(variance))},
                           .albedo = {glm::vec3(float(mean))},
                           .normal = {glm::vec3(0, 0, 1)},
                           .depth = {float(n)},
                           .coverage = {1},
                           .instance_id = {std::uint32_t(samples.size())},
                           .material_id = {7}};
    render::correct_errors(film);
    return film;
}

} // namespace

TEST_CASE("Merged parts of a picture are the picture", "[merge]") {
    const std::vector<double> first{0.5, 2, 1.25}, second{0.25, 3, 0.75, 1, 4};
    std::vector<double> all = first;
    all.insert(all.end(), second.begin(), second.end());
    const auto a = film_of(first, 0.3), b = film_of(second, 0.3), whole = film_of(all, 0.3);
    const view::PicturePart parts[] = {{&b, 3}, {&a, 0}};
    const auto merged = view::merge_films(parts);
    REQUIRE(merged);
    CHECK(merged->samples == 8);
    CHECK(merged->color[0].g == Approx(whole.color[0].g));
    CHECK(merged->std_error[0].b == Approx(whole.std_error[0].b));
    CHECK(merged->luminance_variance[0] == Approx(whole.luminance_variance[0]));
    CHECK(merged->twin[0].x == Approx(whole.twin[0].x));
    CHECK(merged->twin[0].y == Approx(whole.twin[0].y));
    CHECK(merged->depth[0] == Approx((3 * 3 + 5 * 5) / 8.0));
    CHECK(merged->instance_id[0] == 3); // of the earliest sample
    CHECK_FALSE(view::merge_films({}));

    // Likewise through files, with the exposure applied; and parts that do not belong together.
    const TemporaryFolder folder;
    const auto write = [&](const char* name, const render::FilmImage& film, const char* ranges, const char* scene) {
        const std::string path = (folder.path() / name).string();
        const auto done = view::write_picture(
            path, {.film = film, .denoised = {}, .exposure = 2},
            {.metadata = {{"restage:ranges", ranges}, {"restage:scene", scene}, {"restage:samples", "1"}}});
        REQUIRE(done);
        const auto read = view::read_picture(path);
        REQUIRE(read);
        return *read;
    };
    const view::StoredPicture files[] = {write("b.exr", b, "4:3+5", "x.pbrt"), write("a.exr", a, "4:0+3", "x.pbrt")};
    CHECK(files[0].film.samples == 5);
    const auto joined = view::merge_pictures(files);
    REQUIRE(joined);
    CHECK(joined->metadata.at("restage:ranges") == "4:0+8");
    CHECK(joined->metadata.at("restage:samples") == "8");
    CHECK(joined->film.color[0].r == Approx(2 * whole.color[0].r));
    CHECK(joined->film.std_error[0].r == Approx(2 * whole.std_error[0].r));
    CHECK(joined->film.luminance_variance[0] == Approx(4 * whole.luminance_variance[0]));
    CHECK(render::relative_error(joined->film) == Approx(render::relative_error(whole)).epsilon(0.02)); // of 0.01 more

    const view::StoredPicture twice[] = {files[0], files[0]};
    CHECK_THAT(view::merge_pictures(twice).error().message, ContainsSubstring("hold the same samples, of seed 4"));
    const view::StoredPicture strangers[] = {files[0], write("c.exr", a, "5:0+3", "y.pbrt")};
    CHECK_THAT(view::merge_pictures(strangers).error().message, ContainsSubstring("its scene is \"y.pbrt\""));
    const view::StoredPicture apart[] = {files[0], write("d.exr", a, "5:0+3", "x.pbrt")};
    CHECK(view::merge_pictures(apart)->metadata.at("restage:ranges") == "4:3+5,5:0+3");
    const std::string bare = (folder.path() / "bare.exr").string();
    REQUIRE(view::write_picture(bare, {.film = a, .denoised = {}}, {.aovs = "none"}));
    CHECK_THAT(view::read_picture(bare).error().message, ContainsSubstring("number of samples"));
    REQUIRE(view::write_picture(bare, {.film = a, .denoised = {}},
                                {.aovs = "depth", .metadata = {{"restage:ranges", "0:0+3"}}}));
    CHECK_THAT(view::read_picture(bare).error().message, ContainsSubstring("no layer \"stderr\""));
}
