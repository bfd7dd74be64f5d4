// SPDX-License-Identifier: Apache-2.0
// Round trips through pbrt (v4 and v3) give the same scene; undo to the start writes the same bytes; a failed export
// leaves no files.
#include "io/export.hpp"
#include "base/file.hpp"
#include "document/session.hpp"
#include "export_scene.hpp"
#include "io/import.hpp"
#include "io/scene_compare.hpp"
#include "paths.hpp"
#include "scene/bounds.hpp"
#include "scene/tables.hpp"
#include "scene/validate.hpp"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

namespace fs = std::filesystem;
using namespace restage;
using namespace restage::scene;
using Catch::Matchers::ContainsSubstring;
using test::Everything, test::Folder, test::joined, test::Plugins, test::place, test::version;

TEST_CASE("a scene with every kind of thing survives pbrt-v4 and v3", "[export]") {
    Plugins plugins;
    const char* v = GENERATE("v4", "v3");
    CAPTURE(v);
    Folder folder;
    const Everything made(std::string(v) == "v4");
    REQUIRE(validate(made.scene).empty());
    const auto report = io::export_scene(made.scene, folder.file("out.pbrt"), plugins.registry, version(v));
    REQUIRE(report);
    for (const auto& entry : report->entries)
        FAIL_CHECK(io::to_string(entry)); // this scene contains nothing that the version lacks
    const auto again = io::import_scene(folder.file("out.pbrt"), plugins.registry);
    if (!again) FAIL(again.error().message);
    CHECK(again->scene.format == std::string("pbrt-") + v);
    for (const auto& entry : again->report.entries)
        if (entry.fate != io::Fate::kept) FAIL_CHECK(io::to_string(entry));
    CHECK(joined(io::structural_differences(made.scene, again->scene, plugins.registry)) == "");
    // Then a second round trip of the imported scene.
    Folder second;
    REQUIRE(io::export_scene(again->scene, second.file("out.pbrt"), plugins.registry, version(v)));
    const auto third = io::import_scene(second.file("out.pbrt"), plugins.registry);
    REQUIRE(third);
    CHECK(joined(io::structural_differences(again->scene, third->scene, plugins.registry)) == "");
}

TEST_CASE("the comparison of scenes finds differences", "[export]") {
    Plugins plugins;
    const Everything a(true);
    const auto differences = [&](auto&& change) {
        Everything b(true);
        change(b);
        return joined(io::structural_differences(a.scene, b.scene, plugins.registry));
    };
    CHECK(differences([](Everything&) {}) == "");
    CHECK(differences([](Everything& b) { apply(b.scene, *rename(b.scene, Id<Instance>{1}, "other")); }) == "");
    CHECK_THAT(differences([](Everything& b) { apply(b.scene, *set_transform(b.scene, {1}, place(7, 7))); }),
               ContainsSubstring("no match"));
    CHECK_THAT(
        differences([](Everything& b) { apply(b.scene, *remove_instances(b.scene, std::array{Id<Instance>{2}})); }),
        ContainsSubstring("no match"));
    CHECK_THAT(differences([](Everything& b) {
                   apply(b.scene, *set_param(b.scene, Id<Material>{1}, "reflectance", Value::color(0.7f, 0.1f, 0.34f)));
               }),
               ContainsSubstring("0.34"));
    CHECK_THAT(differences([](Everything& b) { apply(b.scene, set_film(b.scene, Film{})); }),
               ContainsSubstring("film"));
    CHECK_THAT(differences([](Everything& b) { apply(b.scene, set_environment(b.scene, {})); }),
               ContainsSubstring("environment"));
    CHECK_THAT(differences([](Everything& b) {
                   Environment sky = *b.scene.environment.value;
                   sky.hidden_from_camera = true;
                   apply(b.scene, set_environment(b.scene, sky));
               }),
               ContainsSubstring("hidden from the camera"));
    CHECK_THAT(differences([](Everything& b) { apply(b.scene, *remove(b.scene, Id<Light>{1})); }),
               ContainsSubstring("lights"));
    CHECK_THAT(differences([](Everything& b) {
                   apply(b.scene, *modify(b.scene, Id<Camera>{1}, "", [](Camera& c) { c.fov = 37; }));
               }),
               ContainsSubstring("camera"));
}

