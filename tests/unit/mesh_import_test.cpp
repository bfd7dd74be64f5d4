// SPDX-License-Identifier: Apache-2.0
// The importer of PLY and STL files: what they become, and what is said of broken ones.
#include "model_files.hpp"

#include <cstring>

using namespace restage;
using namespace restage::tests;
using Catch::Matchers::ContainsSubstring;

namespace {

const char* const tetrahedron_ascii =
    "solid four sided\n"
    "facet normal 0 0 -1\n outer loop\n  vertex 0 0 0\n  vertex 0 1 0\n  vertex 1 0 0\n endloop\nendfacet\n"
    "facet normal 0 -1 0\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 0 1e0\n endloop\nendfacet\n"
    "facet normal -1 0 0\n outer loop\n  vertex 0 0 0\n  vertex 0 0 1\n  vertex 0 1 -0\n endloop\nendfacet\n"
    "facet normal 1 1 1\n outer loop\n  vertex 1 0 0\n  vertex 0 1 0\n  vertex 0 0 1\n endloop\nendfacet\n"
    "endsolid four sided\n";

std::string binary(const std::vector<std::array<float, 9>>& facets, std::uint32_t promised) {
    std::string bytes(80, 's');
    bytes.append(reinterpret_cast<const char*>(&promised), 4);
    for (const auto& f : facets) {
        bytes.append(12, '\0');
        bytes.append(reinterpret_cast<const char*>(f.data()), 36);
        bytes.append(2, '\0');
    }
    return bytes;
}

} // namespace

TEST_CASE("stl: ascii and binary, vertices shared, z up", "[mesh]") {
    ModelFiles files;
    files.write("a.stl", tetrahedron_ascii);
    const auto ascii = files.load("a.stl");
    CHECK(ascii.importer == "mesh");
    const auto& mesh = *ascii.scene.meshes[{1}].data;
    CHECK(mesh.positions.size() == 4);
    CHECK(mesh.triangles.size() == 4);
    CHECK(mesh.normals.empty()); // flat
    CHECK(ascii.scene.instances[{1}].name == "a");
    REQUIRE(ascii.scene.environment.value);
    CHECK(ascii.scene.cameras[{1}].camera_to_world[1].z > 0.5); // its up is z

    // The header of a binary file may begin with "solid", too.
    files.write("b.stl", "solid" + binary({{0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 0, 0, 1, 1, 0, 0, 1, 0}}, 2).substr(5));
    const auto two = files.load("b.stl");
    CHECK(two.scene.meshes[{1}].data->positions.size() == 4);
    CHECK(two.scene.meshes[{1}].data->triangles.size() == 2);
}

TEST_CASE("stl: several solids are one object", "[mesh]") {
    ModelFiles files;
    files.write("a.stl", std::string(tetrahedron_ascii) + tetrahedron_ascii);
    CHECK(files.load("a.stl").scene.meshes[{1}].data->triangles.size() == 8);
}

TEST_CASE("ply: as one grey object, with its normals, y up", "[mesh]") {
    ModelFiles files;
    files.write("a.ply",
                "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
                "property list uchar int vertex_indices\nend_header\n"
                "0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n4 0 1 2 3\n");
    const auto in = files.load("a.ply");
    CHECK(in.importer == "mesh");
    const auto& mesh = in.scene.meshes[{1}];
    CHECK(mesh.data->triangles.size() == 2);
    CHECK(mesh.data->normals.size() == 4);
    CHECK_THAT(mesh.source_file, ContainsSubstring("a.ply"));
    CHECK(in.scene.materials[in.scene.instances[{1}].material].type == "diffuse");
    CHECK(in.scene.cameras[{1}].camera_to_world[1].y > 0.5);
    CHECK(says(in, RESTAGE_KEPT, "a.ply", "2 triangles"));
}

TEST_CASE("meshes: broken files say where", "[mesh]") {
    ModelFiles files;
    const auto error = [&](const char* name, const std::string& bytes) {
        files.write(name, bytes);
        return files.error(name);
    };
    CHECK_THAT(error("a.stl", binary({{0, 0, 0, 1, 0, 0, 0, 1, 0}}, 3)),
               ContainsSubstring("byte 134: the file is cut: 3 facets promised, 1 found"));
    CHECK_THAT(error("a.stl", binary({{0, 0, 0, std::nanf(""), 0, 0, 0, 1, 0}}, 1)), ContainsSubstring("byte 108: "));
    CHECK_THAT(error("a.stl", ""), ContainsSubstring("header ends early"));
    CHECK_THAT(error("a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n"),
               ContainsSubstring("a.stl:4:12: \"zero\" is no finite number"));
    CHECK_THAT(error("a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nendloop\n"), ContainsSubstring("a.stl:4:1: "));
    CHECK_THAT(error("a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0"),
               ContainsSubstring("the file ends"));
    CHECK_THAT(error("a.stl", "solid nothing\nendsolid nothing\n"), ContainsSubstring("no faces"));
    CHECK_THAT(error("a.ply", "ply\nformat ascii 1.0\nend_header\n"), ContainsSubstring("a.ply: it has no vertices"));
}
