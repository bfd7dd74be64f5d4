// SPDX-License-Identifier: Apache-2.0
// Materials, textures, lights, camera and film: effective values with the defaults of each version, and the report.
#include "pbrt_writer.hpp"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <numbers>

using restage::pbrt::test::Folder;
using restage::pbrt::test::Named;
using restage::pbrt::test::Recorder;

namespace {

Recorder loaded(const std::string& text) {
    Recorder r;
    const int ok = r.load_text(text);
    INFO(r.error.message << " line " << r.error.line);
    REQUIRE(ok == 1);
    return r;
}

const std::string v4 = "Film \"rgb\"\nWorldBegin\n", v3 = "Film \"image\"\nWorldBegin\n";

Named material(const std::string& head, const std::string& line) {
    const Recorder r = loaded(head + "Material " + line);
    REQUIRE(r.materials.size() == 1);
    return r.materials[0];
}

void check_value(const Named& m, const char* id, std::initializer_list<double> expected) {
    INFO(m.type << "." << id);
    REQUIRE(m.values.count(id));
    std::size_t i = 0;
    for (const double value : expected)
        CHECK(m.values.at(id).v[i++] == Catch::Approx(value).margin(1e-6));
}

void check_choice(const Named& m, const char* id, const char* expected) {
    INFO(m.type << "." << id);
    REQUIRE(m.values.count(id));
    CHECK(m.values.at(id).text == expected);
}

} // namespace

TEST_CASE("pbrt materials: v4 defaults and roughness", "[pbrt]") {
    Named m = material(v4, "\"diffuse\"");
    CHECK(m.type == "diffuse");
    check_value(m, "reflectance", {0.5, 0.5, 0.5});
    check_value(m, "sigma", {0});
    m = material(v4, "\"coateddiffuse\" \"float uroughness\" 0.2");
    check_value(m, "uroughness", {0.2});
    check_value(m, "vroughness", {0});
    check_value(m, "thickness", {0.01});
    check_value(m, "eta", {1.5});
    check_value(m, "max_depth", {10});
    check_value(m, "n_samples", {1});
    check_choice(m, "remap", "v4");
    m = material(v4, "\"conductor\" \"float roughness\" 0.3 \"bool remaproughness\" false");
    check_value(m, "vroughness", {0.3});
    check_choice(m, "remap", "none");
    check_value(m, "use_reflectance", {0});
    CHECK(m.values.at("k").v[0] > m.values.at("k").v[2]); // copper
    m = material(v4, "\"conductor\" \"rgb reflectance\" [ .9 .8 .7 ]");
    check_value(m, "use_reflectance", {1});
    check_value(m, "reflectance", {0.9, 0.8, 0.7});
    m = material(v4, "\"dielectric\" \"spectrum eta\" \"glass-BK7\"");
    check_value(m, "eta", {1.5168});
    CHECK(m.verbatim.starts_with("=eta \"spectrum eta\" [ \"glass-BK7\" ]\n=spectrum:eta 1.5168"));
    check_value(m, "thin", {0});
    CHECK(material(v4, "\"thindielectric\"").values.at("thin").v[0] == 1);
    m = material(v4, "\"diffusetransmission\" \"float scale\" 2");
    check_value(m, "reflectance", {0.5, 0.5, 0.5});
    check_value(m, "transmittance", {0.5, 0.5, 0.5});
    m = material(v4,
                 "\"coatedconductor\" \"float interface.roughness\" 0.1 \"rgb conductor.eta\" [ 1 2 3 ] \"rgb "
                 "conductor.k\" [ 3 2 1 ]");
    check_value(m, "interface_uroughness", {0.1});
    check_value(m, "conductor_eta", {1, 2, 3});
    check_value(m, "conductor_k", {3, 2, 1});
    check_value(m, "conductor_uroughness", {0});
    CHECK(material(v4, "\"interface\"").type == "interface");
    CHECK(material(v3, "\"\"").type == "interface");
}

