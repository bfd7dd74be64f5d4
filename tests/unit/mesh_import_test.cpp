// SPDX-License-Identifier: Apache-2.0
// The importer of PLY and STL files: the results, and the errors of broken ones.
#include "model_files.hpp"

#include <algorithm>
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
    CHECK(says(in, io::Fate::kept, "a.ply", "2 triangles"));
}

TEST_CASE("stl: files of other programs are read", "[mesh]") {
    ModelFiles files;
    const auto triangles = [&](const std::string& bytes) {
        files.write("a.stl", bytes);
        return files.load("a.stl").scene.meshes[{1}].data->triangles.size();
    };
    std::string text = tetrahedron_ascii;
    const auto with = [&](char end) {
        std::string other = text;
        std::replace(other.begin(), other.end(), '\n', end);
        return other;
    };
    CHECK(triangles(with('\r')) == 4);                        // old Macs
    CHECK(triangles(with(' ')) == 4);                         // one line
    CHECK(triangles("\xef\xbb\xbf" + text) == 4);            // a byte order mark
    CHECK(triangles(text.substr(0, text.find("endsolid"))) == 4);
    CHECK(says(files.load("a.stl"), io::Fate::approximated, "", "without \"endsolid\""));
    CHECK(triangles(binary({{0, 0, 0, 1, 0, 0, 0, 1, 0}}, 0)) == 1); // the count was never written
    CHECK(triangles(binary({{0, 0, 0, 1, 0, 0, 0, 1, 0}}, 1) + "tail") == 1);
    CHECK(says(files.load("a.stl"), io::Fate::approximated, "", "4 bytes behind the last facet"));

    std::string colored = binary({{0, 0, 0, 1, 0, 0, 0, 1, 0}}, 1);
    colored.replace(colored.size() - 2, 2, std::string("\x00\xfc", 2)); // VisCAM: 31 red, valid
    files.write("c.stl", colored);
    const auto in = files.load("c.stl");
    REQUIRE(in.scene.images.live() == 2); // and the studio's
    CHECK(says(in, io::Fate::kept, "", "colours of its faces are a texture"));
}

namespace {

// The linear colour at the first texel of the first object's texture.
std::array<float, 3> first_texel(const io::ImportedScene& in) {
    const auto* value = in.scene.materials[in.scene.instances[{1}].material].params.find("reflectance");
    REQUIRE(value);
    REQUIRE(value->texture);
    const auto& image = in.scene.images[in.scene.textures[value->texture].image];
    REQUIRE(image.data);
    return {image.data->values[0], image.data->values[1], image.data->values[2]};
}

std::string ply(const std::string& vertex, const std::string& more, const std::string& data) {
    return "ply\nformat ascii 1.0\ncomment TextureFile a b.png\nelement vertex 4\nproperty float x\nproperty float y\n"
           "property float z\n" +
           vertex + more + "end_header\n" + data;
}

} // namespace

TEST_CASE("ply: colours of vertices and faces are shown", "[mesh]") {
    ModelFiles files;
    const std::string rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const std::string list = "property list uchar int vertex_index\n";
    files.write("v.ply", ply(rgb, "element face 1\n" + list,
                             "0 0 0 255 0 0\n1 0 0 0 255 0\n1 1 0 0 0 255\n0 1 0 255 255 0\n4 0 1 2 3\n"));
    const auto vertices = files.load("v.ply");
    CHECK(first_texel(vertices) == std::array<float, 3>{1, 0, 0});
    CHECK(vertices.scene.meshes[{1}].source_file.empty()); // the uv are ours
    files.write("f.ply", ply("", "element face 2\n" + list + rgb + "property float quality\n",
                             "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 0 0 255 1\n3 0 2 3 255 0 0 1\n"));
    const auto faces = files.load("f.ply");
    CHECK(first_texel(faces) == std::array<float, 3>{0, 0, 1});
    CHECK(says(faces, io::Fate::dropped, "f.ply", "face property \"quality\": 2 values"));
    CHECK(says(faces, io::Fate::dropped, "f.ply", "1 are named, but there are no texture"));
    // Opacity with the colours is reported only if something is transparent.
    const std::string rgba = rgb + "property uchar alpha\n";
    const auto with_opacity = [&](const char* vertex, const char* face) {
        const auto row = [&](const char* place) { return std::string(place) + " 255 0 0 " + vertex + "\n"; };
        files.write("a.ply", "\xef\xbb\xbf" + ply(rgba, "element face 1\n" + list + rgba,
                                                  row("0 0 0") + row("1 0 0") + row("1 1 0") + row("0 1 0") +
                                                      "3 0 1 2 0 0 255 " + face + "\n"));
        return files.load("a.ply");
    };
    const auto opaque = with_opacity("255", "255"), thin = with_opacity("128", "0");
    CHECK_FALSE(says(opaque, io::Fate::dropped, "a.ply", "alpha"));
    CHECK(says(thin, io::Fate::dropped, "a.ply", "vertex property \"alpha\": 4 values"));
    CHECK(says(thin, io::Fate::dropped, "a.ply", "face property \"alpha\": 1 values"));
}

