// SPDX-License-Identifier: Apache-2.0
// Exports keep what an import could not read, and unrendered textures; strict ones refuse losses.
#include "export_scene.hpp"
#include "io/import.hpp"
#include "io/scene_compare.hpp"
#include "io/strict.hpp"
#include "scene/placeholder.hpp"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <fstream>

using namespace restage;
using namespace restage::scene;
using Catch::Matchers::ContainsSubstring;
using test::Folder, test::joined, test::Plugins, test::version;

namespace {

const std::string v3_head = "Film \"image\"\nCamera \"perspective\"\nWorldBegin\n";
const std::string v4_head = "Film \"rgb\"\nCamera \"perspective\"\nWorldBegin\n";

const char* const lost_files = R"(
LightSource "infinite" "string filename" "sky.exr" "float scale" 4
MakeNamedMedium "smoke" "string type" "nanovdb" "string filename" "smoke.nvdb"
AttributeBegin
  MediumInterface "smoke" ""
  Material "interface"
  Shape "sphere" "float radius" 2
AttributeEnd
ObjectBegin "chair"
  Shape "plymesh" "string filename" "chair.ply"
ObjectEnd
ObjectInstance "chair"
AttributeBegin
  Translate 1 2 3
  AreaLightSource "diffuse" "rgb L" [5 5 5]
  Shape "plymesh" "string filename" "lamp.ply" "float alpha" 0.5
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "float power" 7
  ReverseOrientation
  Shape "plymesh" "string filename" "bulb.ply"
AttributeEnd
Material "diffuse" "rgb reflectance" [0.1 0.2 0.3]
Shape "disk"
Shape "teapot" "integer handles" 2
LightSource "laser" "rgb L" [1 2 3]
Translate 0 5 0
Include "more.pbrt"
NamedMaterial "of more"
Shape "sphere"
ObjectInstance "of more as well"
Material "diffuse" "texture reflectance" "also of more"
Shape "sphere" "float radius" 3
)";

void write(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

std::string exported(const Scene& scene, Folder& folder, const Plugins& plugins, const char* v) {
    const auto report = io::export_scene(scene, folder.file("out.pbrt"), plugins.registry, version(v));
    if (!report) FAIL(report.error().message);
    return read_file(folder.path / "out.pbrt").value();
}

io::ImportedScene imported(const std::string& path, const Plugins& plugins) {
    auto scene = io::import_scene(path, plugins.registry);
    if (!scene) FAIL(scene.error().message);
    return std::move(*scene);
}

} // namespace

TEST_CASE("unreadable things are written back in their place", "[export]") {
    Plugins plugins;
    Folder folder, second;
    write(folder.file("in.pbrt"), v4_head + lost_files);
    const auto scene = imported(folder.file("in.pbrt"), plugins);
    Folder out;
    const std::string text = exported(scene.scene, out, plugins, "v4");
    for (const char* part : {"\"sky.exr\"", "\"float scale\" [ 4 ]", "\"nanovdb\"", "\"smoke.nvdb\"", "\"chair.ply\"",
                             "\"lamp.ply\"", "\"float alpha\" [ 0.5 ]", "\"bulb.ply\"", "\"float power\" [ 7 ]",
                             "Shape \"teapot\" \"integer handles\" [ 2 ]", "LightSource \"laser\"",
                             "Include \"more.pbrt\"", "NamedMaterial \"of more\"", "ObjectInstance \"of more as well\"",
                             "\"texture reflectance\" [ \"also of more\" ]", "ObjectInstance \"chair\""})
        CHECK_THAT(text, ContainsSubstring(part));
    CHECK_THAT(text, !ContainsSubstring("MakeNamedMaterial \"of more\""));
    const auto again = imported(out.file("out.pbrt"), plugins);
    CHECK(missing_things(again.scene).size() == missing_things(scene.scene).size());
    CHECK(joined(io::structural_differences(scene.scene, again.scene, plugins.registry)) == "");
    CHECK(exported(again.scene, second, plugins, "v4") == text); // and again the same
}