TEST_CASE("pbrt materials: v3 names, defaults and meanings", "[pbrt]") {
    Named m = material(v3, "\"matte\" \"float sigma\" 20");
    CHECK(m.type == "diffuse");
    check_value(m, "sigma", {20});
    m = material(v3, "\"plastic\"");
    check_value(m, "kd", {0.25, 0.25, 0.25});
    check_value(m, "roughness", {0.1});
    check_choice(m, "remap", "v3");
    m = material(v3, "\"metal\"");
    CHECK(m.type == "conductor");
    check_value(m, "uroughness", {0.01});
    CHECK(std::abs(m.values.at("eta").v[0] - 0.2004f) < 5e-3f); // v3's own averages of copper
    m = material(v3, "\"glass\" \"float index\" 1.33 \"rgb Kt\" [ .5 .5 .5 ]");
    check_value(m, "eta", {1.33});
    check_value(m, "reflectance", {1, 1, 1});
    check_value(m, "transmittance", {0.5, 0.5, 0.5});
    check_value(material(v3, "\"mirror\""), "kr", {0.9, 0.9, 0.9});
    check_value(material(v3, "\"substrate\" \"bool remaproughness\" \"false\""), "ks", {0.5, 0.5, 0.5});
    m = material(
        v3,
        "\"disney\" \"rgb color\" [ .2 .4 .6 ] \"float anisotropic\" 1 \"float metallic\" 0.75 \"float sheen\" 0.5");
    CHECK(m.type == "principled");
    check_value(m, "base_color", {0.2f, 0.4f, 0.6f});
    check_value(m, "metallic", {0.75});
    // pbrt-v3's widths, 0.25 / sqrt(0.1) and 0.25 * sqrt(0.1), through KHR_materials_anisotropy's mix(a, 1, s^2)
    const double across = std::pow(m.values.at("roughness").v[0], 2), s = m.values.at("anisotropy").v[0];
    CHECK(std::abs(across - 0.0790569) < 1e-5);
    CHECK(std::abs(across + (1 - across) * s * s - 0.790569) < 1e-5);
    check_value(m, "clearcoat", {0});
    m = material(v3, "\"uber\" \"float vroughness\" 0.4 \"rgb opacity\" [ .2 .2 .2 ]");
    check_value(m, "uroughness", {0.1});
    check_value(m, "vroughness", {0.4});
    check_value(m, "kr", {0, 0, 0});
    check_value(m, "opacity", {0.2, 0.2, 0.2});
    check_value(material(v3, "\"translucent\""), "transmit", {0.5, 0.5, 0.5});
    // v3's amount weighs the first, the host's the second: they are swapped.
    const Recorder r =
        loaded(v3 +
               "MakeNamedMaterial \"a\" \"string type\" \"matte\" MakeNamedMaterial \"b\" \"string type\" \"mirror\"\n"
               "Material \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\" \"rgb amount\" [ .25 "
               ".25 .25 ]");
    CHECK(r.materials[2].values.at("first").ref == 2);
    CHECK(r.materials[2].values.at("second").ref == 1);
    CHECK(r.materials[2].values.at("amount").v[0] == Catch::Approx(0.25).margin(1e-6));
}

TEST_CASE("pbrt materials: approximated ones are written back whole, unknown parameters are kept", "[pbrt]") {
    const Recorder r = loaded(
        v4 +
        "MakeNamedMaterial \"skin\" \"string type\" \"subsurface\" \"float mfp\" 3 \"rgb reflectance\" [ .7 .4 .3 ]\n"
        "MakeNamedMaterial \"odd\" \"string type\" \"diffuse\" \"float wetness\" 0.5\nMaterial \"velvet\"\n"
        "MakeNamedMaterial \"paint\" \"string type\" \"measured\" \"string filename\" \"p.bsdf\"");
    CHECK(r.materials[0].type == "coateddiffuse");
    // Under a smooth coat of index 1.33 a fraction of 0.472 is reflected back inside (Egan and Hilgeman 1973): 0.7 / (1
    // - 0.3 * 0.472).
    CHECK(std::abs(r.materials[0].values.at("reflectance").v[0] - 0.8155f) < 1e-3f);
    CHECK(r.materials[0].verbatim ==
          "=* \"string type\" [ \"subsurface\" ]\n=* \"float mfp\" [ 3 ]\n=* \"rgb reflectance\" [ 0.7 0.4 0.3 ]\n");
    CHECK(r.materials[1].verbatim == "\"float wetness\" [ 0.5 ]\n");
    CHECK(r.reports("material \"odd\": parameter \"float wetness\""));
    CHECK(r.materials[2].type == "diffuse");
    CHECK(r.reports("Material \"velvet\" (velvet): there is no such material"));
    CHECK(r.reports("material \"skin\" (subsurface)"));
    bool approximated = false;
    for (const auto& line : r.lines)
        approximated |= line.fate == RESTAGE_APPROXIMATED && line.what.find("paint") != std::string::npos &&
                        line.note.find("data of RGL (.bsdf) is not read") != std::string::npos;
    CHECK(approximated);
    for (const auto& line : r.lines)
        if (line.what.find("odd") != std::string::npos) CHECK(line.line == 4);
}

