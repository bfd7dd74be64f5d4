// SPDX-License-Identifier: Apache-2.0
// io: an importer's data arrives, invalid data is refused with a line, and an import has three outcomes.
#include "base/file.hpp"
#include "io/export.hpp"
#include "io/import.hpp"
#include "io/scene_reader.hpp"
#include "io/scene_writer.hpp"
#include "paths.hpp"
#include "plugin/library.hpp"
#include "scene/validate.hpp"
#include "temporary_folder.hpp"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <filesystem>
#include <limits>

namespace fs = std::filesystem;
using namespace restage;
using namespace restage::io;
using Catch::Matchers::ContainsSubstring;

namespace {

struct TestImporter { // a registry with the importer and the material of tests/plugins_bad
    test::TemporaryFolder temporary;
    const fs::path& path = temporary.path();
    Log log{[](LogLevel, std::string_view) {}};
    plugin::Registry registry{log};

    TestImporter() { add("importer", "importer", "org.example.velvet"); }
    void add(const char* library, const char* kind, const char* id) {
        const fs::path folder = path / "plugins" / library;
        fs::create_directories(folder);
        const std::string file = std::string(library) + plugin::Library::extension();
        fs::copy_file(restage::test::build_dir() / "tests" / "plugins_bad" / file, folder / file);
        REQUIRE(write_file_atomic(
            folder / "plugin.json",
            std::string(R"({"id": ")") + id + R"(", "provides": ["restage.)" + kind +
                R"(/1"], "version": "1.0.0", "licence": "MIT", "needs": {"host": ">=0.2"}, "library": ")" + library +
                "\"}"));
        registry.scan(std::vector<plugin::SearchPath>{{path / "plugins", true}});
        REQUIRE(registry.entries().back()->state == plugin::State::loaded);
    }
    std::string file(const char* name, std::string_view bytes) {
        REQUIRE(write_file_atomic(path / name, bytes));
        return (path / name).string();
    }
};

struct Pushed { // a writer and a valid triangle to push
    Log log{[](LogLevel, std::string_view) {}};
    plugin::Registry registry{log};
    SceneWriter writer{registry, {}};
    const RestageSceneWriter1& out = writer.table();
    float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    std::uint32_t indices[3] = {0, 1, 2};
    RestageMesh mesh{.name = "m", .vertex_count = 3, .triangle_count = 1, .positions = positions, .indices = indices};
    RestageMaterialDesc material{.name = "gray", .type = "diffuse"};

    RestageInstance instance(RestageHandle m, RestageHandle mat) {
        RestageInstance i{.mesh = m, .material = mat};
        i.alpha = 1;
        for (int k = 0; k < 4; ++k)
            i.object_to_world[5 * k] = 1;
        return i;
    }
    bool noted(std::string_view part) const {
        return std::any_of(writer.report.entries.begin(), writer.report.entries.end(),
                           [&](const ReportEntry& e) { return to_string(e).find(part) != std::string::npos; });
    }
};

const float not_a_number = std::numeric_limits<float>::quiet_NaN();

} // namespace

TEST_CASE("an import ends in a scene with a report", "[io]") {
    TestImporter test;
    const auto imported = import_scene(test.file("a.test", "TEST and so on"), test.registry);
    REQUIRE(imported);
    CHECK(imported->importer == "test");
    CHECK(imported->scene.instances.live() == 1);
    CHECK(imported->scene.meshes[{1}].name == "triangle");
    CHECK(imported->scene.materials[{1}].type == "velvet");
    CHECK(imported->scene.film.value.width == 8);
    CHECK(scene::validate(imported->scene).empty());
    REQUIRE(imported->report.entries.size() == 1);
    CHECK_THAT(to_string(imported->report.entries[0]),
               ContainsSubstring("a.test:12: dropped: light \"sun\": not known"));
    CHECK(imported->report.count(Fate::dropped) == 1);
}

