// SPDX-License-Identifier: Apache-2.0
// The OBJ importer, through the registry as the program uses it: objects, groups, smoothing, materials, report, errors.
#include "model_files.hpp"
#include "scene/projection.hpp"

#include <algorithm>

using namespace restage;
using namespace restage::tests;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace {

const char* const square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

struct Fold : ModelFiles { // two squares that share the edge 2-3, at a right angle
    io::ImportedScene open(const std::string& s1, const std::string& s2) {
        write("fold.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 -1\nv 1 1 -1\no fold\n" + s1 + "\nf 1 2 3 4\n" +
                              s2 + "\nf 2 5 6 3\n");
        return load("fold.obj");
    }
};

} // namespace

TEST_CASE("obj: polygons become triangles, with texture coordinates upwards", "[obj]") {
    ModelFiles files;
    files.write("a.obj", std::string(square) + "f 1/1 2/2 3/3 4/4\n");
    const auto in = files.load("a.obj");
    REQUIRE(in.scene.instances.live() == 1);
    const auto& instance = in.scene.instances[{1}];
    CHECK(instance.name == "a"); // of the file
    const auto& mesh = *in.scene.meshes[instance.mesh].data;
    CHECK(mesh.triangles.size() == 2);
    CHECK(mesh.positions.size() == 4); // corners are shared
    CHECK(mesh.normals.empty()); // flat
    REQUIRE(mesh.uvs.size() == 4);
    for (std::size_t i = 0; i < 4; ++i)
        CHECK(mesh.uvs[i] == glm::vec2(mesh.positions[i])); // v as in the file: upwards
    CHECK(in.scene.materials[instance.material].type == "diffuse");
    CHECK(in.scene.format == "obj");
}

TEST_CASE("obj: objects keep their names, and one with two materials is a group", "[obj]") {
    ModelFiles files;
    files.write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    files.write("a.obj", std::string("mtllib a.mtl\n") + square +
                             "o first\nusemtl red\nf 1 2 3\no second\nf 1 2 3\nusemtl blue\nf 1 3 4\n");
    const auto in = files.load("a.obj");
    REQUIRE(in.scene.instances.live() == 3);
    REQUIRE(in.scene.groups.live() == 1);
    CHECK(in.scene.groups[{1}].name == "second");
    const auto find = [&](const char* name) {
        return in.scene.instances[scene::find_by_name<scene::Instance>(in.scene, name)];
    };
    CHECK_FALSE(find("first").group);
    CHECK(find("second/red").group.value == 1);
    CHECK(find("second/blue").group.value == 1);
    CHECK(find("first").material == find("second/red").material);
    CHECK(in.scene.materials[find("second/blue").material].params.color("reflectance", {}) ==
          std::array<float, 3>{0, 0, 1});
}

TEST_CASE("obj: smoothing groups smooth within themselves only", "[obj]") {
    Fold fold;
    const float half = std::sqrt(0.5f);
    const auto normals_at_edge = [&](const io::ImportedScene& in) {
        const auto& mesh = *in.scene.meshes[{1}].data;
        std::vector<glm::vec3> found;
        for (std::size_t i = 0; i < mesh.normals.size(); ++i)
            if (mesh.positions[i] == glm::vec3(1, 0, 0)) found.push_back(mesh.normals[i]);
        return found;
    };
    CHECK(fold.open("s off", "s off").scene.meshes[{1}].data->normals.empty());
    const auto smooth = normals_at_edge(fold.open("s 1", ""));
    REQUIRE(smooth.size() == 1);
    CHECK(smooth[0].x == Approx(half));
    CHECK(smooth[0].z == Approx(half));
    CHECK(normals_at_edge(fold.open("s 1", "s 2")).size() == 2);
    const auto mixed = normals_at_edge(fold.open("s 1", "s off"));
    REQUIRE(mixed.size() >= 2); // smooth ones of a single face, and flat ones
    for (const auto& n : mixed)
        CHECK(glm::length(n) == Approx(1));
}