TEST_CASE("pbrt textures: encodings, scaling, classes shown as their average", "[pbrt]") {
    const Folder folder;
    for (const char* name : {"a.png", "a.tga", "a.exr", "a.jpg"})
        folder.file(name, "x");
    const auto run = [&](const std::string& text) {
        Recorder r;
        REQUIRE(r.load_file(folder.file("s.pbrt", text)) == 1);
        return r;
    };
    const std::string map = "\"imagemap\" \"string filename\" ";
    Recorder r = run(v4 + "Texture \"a\" \"spectrum\" " + map + "\"a.png\"\nTexture \"b\" \"float\" " + map +
                     "\"a.png\" \"string encoding\" \"linear\" \"bool invert\" true\n"
                     "Texture \"c\" \"spectrum\" " +
                     map + "\"a.tga\" \"string encoding\" \"linear\"\nTexture \"d\" \"spectrum\" " + map +
                     "\"a.png\" \"string encoding\" \"gamma 1.8\" \"float scale\" 2 \"string wrap\" \"clamp\" \"float "
                     "uscale\" 3 \"float vdelta\" 0.5\n"
                     "Texture \"e\" \"spectrum\" " +
                     map +
                     "\"missing.png\" Material \"diffuse\" \"texture reflectance\" \"e\" \"texture displacement\" "
                     "\"b\" \"string normalmap\" \"a.png\"");
    REQUIRE(r.textures.size() == 6);
    CHECK(r.images[0].encoding == RESTAGE_SRGB);
    CHECK(r.images[1].encoding == RESTAGE_LINEAR);
    CHECK(r.images[2].encoding == RESTAGE_SRGB); // TGA is always sRGB in v4
    CHECK(r.images[3].encoding == RESTAGE_GAMMA);
    CHECK(r.images[3].gamma == 1.8f);
    CHECK(r.textures[1].is_float);
    CHECK(r.textures[1].values.at("invert").v[0] == 1);
    CHECK(r.textures[3].values.at("scale").v[0] == 2);
    CHECK(r.textures[3].values.at("wrap").text == "clamp");
    CHECK(r.textures[3].values.at("uscale").v[0] == 3);
    CHECK(r.textures[3].values.at("vdelta").v[0] == 0.5f);
    CHECK(r.reports("image \"missing.png\": there is no such file"));
    CHECK(r.materials[0].values.at("bump").ref == 2);
    const Named& normal = r.textures[r.materials[0].values.at("normalmap").ref - 1];
    CHECK(r.images[normal.image - 1].encoding == RESTAGE_LINEAR);
    CHECK(r.reports("\"normalmap\" of a material: where it turns a normal away from the viewer"));

    r = run(v3 + "Texture \"a\" \"color\" " + map + "\"a.tga\"\nTexture \"b\" \"spectrum\" " + map +
            "\"a.tga\" \"bool gamma\" \"false\"\nTexture \"c\" \"float\" " + map +
            "\"a.jpg\"\nTexture \"s\" \"spectrum\" \"scale\" \"texture tex1\" \"a\" \"rgb tex2\" [ .5 .5 .5 ]\nTexture "
            "\"k\" \"spectrum\" \"checkerboard\" \"texture tex1\" \"s\" \"float uscale\" 8\n"
            "Texture \"m\" \"float\" \"mix\" \"float tex1\" 1 \"texture tex2\" \"c\" \"float amount\" .25");
    CHECK(r.images[0].encoding == RESTAGE_SRGB);
    CHECK(r.images[1].encoding == RESTAGE_LINEAR);
    CHECK(r.images[2].encoding == RESTAGE_LINEAR); // v3: gamma only of TGA and PNG by default
    CHECK(r.textures[3].values.at("tex").ref == 1);
    CHECK(r.textures[3].values.at("scale").v[1] == 0.5f);
    CHECK(r.textures[4].values.at("tex1").ref == 4);
    CHECK(r.textures[4].values.at("tex2").v[0] == 0);
    CHECK(r.textures[4].values.at("uscale").v[0] == 8);
    CHECK(r.textures[5].values.at("tex2").ref == 3);
    CHECK(r.textures[5].values.at("amount").v[0] == 0.25f);

    r = run(v4 +
            "Texture \"d\" \"spectrum\" \"dots\" \"rgb inside\" [ 1 0 0 ] \"rgb outside\" [ 0 0 1 ]\nTexture \"p\" "
            "\"spectrum\" \"checkerboard\" \"string mapping\" \"planar\"\n"
            "Material \"diffuse\" \"texture reflectance\" \"d\" \"texture displacement\" \"d\"");
    CHECK(r.textures[0].type == "dots");
    CHECK(r.textures[0].values.at("average").v[0] == 0.5f);
    CHECK(r.textures[0].values.at("inside").v[0] == 1);
    CHECK(r.textures[0].values.at("outside").v[2] == 1);
    CHECK(r.textures[1].values.at("mapping").text == "planar");
    CHECK(r.reports("Texture \"d\" (dots): shades as the average"));
    CHECK(r.reports("mapping \"planar\""));
    CHECK(r.materials[0].values.at("reflectance").ref == 1);
    CHECK(r.materials[0].values.count("bump") == 0);
    CHECK(r.reports("it is a spectrum texture where a float one is needed"));
}

