// SPDX-License-Identifier: Apache-2.0
// Lights with a picture (goniometric, projection): written in either version's syntax, with their pictures.
#include "export_scene.hpp"
#include "io/image_file.hpp"
#include "io/import.hpp"
#include "io/scene_compare.hpp"
#include "scene/placeholder.hpp"

#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_floating_point.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <charconv>
#include <fstream>

using namespace restage;
using namespace restage::scene;
using Catch::Matchers::ContainsSubstring, Catch::Matchers::WithinAbs;
using test::Folder, test::joined, test::Plugins, test::version;

namespace {

using Texels = std::function<glm::vec3(std::uint32_t x, std::uint32_t y)>;

void write_picture(const std::string& path, std::uint32_t width, std::uint32_t height, const Texels& texel) {
    PixelData picture{width, height, 3, {}};
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                picture.values.push_back(texel(x, y)[c]);
    REQUIRE(io::write_image(path, picture));
}

struct Trip {
    Plugins plugins;
    Folder in, out;
    io::Report report;
    std::string text;

    Scene import_text(bool v3, const std::string& light) {
        std::ofstream(in.file("in.pbrt"))
            << (v3 ? "Film \"image\"\n" : "Film \"rgb\"\n") << "Camera \"perspective\"\nWorldBegin\n"
            << light << (v3 ? "\nWorldEnd\n" : "\n");
        return import_file(in.file("in.pbrt"));
    }
    Scene import_file(const std::string& path) {
        auto scene = io::import_scene(path, plugins.registry);
        if (!scene) FAIL(scene.error().message);
        return std::move(scene->scene);
    }
    void export_as(const Scene& scene, const char* to) {
        auto done = io::export_scene(scene, out.file("out.pbrt"), plugins.registry, version(to));
        if (!done) FAIL(done.error().message);
        report = *done;
        text = read_file(out.path / "out.pbrt").value();
    }
    PixelData picture(const char* name) {
        auto pixels = io::read_image((out.path / "textures" / name).string(), scene::Encoding::linear, 1, nullptr);
        if (!pixels) FAIL(pixels.error().message);
        return std::move(*pixels);
    }
};

} // namespace

TEST_CASE("a goniometric light of pbrt-v3 is one of pbrt-v4", "[export]") {
    Trip t;
    // 1 where phi < pi/2 and theta < pi/2, 2 on the other side of the equator there, else 0.
    write_picture(t.in.file("map.pfm"), 64, 32, [](auto x, auto y) {
        return glm::vec3(x >= 16 ? 0.f : y < 16 ? 1.f : 2.f);
    });
    const Scene scene = t.import_text(true,
                                      "Translate 1 2 3\nLightSource \"goniometric\" \"rgb I\" [3 4 5] "
                                      "\"rgb scale\" [2 2 2] \"string mapname\" \"map.pfm\"");
    CHECK(missing_things(scene).empty());
    t.export_as(scene, "v4");
    CHECK_THAT(t.text, ContainsSubstring("LightSource \"goniometric\" \"rgb I\" [ 6 8 10 ] \"string filename\" [ "
                                         "\"textures/goniometric light.pfm\" ]"));
    REQUIRE(t.report.entries.size() == 1);
    CHECK_THAT(t.report.entries[0].note, ContainsSubstring("resampled"));
    const PixelData map = t.picture("goniometric light.pfm");
    REQUIRE(map.width == map.height);
    // pbrt-v4 EqualAreaSquareToSphere: z > 0 (y of the light) where |2u-1| + |2v-1| < 1, x > 0 where u > 1/2, y where
    // v.
    const auto at = [&](double u, double v) {
        return map.values[(std::size_t(v * map.height) * map.width + std::size_t(u * map.width)) * 3];
    };
    CHECK_THAT(at(0.65, 0.65), WithinAbs(1, 1e-5));
    CHECK_THAT(at(0.85, 0.85), WithinAbs(2, 1e-5));
    CHECK_THAT(at(0.35, 0.65) + at(0.65, 0.35) + at(0.35, 0.35) + at(0.15, 0.85), WithinAbs(0, 1e-5));
    double sum = 0;
    for (const float value : map.values)
        sum += static_cast<double>(value);
    CHECK_THAT(sum / static_cast<double>(map.values.size()), WithinAbs((1 + 2) / 8.0, 0.01)); // equal areas

    Trip back;
    back.export_as(t.import_file(t.out.file("out.pbrt")), "v3");
    CHECK_THAT(back.text, ContainsSubstring("LightSource \"goniometric\" \"rgb I\" [ 6 8 10 ] \"string mapname\""));
    const PixelData again = back.picture("goniometric light.pfm");
    const auto back_at = [&](double u, double v) {
        return again.values[(std::size_t(v * again.height) * again.width + std::size_t(u * again.width)) * 3];
    };
    CHECK_THAT(back_at(0.125, 0.25), WithinAbs(1, 1e-5));
    CHECK_THAT(back_at(0.125, 0.75), WithinAbs(2, 1e-5));
    CHECK_THAT(back_at(0.625, 0.25), WithinAbs(0, 1e-5));
}

