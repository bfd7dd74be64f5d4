// SPDX-License-Identifier: Apache-2.0
// Where pbrt warns and continues, so does the importer, with a line of the report and its place; and unreadable
// things stay in place.
#include "pbrt_writer.hpp"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>

using restage::pbrt::test::Folder;
using restage::pbrt::test::Recorder;

namespace {

const std::string v3_head = "Film \"image\"\nCamera \"perspective\"\nWorldBegin\n"; // line 4 comes next
const std::string v4_head = "Film \"rgb\"\nCamera \"perspective\"\nWorldBegin\n";

struct Warned {
    std::string name, text, said; // said: part of "WHAT: NOTE"
    unsigned line;
    std::size_t instances;
};

void check(const std::string& head, const std::string& tail, const Warned& w) {
    INFO(w.name);
    Recorder r;
    REQUIRE(r.load_text(head + w.text + tail) == 1);
    INFO(r.all_reports());
    CHECK(r.instances.size() == w.instances);
    CHECK(std::any_of(r.lines.begin(), r.lines.end(), [&](const auto& line) {
        return line.fate != RESTAGE_KEPT && line.line == w.line &&
               (line.what + ": " + line.note).find(w.said) != std::string::npos;
    }));
}

std::size_t placeholders(const Recorder& r) {
    return static_cast<std::size_t>(std::count_if(
        r.meshes.begin(), r.meshes.end(), [](const auto& mesh) { return mesh.primitive.starts_with("missing "); }));
}

} // namespace