TEST_CASE("obj: MTL statements choose the nearest material", "[obj]") {
    ModelFiles files;
    files.write("m.mtl",
                "newmtl matte\nKd .2 .4 .6\nKs 0 0 0\nnewmtl glossy\nKd .2 .4 .6\nKs .5 .5 .5\nNs 98\nNi 1.3\n"
                "newmtl metal\nKd 0 0 0\nKs .9 .8 .7\nNs 200\nnewmtl mirror\nKd 0 0 0\nKs 1 1 1\nillum 3\n"
                "newmtl glass\nKd 0 0 0\nKs 1 1 1\nillum 7\nNi 1.6\nTf .9 1 .9\nd 0.2\n"
                "newmtl pbr\nKd .2 .4 .6\nPr .25\nPm 1\nPc .5\nPs .5\nnewmtl veil\nKd 1 1 1\nd .25\nnewmtl lamp\nKd 0 "
                "0 0\nKe 3 2 1\n"
                "newmtl unused\nKd 1 1 1\n");
    std::string text = std::string("mtllib m.mtl\n") + square;
    for (const char* name : {"matte", "glossy", "metal", "mirror", "glass", "pbr", "veil", "lamp"})
        text += std::string("o ") + name + "\nusemtl " + name + "\nf 1 2 3\n";
    files.write("m.obj", text);
    const auto in = files.load("m.obj");
    const auto instance = [&](const char* name) {
        return in.scene.instances[scene::find_by_name<scene::Instance>(in.scene, name)];
    };
    const auto material = [&](const char* name) -> const scene::Material& {
        return in.scene.materials[instance(name).material];
    };
    CHECK(material("matte").type == "diffuse");
    CHECK(material("glossy").type == "uber");
    CHECK(material("glossy").params.number("uroughness", 0) == Approx(std::sqrt(0.02)));
    CHECK(material("glossy").params.number("eta", 0) == Approx(1.3));
    CHECK(material("metal").type == "conductor");
    CHECK(material("metal").params.color("reflectance", {})[1] == Approx(0.8));
    CHECK(material("mirror").type == "conductor");
    CHECK(material("mirror").params.number("uroughness", 1) == 0);
    CHECK(material("glass").type == "dielectric");
    CHECK(material("glass").params.number("eta", 0) == Approx(1.6));
    CHECK(instance("glass").alpha == 1); // it is clear, not translucent
    CHECK(material("pbr").type == "principled");
    CHECK(material("pbr").params.number("roughness", 0) == Approx(0.25));
    CHECK(material("pbr").params.number("metallic", 0) == 1);
    CHECK(material("pbr").params.number("clearcoat", 0) == Approx(0.5));
    CHECK(instance("veil").alpha == Approx(0.25));
    REQUIRE(instance("lamp").emission);
    CHECK(instance("lamp").emission->radiance == glm::vec3(3, 2, 1));
    CHECK(says(in, io::Fate::dropped, "m.mtl:29", "Ps"));
    CHECK(says(in, io::Fate::dropped, "", "1 of 9 are used by no face"));
}

TEST_CASE("obj: missing things are reported with their place, and the rest is imported", "[obj]") {
    ModelFiles files;
    files.write("a.mtl", "newmtl wood\nKd 1 1 1\nmap_Kd no\\such.png\n");
    files.write("a.obj", std::string("mtllib a.mtl\nmtllib other.mtl\n") + square +
                             "usemtl wood\nf 1 2 3\nusemtl stone\nf 1 3 4\nl 1 2\nfoo bar\nf 1//9 2//9 3//9\n");
    const auto in = files.load("a.obj");
    CHECK(in.scene.instances.live() == 2);
    CHECK(says(in, io::Fate::dropped, "a.obj:2", "other.mtl"));
    CHECK(says(in, io::Fate::dropped, "such.png", ""));
    CHECK(says(in, io::Fate::approximated, "a.obj:13", "stone"));
    CHECK(says(in, io::Fate::dropped, "a.obj:15", "lines have no surface"));
    CHECK(says(in, io::Fate::dropped, "a.obj:16", "foo"));
    CHECK(says(in, io::Fate::approximated, "a.obj:17", "normal 9 of 0"));
}

