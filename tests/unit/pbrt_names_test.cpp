// SPDX-License-Identifier: Apache-2.0
// Names for the outliner, from various parts of a file; and those in our own comments.
#include "pbrt_writer.hpp"

#include <catch2/catch_test_macros.hpp>

using restage::pbrt::test::Folder;
using restage::pbrt::test::Recorder;

namespace {

Recorder loaded(const std::string& text) {
    Recorder r;
    const int ok = r.load_text("Film \"rgb\"\nWorldBegin\n" + text);
    INFO(r.error.message << " line " << r.error.line);
    REQUIRE(ok == 1);
    return r;
}

// The name of the only instance.
std::string name_of(const std::string& text) {
    const Recorder r = loaded(text);
    REQUIRE(r.instances.size() == 1);
    return r.instances[0].name;
}

constexpr const char* wood = "MakeNamedMaterial \"Wood\" \"string type\" \"diffuse\"\nNamedMaterial \"Wood\"\n";

} // namespace

TEST_CASE("pbrt names: the best available", "[pbrt]") {
    CHECK(name_of("Shape \"sphere\"") == "sphere");
    CHECK(name_of(std::string(wood) + "Shape \"sphere\"") == "Wood");
    CHECK(name_of("AreaLightSource \"diffuse\"\nShape \"sphere\"") == "area light");
    CHECK(name_of("# left wall\nShape \"sphere\"") == "left wall");
    CHECK(name_of("#left wall\nAttributeBegin\nTranslate 1 0 0\nShape \"sphere\"\nAttributeEnd") == "left wall");
    CHECK(name_of("# ===== Chair =====\nAttributeBegin\nShape \"sphere\"\nAttributeEnd") == "Chair");
    CHECK(name_of("# Name: Cube.001\nShape \"sphere\"") == "Cube.001");
    CHECK(name_of("# Object Cube.001\nShape \"sphere\"") == "Cube.001");
    CHECK(name_of("# name: \"a \\\"b\\\"\"\n# red\nShape \"sphere\"") == "a \"b\"");
    // No names: directives, sentences, rulers, parameters, trailing comments, comments about something else.
    for (const char* no :
         {"# Shape \"disk\"", "#Translate 1 2 3", "#--------", "# \"float radius\" 3", "# 0.4 0.5 0.6 0.8",
          "# this is a rather long remark about what comes next in the file", "#Material \"gold\"",
          "Translate 1 0 0 # moved", "# the wood\nMakeNamedMaterial \"x\" \"string type\" \"diffuse\"",
          "# other\nAttributeBegin\nAttributeEnd", "# light\nLightSource \"point\""})
        CHECK(name_of(std::string(no) + "\nShape \"sphere\"") == "sphere");
    CHECK(loaded("# desk lamp\nLightSource \"spot\"").lights.at(0).name == "desk lamp");
    CHECK(loaded("LightSource \"spot\"").lights.at(0).name == "spot light");
}

TEST_CASE("pbrt names: files and objects", "[pbrt]") {
    const Folder folder;
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
        "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1 0 0 0 1 "
        "0\n3 0 1 2\n";
    for (const char* name : {"Spout.ply", "mesh_00012.ply", "Mesh003.ply"})
        folder.file(name, ply);
    const auto named = [&](const std::string& text) {
        Recorder r;
        REQUIRE(r.load_file(folder.file("s.pbrt", "Film \"rgb\"\nWorldBegin\n" + text)) == 1);
        return r;
    };
    const auto shape = [](const char* file) {
        return "Shape \"plymesh\" \"string filename\" \"" + std::string(file) + "\"\n";
    };
    Recorder r = named(std::string(wood) + shape("Spout.ply") + shape("mesh_00012.ply") + shape("Mesh003.ply"));
    CHECK(r.instances[0].name == "Spout");
    CHECK(r.instances[1].name == "Wood");
    CHECK(r.instances[2].name == "Wood");
    CHECK(r.meshes[1].name == "mesh_00012"); // the mesh is the file's
    CHECK(named(shape("Mesh003.ply")).instances[0].name == "Mesh003"); // nothing better is available
    r = named("# name: Cup\nAttributeBegin\n" + shape("Spout.ply") + "AttributeEnd");
    CHECK(r.instances[0].name == "Cup");
    // An object of one shape takes the object's name, a larger one the materials'.
    r = named("ObjectBegin \"Tree\"\n" + std::string(wood) + shape("mesh_00012.ply") +
              "ObjectEnd\nObjectInstance \"Tree\"\n# the oak\nObjectInstance \"Tree\"");
    REQUIRE(r.groups.size() == 2);
    CHECK(r.groups[0].name == "Tree");
    CHECK(r.groups[1].name == "the oak");
    CHECK(r.instances[0].name == "Tree");
    r = named("ObjectBegin \"Tree\"\n" + std::string(wood) + shape("mesh_00012.ply") + shape("Spout.ply") +
              "ObjectEnd\nObjectInstance \"Tree\"");
    CHECK(r.instances[0].name == "Wood");
    CHECK(r.instances[1].name == "Spout");
}