TEST_CASE("pbrt-v3: its warnings are reported, and reading continues", "[pbrt]") {
    const std::string mesh = "Shape \"trianglemesh\" ", p = "\"point P\" [0 0 0 1 0 0 0 1 0]";
    const std::vector<Warned> cases = {
        {"comma", "Translate 1, 2, 3\nShape \"sphere\"\n", "pbrt reads 1 and leaves the rest out", 4, 1},
        {"two points", "Shape \"sphere\" \"float radius\" 1.5.2\n", "pbrt reads 1.5", 4, 1},
        {"block not closed", "AttributeBegin\nShape \"sphere\"\n", "AttributeBegin: is not closed", 4, 1},
        {"transform not closed", "TransformBegin\nShape \"sphere\"\n", "TransformBegin: is not closed", 4, 1},
        {"closed twice", "AttributeEnd\nShape \"sphere\"\n", "AttributeEnd: without a Begin", 4, 1},
        {"transform closed twice", "TransformEnd\nShape \"sphere\"\n", "TransformEnd: without a Begin", 4, 1},
        {"crossed", "AttributeBegin\nTransformBegin\nAttributeEnd\nTransformEnd\nShape \"sphere\"\n", "do not match", 6,
         1},
        {"index", mesh + p + " \"integer indices\" [0 1 7]\nShape \"sphere\"\n", "there are 3 vertices", 4, 2},
        {"no indices", mesh + "\"point P\" [0 0 0 1 0 0 0 1 0 1 1 1]\nShape \"sphere\"\n", "no faces", 4, 2},
        {"no points", mesh + "\"integer indices\" [0 1 2]\nShape \"sphere\"\n", "no vertices", 4, 2},
        {"ten numbers", mesh + "\"point P\" [0 0 0 1 0 0 0 1 0 9] \"integer indices\" [0 1 2]\n", "1 surplus numbers",
         4, 1},
        {"four indices", mesh + p + " \"integer indices\" [0 1 2 0]\n", "not a multiple of 3", 4, 1},
        {"normals", mesh + p + " \"integer indices\" [0 1 2] \"normal N\" [0 0 1]\n", "1 entries for 3 vertices", 4, 1},
        {"subdivision", "Shape \"loopsubdiv\" " + p + "\nShape \"sphere\"\n", "Shape \"loopsubdiv\"", 4, 2},
        {"bool", "Shape \"sphere\"\nAreaLightSource \"diffuse\" \"bool twosided\" \"maybe\"\n", "\"maybe\"", 5, 1},
        {"wrong kind", "Shape \"sphere\" \"string radius\" \"big\"\n", "value of the wrong kind", 4, 1},
        {"two values", "Shape \"sphere\" \"float radius\" [1 2]\n", "value of the wrong kind", 4, 1},
        {"two of rgb", "Material \"matte\" \"rgb Kd\" [1 0]\nShape \"sphere\"\n", "value of the wrong kind", 4, 1},
        {"odd spectrum", "Material \"matte\" \"spectrum Kd\" [400 1 500]\nShape \"sphere\"\n", "odd number", 4, 1},
        {"falling spectrum", "Material \"matte\" \"spectrum Kd\" [500 1 400 1]\nShape \"sphere\"\n", "sorted", 4, 1},
        {"material", "NamedMaterial \"none of these\"\nShape \"sphere\"\n", "no material has that name", 4, 1},
        {"texture", "Material \"matte\" \"texture Kd\" \"no\"\nShape \"sphere\"\n", "no texture has that name", 4, 1},
        {"medium", "MediumInterface \"no\" \"\"\nShape \"sphere\"\n", "no medium has that name", 5, 1},
        {"object", "ObjectInstance \"no\"\nShape \"sphere\"\n", "no ObjectBegin has that name", 4, 2},
        {"coordinates", "CoordSysTransform \"no\"\nShape \"sphere\"\n", "no CoordinateSystem has that name", 4, 1},
        {"shape", "Shape \"teapot\"\nShape \"sphere\"\n", "no such shape", 4, 2},
        {"light", "LightSource \"laser\"\nShape \"sphere\"\n", "no such light", 4, 2},
        {"material again",
         "MakeNamedMaterial \"a\" \"string type\" \"matte\"\nMakeNamedMaterial \"a\" \"string type\" "
         "\"mirror\"\nShape \"sphere\"\n",
         "is defined again", 5, 1},
        {"texture again",
         "Texture \"a\" \"color\" \"constant\"\nTexture \"a\" \"color\" \"constant\"\nShape \"sphere\"\n",
         "is defined again", 5, 1},
        {"camera late", "Camera \"perspective\"\nShape \"sphere\"\n", "before WorldBegin", 4, 1},
        {"spot", "LightSource \"spot\" \"point from\" [0 0 1]\nShape \"sphere\"\n", "the same point", 4, 2},
        {"world twice", "WorldBegin\nShape \"sphere\"\n", "a second one", 4, 1},
        {"look at", "LookAt 0 0 0  0 0 0  0 1 0\nShape \"sphere\"\n", "LookAt", 4, 1},
        {"instance inside", "ObjectBegin \"a\"\nObjectInstance \"a\"\nObjectEnd\nShape \"sphere\"\n",
         "inside ObjectBegin", 5, 1},
        {"ply", "Shape \"plymesh\" \"string filename\" \"no.ply\"\nShape \"sphere\"\n", "its place is kept", 4, 2},
    };
    for (const Warned& w : cases)
        check(v3_head, "WorldEnd\n", w);
    Recorder early;
    REQUIRE(early.load_text("Film \"image\"\nShape \"sphere\"\nWorldBegin\nShape \"sphere\"\nWorldEnd\n") == 1);
    CHECK(early.instances.size() == 1);
    CHECK(early.reports("it must come after WorldBegin"));
}

TEST_CASE("pbrt-v4: its warnings are reported, and reading continues", "[pbrt]") {
    const std::string mesh = "Shape \"trianglemesh\" ", p = "\"point3 P\" [0 0 0 1 0 0 0 1 0]";
    const std::vector<Warned> cases = {
        {"comma", "Translate 1, 2, 3\nShape \"sphere\"\n", "pbrt reads 1 and leaves the rest out", 4, 1},
        {"closed twice", "AttributeEnd\nShape \"sphere\"\n", "AttributeEnd: without a Begin", 4, 1},
        {"index", mesh + p + " \"integer indices\" [0 1 7]\nShape \"sphere\"\n", "there are 3 vertices", 4, 2},
        {"no points", mesh + "\"integer indices\" [0 1 2]\nShape \"sphere\"\n", "no vertices", 4, 2},
        {"patch", "Shape \"bilinearmesh\" " + p + "\nShape \"sphere\"\n", "four \"integer indices\"", 4, 2},
        {"five indices",
         "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"integer indices\" [0 1 2 3 0]\n",
         "not a multiple of 4", 4, 1},
        {"colour space", "ColorSpace \"cmyk\"\nShape \"sphere\"\n", "\"cmyk\"", 4, 1},
        {"coordinates", "CoordSysTransform \"no\"\nShape \"sphere\"\n", "no CoordinateSystem has that name", 4, 1},
    };
    for (const Warned& w : cases)
        check(v4_head, "", w);
    for (const char* stops : {"AttributeBegin\nShape \"sphere\"\n", "Camera \"perspective\"\n",
                              "Shape \"sphere\" \"string radius\" \"big\"\n", "Shape \"loopsubdiv\"\n"}) {
        INFO(stops);
        Recorder r;
        CHECK(r.load_text(v4_head + stops) == 0);
        CHECK(r.error.set);
    }
}