TEST_CASE("ply: MeshLab's textures, per corner of a face", "[mesh]") {
    ModelFiles files;
    files.write("t.ply",
                ply("", "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n",
                    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 1 1 0 .5\n"));
    const auto in = files.load("t.ply");
    const auto& mesh = *in.scene.meshes[{1}].data;
    REQUIRE(mesh.uvs.size() == 6);
    CHECK(mesh.uvs[2] == glm::vec2(1, 1));
    CHECK(mesh.uvs[5] == glm::vec2(0, 0.5f));
    CHECK(says(in, io::Fate::dropped, "a b.png", ""));
    CHECK(says(in, io::Fate::kept, "", "textured"));
}

TEST_CASE("ply: strips, concave polygons, points, map coordinates", "[mesh]") {
    ModelFiles files;
    const auto area = [&](const std::string& bytes) {
        files.write("a.ply", bytes);
        const auto in = files.load("a.ply");
        const auto& m = *in.scene.meshes[{1}].data;
        double sum = 0;
        for (const auto& t : m.triangles) {
            const auto n = glm::cross(m.positions[t.y] - m.positions[t.x], m.positions[t.z] - m.positions[t.x]);
            CHECK(n.z > 0);
            sum += 0.5 * double(glm::length(n));
        }
        return sum;
    };
    const std::string square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    CHECK(area(ply("", "element tristrips 1\nproperty list int int vertex_indices\n",
                   square + "9 0 1 3 2 -1 0 1 2 -1\n")) == Catch::Approx(1.5));
    CHECK(area("ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
               "0 0 0\n4 0 0\n4 4 0\n2 1 0\n0 4 0\n5 0 1 2 3 4\n") == Catch::Approx(10));

    files.write("p.ply", ply("property uchar red\nproperty uchar green\nproperty uchar blue\n", "",
                             "0 0 0 0 255 0\n1 0 0 0 255 0\n1 1 0 0 255 0\n0 1 0 0 255 0\n"));
    const auto points = files.load("p.ply");
    CHECK(points.scene.meshes[{1}].data->triangles.size() == 32);
    CHECK(first_texel(points) == std::array<float, 3>{0, 1, 0});
    CHECK(says(points, io::Fate::approximated, "", "its 4 points get a radius"));

    files.write("u.ply",
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
                "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                "500000.125 5400000 0\n500000.25 5400000 0\n500000.125 5400001 0\n3 0 1 2\n");
    const auto utm = files.load("u.ply");
    const auto& instance = utm.scene.instances[{1}];
    const auto& m = *utm.scene.meshes[instance.mesh].data;
    CHECK(double(m.positions[1].x) + instance.object_to_world[3].x == 500000.25);
}

TEST_CASE("meshes: errors of broken files have their place", "[mesh]") {
    ModelFiles files;
    const auto error = [&](const char* name, const std::string& bytes) {
        files.write(name, bytes);
        return files.error(name);
    };
    CHECK_THAT(error("a.stl", binary({{0, 0, 0, 1, 0, 0, 0, 1, 0}}, 3)),
               ContainsSubstring("byte 134: the file is cut: 3 facets declared, 1 found"));
    CHECK_THAT(error("a.stl", binary({{0, 0, 0, std::nanf(""), 0, 0, 0, 1, 0}}, 1)), ContainsSubstring("byte 108: "));
    CHECK_THAT(error("a.stl", ""), ContainsSubstring("header ends early"));
    CHECK_THAT(error("a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n"),
               ContainsSubstring("a.stl:4:12: \"zero\" is not a finite number"));
    CHECK_THAT(error("a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nendloop\n"), ContainsSubstring("a.stl:4:1: "));
    CHECK_THAT(error("a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0"),
               ContainsSubstring("the file ends"));
    CHECK_THAT(error("a.stl", "solid nothing\nendsolid nothing\n"), ContainsSubstring("no faces"));
    CHECK_THAT(error("a.ply", "ply\nformat ascii 1.0\nend_header\n"), ContainsSubstring("a.ply: it has no vertices"));
    const std::string head =
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n";
    CHECK_THAT(error("a.ply", "ply\nformat ascii 1.0\n" + head + "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"),
               ContainsSubstring("a.ply:13:1: a face names vertex 7 of 3"));
    const std::string start = "ply\nformat binary_little_endian 1.0\n" + head + std::string(36, '\0');
    CHECK_THAT(error("a.ply", start + std::string("\3\0\0\0\0\1\0\0\0\7\0\0\0", 13)),
               ContainsSubstring("byte " + std::to_string(start.size()) + ": a face names vertex 7"));
}