TEST_CASE("obj: files of other programs are read", "[obj]") {
    ModelFiles files;
    files.write("m.mtl",
                "\xef\xbb\xbfnewmtl wire 255 000 000\nKd 1 0 0\nillum 1\nnewmtl wire 000 255 000\nKd 0 1 \\\n"
                "0\nillum 1\n");
    const auto areas = [](const io::ImportedScene& in) {
        double sum = 0;
        in.scene.instances.each([&](auto, const scene::Instance& i) {
            const auto& m = *in.scene.meshes[i.mesh].data;
            for (const auto& t : m.triangles)
                sum += 0.5 * glm::length(glm::cross(glm::dvec3(m.positions[t.y]) - glm::dvec3(m.positions[t.x]),
                                                    glm::dvec3(m.positions[t.z]) - glm::dvec3(m.positions[t.x])));
        });
        return sum;
    };
    const auto load = [&](const std::string& text) {
        files.write("a.obj", text);
        return files.load("a.obj");
    };
    // A byte order mark in both, names with blanks, a continued line.
    const auto wire = load(std::string("\xef\xbb\xbfmtllib m.mtl\n") + square +
                           "usemtl wire 255 000 000\nf 1 2 \\\n 3\nusemtl wire 000 255 000\nf 1 3 4\n");
    REQUIRE(wire.scene.instances.live() == 2);
    for (const int i : {1, 2}) {
        const auto& instance = wire.scene.instances[{static_cast<std::uint32_t>(i)}];
        const auto color = wire.scene.materials[instance.material].params.color("reflectance", {});
        CHECK(color == (i == 1 ? std::array<float, 3>{1, 0, 0} : std::array<float, 3>{0, 1, 0}));
    }
    // Trailing slashes, old Mac line ends, negative indices, numbers with a plus.
    CHECK(areas(load(std::string(square) + "f 1// 2// 3// 4//\n")) == Approx(1));
    CHECK(areas(load(std::string(square) + "f 1/1/ 2/2/ 3/3/\n")) == Approx(0.5));
    CHECK(areas(load(std::string(square) + "f 1/ 2/ 3/\n")) == Approx(0.5));
    CHECK(areas(load("v 0 0 0\rv +1 0 0\rv 1 1e0 0\rf -3 -2 -1\r")) == Approx(0.5));
    // Concave: 14 as a fan. With many corners: a comb of 300 teeth, each of area 1, on a bar of area 300.
    CHECK(areas(load("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\n")) == Approx(10));
    std::string comb = "v 0 -1 0\nv 300 -1 0\n", face = "f 1 2";
    for (int tooth = 300; tooth > 0; --tooth) {
        comb += "v " + std::to_string(tooth) + " 0 0\nv " + std::to_string(tooth) + "e0 0 0\nv " +
                std::to_string(tooth - 0.5) + " 2 0\n";
        for (int k = 2; k >= 0; --k)
            face += " " + std::to_string(2 + 3 * (301 - tooth) - k);
    }
    CHECK(areas(load(comb + "v 0 0 0\n" + face + " 903\n")) == Approx(300 + 300));
}