TEST_CASE("pbrt: a file may end between the parameters of a shape", "[pbrt]") {
    for (const bool old : {true, false}) {
        Folder folder;
        folder.file("open.pbrt", "# the indices\nShape \"trianglemesh\" \"integer indices\" [0 1 2]\n");
        folder.file("deep.pbrt", "Include \"open.pbrt\"");
        const std::string type = old ? "point" : "point3";
        Recorder r;
        REQUIRE(r.load_file(folder.file("s.pbrt", (old ? v3_head : v4_head) + "Include \"deep.pbrt\"\n\"" + type +
                                                      " P\" [0 0 0 1 0 0 0 0 1]\nShape \"sphere\"\n" +
                                                      (old ? "WorldEnd\n" : ""))) == 1);
        REQUIRE(r.instances.size() == 2);
        CHECK(r.meshes[0].positions.size() == 9);
        CHECK(r.meshes[0].positions[8] == 1);
    }
}

TEST_CASE("pbrt-v3: crossed blocks keep pbrt's two stacks", "[pbrt]") {
    // AttributeEnd takes the transform of TransformBegin and the attributes of AttributeBegin; the TransformEnd after
    // it finds that of AttributeBegin.
    Recorder r;
    REQUIRE(r.load_text(v3_head +
                        "Translate 1 0 0\nAttributeBegin\nReverseOrientation\nTranslate 0 1 0\nTransformBegin\n"
                        "Translate 0 0 1\nAttributeEnd\nShape \"sphere\"\nTransformEnd\nShape \"sphere\"\n"
                        "WorldEnd\n") == 1);
    REQUIRE(r.instances.size() == 2);
    const double* inner = r.instances[0].raw.object_to_world;
    CHECK((inner[12] == 1 && inner[13] == 1 && inner[14] == 0));
    CHECK((r.instances[0].raw.flags & RESTAGE_INSTANCE_REVERSE_ORIENTATION) == 0);
    const double* outer = r.instances[1].raw.object_to_world;
    CHECK((outer[12] == 1 && outer[13] == 0 && outer[14] == 0));
}

TEST_CASE("pbrt: unreadable things stay in place", "[pbrt]") {
    Recorder r;
    REQUIRE(
        r.load_text(
            v4_head +
            "LightSource \"infinite\" \"string filename\" \"sky.exr\" \"float scale\" 4\n"
            "MakeNamedMedium \"smoke\" \"string type\" \"nanovdb\" \"string filename\" \"smoke.nvdb\"\n"
            "AttributeBegin\nMediumInterface \"smoke\" \"\"\nMaterial \"interface\"\nShape \"sphere\"\nAttributeEnd\n"
            "ObjectBegin \"chair\"\nShape \"plymesh\" \"string filename\" \"chair.ply\"\nObjectEnd\n"
            "ObjectInstance \"chair\"\nTranslate 1 2 3\n"
            "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [5 5 5]\n"
            "Shape \"plymesh\" \"string filename\" \"lamp.ply\"\nAttributeEnd\n"
            "Include \"more.pbrt\"\n") == 1);
    INFO(r.all_reports());
    REQUIRE(r.environments.size() == 1);
    CHECK(r.environments[0].scale[0] == 4);
    CHECK(r.environments[0].image != 0);
    REQUIRE(r.media.size() == 1);
    CHECK(r.media[0].verbatim.find("=* \"string filename\" [ \"smoke.nvdb\" ]") != std::string::npos);
    REQUIRE(r.instances.size() == 4);
    CHECK(placeholders(r) == 3);
    CHECK(r.instances[1].name == "chair");
    CHECK((r.instances[2].raw.flags & RESTAGE_INSTANCE_EMITS) != 0);
    CHECK(r.instances[2].raw.emission[0] == 5);
    CHECK(r.instances[3].raw.object_to_world[13] == 2);
    CHECK(r.meshes[r.instances[3].raw.mesh - 1].primitive == "missing Include \"more.pbrt\"");
    for (const char* file : {"sky.exr", "smoke.nvdb", "chair.ply", "lamp.ply", "more.pbrt"})
        CHECK(r.reports(file));
}