TEST_CASE("a file of unknown format is refused with the known formats", "[io]") {
    TestImporter test;
    const auto unknown = import_scene(test.file("a.xyz", "something else"), test.registry);
    REQUIRE_FALSE(unknown);
    CHECK_THAT(unknown.error().message, ContainsSubstring("unknown file format; known: Test format"));
    CHECK_FALSE(import_scene(test.file("empty", ""), test.registry));
    CHECK_THAT(import_scene("/no/such/file", test.registry).error().message, ContainsSubstring("No such file"));
    CHECK_THAT(import_scene(test.path.string(), test.registry).error().message, ContainsSubstring("is a folder"));
    CHECK_THAT(import_scene(test.file("b.test", "TEST"), test.registry, {.format = "usd"}).error().message,
               ContainsSubstring("there is no importer \"usd\""));
    const auto stopped = import_scene(test.file("c.test", "TEST"), test.registry,
                                      {.progress = [](float, std::string_view) { return false; }});
    REQUIRE_FALSE(stopped);
    CHECK(stopped.error().cancelled());
    CHECK_THAT(stopped.error().message, ContainsSubstring("stopped on request"));
    CHECK_FALSE(unknown.error().cancelled());
}

TEST_CASE("an importer's data arrives unchanged", "[io]") {
    Pushed p;
    const float normals[9] = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    const float uvs[6] = {0, 0, 1, 0, 0, 1};
    p.mesh.normals = normals;
    p.mesh.uvs = uvs;
    p.mesh.source_file = "/a/b.ply";
    const RestageHandle mesh = p.out.mesh(p.out.ctx, &p.mesh);
    const RestageValue values[] = {{.type = RESTAGE_COLOR, .id = "reflectance", .v = {1, 0.5f, 0, 1}},
                                   {.type = RESTAGE_ENUM, .id = "remap", .text = "v3"}};
    p.material.values = values;
    p.material.value_count = 2;
    const RestageOriginValue eta{.id = "eta", .text = "\"spectrum eta\" \"glass-BK7\""};
    const RestageOrigin origin{.value_count = 1, .format = "pbrt-v4", .verbatim = "\"float x\" 1", .values = &eta};
    p.material.origin = &origin;
    const RestageHandle material = p.out.material(p.out.ctx, &p.material);
    RestageInstance instance = p.instance(mesh, material);
    instance.flags = RESTAGE_INSTANCE_EMITS | RESTAGE_INSTANCE_TWO_SIDED | RESTAGE_INSTANCE_REVERSE_ORIENTATION;
    instance.emission[1] = 3;
    instance.object_to_world[12] = 7;
    REQUIRE(p.out.instance(p.out.ctx, &instance));
    RestageCamera camera{.fov = 30, .focal_distance = 1};
    for (int k = 0; k < 4; ++k)
        camera.camera_to_world[5 * k] = 1;
    REQUIRE(p.out.camera(p.out.ctx, &camera) == 1);
    Jobs jobs(1);
    REQUIRE(p.writer.finish(jobs, true));
    const scene::Scene& s = p.writer.scene;
    CHECK(s.format == "pbrt-v4");
    CHECK(s.meshes[{mesh}].data->normals.size() == 3);
    CHECK(s.meshes[{mesh}].data->upper == glm::vec3(1, 1, 0));
    CHECK(s.meshes[{mesh}].source_file == "/a/b.ply");
    CHECK(s.materials[{material}].params.color("reflectance", {}) == std::array{1.f, 0.5f, 0.f});
    CHECK(s.materials[{material}].params.choice("remap", "") == "v3");
    CHECK(s.materials[{material}].origin ==
          scene::Origin{"\"float x\" 1", "pbrt-v4", {{"eta", "\"spectrum eta\" \"glass-BK7\""}}});
    const scene::Instance& i = s.instances[{1}];
    CHECK(i.name == "object 1");
    CHECK(i.object_to_world[3].x == 7);
    CHECK(i.emission == scene::Emission{{0, 3, 0}, true});
    CHECK(i.reverse_orientation);
    CHECK(s.active_camera.value.value == 1);
    CHECK(p.writer.report.entries.empty());

    // And the reader returns the same.
    SceneReader reader(s, p.registry, {});
    const RestageSceneReader1& in = reader.table();
    CHECK(in.count(in.ctx, RESTAGE_KIND_INSTANCE) == 1);
    CHECK(in.count(in.ctx, 99) == 0);
    RestageMesh mesh_out;
    REQUIRE(in.mesh(in.ctx, mesh, &mesh_out));
    CHECK(std::equal(p.positions, p.positions + 9, mesh_out.positions));
    CHECK(std::equal(uvs, uvs + 6, mesh_out.uvs));
    CHECK(mesh_out.indices[2] == 2);
    CHECK_FALSE(in.mesh(in.ctx, 99, &mesh_out));
    RestageMaterialDesc material_out;
    REQUIRE(in.material(in.ctx, material, &material_out));
    REQUIRE(material_out.value_count == 2);
    CHECK(std::string(material_out.values[1].text) == "v3");
    RestageInstance instance_out;
    REQUIRE(in.instance(in.ctx, 1, &instance_out));
    CHECK(instance_out.flags == instance.flags);
    CHECK(std::equal(instance.object_to_world, instance.object_to_world + 16, instance_out.object_to_world));
    RestageEnvironment environment;
    CHECK_FALSE(in.environment(in.ctx, &environment));
}

