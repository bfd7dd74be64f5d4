// SPDX-License-Identifier: Apache-2.0
// Options of importers: refused by name; units and axes in closed form; merging keeps every triangle; defaults change
// nothing.
#include "gltf_builder.hpp"
#include "io/options.hpp"
#include "scene/bounds.hpp"

#include <algorithm>

using namespace restage;
using namespace restage::tests;
using Catch::Matchers::ContainsSubstring;

namespace {

// A tetrahedron that is 3 along the third axis.
constexpr const char* ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 2 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
constexpr const char* obj = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\no a\nf 1 3 2\no b\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
constexpr const char* stl =
    "solid t\nfacet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 2 0\nvertex 1 0 0\nendloop\n"
    "endfacet\nfacet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 3\nendloop\n"
    "endfacet\nendsolid t\n";

struct Files : ModelFiles {
    Files() { write("t.ply", ply), write("t.obj", obj), write("t.stl", stl); }
    io::ImportedScene with(const std::string& file, const std::vector<std::string>& options) {
        const auto importer = registry.find_importer(file.ends_with("obj") ? "obj" : "mesh");
        REQUIRE(importer);
        io::ImportOptions in;
        for (const std::string& option : options) {
            const auto set = io::set_option(*importer->table, option, in.values);
            INFO((set ? "" : set.error().message));
            REQUIRE(set);
        }
        return load(file, in);
    }
};

bool same(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-9; }

} // namespace

TEST_CASE("units and axes transform the contents of a file", "[options]") {
    Files files;
    for (const char* file : {"t.ply", "t.obj", "t.stl"}) {
        INFO(file);
        const scene::Bounds plain = scene::world_bounds(files.load(file).scene);
        CHECK(same(plain.lower, {0, 0, 0}));
        CHECK(same(plain.upper, {1, 2, 3}));
        const auto bounds = [&](const std::vector<std::string>& options) {
            return scene::world_bounds(files.with(file, options).scene);
        };
        for (const auto& [unit, metres] :
             {std::pair("mm", 0.001), {"cm", 0.01}, {"m", 1.}, {"in", 0.0254}, {"ft", 0.3048}})
            CHECK(same(bounds({std::string("units=") + unit}).upper, glm::dvec3(1, 2, 3) * metres));
        // z becomes y, and y points away from the viewer: (x, y, z) -> (x, z, -y).
        CHECK(same(bounds({"up=z"}).lower, {0, 0, -2}));
        CHECK(same(bounds({"up=z"}).upper, {1, 3, 0}));
        CHECK(same(bounds({"up=y"}).upper, plain.upper));
        CHECK(same(bounds({"up=z", "units=cm"}).lower, {0, 0, -0.02}));
    }
}

TEST_CASE("a z-up file stands upright in a y-up scene", "[options]") {
    Files files;
    const auto sky_up = [](const io::ImportedScene& in) {
        return glm::dvec3(in.scene.environment.value->light_to_world[2]); // of a panorama
    };
    CHECK(same(sky_up(files.load("t.stl")), {0, 0, 1})); // as in the file
    CHECK(same(sky_up(files.with("t.stl", {"up=z"})), {0, 1, 0}));
    CHECK(same(sky_up(files.with("t.stl", {"up=y"})), {0, 1, 0}));
    CHECK(same(sky_up(files.load("t.obj")), {0, 1, 0}));
}

TEST_CASE("the defaults of all options read a file as without options", "[options]") {
    Files files;
    for (const char* file : {"t.ply", "t.obj", "t.stl"}) {
        const auto plain = files.load(file), same = files.with(file, {"units=as_is", "up=as_is"});
        std::vector<glm::dmat4> a, b;
        plain.scene.instances.each([&](auto, const scene::Instance& i) { a.push_back(i.object_to_world); });
        same.scene.instances.each([&](auto, const scene::Instance& i) { b.push_back(i.object_to_world); });
        CHECK(a == b);
        CHECK(std::ranges::all_of(a, [](const glm::dmat4& m) { return m == glm::dmat4(1); }));
        CHECK(plain.report.entries == same.report.entries);
    }
}

TEST_CASE("merging gives one object per material", "[options]") {
    Files files;
    files.write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    files.write("m.obj",
                "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                "o one\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\no two\nusemtl red\nf 1 2 4\nf 2 3 4\n"
                "o three\nusemtl red\nf 1/1 2/2 3/3\n");
    const auto apart = files.load("m.obj"), merged = files.with("m.obj", {"merge=true"});
    CHECK(apart.scene.instances.live() == 4);
    CHECK(merged.scene.groups.live() == 0);
    REQUIRE(merged.scene.instances.live() == 3); // red without and with coordinates, blue
    const auto triangles = [](const io::ImportedScene& in) {
        std::size_t all = 0;
        in.scene.instances.each(
            [&](auto, const scene::Instance& i) { all += in.scene.meshes[i.mesh].data->triangles.size(); });
        return all;
    };
    CHECK(triangles(apart) == triangles(merged));
    const auto red = scene::find_by_name<scene::Instance>(merged.scene, "red");
    REQUIRE(red);
    const scene::MeshData& mesh = *merged.scene.meshes[merged.scene.instances[red].mesh].data;
    CHECK(mesh.triangles.size() == 3);
    CHECK(mesh.uvs.empty());
    double area = 0;
    for (const glm::uvec3& t : mesh.triangles)
        area += glm::length(
                    glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x])) /
                2;
    CHECK(std::abs(area - 1.5) < 1e-6);
}