TEST_CASE("pbrt: a missing sky picture becomes its constant", "[pbrt]") {
    Recorder r;
    REQUIRE(r.load_text(v3_head +
                        "LightSource \"infinite\" \"string mapname\" \"no.exr\" \"rgb L\" [1 2 3]\nWorldEnd\n") == 1);
    REQUIRE(r.environments.size() == 1);
    CHECK(r.environments[0].scale[2] == 3);
    CHECK(r.reports("image \"no.exr\": there is no such file"));
}

TEST_CASE("pbrt-v4: media may be defined after they are used, v3's before", "[pbrt]") {
    const std::string
        use = "AttributeBegin\nMediumInterface \"m\" \"\"\nShape \"sphere\"\nAttributeEnd\n",
        define =
            "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" [0 0 0]\n";
    Recorder v4;
    REQUIRE(v4.load_text(v4_head + use + define) == 1);
    REQUIRE(v4.raw_media.size() == 1);
    CHECK(v4.instances[0].raw.interior == 1);
    CHECK(v4.raw_media[0].sigma_a[1] == 2);
    Recorder v3;
    REQUIRE(v3.load_text(v3_head + use + define + "WorldEnd\n") == 1);
    CHECK(v3.instances[0].raw.interior == 0);
    CHECK(v3.reports("no medium has that name"));
}

TEST_CASE("pbrt spots fade by their version's rule", "[pbrt]") {
    Recorder v3, v4;
    REQUIRE(v3.load_text(v3_head + "LightSource \"spot\"\nWorldEnd\n") == 1);
    REQUIRE(v4.load_text(v4_head + "LightSource \"spot\"\n") == 1);
    CHECK(v3.raw_lights.at(0).falloff == RESTAGE_FALLOFF_QUARTIC);
    CHECK(v4.raw_lights.at(0).falloff == RESTAGE_FALLOFF_SMOOTH);
}

TEST_CASE("pbrt-v2: gamma of a picture is a power", "[pbrt]") {
    Recorder r;
    REQUIRE(r.load_text(v3_head +
                        "Texture \"t\" \"color\" \"imagemap\" \"string filename\" \"gone.png\" \"float gamma\" [1.8]\n"
                        "Material \"matte\" \"texture Kd\" \"t\"\nShape \"sphere\"\nWorldEnd\n") == 1);
    REQUIRE(r.images.size() == 1);
    CHECK(r.images[0].encoding == RESTAGE_GAMMA);
    CHECK(r.images[0].gamma == 1.8f);
    CHECK(r.reports("pbrt-v2"));
}