TEST_CASE("names are unique within their kind", "[io]") {
    Pushed p;
    p.out.mesh(p.out.ctx, &p.mesh);
    p.out.mesh(p.out.ctx, &p.mesh);
    p.mesh.name = "m 2";
    p.out.mesh(p.out.ctx, &p.mesh);
    p.mesh.name = nullptr;
    p.out.mesh(p.out.ctx, &p.mesh);
    p.out.mesh(p.out.ctx, &p.mesh);
    std::vector<std::string> names;
    p.writer.scene.meshes.each([&](auto, const scene::Mesh& m) { names.push_back(m.name); });
    CHECK(names == std::vector<std::string>{"m", "m 2", "m 2 2", "mesh 1", "mesh 2"});
}

TEST_CASE("invalid data is refused with a line in the report", "[io]") {
    Pushed p;
    const RestageHandle mesh = p.out.mesh(p.out.ctx, &p.mesh);
    const RestageHandle material = p.out.material(p.out.ctx, &p.material);

    p.indices[1] = 3;
    CHECK(p.out.mesh(p.out.ctx, &p.mesh) == 0);
    CHECK(p.noted("triangle 0 refers to vertex 3 of 3"));
    p.indices[1] = 1;
    p.positions[4] = not_a_number;
    CHECK(p.out.mesh(p.out.ctx, &p.mesh) == 0);
    CHECK(p.noted("the position of vertex 1 is not a finite number"));
    p.positions[4] = 0;
    p.mesh.triangle_count = 0;
    CHECK(p.out.mesh(p.out.ctx, &p.mesh) == 0);
    p.mesh.triangle_count = 1;
    const float bad_normals[9] = {0, 0, 1, not_a_number, 0, 1, 0, 0, 1};
    p.mesh.normals = bad_normals;
    const RestageHandle without = p.out.mesh(p.out.ctx, &p.mesh); // the mesh is kept without its normals
    REQUIRE(without);
    CHECK(p.writer.scene.meshes[{without}].data->normals.empty());
    CHECK(p.noted("left out"));

    CHECK(p.out.instance(p.out.ctx, [&] {
        static RestageInstance i;
        i = p.instance(99, material);
        return &i;
    }()) == 0);
    CHECK(p.noted("there is no mesh 99"));
    CHECK(p.out.instance(p.out.ctx, [&] {
        static RestageInstance i;
        i = p.instance(mesh, 0);
        return &i;
    }()) == 0);
    CHECK(p.noted("it has no material"));
    RestageInstance instance = p.instance(mesh, material);
    instance.object_to_world[3] = 1;
    CHECK(p.out.instance(p.out.ctx, &instance) == 0);

    const RestageValue values[] = {{.type = RESTAGE_FLOAT, .id = "a", .v = {not_a_number}},
                                   {.type = RESTAGE_COLOR, .id = "b", .ref = 9},
                                   {.type = 77, .id = "c"},
                                   {.type = RESTAGE_FLOAT, .id = nullptr},
                                   {.type = RESTAGE_FLOAT, .id = "fine", .v = {2}}};
    p.material.values = values;
    p.material.value_count = 5;
    const RestageHandle odd = p.out.material(p.out.ctx, &p.material);
    REQUIRE(odd);
    REQUIRE(p.writer.scene.materials[{odd}].params.entries().size() == 1);
    CHECK(p.noted("parameter \"a\": not a finite number"));
    CHECK(p.noted("parameter \"b\": there is no such texture"));

    const RestageImage nothing{.path = ""};
    CHECK(p.out.image(p.out.ctx, &nothing) == 0);
    const RestageTexture lost{.type = "imagemap", .image = 5};
    CHECK(p.out.texture(p.out.ctx, &lost) == 0);
    const RestageLight unknown{.kind = 17};
    CHECK(p.out.light(p.out.ctx, &unknown) == 0);
    const RestageGroup orphan{.parent = 4};
    CHECK(p.out.group(p.out.ctx, &orphan) == 0);
    Jobs jobs(1);
    REQUIRE(p.writer.finish(jobs, true)); // the rest is valid; a camera was added
    CHECK(p.noted("one was added in front of everything"));
    CHECK(scene::validate(p.writer.scene).empty());
}

