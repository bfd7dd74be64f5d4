// SPDX-License-Identifier: Apache-2.0
// Things pbrt cannot express survive in comments: names, nested groups, hidden things, inactive cameras; and
// lights and curves as they were before reduction for the renderer.
#include "document/session.hpp"
#include "export_scene.hpp"
#include "io/export.hpp"
#include "io/import.hpp"
#include "io/scene_compare.hpp"
#include "scene/validate.hpp"

#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace fs = std::filesystem;
using namespace restage;
using namespace restage::scene;
using Catch::Matchers::ContainsSubstring;
using test::Everything, test::Folder, test::joined, test::Plugins, test::place, test::version;

namespace {

// Every kind of thing, with difficult names: repeated with a number, quoted, in other alphabets, numbered by
// programs.
Everything furnished(bool v4) {
    Everything made(v4);
    Scene& s = made.scene;
    unsigned number = 0;
    s.instances.each(
        [&](Id<Instance> id, const Instance& i) { apply(s, *rename(s, id, i.name + " " + std::to_string(++number))); });
    apply(s, *rename(s, Id<Instance>{1}, "say \"a\\b\"\nand stop"));
    apply(s, *rename(s, Id<Instance>{2}, "Кувшин"));
    apply(s, *rename(s, Id<Instance>{3}, "mesh_0012"));
    const auto kitchen = made.add(Group{.name = "kitchen"});
    const auto table = made.add(Group{.name = "table: \"oak\"", .parent = kitchen});
    made.add(Group{.name = "nothing yet", .parent = kitchen});
    const auto set = made.add(Group{.name = "set", .parent = table});
    for (const char* name : {"cup", "saucer"})
        made.add(Instance{.name = name, .mesh = {1}, .material = {1}, .group = set, .object_to_world = place(2, 0.3)});
    made.add(
        Instance{.name = "cloth here", .mesh = {2}, .material = {1}, .group = table, .object_to_world = place(1, 1)});
    made.add(Instance{.name = "lone", .mesh = {3}, .material = {2}, .group = made.add(Group{.name = "of one"})});
    apply(s, *set_hidden(s, std::array{Id<Instance>{4}, Id<Instance>{20}}, true));
    made.add(Light{.name = "off",
                   .kind = scene::LightKind::spot,
                   .light_to_world = place(1, 1),
                   .falloff = v4 ? scene::Falloff::smooth : scene::Falloff::quartic,
                   .hidden = true});
    made.add(Camera{.name = "from above", .camera_to_world = place(3, 2), .fov = 50, .lens_radius = 0.1f});
    made.add(Camera{.name = "default"});
    return made;
}

io::SceneCompareOptions with_names() {
    io::SceneCompareOptions options;
    options.names = true;
    return options;
}

} // namespace

TEST_CASE("names, groups, hidden things and inactive cameras survive pbrt", "[export]") {
    Plugins plugins;
    const char* v = GENERATE("v4", "v3");
    CAPTURE(v);
    Folder folder;
    const Everything made = furnished(std::string(v) == "v4");
    REQUIRE(validate(made.scene).empty());
    const auto report = io::export_scene(made.scene, folder.file("out.pbrt"), plugins.registry, version(v));
    REQUIRE(report);
    for (const auto& entry : report->entries)
        FAIL_CHECK(io::to_string(entry));
    const auto again = io::import_scene(folder.file("out.pbrt"), plugins.registry);
    if (!again) FAIL(again.error().message);
    for (const auto& entry : again->report.entries)
        if (entry.fate != io::Fate::kept) FAIL_CHECK(io::to_string(entry));
    CHECK(joined(io::structural_differences(made.scene, again->scene, plugins.registry, with_names())) == "");

    // To pbrt hidden things and inactive cameras are comments.
    const std::string text = read_file(folder.file("out.pbrt")).value();
    std::size_t cameras = 0;
    for (std::size_t at = text.find("\nCamera "); at != std::string::npos; at = text.find("\nCamera ", at + 1))
        ++cameras;
    CHECK(cameras == 1);
    CHECK_THAT(text, ContainsSubstring("#restage     Camera \"perspective\" \"float fov\" [ 50 ]"));
    CHECK_THAT(text, !ContainsSubstring("\"\nand stop"));
    std::size_t hidden = 0;
    again->scene.instances.each([&](auto, const Instance& i) { hidden += i.hidden; });
    CHECK(hidden == 2);
    std::size_t lights = 0;
    again->scene.lights.each([&](auto, const Light& l) { lights += l.hidden && l.name == "off"; });
    CHECK(lights == 1);
    CHECK_THAT(text, ContainsSubstring("#restage     LightSource \"spot\""));
}

TEST_CASE("the comparison of scenes includes names on request", "[export]") {
    Plugins plugins;
    const Everything a = furnished(true);
    const auto differences = [&](auto&& change, bool names) {
        Everything b = furnished(true);
        change(b.scene);
        io::SceneCompareOptions options;
        options.names = names;
        return joined(io::structural_differences(a.scene, b.scene, plugins.registry, options));
    };
    const auto renamed = [](Scene& s) { apply(s, *rename(s, Id<Group>{3}, "bath")); };
    CHECK(differences(renamed, false) == "");
    CHECK_THAT(differences(renamed, true), ContainsSubstring("groups: bath | ") || ContainsSubstring("| bath"));
    const auto camera = [](Scene& s) { apply(s, *remove(s, Id<Camera>{2})); };
    CHECK(differences(camera, false) == "");
    CHECK_THAT(differences(camera, true), ContainsSubstring("cameras: "));
}