TEST_CASE("pbrt lights: values in both versions", "[pbrt]") {
    using std::numbers::pi;
    Recorder r = loaded(
        v4 +
        "LightSource \"point\" \"rgb I\" [ 1 2 3 ] \"float scale\" 2 \"point3 from\" [ 1 2 3 ]\n"
        "LightSource \"point\" \"blackbody I\" 6500 \"float scale\" 10\nLightSource \"point\" \"float power\" 100\n"
        "LightSource \"distant\" \"rgb L\" [ 1 1 1 ] \"float illuminance\" 5 \"point3 from\" [ 0 0 0 ] \"point3 to\" [ "
        "2 0 0 ]\n"
        "Translate 0 0 7 LightSource \"spot\" \"rgb I\" [ 4 4 4 ] \"float coneangle\" 40 \"point3 to\" [ 0 -1 0 ]\n"
        "LightSource \"goniometric\" LightSource \"projection\" \"float fov\" 60 LightSource \"laser\"");
    REQUIRE(r.raw_lights.size() == 7);
    CHECK(r.raw_lights[0].value[1] == 4);
    CHECK(r.raw_lights[0].light_to_world[12] == 1);
    // A blackbody light has luminance 1 times its scale.
    const float* w = r.raw_lights[1].value;
    CHECK(0.2126 * double(w[0]) + 0.7152 * double(w[1]) + 0.0722 * double(w[2]) == Catch::Approx(10).epsilon(1e-3));
    CHECK(r.raw_lights[2].value[0] == Catch::Approx(100 / (4 * pi)));
    CHECK(r.raw_lights[3].kind == RESTAGE_LIGHT_DISTANT);
    CHECK(r.raw_lights[3].value[0] == 5);
    CHECK(r.raw_lights[3].light_to_world[8] == Catch::Approx(1)); // the light travels along its +z
    CHECK(r.raw_lights[4].kind == RESTAGE_LIGHT_SPOT);
    CHECK(r.raw_lights[4].cone_angle == 40);
    CHECK(r.raw_lights[4].cone_delta == 5);
    CHECK(r.raw_lights[4].light_to_world[9] == Catch::Approx(-1));
    CHECK(r.raw_lights[4].light_to_world[14] == 7);
    CHECK(r.reports("LightSource \"goniometric\""));
    CHECK(r.reports("LightSource \"laser\": there is no such light"));

    r = loaded(v3 +
               "LightSource \"point\" \"rgb I\" [ 1 2 3 ] \"rgb scale\" [ 2 3 4 ] LightSource \"point\" \"blackbody "
               "I\" [ 6500 2 ]");
    CHECK(r.raw_lights[0].value[2] == 12);
    CHECK(r.raw_lights[1].value[1] > 1.7f); // relative to a peak of 1 at 446 nm
    CHECK(r.raw_lights[1].value[1] < 2);
}