TEST_CASE("pbrt: subsurface materials have their colour", "[pbrt]") {
    const auto loaded = [](const std::string& head, const std::string& material) {
        Recorder r;
        REQUIRE(r.load_text(head + material + "\nShape \"sphere\"\n" + (head == v3_head ? "WorldEnd\n" : "")) == 1);
        REQUIRE(r.materials.size() == 1);
        return r;
    };
    // Through a coat of eta 1.33 a base of albedo r reflects r (1 - F) / (1 - r F), F = 0.472 inside.
    const auto sent_back = [](double base) { return base * (1 - 0.4723) / (1 - 0.4723 * base); };
    const std::string texture = "Texture \"a\" \"spectrum\" \"constant\" \"rgb value\" [.8 .1 .1]\n";
    for (const auto& [head, material] :
         {std::pair{v3_head, texture + "Material \"kdsubsurface\" \"texture Kd\" \"a\""},
          {v3_head, std::string("Material \"kdsubsurface\" \"rgb Kd\" [.8 .1 .1]")},
          {v4_head, texture + "Material \"subsurface\" \"texture reflectance\" \"a\" \"rgb mfp\" [1 1 1]"},
          {v4_head, std::string("Material \"subsurface\" \"rgb reflectance\" [.8 .1 .1]")}}) {
        INFO(material);
        const Recorder r = loaded(head, material);
        CHECK(r.materials[0].type == "coateddiffuse");
        const auto& color = r.materials[0].values.at("reflectance").v;
        CHECK(sent_back(double(color[0])) == Catch::Approx(0.8).margin(0.002));
        CHECK(sent_back(double(color[1])) == Catch::Approx(0.1).margin(0.002));
    }
    // Ketchup is red, milk is white: Jensen et al. 2001, Fig. 5 (diffuse reflectance of ketchup: 0.16 0.01 0.00; of
    // whole milk: 0.91 0.88 0.77, computed for eta 1.3).
    for (const std::string& head : {v3_head, v4_head}) {
        const auto red =
            loaded(head, "Material \"subsurface\" \"string name\" \"Ketchup\"").materials[0].values.at("reflectance").v;
        CHECK(sent_back(double(red[0])) == Catch::Approx(0.16).margin(0.03));
        CHECK(sent_back(double(red[1])) == Catch::Approx(0.01).margin(0.02));
        const auto milk = loaded(head, "Material \"subsurface\" \"string name\" \"Wholemilk\"")
                              .materials[0]
                              .values.at("reflectance")
                              .v;
        CHECK(sent_back(double(milk[0])) == Catch::Approx(0.91).margin(0.03));
        CHECK(sent_back(double(milk[2])) == Catch::Approx(0.77).margin(0.03));
    }
    const Recorder textured =
        loaded(v3_head, "Texture \"a\" \"spectrum\" \"checkerboard\"\nMaterial \"kdsubsurface\" \"texture Kd\" \"a\"");
    CHECK(textured.materials[0].type == "uber");
    CHECK(textured.materials[0].values.at("kd").ref != 0);
}

TEST_CASE("pbrt-v3: a value of another type is ignored", "[pbrt]") {
    Recorder r;
    REQUIRE(r.load_text(v3_head + "LightSource \"infinite\" \"rgb L\" [1 2 3] \"float scale\" 3\n"
                                  "Material \"matte\" \"float Kd\" .9 \"rgb sigma\" [50 50 50]\n"
                                  "Shape \"sphere\" \"integer radius\" 3\n"
                                  "Material \"matte\" \"colour Kd\" [.9 .9 .9]\nShape \"sphere\"\n"
                                  "Material \"glass\" \"spectrum eta\" [400 2 700 2]\nShape \"sphere\"\nWorldEnd\n") ==
            1);
    INFO(r.all_reports());
    CHECK(r.environments.at(0).scale[2] == 3);
    CHECK(r.materials.at(0).values.at("reflectance").v[0] == 0.5f);
    CHECK(r.materials.at(0).values.at("sigma").v[0] == 0);
    CHECK(r.meshes.at(0).positions.at(2) == Catch::Approx(-1).epsilon(0.01)); // a sphere of radius 1
    CHECK(r.materials.at(1).values.at("reflectance").v[0] == 0.5f);
    CHECK(r.materials.at(2).values.at("eta").v[0] == 1.5f);
    for (const char* part : {"\"float scale\" has a value of the wrong kind", "\"float Kd\"", "\"rgb sigma\"",
                             "\"integer radius\"", "\"colour Kd\"", "\"spectrum eta\""})
        CHECK(r.reports(part));
}