TEST_CASE("unknown options of an importer are refused", "[options]") {
    Files files;
    scene::ParamSet values;
    const auto importer = files.registry.find_importer("mesh");
    const auto refusal = [&](const char* assignment) {
        const auto set = io::set_option(*importer->table, assignment, values);
        return set ? std::string() : set.error().message;
    };
    CHECK_THAT(refusal("merge=true"),
               ContainsSubstring("importer \"mesh\": there is no option \"merge\"; known: units="));
    CHECK_THAT(refusal("up=x"), ContainsSubstring("option \"up\" cannot be \"x\"; as_is|y|z are possible"));
    CHECK_THAT(refusal("up"), ContainsSubstring("write name=value"));
    io::ImportOptions options;
    options.values.set("height", scene::Value::number(1));
    const auto in = io::import_scene(files.path("t.ply"), files.registry, options);
    REQUIRE(!in);
    CHECK_THAT(in.error().message, ContainsSubstring("there is no option \"height\""));
}

TEST_CASE("text and whole numbers are accepted for an option's type, and nothing else is", "[options]") {
    model::Importer importer{.format = "x", .label = "X", .extensions = {}, .options = {}};
    importer.options = {{.id = "scale", .type = model::ParamType::number, .min = 0, .max = 10, .def = {1}},
                        {.id = "count", .type = model::ParamType::integer, .int_min = 0, .int_max = 9},
                        {.id = "merge", .type = model::ParamType::boolean},
                        {.id = "up", .type = model::ParamType::choice, .choices = {"y", "z"}},
                        {.id = "scene", .type = model::ParamType::text}};
    const auto text = [](const char* s) { return scene::Value{.type = scene::ParamType::text, .text = s}; };
    const auto fits = [&](const char* id, const scene::Value& value) {
        const auto fitting = io::fitting_option(importer, id, value);
        if (!fitting) return "refused: " + fitting.error().message;
        CHECK(io::fitting_option(importer, id, text(io::option_text(*fitting).c_str())) == *fitting); // there and back
        return io::option_text(*fitting);
    };
    CHECK(fits("scale", text("0.1")) == "0.1");
    CHECK(fits("scale", scene::Value::integer(2)) == "2");
    CHECK(fits("count", text("7")) == "7");
    CHECK(fits("merge", text("true")) == "true");
    CHECK(fits("up", text("z")) == "z");
    CHECK(fits("scene", scene::Value::choice("Night, \"late\"")) == "Night, \"late\"");
    CHECK(fits("scene", text("")).empty());
    for (const auto& [id, value] : {std::pair("scale", scene::Value::boolean(true)),
                                    {"scale", scene::Value::choice("2")},
                                    {"count", scene::Value::number(2)},
                                    {"merge", scene::Value::integer(1)},
                                    {"merge", scene::Value::choice("true")},
                                    {"up", scene::Value::integer(1)},
                                    {"scene", scene::Value::number(1)}}) {
        INFO(id);
        CHECK_THAT(fits(id, value),
                   ContainsSubstring("refused: importer \"x\": option \"" + std::string(id) + "\" cannot be ") &&
                       ContainsSubstring("known: scale=NUMBER, count=WHOLE NUMBER, "
                                         "merge=true|false, up=y|z, scene=TEXT"));
    }
    CHECK_THAT(fits("scale", text("11")), ContainsSubstring("out of its range"));
    CHECK_THAT(fits("scale", text("wide")), ContainsSubstring("\"wide\" is not a number"));
    CHECK_THAT(fits("merge", text("1")), ContainsSubstring("neither true nor false"));
}

namespace {

// A triangle 1 by 1 across x and z at y = 2, a camera, and a medium that absorbs half of red over a length of 5.
tests::Builder model_in_units() {
    tests::Builder b;
    b.root["nodes"] = {
        {{"mesh", 0}, {"name", "thing"}, {"translation", {0, 2, 0}}, {"rotation", {0.70710678, 0, 0, 0.70710678}}},
        {{"camera", 0}, {"name", "eye"}, {"translation", {0, 0, 10}}}};
    b.root["cameras"] = {
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0.1}, {"zfar", 100}}}}};
    b.root["scenes"] = {{{"nodes", {0, 1}}}};
    b.root["materials"] = {
        {{"extensions",
          {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
           {"KHR_materials_volume",
            {{"thicknessFactor", 1}, {"attenuationDistance", 5}, {"attenuationColor", {0.5, 1, 1}}}}}}}};
    b.root["meshes"][0]["primitives"][0]["material"] = 0;
    return b;
}

} // namespace