TEST_CASE("a missing file is found, and written", "[export]") {
    Plugins plugins;
    Folder folder, out;
    write(folder.file("in.pbrt"), v4_head + "Translate 1 2 3\nShape \"plymesh\" \"string filename\" \"chair.ply\"\n");
    const auto scene = imported(folder.file("in.pbrt"), plugins);
    const auto missing = missing_things(scene.scene);
    REQUIRE(missing.size() == 1);
    CHECK(missing[0].kind == "mesh");
    CHECK(missing[0].file == folder.file("chair.ply"));
    auto data = std::make_shared<MeshData>();
    data->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data->triangles = {{0, 1, 2}};
    data->upper = {1, 1, 0};
    Scene found = scene.scene;
    const auto edit = find_mesh(found, Id<Mesh>{1}, folder.file("chair.ply"), data);
    REQUIRE(edit);
    apply(found, *edit);
    CHECK(missing_things(found).empty());
    CHECK_FALSE(find_mesh(found, Id<Mesh>{1}, "x", data));
    const std::string text = exported(found, out, plugins, "v4");
    CHECK_THAT(text, ContainsSubstring("trianglemesh"));
    apply(found, inverse(*edit)); // and undone
    CHECK(missing_things(found).size() == 1);
    CHECK_THAT(exported(found, out, plugins, "v4"), ContainsSubstring("\"chair.ply\""));
}

TEST_CASE("strict exports refuse losses and write nothing", "[export]") {
    Plugins plugins;
    Folder folder, out;
    write(folder.file("in.pbrt"), v4_head + lost_files);
    const auto scene = imported(folder.file("in.pbrt"), plugins);
    CHECK_FALSE(io::refuse_losses(scene.report, "in.pbrt"));
    const auto refused = io::export_strictly(scene.scene, out.file("out.pbrt"), plugins.registry, version("v4"));
    REQUIRE_FALSE(refused);
    CHECK_THAT(refused.error().message, ContainsSubstring("chair.ply"));
    CHECK(out.contents().empty());
    write(folder.file("plain.pbrt"),
          v4_head +
              "LightSource \"infinite\" \"rgb L\" [1 1 1]\nShape \"trianglemesh\" \"point3 P\" "
              "[0 0 0 1 0 0 0 1 0]\n");
    const auto plain = imported(folder.file("plain.pbrt"), plugins);
    CHECK(io::refuse_losses(plain.report, "plain.pbrt"));
    CHECK(io::export_strictly(plain.scene, out.file("out.pbrt"), plugins.registry, version("v4")));
    CHECK(out.contents().count("out.pbrt") == 1);
}

TEST_CASE("a missing picture is reported once, with the place that uses it", "[export]") {
    Plugins plugins;
    Folder folder;
    write(folder.file("in.pbrt"), v4_head +
                                      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"none.png\"\n"
                                      "Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n");
    const auto scene = imported(folder.file("in.pbrt"), plugins);
    REQUIRE(scene.report.count(io::Fate::dropped) == 1);
    const auto& entries = scene.report.entries;
    const auto told = std::ranges::find(entries, io::Fate::dropped, &io::ReportEntry::fate);
    CHECK(told->line > 0);
    CHECK_THAT(told->note, ContainsSubstring("there is no such file"));
}

TEST_CASE("a strict conversion refuses losses in the file, not differences in rendering", "[export]") {
    Plugins plugins;
    Folder folder, out;
    const auto converted = [&](const std::string& text, const char* to) {
        write(folder.file("in.pbrt"), text);
        const auto scene = imported(folder.file("in.pbrt"), plugins);
        INFO(text);
        CHECK_FALSE(io::refuse_losses(scene.report, "in.pbrt")); // each renders differently from pbrt
        const auto done = io::convert_strictly(scene, out.file("out.pbrt"), plugins.registry, version(to));
        CHECK(out.contents().count("out.pbrt") == (done ? 1u : 0u));
        std::filesystem::remove(out.file("out.pbrt"));
        return done ? std::string() : done.error().message;
    };
    const std::string cubes = "Texture \"t\" \"spectrum\" \"checkerboard\" \"string mapping\" \"planar\"\n";
    const std::string matte = "Material \"matte\" \"texture Kd\" \"t\"\nShape \"sphere\"\n";
    const std::string diffuse = "Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n";
    CHECK(converted(v4_head + cubes + diffuse, "v4") == "");
    CHECK(converted(v3_head + cubes + matte + "WorldEnd\n", "v4") == "");
    CHECK(
        converted(v4_head + "LightSource \"infinite\" \"rgb L\" [1 1 1] \"point3 portal\" [0 0 0 1 0 0 1 1 0 0 1 0]\n",
                  "v4") == "");
    CHECK_THAT(
        converted(v4_head + cubes + diffuse + "ActiveTransform StartTime\nTranslate 1 0 0\nShape \"sphere\"\n", "v4"),
        ContainsSubstring("in motion"));
    CHECK_THAT(converted(v3_head + "LookAt 0 0 0 0 0 0 0 1 0\nShape \"sphere\"\nWorldEnd\n", "v3"),
               ContainsSubstring("LookAt"));
    CHECK_THAT(converted(v4_head + "Shape \"plymesh\" \"string filename\" \"none.ply\"\n", "v4"),
               ContainsSubstring("none.ply"));
}

