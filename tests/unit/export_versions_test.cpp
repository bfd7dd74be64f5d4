// SPDX-License-Identifier: Apache-2.0
// From one version of pbrt to the other: common features are written in the other's syntax, sampling settings are no
// loss, and the rest is named in the report.
#include "export_scene.hpp"
#include "io/import.hpp"

#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <fstream>

using namespace restage;
using namespace restage::scene;
using Catch::Matchers::ContainsSubstring;
using test::Folder, test::Plugins, test::version;

namespace {

struct Converted {
    std::string text, report;
};

Converted converted(const Plugins& plugins, const std::string& text, const char* to) {
    Folder folder, out;
    std::ofstream(folder.file("in.pbrt"), std::ios::binary) << text;
    const auto scene = io::import_scene(folder.file("in.pbrt"), plugins.registry);
    if (!scene) FAIL(scene.error().message);
    const auto done = io::export_scene(scene->scene, out.file("out.pbrt"), plugins.registry, version(to));
    if (!done) FAIL(done.error().message);
    Converted all{read_file(out.path / "out.pbrt").value(), ""};
    for (const auto& entry : done->entries)
        all.report += entry.what + ": " + entry.note + "\n";
    return all;
}

const std::string camera = "Camera \"perspective\" \"float shutteropen\" 0 \"float shutterclose\" .5\n";

} // namespace

TEST_CASE("samplers, integrators and shutters are written in the other version's syntax", "[export]") {
    Plugins plugins;
    const auto v4 =
        converted(plugins,
                  "Film \"image\" \"float diagonal\" 20\nSampler \"02sequence\" \"integer pixelsamples\" 64\n"
                  "Integrator \"bdpt\" \"integer maxdepth\" 7 \"bool visualizestrategies\" \"false\"\n"
                  "Accelerator \"kdtree\"\n" +
                      camera + "WorldBegin\nWorldEnd\n",
                  "v4");
    INFO(v4.text);
    CHECK(v4.report == "");
    for (const char* part :
         {"Sampler \"paddedsobol\" \"integer pixelsamples\" [ 64 ]", "Integrator \"bdpt\" \"integer maxdepth\" [ 7 ]",
          "\"float shutterclose\" [ 0.5 ]", "\"float diagonal\" [ 20 ]", "Accelerator \"kdtree\"",
          "\"float iso\" [ 200 ]"}) // pbrt-v4 exposes half as long
        CHECK_THAT(v4.text, ContainsSubstring(part));
    CHECK_THAT(v4.text, !ContainsSubstring("visualize"));
    const auto v3 = converted(plugins,
                              "Film \"rgb\"\nSampler \"zsobol\" \"integer pixelsamples\" 64\n"
                              "Integrator \"volpath\" \"string lightsampler\" \"power\"\n" +
                                  camera + "WorldBegin\n",
                              "v3");
    INFO(v3.text);
    CHECK(v3.report == "");
    CHECK_THAT(v3.text, ContainsSubstring("Sampler \"sobol\" \"integer pixelsamples\" [ 64 ]"));
    CHECK_THAT(v3.text, ContainsSubstring("Integrator \"volpath\" \"integer maxdepth\" [ 5 ]"));
    CHECK(converted(plugins, "Film \"rgb\"\nWorldBegin\n", "v3").report == ""); // defaults are not lost
}

TEST_CASE("settings that the other version lacks are named", "[export]") {
    Plugins plugins;
    const auto v4 = converted(
        plugins, "Film \"image\" \"float maxsampleluminance\" 9\nIntegrator \"directlighting\"\nWorldBegin\nWorldEnd\n",
        "v4");
    CHECK_THAT(v4.report, ContainsSubstring("Integrator \"directlighting\""));
    CHECK_THAT(v4.report, ContainsSubstring("maxsampleluminance"));
    CHECK_THAT(v4.text, ContainsSubstring("Integrator \"volpath\""));
    const auto v3 = converted(
        plugins,
        "Option \"string rendercoordsys\" \"world\"\nFilm \"rgb\"\nIntegrator \"path\" \"bool regularize\" true\n"
        "WorldBegin\n",
        "v3");
    CHECK_THAT(v3.report, ContainsSubstring("Option"));
    CHECK_THAT(v3.report, ContainsSubstring("regularize"));
    CHECK_THAT(v3.text, ContainsSubstring("Integrator \"path\""));
}

TEST_CASE("texture filtering settings are no loss", "[export]") {
    Plugins plugins;
    const auto v4 = converted(plugins,
                              "Film \"image\"\nWorldBegin\nTexture \"c\" \"color\" \"checkerboard\" \"string aamode\" "
                              "\"none\"\nMaterial \"matte\" \"texture Kd\" \"c\"\nShape \"sphere\"\nWorldEnd\n",
                              "v4");
    CHECK(v4.report == "");
}