TEST_CASE("pbrt: unknown parameters give a warning, known ones are kept", "[pbrt]") {
    for (const std::string& head : {v3_head, v4_head}) {
        Recorder r;
        const std::string end = head == v3_head ? "WorldEnd\n" : "";
        REQUIRE(r.load_text(head +
                            "Shape \"sphere\" \"float raduis\" 3\nLightSource \"point\" \"integer nsamples\" 4\n" +
                            end) == 1);
        INFO(r.all_reports());
        const auto fate = [&](const char* part) {
            for (const auto& line : r.lines)
                if ((line.what + line.note).find(part) != std::string::npos) return line.fate;
            return -1;
        };
        CHECK(fate("raduis") == RESTAGE_APPROXIMATED);
        CHECK(fate("nsamples") == RESTAGE_KEPT);
    }
    Recorder depth;
    REQUIRE(depth.load_text("Film \"image\"\nIntegrator \"path\" \"float maxdepth\" 9 \"float rrthreshold\" 1\n"
                            "Sampler \"random\" \"integer pixelsample\" 9\nWorldBegin\nWorldEnd\n") == 1);
    CHECK(depth.settings.max_depth == 5);
    CHECK(depth.reports("\"float maxdepth\" has a value of the wrong kind"));
    CHECK(depth.reports("pixelsample"));
    CHECK_FALSE(depth.reports("rrthreshold"));
    Recorder v4; // pbrt stops here; the intent is clear
    REQUIRE(v4.load_text(v4_head + "Shape \"sphere\" \"integer radius\" 3\n") == 1);
    CHECK(v4.meshes.at(0).positions.at(2) == Catch::Approx(-3).epsilon(0.01));
    CHECK(v4.reports("should be \"float radius\""));
}

TEST_CASE("pbrt-v3: replacements are those of pbrt", "[pbrt]") {
    Recorder r;
    REQUIRE(r.load_text(v3_head +
                        "Material \"gypsum\" \"rgb Kd\" [.9 .8 .7]\nShape \"sphere\"\n"
                        "MakeNamedMaterial \"a\" \"rgb Kd\" [.9 .9 .9]\nNamedMaterial \"a\"\nShape \"sphere\"\n"
                        "Material \"matte\" \"spectrum Kd\" \"no.spd\"\nShape \"sphere\"\n"
                        "LightSource \"point\" \"spectrum I\" \"no.spd\"\n"
                        "Texture \"p\" \"color\" \"imagemap\" \"string filename\" \"no.png\"\n"
                        "Texture \"e\" \"color\" \"imagemap\" \"string filename\" \"no.exr\" \"float scale\" 3\n"
                        "WorldEnd\n") == 1);
    INFO(r.all_reports());
    CHECK(r.materials.at(0).values.at("reflectance").v[2] == 0.7f); // matte with its parameters
    CHECK(r.materials.at(1).type == "interface"); // no "string type"
    CHECK(r.reports("no \"string type\""));
    CHECK(r.materials.at(2).values.at("reflectance").v[0] == 0); // black
    CHECK(r.raw_lights.at(0).value[0] == 0);
    // A grey of 0.5 instead of the texels, decoded and scaled.
    CHECK(r.textures.at(0).values.at("average").v[0] == Catch::Approx(0.21404).epsilon(1e-4));
    CHECK(r.textures.at(1).values.at("average").v[0] == Catch::Approx(1.5));
}

TEST_CASE("pbrt: empty quadrics do not stop the import", "[pbrt]") {
    for (const std::string& head : {v3_head, v4_head})
        for (const char* shape :
             {"\"sphere\" \"float radius\" 0", "\"sphere\" \"float radius\" -1", "\"sphere\" \"float phimax\" 0",
              "\"sphere\" \"float zmin\" .5 \"float zmax\" .5", "\"disk\" \"float innerradius\" 2",
              "\"cylinder\" \"float zmin\" 1", "\"cylinder\" \"float radius\" 0"}) {
            INFO(shape);
            Recorder r;
            REQUIRE(r.load_text(head + "Shape " + shape + "\nShape \"sphere\"\n" +
                                (head == v3_head ? "WorldEnd\n" : "")) == 1);
            CHECK(r.instances.size() == 2);
            CHECK(placeholders(r) == 1);
            CHECK(r.reports("its place is kept"));
        }
}