TEST_CASE("gltf: units and the up axis transform objects, cameras and media", "[options][gltf]") {
    Files files;
    tests::Builder b = model_in_units();
    files.write("m.gltf", b.text());
    const auto read = [&](std::vector<std::string> options) {
        io::ImportOptions in{.progress = {}, .format = {}};
        for (const std::string& option : options)
            REQUIRE(io::set_text_option(option, in.values));
        return files.load("m.gltf", in);
    };
    const auto plain = read({}), same_as_plain = read({"units=m", "up=y"}), small = read({"units=cm"}),
               turned = read({"units=cm", "up=z"});
    const auto eye = [](const io::ImportedScene& in) {
        const auto id = scene::find_by_name<scene::Camera>(in.scene, "eye");
        REQUIRE(id);
        return in.scene.cameras[id];
    };
    const auto sigma = [](const io::ImportedScene& in) {
        double red = 0;
        in.scene.media.each([&](auto, const scene::Medium& m) { red = double(m.sigma_a.x); });
        return red;
    };
    const auto window = [&](const io::ImportedScene& in) { return eye(in).screen_window.value(); };
    const scene::Bounds was = scene::world_bounds(plain.scene);
    CHECK(tests::thing(plain).object_to_world == tests::thing(same_as_plain).object_to_world);
    CHECK(eye(plain).camera_to_world == eye(same_as_plain).camera_to_world);
    CHECK(std::abs(sigma(plain) - std::log(2.0) / 5) < 1e-6);

    const auto near = [](const glm::dvec3& x, const glm::dvec3& y) { return glm::length(x - y) < 1e-7; };
    const scene::Bounds now = scene::world_bounds(small.scene);
    CHECK(near(now.lower, was.lower * 0.01));
    CHECK(near(now.upper, was.upper * 0.01));
    CHECK(near(glm::dvec3(eye(small).camera_to_world[3]), {0, 0, 0.1}));
    for (int k = 0; k < 4; ++k) {
        CHECK(std::abs(double(window(small)[k]) - double(window(plain)[k]) * 0.01) < 1e-8);
        CHECK(std::abs(glm::length(glm::dvec3(eye(small).camera_to_world[k % 3])) - 1) < 1e-9); // without scale
    }
    CHECK(std::abs(sigma(small) - std::log(2.0) / 0.05) < 1e-4); // the transmission is unchanged

    // (x, y, z) -> (x, z, -y), after the unit.
    const scene::Bounds up = scene::world_bounds(turned.scene);
    CHECK(near(up.lower, glm::dvec3(now.lower.x, now.lower.z, -now.upper.y)));
    CHECK(near(up.upper, glm::dvec3(now.upper.x, now.upper.z, -now.lower.y)));
    CHECK(near(glm::dvec3(eye(turned).camera_to_world[3]), {0, 0.1, 0}));
}

TEST_CASE("gltf: one of several scenes is chosen by its name or number", "[options][gltf]") {
    Files files;
    tests::Builder b;
    b.root["nodes"] = {
        {{"mesh", 0}, {"name", "day"}}, {{"mesh", 0}, {"name", "night"}}, {{"mesh", 0}, {"name", "two"}}};
    b.root["scenes"] = {
        {{"name", "Day"}, {"nodes", {0}}}, {{"nodes", {1}}}, {{"name", "2 of them"}, {"nodes", {1, 2}}}};
    files.write("s.gltf", b.text());
    const auto read = [&](const char* scene) {
        io::ImportOptions in{.progress = {}, .format = {}};
        in.values.set("scene", scene::Value::choice(scene));
        return io::import_scene(files.path("s.gltf"), files.registry, in);
    };
    const auto names = [](const Result<io::ImportedScene>& in) {
        std::string all;
        REQUIRE(in);
        in->scene.instances.each([&](auto, const scene::Instance& i) { all += i.name + " "; });
        return all;
    };
    CHECK(names(read("")) == "day "); // the file's default
    CHECK(names(read("Day")) == "day ");
    CHECK(names(read("1")) == "day ");
    CHECK(names(read("2")) == "night ");
    CHECK(names(read("2 of them")) == "night two ");
    CHECK(tests::says(*read("2"), io::Fate::dropped, "scene \"Day\"", "another one was requested"));
    for (const char* none : {"0", "4", "day", "2.0", "-1"}) {
        const auto in = read(none);
        REQUIRE(!in);
        CHECK_THAT(in.error().message, ContainsSubstring("there is no scene \"" + std::string(none) +
                                                         "\"; there are 1 \"Day\", 2, 3 \"2 of them\""));
    }
    b.root.erase("scenes"), b.root.erase("scene");
    files.write("s.gltf", b.text());
    const auto in = read("Day");
    REQUIRE(!in);
    CHECK_THAT(in.error().message, ContainsSubstring("there is no scene \"Day\"; the file names none"));
}