TEST_CASE("a goniometric light of pbrt-v4 keeps its power in pbrt-v3", "[export]") {
    Trip t;
    write_picture(t.in.file("map.pfm"), 16, 16, [](auto, auto y) { return glm::vec3(y < 8 ? 0.5f : 0.f); });
    t.export_as(t.import_text(false, "LightSource \"goniometric\" \"float power\" 10 \"string filename\" \"map.pfm\""),
                "v3");
    // 10 W over 4 pi, by the mean of the picture, 1/4: 3.1831 W/sr where it is 1.
    const auto value = t.text.find("\"rgb I\" [ 3.183");
    CHECK(value != t.text.npos);
}

TEST_CASE("a projection light is written in the other version's syntax", "[export]") {
    Trip t;
    write_picture(t.in.file("slide.pfm"), 4, 2, [](auto x, auto y) { return glm::vec3(x, y, 1); });
    const Scene scene =
        t.import_text(true, "LightSource \"projection\" \"rgb I\" [2 4 6] \"string mapname\" \"slide.pfm\"");
    t.export_as(scene, "v4");
    CHECK_THAT(t.text, ContainsSubstring("LightSource \"projection\" \"float fov\" [ 45 ] \"string filename\" [ "
                                         "\"textures/projection light.pfm\" ]"));
    const PixelData slide = t.picture("projection light.pfm"); // v3's top row is v4's lowest; v4 has no "I"
    REQUIRE(slide.values.size() == 4 * 2 * 3);
    CHECK(std::vector<float>(slide.values.begin(), slide.values.begin() + 6) == std::vector<float>{0, 4, 6, 2, 4, 6});
    CHECK(std::vector<float>(slide.values.begin() + 12, slide.values.begin() + 18) ==
          std::vector<float>{0, 0, 6, 2, 0, 6});
    CHECK(t.report.entries.empty());

    Trip back;
    back.export_as(t.import_file(t.out.file("out.pbrt")), "v3");
    CHECK_THAT(back.text, ContainsSubstring("LightSource \"projection\" \"rgb I\" [ 1 1 1 ] \"float fov\" [ 45 ] "
                                            "\"string mapname\""));
    CHECK(back.picture("projection light.pfm").values[1] == 0);
    for (const auto& entry : back.report.entries)
        CHECK_THAT(entry.what, !ContainsSubstring("light")); // v4's sampler does not exist in v3
}

TEST_CASE("a projection light of pbrt-v4 keeps its power, and its angle, which pbrt-v3 sets differently", "[export]") {
    Trip t;
    write_picture(t.in.file("slide.pfm"), 2, 2, [](auto, auto) { return glm::vec3(1); });
    t.export_as(t.import_text(false,
                              "LightSource \"projection\" \"float power\" 7 \"float fov\" 10 \"string filename\" "
                              "\"slide.pfm\""),
                "v3");
    // In four cells of the screen, as pbrt sums: tan^2(5 deg) * 4 * cos^3 at (0.5, 0.5) tan(5 deg).
    const double tangent = std::tan(5 * 3.14159265358979 / 180), cosine = 1 / std::sqrt(1 + tangent * tangent / 2);
    const double wanted = 7 / (4 * tangent * tangent * cosine * cosine * cosine);
    const auto at = t.text.find("\"rgb I\" [ ");
    REQUIRE(at != t.text.npos);
    double intensity = 0;
    std::from_chars(t.text.data() + at + 10, t.text.data() + t.text.size(), intensity); // in any locale
    CHECK_THAT(intensity, WithinAbs(wanted, wanted * 1e-4));
    CHECK_THAT(t.text, ContainsSubstring("\"float fov\" [ 10 ]"));
}

TEST_CASE("lights with a picture survive a round trip, even edited, and missing pictures are named", "[export]") {
    Trip t;
    write_picture(t.in.file("map.pfm"), 16, 16, [](auto, auto) { return glm::vec3(1); });
    Scene scene = t.import_text(false,
                                "LightSource \"goniometric\" \"rgb I\" [1 2 3] \"string filename\" \"map.pfm\"\n"
                                "LightSource \"projection\" \"string filename\" \"none.png\" \"float fov\" 30");
    REQUIRE(missing_things(scene).size() == 1);
    CHECK_THAT(missing_things(scene)[0].file, ContainsSubstring("none.png"));
    t.export_as(scene, "v4");
    CHECK_THAT(t.text, ContainsSubstring("LightSource \"goniometric\""));
    CHECK_THAT(t.text, ContainsSubstring("\"textures/map.pfm\""));
    CHECK_THAT(t.text, ContainsSubstring("\"none.png\""));
    REQUIRE(t.report.entries.size() == 1);
    CHECK_THAT(t.report.entries[0].note, ContainsSubstring("is missing"));
    CHECK(joined(io::structural_differences(scene, t.import_file(t.out.file("out.pbrt")), t.plugins.registry)) == "");
    Light edited = *scene.lights.find(Id<Light>{1});
    edited.value *= 2;
    scene.lights.set(Id<Light>{1}, edited, scene.clock);
    Trip other;
    other.export_as(scene, "v4");
    CHECK_THAT(other.text, ContainsSubstring("\"goniometric\" \"string filename\" [ \"textures/map.pfm\" ] "
                                             "\"rgb I\" [ 2 4 6 ]"));
    Trip v3;
    v3.export_as(scene, "v3");
    CHECK_THAT(v3.text, ContainsSubstring("LightSource \"spot\"")); // a replacement, which is reported
    CHECK(v3.report.count(io::Fate::dropped) == 1);
}