TEST_CASE("pbrt-v3: blocks out of place", "[pbrt]") {
    Recorder early; // VERIFY_WORLD: skipped
    REQUIRE(early.load_text("Film \"image\"\nAttributeBegin\nReverseOrientation\nTransformBegin\n"
                            "Texture \"t\" \"color\" \"constant\"\nMakeNamedMaterial \"m\" \"string type\" \"mirror\"\n"
                            "WorldBegin\nShape \"sphere\"\nWorldEnd\n") == 1);
    INFO(early.all_reports());
    CHECK((early.instances.at(0).raw.flags & RESTAGE_INSTANCE_REVERSE_ORIENTATION) == 0);
    CHECK(early.textures.empty());
    CHECK(early.reports("AttributeBegin: it must come after WorldBegin"));
    CHECK(early.reports("ReverseOrientation: it must come after WorldBegin"));
    Recorder nested; // the second object is open at the first ObjectEnd; later shapes are in the world
    REQUIRE(nested.load_text(v3_head + "ObjectBegin \"a\"\nShape \"sphere\"\nObjectBegin \"b\"\nTranslate 1 0 0\n"
                                       "Shape \"disk\"\nObjectEnd\nShape \"cylinder\"\nObjectEnd\nObjectEnd\n"
                                       "ObjectInstance \"b\"\nWorldEnd\n") == 1);
    INFO(nested.all_reports());
    REQUIRE(nested.instances.size() == 2);
    CHECK(nested.instances[0].raw.object_to_world[12] == 0); // the cylinder
    CHECK(nested.instances[1].raw.object_to_world[12] == 1); // the disk
    CHECK(nested.reports("ObjectBegin \"b\": inside an object"));
    CHECK(nested.reports("ObjectEnd: without an ObjectBegin"));
}

TEST_CASE("pbrt: invalid windows", "[pbrt]") {
    const std::string film = "Film \"image\" \"float cropwindow\" [0 1 0]\n";
    Recorder v3;
    REQUIRE(v3.load_text(film + "Camera \"perspective\" \"float screenwindow\" [-1 1 -1]\nWorldBegin\nWorldEnd\n") ==
            1);
    CHECK(v3.film.crop[3] == 1);
    CHECK(v3.raw_cameras.at(0).screen_window[1] == 0);
    CHECK(v3.reports("cropwindow"));
    CHECK(v3.reports("screenwindow"));
    Recorder v4;
    REQUIRE(v4.load_text("Film \"rgb\"\nCamera \"perspective\" \"float screenwindow\" [-1 1 -1]\nWorldBegin\n") == 1);
    CHECK(v4.raw_cameras.at(0).screen_window[1] == 0);
    for (const std::string& head : {std::string("Film \"image\"\n"), std::string("Film \"rgb\"\n")}) {
        Recorder mirrored; // x1 < x0: the picture is mirrored, as by a Scale -1 1 1 before everything
        REQUIRE(mirrored.load_text(head + "Camera \"perspective\" \"float screenwindow\" [2 -1 -1 1]\nWorldBegin\n" +
                                   (head == "Film \"image\"\n" ? "WorldEnd\n" : "")) == 1);
        const RestageCamera& c = mirrored.raw_cameras.at(0);
        CHECK(c.camera_to_world[0] == -1);
        CHECK(c.screen_window[0] == -2);
        CHECK(c.screen_window[1] == 1);
    }
}

TEST_CASE("pbrt-v4: textures may be defined after they are used", "[pbrt]") {
    const std::string
        use = "Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\" \"texture alpha\" \"a\"\n",
        define =
            "Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [.1 .2 .3]\n"
            "Texture \"a\" \"float\" \"constant\" \"float value\" .5\n";
    Recorder v4;
    REQUIRE(v4.load_text(v4_head + use + define) == 1);
    INFO(v4.all_reports());
    CHECK(v4.textures.size() == 2);
    CHECK(v4.materials.at(0).values.at("reflectance").ref != 0);
    CHECK(v4.instances.at(0).raw.alpha_texture != 0);
    CHECK_FALSE(v4.reports("no texture"));
    CHECK_FALSE(v4.reports("again"));
    Recorder circle;
    REQUIRE(circle.load_text(v4_head + "Texture \"a\" \"spectrum\" \"scale\" \"texture tex\" \"b\"\n"
                                       "Texture \"b\" \"spectrum\" \"scale\" \"texture tex\" \"a\"\n") == 1);
    CHECK(circle.reports("no texture has that name"));
    std::string chain = v4_head;
    for (int i = 0; i < 3000; ++i)
        chain += "Texture \"" + std::to_string(i) + "\" \"spectrum\" \"scale\" \"texture tex\" \"" +
                 std::to_string(i + 1) + "\"\n";
    Recorder deep;
    CHECK(deep.load_text(chain) == 0); // refused, not a stack overflow
    CHECK(deep.error.set);
}