TEST_CASE("a spot that fades like the other version's is reported", "[export]") {
    Plugins plugins;
    Folder folder, out;
    write(folder.file("in.pbrt"), v3_head + "LightSource \"spot\" \"float conedeltaangle\" 20\nWorldEnd\n");
    const auto scene = imported(folder.file("in.pbrt"), plugins);
    const auto same = io::export_scene(scene.scene, out.file("a.pbrt"), plugins.registry, version("v3"));
    REQUIRE(same);
    CHECK(same->entries.empty());
    const auto other = io::export_scene(scene.scene, out.file("b.pbrt"), plugins.registry, version("v4"));
    REQUIRE(other);
    REQUIRE(other->count(io::Fate::approximated) == 1);
    CHECK_THAT(other->entries[0].note, ContainsSubstring("fourth power"));
}

TEST_CASE("features of both versions of pbrt are written in the other's syntax", "[export]") {
    Plugins plugins;
    Folder folder, out, back;
    const std::string textures = R"(
Texture "dots" "spectrum" "dots" "rgb inside" [1 0 0] "rgb outside" [0 1 0] "float uscale" 3
Texture "corners" "spectrum" "bilerp" "rgb v00" [0.1 0.2 0.3] "rgb v11" [1 0 1]
Texture "uv" "spectrum" "uv"
Texture "marble" "spectrum" "marble" "integer octaves" 5 "float scale" 2 "float variation" 0.3
Texture "clouds" "float" "fbm" "integer octaves" 4 "float roughness" 0.7
Texture "bumps" "float" "wrinkled"
Texture "wind" "spectrum" "windy"
Texture "one" "spectrum" "constant" "rgb value" [0.5 0.6 0.7]
TransformBegin
Scale 2 2 2
Texture "cubes" "spectrum" "checkerboard" "integer dimension" 3 "texture tex1" "one" "texture tex2" "dots"
TransformEnd
Texture "planar" "spectrum" "checkerboard" "string mapping" "planar" "vector v1" [1 0 0] "vector v2" [0 0 1]
)";
    std::string shapes;
    for (const char* name : {"dots", "corners", "uv", "marble", "cubes", "planar", "wind"})
        shapes += std::string("Material \"matte\" \"texture Kd\" \"") + name + "\"\nShape \"sphere\"\n";
    shapes += "Material \"matte\" \"texture bumpmap\" \"clouds\"\nShape \"sphere\"\n";
    write(folder.file("in.pbrt"), v3_head + textures + shapes + "WorldEnd\n");
    auto scene = imported(folder.file("in.pbrt"), plugins).scene;
    apply(scene, *rename(scene, Id<Instance>{1}, "edited")); // an edit of something else changes nothing of it
    const std::string v4 = exported(scene, out, plugins, "v4");
    for (const char* part :
         {"\"dots\" \"rgb inside\" [ 1 0 0 ] \"rgb outside\" [ 0 1 0 ] \"float uscale\" [ 3 ]",
          "\"bilerp\" \"rgb v00\" [ 0.1 0.2 0.3 ] \"rgb v01\" [ 1 1 1 ]", "\"rgb v11\" [ 1 0 1 ]",
          "\"uv\" \"spectrum\" \"bilerp\"", "\"marble\" \"integer octaves\" [ 5 ]", "\"float variation\" [ 0.3 ]",
          "\"float\" \"fbm\" \"integer octaves\" [ 4 ] \"float roughness\" [ 0.7 ]", "\"float\" \"wrinkled\"",
          "\"float\" \"windy\"",
          "\"integer dimension\" [ 3 ] \"texture tex1\" [ \"one\" ] \"texture tex2\" [ \"dots\" ]",
          "Transform [ 2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1 ]", "\"string mapping\" [ \"planar\" ]",
          "\"vector3 v2\" [ 0 0 1 ]"})
        CHECK_THAT(v4, ContainsSubstring(part));
    const auto as_v4 = imported(out.file("out.pbrt"), plugins).scene;
    const std::string v3 = exported(as_v4, back, plugins, "v3");
    for (const char* part : {"\"dots\" \"rgb inside\" [ 1 0 0 ]", "\"marble\" \"integer octaves\" [ 5 ]",
                             "\"integer dimension\" [ 3 ]", "TransformBegin", "\"vector v2\" [ 0 0 1 ]"})
        CHECK_THAT(v3, ContainsSubstring(part));
    Folder same;
    CHECK_THAT(exported(scene, same, plugins, "v3"), ContainsSubstring("\"uv\" \"spectrum\" \"uv\""));
}
