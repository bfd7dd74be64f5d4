// SPDX-License-Identifier: Apache-2.0
// Options of importers: refused by name, units and axes by closed form, merging keeps every triangle, and defaults
// change nothing.
#include "io/options.hpp"
#include "model_files.hpp"
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

TEST_CASE("units and axes place what a file holds", "[options]") {
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
        // z becomes y, and y goes away from the viewer: (x, y, z) -> (x, z, -y).
        CHECK(same(bounds({"up=z"}).lower, {0, 0, -2}));
        CHECK(same(bounds({"up=z"}).upper, {1, 3, 0}));
        CHECK(same(bounds({"up=y"}).upper, plain.upper));
        CHECK(same(bounds({"up=z", "units=cm"}).lower, {0, 0, -0.02}));
    }
}

TEST_CASE("a file whose z is up stands upright in a scene whose y is", "[options]") {
    Files files;
    const auto sky_up = [](const io::ImportedScene& in) {
        return glm::dvec3(in.scene.environment.value->light_to_world[2]); // of a panorama
    };
    CHECK(same(sky_up(files.load("t.stl")), {0, 0, 1})); // as it is
    CHECK(same(sky_up(files.with("t.stl", {"up=z"})), {0, 1, 0}));
    CHECK(same(sky_up(files.with("t.stl", {"up=y"})), {0, 1, 0}));
    CHECK(same(sky_up(files.load("t.obj")), {0, 1, 0}));
}

TEST_CASE("the defaults of every option read a file as no option does", "[options]") {
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

TEST_CASE("merging makes one object of each material", "[options]") {
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

TEST_CASE("options that an importer does not have are refused", "[options]") {
    Files files;
    scene::ParamSet values;
    const auto importer = files.registry.find_importer("mesh");
    const auto refusal = [&](const char* assignment) {
        const auto set = io::set_option(*importer->table, assignment, values);
        return set ? std::string() : set.error().message;
    };
    CHECK_THAT(refusal("merge=true"),
               ContainsSubstring("importer \"mesh\": there is no option \"merge\"; there are: units="));
    CHECK_THAT(refusal("up=x"), ContainsSubstring("option \"up\" cannot be \"x\"; as_is|y|z are possible"));
    CHECK_THAT(refusal("up"), ContainsSubstring("write name=value"));
    io::ImportOptions options;
    options.values.set("height", scene::Value::number(1));
    const auto in = io::import_scene(files.path("t.ply"), files.registry, options);
    REQUIRE(!in);
    CHECK_THAT(in.error().message, ContainsSubstring("there is no option \"height\""));
}