TEST_CASE("pbrt lights: area lights", "[pbrt]") {
    using std::numbers::pi;
    const std::string square = "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 2 0 0 0 2 0 2 2 0 ]\n";
    Recorder r = loaded(
        v4 +
        "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [ 1 2 3 ] \"float scale\" 2 \"bool twosided\" true\n" +
        square + "AttributeEnd\n" + square + "AreaLightSource \"diffuse\" \"float power\" 50 Scale 3 3 3\n" + square +
        "AreaLightSource \"\"\n" + square + "AreaLightSource \"diffuse\" Material \"interface\"\n" + square);
    REQUIRE(r.instances.size() == 5);
    CHECK(r.instances[0].raw.flags == (RESTAGE_INSTANCE_EMITS | RESTAGE_INSTANCE_TWO_SIDED));
    CHECK(r.instances[0].raw.emission[2] == 6);
    CHECK(r.instances[1].raw.flags == 0);
    CHECK(r.instances[2].raw.emission[0] == Catch::Approx(50 / (36 * pi)));
    CHECK(r.instances[3].raw.flags == 0);
    CHECK(r.instances[4].raw.flags == 0);
    CHECK(r.reports("AreaLightSource on an interface"));
    r = loaded(
        v3 +
        "AreaLightSource \"area\" \"rgb L\" [ 1 1 1 ] \"rgb scale\" [ 1 2 3 ] \"integer nsamples\" 4 Shape \"sphere\"");
    CHECK(r.instances[0].raw.emission[1] == 2);
    CHECK_FALSE(r.reports("nsamples")); // changes nothing in the picture
}

TEST_CASE("pbrt lights: environments", "[pbrt]") {
    const Folder folder;
    folder.file("sky.exr", "x");
    const auto run = [&](const std::string& text) {
        Recorder r;
        REQUIRE(r.load_file(folder.file("s.pbrt", text)) == 1);
        return r;
    };
    Recorder r = run(v4 +
                     "Rotate 90 0 0 1 LightSource \"infinite\" \"string filename\" \"sky.exr\" \"float scale\" 3 "
                     "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]");
    REQUIRE(r.environments.size() == 1);
    CHECK(r.environments[0].mapping == RESTAGE_OCTAHEDRAL);
    CHECK(r.environments[0].scale[0] == 3);
    CHECK(r.environments[0].light_to_world[1] == Catch::Approx(1));
    CHECK(r.reports("there is one environment only"));
    r = run(v3 + "LightSource \"infinite\" \"string mapname\" \"sky.exr\" \"rgb L\" [ 1 2 3 ] \"rgb scale\" [ 2 2 2 ]");
    CHECK(r.environments[0].mapping == RESTAGE_EQUIRECT);
    CHECK(r.environments[0].scale[2] == 6);
    CHECK(r.images[0].encoding == RESTAGE_LINEAR);
    r = run(v4 +
            "LightSource \"infinite\" \"rgb L\" [ 1 2 3 ] LightSource \"infinite\" \"float illuminance\" 3.14159265 "
            "LightSource \"infinite\" \"string filename\" \"gone.exr\"");
    REQUIRE(r.environments.size() == 1);
    CHECK(r.environments[0].image == 0);
    CHECK(r.environments[0].scale[0] == Catch::Approx(2).epsilon(1e-5));
    CHECK(r.environments[0].scale[2] == Catch::Approx(4).epsilon(1e-5));
    CHECK(r.reports("added to the environment before it"));
    CHECK(r.reports("gone.exr"));
    CHECK(loaded(v4).environments.empty());
}