TEST_CASE("undo to the start writes the same bytes", "[export]") {
    Plugins plugins;
    document::Session session(plugins.registry);
    session.adopt(Everything(true).scene);
    Folder before, edited, after, twice;
    REQUIRE(session.export_to(before.file("s.pbrt")));
    REQUIRE(session.export_to(twice.file("s.pbrt")));
    CHECK(before.contents() == twice.contents());

    const std::array chairs{session.find<Instance>("cloth"), session.find<Instance>("lamp")};
    const auto copies = session.duplicate(chairs, glm::translate(glm::dmat4(1), {0, 0, 4}));
    REQUIRE(copies);
    REQUIRE(session.move(*copies, glm::rotate(glm::dmat4(1), 0.3, {0, 1, 0}), "drag"));
    REQUIRE(session.remove(std::array{session.find<Instance>("veil")}));
    REQUIRE(session.set_material(std::array{session.find<Instance>("lamp")}, session.find<Material>("gold")));
    REQUIRE(session.set_param(session.find<Material>("gold"), "uroughness", Value::number(0.5f)));
    const auto velvet = session.add_material("blue", "diffuse");
    REQUIRE(velvet);
    REQUIRE(session.set_material(*copies, *velvet));
    CHECK(session.modified());
    REQUIRE(session.save_as(edited.file("s.pbrt")));
    CHECK_FALSE(session.modified());
    CHECK(before.contents() != edited.contents());
    const auto reread = io::import_scene(edited.file("s.pbrt"), plugins.registry);
    REQUIRE(reread);
    CHECK(joined(io::structural_differences(session.scene(), reread->scene, plugins.registry)) == "");

    while (session.undo()) {
    }
    CHECK(session.modified()); // the file contains the edits
    REQUIRE(session.export_to(after.file("s.pbrt")));
    CHECK(before.contents() == after.contents());
    while (session.redo()) {
    }
    CHECK_FALSE(session.modified());
}