TEST_CASE("lights given by spectra are written back verbatim until they are edited", "[export]") {
    Plugins plugins;
    Folder in, folder;
    REQUIRE(write_file_atomic(in.file("lamp.spd"), "400 1\n500 2\n600 3\n700 3\n"));
    REQUIRE(write_file_atomic(in.file("in.pbrt"), R"(
Film "rgb" "integer xresolution" [ 8 ] "integer yresolution" [ 8 ]
WorldBegin
LightSource "point" "blackbody I" [ 4500 ] "float power" [ 60 ] "point3 from" [ 1 2 3 ]
LightSource "distant" "spectrum L" [ "lamp.spd" ] "float scale" [ 0.5 ]
LightSource "goniometric" "blackbody I" [ 3000 ] "string filename" [ "lamp.spd" ] "float power" [ 5 ]
LightSource "infinite" "spectrum L" [ "stdillum-D65" ] "float scale" [ 0.1 ]
AttributeBegin
# name: "bulb"
AreaLightSource "diffuse" "blackbody L" [ 2700 ] "float scale" [ 7 ] "bool twosided" [ true ]
Shape "sphere"
AttributeEnd
AreaLightSource "diffuse" "string filename" [ "lamp.spd" ] "float power" [ 3 ]
Shape "disk"
)"));
    document::Session session(plugins.registry);
    REQUIRE(session.open(in.file("in.pbrt")));
    const auto text = [&] {
        const auto report = session.export_to(folder.file("out.pbrt"), version("v4"));
        REQUIRE(report);
        std::string all = read_file(folder.file("out.pbrt")).value();
        for (const auto& entry : report->entries)
            all += io::to_string(entry) + "\n";
        return all;
    };
    const std::string first = text();
    for (
        const char* part :
        {"\"blackbody I\" [ 4500 ]", "\"spectrum L\" [ \"textures/lamp.spd\" ] \"float scale\" [ 0.5 ]",
         R"(LightSource "goniometric" "blackbody I" [ 3000 ] "string filename" [ "textures/lamp.spd" ] "float power" [ 5 ])",
         "\"spectrum L\" [ \"stdillum-D65\" ] \"float scale\" [ 0.1 ]",
         "\"blackbody L\" [ 2700 ] \"float scale\" [ 7 ] \"bool twosided\" [ true ]",
         "\"string filename\" [ \"textures/lamp.spd\" ] \"float power\" [ 3 ]"})
        CHECK_THAT(first, ContainsSubstring(part));
    CHECK(fs::exists(folder.path / "textures/lamp.spd"));
    const auto again = io::import_scene(folder.file("out.pbrt"), plugins.registry);
    REQUIRE(again);
    CHECK(joined(io::structural_differences(session.scene(), again->scene, plugins.registry, with_names())) == "");

    REQUIRE(session.edit(set_emission(session.scene(), session.find<Instance>("bulb"), Emission{{1, 2, 3}, false})));
    Light point = session.scene().lights[{1}];
    point.value = {4, 5, 6};
    REQUIRE(session.edit(set_light(session.scene(), {1}, point)));
    const std::string edited = text();
    CHECK_THAT(edited, ContainsSubstring("\"rgb L\" [ 1 2 3 ]") && ContainsSubstring("\"rgb I\" [ 4 5 6 ]") &&
                           !ContainsSubstring("2700") && !ContainsSubstring("4500") &&
                           ContainsSubstring("given by a spectrum") && ContainsSubstring("\"bulb\""));
}

TEST_CASE("curves are written back as curves", "[export]") {
    Plugins plugins;
    Folder folder;
    REQUIRE(write_file_atomic(folder.file("in.pbrt"), R"(
Film "rgb" "integer xresolution" [ 8 ] "integer yresolution" [ 8 ]
WorldBegin
MakeNamedMaterial "Fur" "string type" [ "hair" ] "float beta_m" [ 0.25 ]
NamedMaterial "Fur"
Translate 1 2 3
Shape "curve" "point3 P" [ 0 0 0 1 0 0 1 1 0 0 1 0 ] "float width" [ 0.1 ] "string type" [ "cylinder" ]
Shape "curve" "point3 P" [ 0 0 1 1 0 1 1 1 1 0 1 1 ] "float width0" [ 0.1 ] "float width1" [ 0 ]
Scale 2 2 2
Shape "curve" "point3 P" [ 0 0 2 1 0 2 1 1 2 0 1 2 ] "float width" [ 0.1 ]
)"));
    document::Session session(plugins.registry);
    REQUIRE(session.open(folder.file("in.pbrt")));
    REQUIRE(session.scene().instances.live() == 1);
    const auto fur = session.find<Instance>("Fur");
    REQUIRE(fur);
    REQUIRE(session.duplicate(std::array{fur}, glm::translate(glm::dmat4(1), {5, 0, 0})));
    REQUIRE(session.export_to(folder.file("out.pbrt"), version("v4")));
    const std::string text = read_file(folder.file("out.pbrt")).value();
    CHECK_THAT(text, ContainsSubstring("Shape \"curve\" \"point3 P\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ] \"float width\" [ "
                                       "0.1 ] \"string type\" [ \"cylinder\" ]"));
    CHECK_THAT(text,
               ContainsSubstring("[ 0 0 4 2 0 4 2 2 4 0 2 4 ] \"float width0\" [ 0.2 ] \"float width1\" [ 0.2 ]"));
    CHECK(!fs::exists(folder.path / "models"));
    const auto again = io::import_scene(folder.file("out.pbrt"), plugins.registry);
    REQUIRE(again);
    CHECK(joined(io::structural_differences(session.scene(), again->scene, plugins.registry, with_names())) == "");
}