TEST_CASE("pbrt camera, film and settings", "[pbrt]") {
    Recorder r = loaded(
        "LookAt 1 2 3 1 2 0 0 1 0\nCamera \"perspective\" \"float fov\" 30 \"float lensradius\" 0.1 \"float "
        "focaldistance\" 4 \"float screenwindow\" [ -1 2 -3 4 ]\n"
        "Film \"rgb\" \"integer xresolution\" 30 \"integer yresolution\" 20 \"integer pixelbounds\" [ 3 15 0 10 ] "
        "\"float iso\" 200 \"float maxcomponentvalue\" 10 \"string sensor\" \"nikon_d850\"\n"
        "PixelFilter \"mitchell\" \"float xradius\" 3 Integrator \"path\" \"integer maxdepth\" 9 \"bool regularize\" "
        "true\n"
        "Sampler \"stratified\" \"integer xsamples\" 3 Option \"disablepixeljitter\" true WorldBegin");
    const RestageCamera& c = r.raw_cameras.at(0);
    CHECK(c.camera_to_world[14] == 3);
    CHECK(c.camera_to_world[10] == -1); // looks along -z of the world
    CHECK(c.fov == 30);
    CHECK(c.lens_radius == 0.1f);
    CHECK(c.screen_window[3] == 4);
    CHECK(r.film.width == 30);
    CHECK(r.film.crop[0] == 0.1f);
    CHECK(r.film.crop[3] == 0.5f);
    CHECK(r.film.exposure == 2);
    CHECK(r.film_filter == "mitchell");
    CHECK(r.film.filter_radius[0] == 3);
    CHECK(r.film.filter_radius[1] == 2);
    CHECK(r.settings.max_depth == 9);
    CHECK(r.settings.samples == 12);
    for (const char* part :
         {"Integrator \"path\" \"integer maxdepth\" [ 9 ] \"bool regularize\" [ true ]", "Sampler \"stratified\"",
          "Option \"disablepixeljitter\" true", "Film \"float maxcomponentvalue\" [ 10 ]"})
        CHECK(r.settings_text.find(part) != std::string::npos);
    CHECK(r.reports("Film sensor \"nikon_d850\""));

    r = loaded(v4); // v4's defaults
    CHECK(r.film.width == 1280);
    CHECK(r.film.height == 720);
    CHECK(r.film_filter == "gaussian");
    CHECK(r.film.filter_radius[0] == 1.5f);
    CHECK(r.film.filter_params[0] == 0.5f);
    CHECK(r.settings.max_depth == 5);
    CHECK(r.raw_cameras.at(0).fov == 90);
    CHECK(r.reports("Camera: the file has none"));
    r = loaded(
        "Film \"image\" \"float scale\" 3 \"float cropwindow\" [ 0.5 0 0 1 ] PixelFilter \"gaussian\" Camera "
        "\"perspective\" \"float halffov\" 20 Sampler \"random\" WorldBegin WorldEnd");
    CHECK(r.film.exposure == 3);
    CHECK(r.film.crop[0] == 0);
    CHECK(r.film.crop[1] == 0.5f);
    CHECK(r.film.filter_radius[0] == 2);
    CHECK(r.film.filter_params[0] == 0.5f); // alpha = 2
    CHECK(r.raw_cameras.at(0).fov == 40);
    CHECK(r.settings.samples == 4);
    CHECK(loaded("Film \"image\" WorldBegin WorldEnd").film_filter == "box");
    for (const char* kind : {"realistic", "fisheye"})
        CHECK(
            loaded("Camera \"" + std::string(kind) + "\" WorldBegin").reports("Camera \"" + std::string(kind) + "\""));
}

TEST_CASE("pbrt camera: a realistic one has the angle of its lenses", "[pbrt]") {
    const Folder folder;
    // A thin symmetric lens of R = 50 mm and n = 1.5 with a stop of 4 mm: f = R / (2 (n - 1)) = 50 mm.
    folder.file("thin.dat", "# radius thickness eta aperture\n50 0 1.5 30\n-50 5 0 30\n0 5 0 4\n");
    const auto camera = [&](const char* params) {
        Recorder r;
        REQUIRE(r.load_file(folder.file("s.pbrt", "Camera \"realistic\" " + std::string(params) +
                                                      "\nFilm \"rgb\" \"integer xresolution\" 400 \"integer "
                                                      "yresolution\" 300 \"float diagonal\" 25\nWorldBegin\n")) == 1);
        CHECK(r.reports("Camera \"realistic\""));
        return r.raw_cameras.at(0);
    };
    const RestageCamera thin = camera(
        "\"string lensfile\" \"thin.dat\" \"float aperturediameter\" 10 \"float "
        "focusdistance\" 2");
    CHECK(double(thin.fov) ==
          Catch::Approx(2 * std::atan(7.5 / 50) * 180 / std::numbers::pi)); // 15 mm is the shorter side
    CHECK(thin.lens_radius == Catch::Approx(0.002));
    CHECK(thin.focal_distance == 2);
    CHECK(camera("\"string lensfile\" \"none.dat\"").fov == 45);
    folder.file("empty.dat", "1 2 3\n");
    CHECK(camera("\"string lensfile\" \"empty.dat\"").fov == 45);
}