TEST_CASE("obj: comments and options may follow their statements", "[obj]") {
    ModelFiles files;
    files.write("my lib.mtl", "newmtl red # of the door\nKd 1 0 0 # as paint\nillum 1\n");
    files.write("more.mtl",
                "newmtl tex\nillum 1\nmap_Kd wood #2.png -s 3 2\nnewmtl other\nillum 1\nmap_Kd oak.png # planks\n");
    files.write("a.obj", std::string("mtllib my lib.mtl more.mtl # both\n") + square +
                             "usemtl red\nf 1 2 3 # the first\nusemtl  tex\nf 1 3 4#\nusemtl other\nf 1 2 4 #\n");
    CHECK_THAT(files.error("a.obj"), ContainsSubstring("a.obj:13:7: the face names \"4#\""));
    files.write("a.obj", std::string("mtllib my lib.mtl more.mtl # both\n") + square +
                             "usemtl red\nf 1 2 3 # the first\nusemtl tex\nf 1 3 4 #\nusemtl other\nf 1 2 4\n");
    const auto in = files.load("a.obj");
    const auto& material = in.scene.materials[scene::find_by_name<scene::Material>(in.scene, "red # of the door")];
    CHECK(material.params.color("reflectance", {}) == std::array<float, 3>{1, 0, 0});
    const auto texture = [&](const char* name) -> const scene::Texture& {
        return in.scene.textures[scene::find_by_name<scene::Texture>(in.scene, name)];
    };
    CHECK(texture("tex map_Kd").params.number("uscale", 1) == 3);
    CHECK(texture("tex map_Kd").params.number("vscale", 1) == 2);
    CHECK(says(in, io::Fate::dropped, "wood #2.png", "No such file"));
    CHECK(says(in, io::Fate::dropped, "oak.png", "No such file"));
    for (const io::ReportEntry& entry : in.report.entries)
        CHECK(entry.what.find("mtllib") == std::string::npos);
}

TEST_CASE("obj: large map coordinates keep their millimetres", "[obj]") {
    ModelFiles files;
    files.write("utm.obj",
                "v 500000.125 5400000.25 100\nv 500001.125 5400000.25 100\nv 500000.125 5400000.375 100\n"
                "f 1 2 3\n");
    const auto in = files.load("utm.obj");
    const auto& instance = in.scene.instances[{1}];
    const auto& mesh = *in.scene.meshes[instance.mesh].data;
    const auto world = [&](int i) {
        return glm::dvec3(instance.object_to_world * glm::dvec4(glm::dvec3(mesh.positions[i]), 1));
    };
    CHECK(world(0).x == Approx(500000.125).epsilon(1e-12));
    CHECK(world(1).x - world(0).x == Approx(1).epsilon(1e-6));
    CHECK(world(2).y - world(0).y == Approx(0.125).epsilon(1e-6));
    CHECK(says(in, io::Fate::kept, "", "large for the objects' size"));
}

TEST_CASE("obj: options of textures may leave out numbers, and names may have blanks", "[obj]") {
    ModelFiles files;
    files.write("m.mtl",
                "newmtl a\nillum 1\nmap_Kd -s 2 2 -o .5 .5 -clamp on my wood.png\nnewmtl b\nillum 1\nKd .5\n"
                "map_kd -s 3 -blendu off \"7.png\"\nnewmtl c\nKd spectral a.rfl\nbump -bm 0.25 7.png\n");
    files.write("a.obj", std::string("mtllib m.mtl\n") + square +
                             "o a\nusemtl a\nf 1 2 3\no b\nusemtl b\nf 1 2 3\no c\nusemtl c\nf 1 3 4\n");
    const auto in = files.load("a.obj");
    const auto texture = [&](const char* name) -> const scene::Texture& {
        return in.scene.textures[scene::find_by_name<scene::Texture>(in.scene, name)];
    };
    CHECK(texture("a map_Kd").params.number("uscale", 1) == 2);
    CHECK(texture("a map_Kd").params.number("vscale", 1) == 2);
    CHECK(texture("a map_Kd").params.number("udelta", 0) == 0.5);
    CHECK(texture("a map_Kd").params.number("vdelta", 0) == 0.5);
    CHECK(texture("b map_Kd").params.number("uscale", 1) == 3);
    CHECK(texture("b map_Kd").params.number("vscale", 1) == 1);
    CHECK(says(in, io::Fate::dropped, "my wood.png", "No such file"));
    CHECK(says(in, io::Fate::dropped, "7.png", "No such file"));
    CHECK(says(in, io::Fate::dropped, "m.mtl:9", "Kd spectral a.rfl"));
}