TEST_CASE("pbrt: missing files are reported even if they would not be read", "[pbrt]") {
    Recorder v4;
    REQUIRE(v4.load_text(v4_head + "Material \"measured\" \"string filename\" \"gone.bsdf\"\n"
                                   "AreaLightSource \"diffuse\" \"string filename\" \"gone.png\"\n"
                                   "Shape \"sphere\"\n") == 1);
    CHECK(v4.reports("file \"gone.bsdf\": there is no such file"));
    CHECK(v4.reports("file \"gone.png\": there is no such file"));
    Recorder v3;
    REQUIRE(v3.load_text(v3_head +
                         "Material \"fourier\" \"string bsdffile\" \"gone.bsdf\"\nShape \"sphere\"\nWorldEnd\n") == 1);
    CHECK(v3.reports("file \"gone.bsdf\": there is no such file"));
}

TEST_CASE("pbrt: losses of moving things are reported", "[pbrt]") {
    Recorder r;
    REQUIRE(r.load_text(v4_head + "ActiveTransform EndTime\nTranslate 1 0 0\nActiveTransform All\nShape \"sphere\"\n"
                                  "Texture \"f\" \"float\" \"fbm\"\n") == 1);
    CHECK(
        r.reports("Shape in motion: stands still where it is when the shutter opens; its motion is not written back"));
    CHECK(r.reports("Texture in motion"));
}

TEST_CASE("pbrt: materials of the other version are accepted, and reported", "[pbrt]") {
    Recorder v3, v4;
    REQUIRE(v3.load_text(v3_head +
                         "Material \"diffuse\" \"rgb reflectance\" [.9 .8 .7]\nShape \"sphere\"\nWorldEnd\n") == 1);
    CHECK(v3.materials.at(0).values.at("reflectance").v[2] == 0.7f);
    CHECK(v3.reports("pbrt-v3 has no material of that name"));
    REQUIRE(v4.load_text(v4_head + "Material \"matte\" \"rgb Kd\" [.9 .8 .7]\nShape \"sphere\"\n") == 1);
    CHECK(v4.materials.at(0).values.at("reflectance").v[2] == 0.7f);
    CHECK(v4.reports("pbrt-v4 has no material of that name"));
}

TEST_CASE("pbrt-v4: objects may be defined after they are placed", "[pbrt]") {
    const std::string
        place = "AttributeBegin\nTranslate 1 2 3\nObjectInstance \"a\"\nAttributeEnd\n",
        define = "Translate 9 9 9\nObjectBegin \"a\"\nIdentity\nTranslate 0 0 1\nShape \"sphere\"\nObjectEnd\n";
    Recorder v4;
    REQUIRE(v4.load_text(v4_head + place + define + "ObjectInstance \"a\"\nObjectInstance \"b\"\n") == 1);
    INFO(v4.all_reports());
    REQUIRE(v4.instances.size() == 3);
    CHECK(placeholders(v4) == 1); // of b
    CHECK(v4.instances[2].raw.object_to_world[12] == 1);
    CHECK(v4.instances[2].raw.object_to_world[14] == 4);
    Recorder v3;
    REQUIRE(v3.load_text(v3_head + place + define + "WorldEnd\n") == 1);
    CHECK(v3.reports("no ObjectBegin has that name"));
}

TEST_CASE("pbrt-v4: options that change the picture, and attributes of unknown targets", "[pbrt]") {
    Recorder r;
    REQUIRE(r.load_text("Option \"bool forcediffuse\" true\nOption \"bool disablepixeljitter\" false\n" + v4_head +
                        "Attribute \"lamp\" \"rgb L\" [2 2 2]\nShape \"sphere\"\n") == 1);
    INFO(r.all_reports());
    CHECK(r.reports("Option \"bool forcediffuse\": it is not followed"));
    CHECK_FALSE(r.reports("\"bool disablepixeljitter\": it is not followed"));
    CHECK(r.reports("Attribute \"lamp\": pbrt has attributes of"));
}