TEST_CASE("pbrt names: comments of our own", "[pbrt]") {
    const Recorder r = loaded(R"(
#restage AttributeBegin
#restage     # name: "top"
#restage     Shape "sphere"
#restage AttributeEnd
AttributeBegin
    # name: "cup"
    # group: "kitchen" "table"
    Shape "disk"
AttributeEnd
ObjectBegin "o"
    Shape "sphere"
    Shape "disk"
ObjectEnd
AttributeBegin
    # name: "set"
    # group: "kitchen"
    # names: "a" "b"
    ObjectInstance "o"
AttributeEnd
ObjectBegin "p"
    Shape "sphere"
ObjectEnd
# alone: "ball"
ObjectInstance "p"
)");
    REQUIRE(r.instances.size() == 5);
    CHECK(r.instances[0].name == "top");
    CHECK((r.instances[0].raw.flags & RESTAGE_INSTANCE_HIDDEN) != 0);
    CHECK(r.instances[1].name == "cup");
    CHECK((r.instances[1].raw.flags & RESTAGE_INSTANCE_HIDDEN) == 0);
    CHECK(r.instances[1].raw.group == 2);
    CHECK(r.instances[2].name == "a");
    CHECK(r.instances[3].name == "b");
    CHECK(r.instances[3].raw.group == 3);
    CHECK(r.instances[4].name == "ball");
    CHECK(r.instances[4].raw.group == 0);
    REQUIRE(r.groups.size() == 3);
    CHECK(r.groups[0].name == "kitchen");
    CHECK(r.groups[1].name == "table");
    CHECK(r.groups[2].name == "set");
    Recorder two;
    REQUIRE(two.load_text("Film \"rgb\"\nCamera \"perspective\" \"float fov\" 30\n#restage AttributeBegin\n#restage "
                          "Identity\n#restage # name: \"side\"\n#restage Camera \"perspective\" \"float fov\" "
                          "50\n#restage AttributeEnd\nWorldBegin\n") == 1);
    REQUIRE(two.cameras.size() == 2);
    CHECK(two.cameras[1].name == "side");
    CHECK(two.raw_cameras[0].fov == 30);
    // Errors in such lines are errors as anywhere.
    Recorder broken;
    CHECK(broken.load_text("Film \"rgb\"\nWorldBegin\n#restage Shape 3\n") == 0);
    CHECK(broken.error.line == 3);
    CHECK(broken.error.column == 16);
}

TEST_CASE("pbrt materials: v3 shapes override parameters", "[pbrt]") {
    Recorder r;
    REQUIRE(r.load_text(R"(Film "image"
WorldBegin
Texture "t" "color" "constant" "rgb value" [ .1 .2 .3 ]
MakeNamedMaterial "paint" "string type" "plastic" "rgb Kd" [ .5 .5 .5 ] "float roughness" 0.3
NamedMaterial "paint"
Shape "sphere" "rgb Kd" [ 1 0 0 ]
Shape "sphere" "rgb Kd" [ 1 0 0 ] "float radius" 2
Shape "sphere"
Shape "sphere" "texture Kd" "t"
Material "matte" "float sigma" 10
Shape "disk" "rgb Kd" [ 0 1 0 ]
WorldEnd
)") == 1);
    REQUIRE(r.instances.size() == 5);
    const auto material = [&](std::size_t i) { return r.materials.at(r.instances[i].raw.material - 1); };
    CHECK(material(0).type == "plastic");
    CHECK(material(0).name == "paint");
    CHECK(material(0).values.at("kd").v == std::array<float, 4>{1, 0, 0, 1});
    CHECK(material(0).values.at("roughness").v[0] == 0.3f);
    CHECK(r.instances[0].raw.material == r.instances[1].raw.material);
    CHECK(material(2).values.at("kd").v[1] == 0.5f);
    CHECK(material(3).values.at("kd").ref == 1);
    CHECK(material(4).type == "diffuse");
    CHECK(material(4).values.at("sigma").v[0] == 10);
    CHECK(material(4).values.at("reflectance").v[1] == 1);
    CHECK(r.instances[0].raw.mesh == r.instances[2].raw.mesh);
    CHECK(r.meshes[0].primitive == "sphere");
    CHECK(r.instances[0].verbatim == "");
}