TEST_CASE("obj: colours of vertices are shown, and lines without faces get a thickness", "[obj]") {
    ModelFiles files;
    files.write("c.obj", "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n");
    const auto in = files.load("c.obj");
    const auto& material = in.scene.materials[in.scene.instances[{1}].material];
    const auto* reflectance = material.params.find("reflectance");
    REQUIRE(reflectance);
    REQUIRE(reflectance->texture);
    const auto& image = in.scene.images[in.scene.textures[reflectance->texture].image];
    REQUIRE(image.data);
    CHECK(image.data->values[0] == 1);
    CHECK(image.data->values[1] == 0);

    files.write("l.obj", "v 0 0 0\nv 3 0 0\nv 3 4 0\nl 1 2 3\n");
    const auto lines = files.load("l.obj");
    CHECK(lines.scene.meshes[{1}].data->triangles.size() == 24);
    CHECK(says(lines, io::Fate::approximated, "", "its 2 lines get a radius"));
}

TEST_CASE("obj: a camera shows all objects, and a studio lights them", "[obj]") {
    ModelFiles files;
    files.write("a.obj", "v -3 0 7\nv 5 1 7\nv 0 9 -2\nf 1 2 3\n");
    const auto in = files.load("a.obj");
    REQUIRE(in.scene.environment.value);
    REQUIRE(in.scene.active_camera.value);
    CHECK(says(in, io::Fate::kept, "", "the file has none; one that shows everything is added"));
    CHECK(says(in, io::Fate::kept, "", "a neutral studio is added"));
    const auto& camera = in.scene.cameras[in.scene.active_camera.value];
    CHECK(glm::determinant(glm::dmat3(camera.camera_to_world)) == Approx(-1)); // a right-handed world
    for (const double aspect : {16.0 / 9, 1.0, 9.0 / 16, 4.0}) { // at any aspect
        const glm::dvec4 window = scene::film_window(camera, aspect);
        CHECK(window.y / window.w == Approx(aspect));
        double fills = 0;
        for (const glm::vec3& p : in.scene.meshes[{1}].data->positions) {
            const glm::dvec4 q = glm::inverse(camera.camera_to_world) * glm::dvec4(p, 1);
            CHECK(q.z > 0);
            CHECK(std::abs(q.x) < window.y * q.z);
            CHECK(std::abs(q.y) < window.w * q.z);
            fills = std::max({fills, std::abs(q.x) / (window.y * q.z), std::abs(q.y) / (window.w * q.z)});
        }
        CHECK(fills > 0.5);
    }
    CHECK(scene::camera_fov(camera, 16.0 / 9) == Approx(40));
}

TEST_CASE("obj: broken files name the line and the column", "[obj]") {
    ModelFiles files;
    const auto error = [&](const std::string& text) {
        files.write("bad.obj", text);
        return files.error("bad.obj");
    };
    CHECK_THAT(error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"),
               ContainsSubstring("bad.obj:4:7: the face names vertex 4 of 3"));
    CHECK_THAT(error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 0 3\n"), ContainsSubstring("bad.obj:4:5: "));
    CHECK_THAT(error("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4\n"), ContainsSubstring("bad.obj:4:9: "));
    CHECK_THAT(error("v 0 0 0\nv 1 inf 0\nv 0 1 0\nf 1 2 3\n"), ContainsSubstring("bad.obj:2:5: "));
    CHECK_THAT(error("v 0 0 0\n"), ContainsSubstring("no faces"));
    CHECK_THAT(error(""), ContainsSubstring("bad.obj"));
}