TEST_CASE("a product of two colours is preserved", "[export]") {
    Plugins plugins;
    const auto v4 = converted(plugins,
                              "Film \"image\"\nWorldBegin\nTexture \"s\" \"color\" \"scale\" \"rgb tex1\" [.5 .25 1]\n"
                              "\"rgb tex2\" [.5 1 .25]\nMaterial \"matte\" \"texture Kd\" \"s\"\nShape \"sphere\"\n"
                              "WorldEnd\n",
                              "v4");
    CHECK(v4.report == "");
    CHECK_THAT(v4.text, ContainsSubstring("\"rgb tex\" [ 0.25 0.25 0.25 ]"));
}

TEST_CASE("pbrt-v3 gets its booleans in quotes, v4 without", "[export]") {
    Plugins plugins;
    const std::string material = "Material \"disney\" \"bool thin\" ", shape = "\nShape \"sphere\"\nWorldEnd\n",
                      curve =
                          "Shape \"loopsubdiv\" \"bool quiet\" \"true\" \"point P\" [0 0 0 1 0 0 0 1 0] \"integer "
                          "indices\" [0 1 2]\n";
    const auto v3 = converted(plugins,
                              "Film \"image\"\nIntegrator \"bdpt\" \"bool visualizestrategies\" \"true\"\nSampler "
                              "\"halton\" \"bool samplepixelcenter\" \"true\"\nWorldBegin\n" +
                                  curve + material + "\"true\"" + shape,
                              "v3");
    INFO(v3.text);
    CHECK_THAT(v3.text, !ContainsSubstring("[ true ]"));
    CHECK_THAT(v3.text, ContainsSubstring("\"bool thin\" [ \"true\" ]"));
    CHECK_THAT(v3.text, ContainsSubstring("\"bool samplepixelcenter\" [ \"true\" ]"));
    CHECK_THAT(v3.text, ContainsSubstring("\"bool quiet\" [ \"true\" ]"));
    const auto v4 = converted(plugins,
                              "Film \"rgb\" \"bool savefp16\" false\nWorldBegin\nMaterial \"subsurface\" \"bool "
                              "remaproughness\" false\nShape \"sphere\"\n",
                              "v4");
    CHECK_THAT(v4.text, ContainsSubstring("\"bool savefp16\" [ false ]"));
    CHECK_THAT(v4.text, !ContainsSubstring("\"false\""));
}

TEST_CASE("a coloured scale of a sky's picture goes into the picture for pbrt-v4", "[export]") {
    Plugins plugins;
    Folder folder, out;
    std::string pfm = "PF\n2 1\n-1\n";
    const float texels[6] = {1, 1, 1, 1, 1, 1};
    pfm.append(reinterpret_cast<const char*>(texels), sizeof texels);
    std::ofstream(folder.file("sky.pfm"), std::ios::binary) << pfm;
    std::ofstream(folder.file("in.pbrt"), std::ios::binary)
        << "Film \"image\"\nWorldBegin\nLightSource \"infinite\" \"string mapname\" \"sky.pfm\" \"rgb L\" [1 2 "
           "4]\nWorldEnd\n";
    const auto scene = io::import_scene(folder.file("in.pbrt"), plugins.registry);
    REQUIRE(scene);
    const auto done = io::export_scene(scene->scene, out.file("out.pbrt"), plugins.registry, version("v4"));
    REQUIRE(done);
    for (const auto& entry : done->entries)
        CHECK_THAT(entry.note, !ContainsSubstring("luminance of its coloured scale"));
    const auto again = io::import_scene(out.file("out.pbrt"), plugins.registry);
    REQUIRE(again);
    REQUIRE(again->scene.images.size() == 1);
    const Image* image = again->scene.images.find(Id<Image>{1});
    REQUIRE(image);
    REQUIRE(image->data);
    const float* first = image->data->values.data();
    CHECK(std::abs(first[2] / first[0] - 4) < 0.01f);
    CHECK(std::abs(first[1] / first[0] - 2) < 0.01f);
}

TEST_CASE("shapes are written with their effective values", "[export]") {
    Plugins plugins;
    const std::string v3 = "Film \"image\"\nWorldBegin\n", v4 = "Film \"rgb\"\nWorldBegin\n";
    const std::string wrong =
        v3 + "Shape \"sphere\" \"integer radius\" 3\nShape \"sphere\" \"integer radius\" 3\nWorldEnd\n";
    const auto other = converted(plugins, wrong, "v4");
    INFO(other.text);
    CHECK_THAT(other.text, !ContainsSubstring("Shape \"sphere\" \"integer radius\""));
    CHECK_THAT(other.report, ContainsSubstring("\"integer radius\" [ 3 ]"));
    const auto same = converted(plugins, wrong, "v3"); // both keep it, as pbrt warns of it
    const auto first = same.text.find("\"integer radius\" [ 3 ]");
    REQUIRE(first != std::string::npos);
    CHECK(same.text.find("\"integer radius\" [ 3 ]", first + 1) != std::string::npos);
    const auto twice = converted(plugins, v4 + "Shape \"sphere\" \"float radius\" 1 \"float radius\" 2\n", "v4");
    CHECK_THAT(twice.text, ContainsSubstring("Shape \"sphere\" \"float radius\" [ 2 ]\n"));
    const auto attribute =
        converted(plugins, v4 + "Attribute \"shape\" \"float radius\" 1\nShape \"sphere\" \"float radius\" 2\n", "v4");
    CHECK_THAT(attribute.text, ContainsSubstring("Shape \"sphere\" \"float radius\" [ 2 ]\n"));
}