TEST_CASE("pbrt report: the same thing is one line with a count and the first place", "[pbrt]") {
    std::string text = v4;
    for (int i = 0; i < 5; ++i)
        text += "Shape \"teapot\" \"point3 P\" [ 0 0 0 ]\n";
    const Recorder r = loaded(text + "NamedMaterial \"x\"\nNamedMaterial \"y\"\n");
    int teapots = 0;
    for (const auto& line : r.lines)
        if (line.what == "Shape \"teapot\"") {
            ++teapots;
            CHECK(line.line == 3);
            CHECK(line.fate == RESTAGE_DROPPED);
            CHECK(line.note.find("5 times") != std::string::npos);
        }
    CHECK(teapots == 1);
}

TEST_CASE("pbrt camera: orthographic and spherical ones are kept as such", "[pbrt]") {
    const auto camera = [](const std::string& text) {
        const Recorder r = loaded(text + " WorldBegin");
        for (const auto& line : r.lines) // a kept one determines the version
            CHECK((line.fate == RESTAGE_KEPT || !line.what.starts_with("Camera")));
        return r.raw_cameras.at(0);
    };
    const RestageCamera flat =
        camera("LookAt 0 0 5 0 0 0 0 1 0 Camera \"orthographic\" \"float screenwindow\" [ -5 5 -4 4 ]");
    CHECK(flat.projection == RESTAGE_ORTHOGRAPHIC);
    CHECK(flat.screen_window[1] == 5);
    CHECK(flat.camera_to_world[14] == 5); // at the file's position
    CHECK(camera("Camera \"spherical\"").projection == RESTAGE_SPHERICAL_EQUAL_AREA);
    CHECK(camera("Camera \"spherical\" \"string mapping\" \"equirectangular\"").projection == RESTAGE_SPHERICAL);
    CHECK(camera("Film \"image\" Camera \"environment\"").projection == RESTAGE_SPHERICAL);
}

TEST_CASE("pbrt lamps: alpha has the version's meaning", "[pbrt]") {
    const auto lamp = [](const std::string& head, const std::string& alpha, const std::string& shape) {
        const Recorder r =
            loaded(head +
                   " WorldBegin AreaLightSource \"diffuse\" Texture \"zero\" \"float\" \"constant\" "
                   "\"float value\" 0 Texture \"half\" \"float\" \"constant\" \"float value\" 0.5 Shape " +
                   shape + " " + alpha);
        REQUIRE(r.instances.size() == 1);
        return r.instances[0].raw;
    };
    const std::string v3 = "Film \"image\"", v4 = "Film \"rgb\"", ball = "\"sphere\"",
                      card = "\"trianglemesh\" \"point P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 ]",
                      card4 = "\"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 ]";
    constexpr std::uint32_t unseen = RESTAGE_INSTANCE_EMITS_UNSEEN, mask = RESTAGE_INSTANCE_ALPHA_MASK;
    const auto flags = [&](const RestageInstance& i) { return i.flags & (unseen | mask); };
    CHECK(flags(lamp(v4, "\"float alpha\" 0", ball)) == unseen);
    CHECK(flags(lamp(v4, "\"texture alpha\" \"zero\"", ball)) == unseen);
    CHECK(flags(lamp(v4, "\"texture alpha\" \"half\"", ball)) == 0);
    CHECK(flags(lamp(v4, "\"float alpha\" 0.5", card4)) == 0);
    CHECK(flags(lamp(v3, "\"float alpha\" 0.5", card)) == (mask | unseen));
    CHECK(flags(lamp(v3, "\"texture alpha\" \"zero\"", card)) == (mask | unseen));
    CHECK(lamp(v3, "\"float alpha\" 0", ball).alpha == 1); // v3 has it for triangles only
    const auto said = [&](const std::string& alpha) {
        return loaded(v4 + " WorldBegin AreaLightSource \"diffuse\" Shape \"sphere\" " + alpha)
            .reports("AreaLightSource on a Shape with alpha");
    };
    CHECK(said("\"float alpha\" 0.5"));
    CHECK_FALSE(said("\"float alpha\" 0"));
    CHECK_FALSE(said(""));
}