TEST_CASE("an extreme film fails the import, not the machine", "[io]") {
    Pushed p;
    const RestageFilm film{.width = 4000000,
                           .height = 4000000,
                           .crop = {0, 1, 0, 1},
                           .filter = "box",
                           .filter_radius = {0.5f, 0.5f},
                           .exposure = 1};
    p.out.film(p.out.ctx, &film);
    Jobs jobs(1);
    const auto finished = p.writer.finish(jobs, true);
    REQUIRE_FALSE(finished);
    CHECK_THAT(finished.error().message, ContainsSubstring("the film has 4000000x4000000 pixels"));
}

TEST_CASE("only the first error is shown, with its place", "[io]") {
    Pushed p;
    p.out.error(p.out.ctx, "a.pbrt", 41, 3, "unclosed bracket");
    p.out.error(p.out.ctx, "a.pbrt", 50, 1, "and another");
    CHECK(p.writer.error() == "a.pbrt:41:3: unclosed bracket");
}

TEST_CASE("a missing image is reported and import continues; one file is one image", "[io]") {
    Pushed p;
    const test::TemporaryFolder folder;
    const std::string there = (folder / "gray.pfm").string();
    const unsigned char pfm[] = "Pf\n1 1\n-1.0\n\0\0\0\x3f"; // one pixel, 0.5
    REQUIRE(write_file_atomic(there, std::string_view(reinterpret_cast<const char*>(pfm), sizeof pfm - 1)));
    const RestageImage gone{.path = "/no/such/wood.png", .encoding = RESTAGE_SRGB}, gray{.path = there.c_str()};
    const RestageHandle a = p.out.image(p.out.ctx, &gone), b = p.out.image(p.out.ctx, &gray),
                        c = p.out.image(p.out.ctx, &gray);
    CHECK(b == c);
    Jobs jobs(2);
    REQUIRE(p.writer.finish(jobs, true));
    CHECK_FALSE(p.writer.scene.images[{a}].data);
    REQUIRE(p.writer.scene.images[{b}].data);
    CHECK(p.writer.scene.images[{b}].data->values == std::vector<float>{0.5f});
    CHECK(p.noted("/no/such/wood.png: dropped: image \"wood.png\""));
    fs::remove(there);
}

TEST_CASE("export options are checked against the exporter's table", "[io]") {
    const model::Exporter exporter{
        .format = "x",
        .label = "X",
        .extensions = {"x", "xx"},
        .options = {{.id = "version", .type = model::ParamType::choice, .choices = {"v4", "v3"}},
                    {.id = "meshes", .type = model::ParamType::integer, .int_max = 10},
                    {.id = "flat", .type = model::ParamType::boolean}}};
    scene::ParamSet values;
    REQUIRE(set_option(exporter, "version=v3", values));
    REQUIRE(set_option(exporter, "meshes=7", values));
    REQUIRE(set_option(exporter, "flat=true", values));
    CHECK(values.choice("version", "") == "v3");
    CHECK(values.number("meshes", 0) == 7);
    CHECK_THAT(set_option(exporter, "version=v5", values).error().message,
               ContainsSubstring("cannot be \"v5\"; v4|v3 are possible"));
    CHECK_THAT(set_option(exporter, "what=1", values).error().message,
               ContainsSubstring("there is no option \"what\"; known: version=v4|v3, "
                                 "meshes=WHOLE NUMBER, flat=true|false"));
    CHECK_FALSE(set_option(exporter, "meshes=11", values));
    CHECK_FALSE(set_option(exporter, "meshes=7x", values));
    CHECK_FALSE(set_option(exporter, "flat=1", values));
    CHECK_FALSE(set_option(exporter, "version", values));
    Log log([](LogLevel, std::string_view) {});
    const plugin::Registry none(log);
    CHECK_THAT(export_scene({}, "a.pbrt", none).error().message,
               ContainsSubstring("no exporter writes files called .pbrt"));
}