TEST_CASE("missing files keep their names wherever they are named", "[export]") {
    Plugins plugins;
    const auto v4 =
        converted(plugins,
                  "Include \"gone.pbrt\"\nFilm \"rgb\"\nCamera \"realistic\" \"string lensfile\" \"gone.dat\"\n"
                  "WorldBegin\n"
                  "LightSource \"infinite\" \"spectrum L\" \"sky.spd\"\n"
                  "LightSource \"point\" \"spectrum I\" \"lamp.spd\"\n"
                  "MakeNamedMedium \"m\" \"string type\" \"nanovdb\" \"string filename\" \"gone.nvdb\"\n"
                  "Material \"conductor\" \"spectrum eta\" \"eta.spd\" \"spectrum k\" \"k.spd\"\n"
                  "MediumInterface \"m\" \"\"\n"
                  "AreaLightSource \"diffuse\" \"string filename\" \"gone.exr\"\nShape \"sphere\"\n"
                  "Material \"measured\" \"string filename\" \"gone.bsdf\"\nShape \"sphere\"\n",
                  "v4");
    INFO(v4.text);
    INFO(v4.report);
    for (const char* name :
         {"gone.pbrt", "gone.dat", "sky.spd", "lamp.spd", "gone.nvdb", "eta.spd", "k.spd", "gone.exr", "gone.bsdf"}) {
        INFO(name);
        CHECK_THAT(v4.text, ContainsSubstring("\"" + std::string(name) + "\""));
        CHECK_THAT(v4.report, ContainsSubstring(name));
    }
    CHECK_THAT(v4.report, !ContainsSubstring("colour space"));
}

TEST_CASE("lamps with null surfaces, and lamps of alpha 0, emit in the other version", "[export]") {
    Plugins plugins;
    const std::string lamp =
        "AttributeBegin\nMaterial \"none\"\nAreaLightSource \"diffuse\" \"rgb L\" [5 5 5]\nShape "
        "\"sphere\"\nAttributeEnd\n";
    const auto v4 = converted(plugins, "Film \"image\"\nWorldBegin\n" + lamp + "WorldEnd\n", "v4");
    INFO(v4.text);
    CHECK_THAT(v4.text, ContainsSubstring("AreaLightSource \"diffuse\" \"rgb L\" [ 5 5 5 ]"));
    CHECK_THAT(v4.text, ContainsSubstring("Material \"diffuse\"\n        Shape \"sphere\" \"float alpha\" [ 0 ]") ||
                            ContainsSubstring("Material \"diffuse\"\n    Shape \"sphere\" \"float alpha\" [ 0 ]"));
    CHECK_THAT(v4.report, ContainsSubstring("emits, and is invisible"));
    const auto zero =
        converted(plugins,
                  "Film \"rgb\"\nWorldBegin\nTexture \"a\" \"float\" \"constant\" \"float value\" 0\n"
                  "AreaLightSource \"diffuse\" \"rgb L\" [5 5 5]\nShape \"sphere\" \"texture alpha\" \"a\"\n",
                  "v4");
    CHECK(zero.report == "");
}

TEST_CASE("shadowalpha is written back", "[export]") {
    Plugins plugins;
    const auto v3 =
        converted(plugins,
                  "Film \"image\"\nWorldBegin\nShape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0] \"integer "
                  "indices\" [0 1 2] \"float shadowalpha\" 0\nWorldEnd\n",
                  "v3");
    CHECK(v3.report == "");
    CHECK_THAT(v3.text, ContainsSubstring("\"float shadowalpha\" [ 0 ]"));
}

TEST_CASE("a texture of an unknown class without parameters is written back", "[export]") {
    Plugins plugins;
    const auto v3 = converted(plugins,
                              "Film \"image\"\nWorldBegin\nTexture \"t\" \"color\" \"fractal\"\nMaterial \"matte\" "
                              "\"texture Kd\" \"t\"\nShape \"sphere\"\nWorldEnd\n",
                              "v3");
    CHECK_THAT(v3.text, ContainsSubstring("Texture \"t\" \"spectrum\" \"fractal\""));
    CHECK(v3.report == "");
}