TEST_CASE("values that the renderer reduced or did not understand are written back until edited", "[export]") {
    Plugins plugins;
    Folder folder;
    REQUIRE(write_file_atomic(folder.file("in.pbrt"), R"(
Option "disablepixeljitter" true
Film "rgb" "integer xresolution" [ 8 ] "integer yresolution" [ 8 ] "string filename" [ "a.exr" ] "float maxcomponentvalue" [ 50 ]
Sampler "halton" "integer pixelsamples" [ 7 ] "string randomization" [ "owen" ]
Integrator "bdpt" "integer maxdepth" [ 9 ] "bool regularize" [ true ]
Camera "perspective" "float fov" [ 40 ]
WorldBegin
MakeNamedMaterial "gold" "string type" [ "conductor" ] "spectrum eta" [ "metal-Au-eta" ] "spectrum k" [ "metal-Au-k" ]
MakeNamedMaterial "skin" "string type" [ "subsurface" ] "string name" [ "Skin1" ] "float scale" [ 3 ]
Texture "noise" "spectrum" "marble" "integer octaves" [ 5 ]
MakeNamedMaterial "stone" "string type" [ "diffuse" ] "texture reflectance" [ "noise" ]
NamedMaterial "gold"
Shape "sphere" "float radius" [ 2 ]
NamedMaterial "skin"
Shape "disk" "float radius" [ 2 ]
NamedMaterial "stone"
Shape "cylinder" "float radius" [ 2 ] "float zmin" [ -3 ]
)"));
    document::Session session(plugins.registry);
    REQUIRE(session.open(folder.file("in.pbrt")));
    const auto text = [&](const char* v) {
        REQUIRE(session.export_to(folder.file("out.pbrt"), version(v)));
        return read_file(folder.file("out.pbrt")).value();
    };
    const std::string first = text("v4");
    for (const char* part :
         {"Option \"disablepixeljitter\" true", "\"float maxcomponentvalue\" [ 50 ]", "Sampler \"halton\"",
          "\"string randomization\" [ \"owen\" ]", "\"integer pixelsamples\" [ 7 ]", "Integrator \"bdpt\"",
          "\"bool regularize\" [ true ]", "\"integer maxdepth\" [ 9 ]", "\"spectrum eta\" [ \"metal-Au-eta\" ]",
          "\"spectrum k\" [ \"metal-Au-k\" ]", "\"string type\" [ \"subsurface\" ]", "\"string name\" [ \"Skin1\" ]",
          "\"spectrum\" \"marble\" \"integer octaves\" [ 5 ]", "Shape \"sphere\" \"float radius\" [ 2 ]",
          "Shape \"cylinder\" \"float radius\" [ 2 ] \"float zmin\" [ -3 ]"})
        CHECK_THAT(first, ContainsSubstring(part));
    const auto again = io::import_scene(folder.file("out.pbrt"), plugins.registry);
    REQUIRE(again);
    CHECK(joined(io::structural_differences(session.scene(), again->scene, plugins.registry)) == "");

    REQUIRE(session.set_param(session.find<Material>("gold"), "eta", Value::color(1, 2, 3)));
    REQUIRE(session.set_param(session.find<Material>("skin"), "reflectance", Value::color(0.1f, 0.2f, 0.3f)));
    const std::string edited = text("v4");
    CHECK_THAT(edited, ContainsSubstring("\"rgb eta\" [ 1 2 3 ]") && !ContainsSubstring("metal-Au-eta") &&
                           ContainsSubstring("metal-Au-k"));
    CHECK_THAT(edited, ContainsSubstring("\"string type\" [ \"coateddiffuse\" ]") && !ContainsSubstring("subsurface"));
    const std::string other = text("v3"); // cannot use v4's lines, but shows them
    CHECK_THAT(other, ContainsSubstring("# Option \"disablepixeljitter\" true") &&
                          ContainsSubstring("\"string type\" [ \"metal\" ]"));
}

TEST_CASE("the session checks values against the material's table", "[export]") {
    Plugins plugins;
    document::Session session(plugins.registry);
    session.adopt(Everything(true).scene);
    const auto gold = session.find<Material>("gold");
    const auto refused = [&](const char* param, Value value) {
        return session.set_param(gold, param, std::move(value)).error().message;
    };
    CHECK_THAT(refused("uroughness", Value::number(7)), ContainsSubstring("out of its range"));
    CHECK_THAT(refused("uroughness", Value::color(0, 0, 0)), ContainsSubstring("has a different type"));
    CHECK_THAT(refused("remap", Value::choice("v5")), ContainsSubstring("v4|v3|none are possible"));
    CHECK_THAT(refused("sheen", Value::number(0)), ContainsSubstring("does not exist in a conductor"));
    CHECK_THAT(refused("use_reflectance", {.type = model::ParamType::boolean, .texture = {1}}),
               ContainsSubstring("takes no texture"));
    CHECK_FALSE(session.modified());
    CHECK_FALSE(session.add_material("x", "unobtainium"));
    CHECK_FALSE(session.open("/no/such/file.pbrt"));
    CHECK(session.scene().instances.live() > 0); // the open document stays open
    const Version before = session.version();
    session.adopt(Everything(true).scene);
    CHECK(session.version() > before);
    CHECK(session.scene().meshes.version({1}) > before);
}

TEST_CASE("the bundled scenes survive a round trip", "[export]") {
    Plugins plugins;
    const fs::path scenes = restage::test::source_dir() / "scenes";
    for (const char* name : {"cornell/cornell.pbrt", "spheres/spheres.pbrt", "demo/demo.pbrt"}) {
        CAPTURE(name);
        const auto first = io::import_scene((scenes / name).string(), plugins.registry);
        REQUIRE(first);
        Folder folder;
        REQUIRE(io::export_scene(first->scene, folder.file("s.pbrt"), plugins.registry));
        const auto second = io::import_scene(folder.file("s.pbrt"), plugins.registry);
        REQUIRE(second);
        CHECK(joined(io::structural_differences(first->scene, second->scene, plugins.registry)) == "");
    }
}

TEST_CASE("copies of an object cost one mesh in the file", "[export]") {
    Plugins plugins;
    document::Session session(plugins.registry);
    session.adopt(Everything(true).scene);
    std::vector<Id<Instance>> copies{session.find<Instance>("cup")};
    for (int i = 0; i < 5; ++i)
        copies = session.duplicate(copies, glm::translate(glm::dmat4(1), {1, 0, 0})).value();
    Folder folder;
    REQUIRE(session.export_to(folder.file("s.pbrt")));
    const auto files = folder.contents();
    CHECK(std::count_if(files.begin(), files.end(),
                        [](const auto& f) { return f.first.starts_with("models/cloth"); }) == 1);
    const std::string& text = files.at("s.pbrt");
    std::size_t placed = 0;
    for (std::size_t at = text.find("ObjectInstance \"cup\""); at != std::string::npos;
         at = text.find("ObjectInstance \"cup\"", at + 1))
        ++placed;
    CHECK(placed == 6);
}

TEST_CASE("losses of a version are in the report", "[export]") {
    Plugins plugins;
    Folder folder;
    const auto lacks = [&](const Scene& scene, const char* v, const char* part) {
        const auto report = io::export_scene(scene, folder.file("s.pbrt"), plugins.registry, version(v));
        REQUIRE(report);
        CHECK(std::any_of(report->entries.begin(), report->entries.end(),
                          [&](const auto& e) { return io::to_string(e).find(part) != std::string::npos; }));
        const auto again = io::import_scene(folder.file("s.pbrt"), plugins.registry); // still a valid file
        REQUIRE(again);
        CHECK(again->scene.instances.live() == scene.instances.live());
    };
    lacks(Everything(true).scene, "v3", "has no layered materials");
    lacks(Everything(true).scene, "v3", "resampled to pbrt-v3's equirectangular");
    lacks(Everything(false).scene, "v4", "no Oren-Nayar");
    lacks(Everything(false).scene, "v4", "resampled to pbrt-v4's octahedral");
    Everything hidden(true);
    Environment sky = *hidden.scene.environment.value;
    sky.hidden_from_camera = true;
    apply(hidden.scene, set_environment(hidden.scene, sky));
    lacks(hidden.scene, "v4", "hidden from the camera");
    lacks(hidden.scene, "v3", "hidden from the camera");
}

TEST_CASE("a failed export leaves the old files", "[export]") {
    Plugins plugins;
    Folder folder;
    const Everything made(true);
    REQUIRE(io::export_scene(made.scene, folder.file("s.pbrt"), plugins.registry));
    const auto before = folder.contents();
    io::ExportOptions stopped;
    stopped.progress = [](float done, std::string_view) { return done < 0.5f; };
    const auto result = io::export_scene(made.scene, folder.file("s.pbrt"), plugins.registry, stopped);
    REQUIRE_FALSE(result);
    CHECK(result.error().cancelled());
    CHECK_THAT(result.error().message, ContainsSubstring("stopped on request"));
    CHECK(folder.contents() == before);
    Everything broken(true);
    apply(broken.scene, *modify(broken.scene, Id<Instance>{1}, "", [](Instance& i) { i.material = {99}; }));
    const auto refused = io::export_scene(broken.scene, folder.file("s.pbrt"), plugins.registry);
    REQUIRE_FALSE(refused);
    CHECK_THAT(refused.error().message, ContainsSubstring("material 99 does not exist"));
    CHECK(folder.contents() == before);
    CHECK_THAT(io::export_scene(made.scene, folder.file("no/such/s.pbrt"), plugins.registry).error().message,
               ContainsSubstring("there is no folder"));
    CHECK_THAT(io::export_scene(made.scene, folder.file("s.blend"), plugins.registry).error().message,
               ContainsSubstring("no exporter writes files called .blend; known: mitsuba, pbrt"));
}
