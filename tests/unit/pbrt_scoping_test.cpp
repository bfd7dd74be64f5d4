// SPDX-License-Identifier: Apache-2.0
// Graphics state: what Begin and End save, transforms, objects, Include and Import, versions.
#include "pbrt_writer.hpp"
#include "transform.hpp"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <numbers>

using namespace restage::pbrt;
using restage::pbrt::test::Folder;
using restage::pbrt::test::Recorder;

namespace {

const std::string sphere = " Shape \"sphere\" ";

Vec3 origin_of(const Recorder& r, std::size_t instance) {
    const double* m = r.instances.at(instance).raw.object_to_world;
    return {m[12], m[13], m[14]};
}

void check_vec(Vec3 a, Vec3 b, double tolerance = 1e-12) {
    INFO(a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z);
    CHECK(length(a - b) <= tolerance);
}

Recorder loaded(const std::string& world, const std::string& head = "") {
    Recorder r;
    const int ok = r.load_text(head + "\nWorldBegin\n" + world);
    INFO(r.error.message);
    REQUIRE(ok == 1);
    return r;
}

std::string material_of(const Recorder& r, std::size_t instance) {
    return r.materials.at(r.instances.at(instance).raw.material - 1).name;
}

} // namespace

TEST_CASE("pbrt transforms: in double, in pbrt's order", "[pbrt]") {
    const double third = std::numbers::pi / 3;
    const Matrix r = rotation(60, {0, 0, 2});
    check_vec(transform_vector(r, {1, 0, 0}), {std::cos(third), std::sin(third), 0}, 1e-15);
    // Rotations preserve their axis, lengths and handedness.
    const Matrix any = rotation(77, {1, -2, 3});
    check_vec(transform_vector(any, {1, -2, 3}), {1, -2, 3}, 1e-14);
    CHECK(determinant3(any) == Catch::Approx(1).epsilon(1e-14));
    CHECK(rotation(90, {0, 0, 0}) == Matrix{});
    // LookAt takes the world to a camera that looks along +z with +y up and +x right: left-handed, as pbrt.
    const auto view = look_at({1, 2, 3}, {1, 2, 8}, {0, 1, 0});
    REQUIRE(view);
    check_vec(transform_point(*view, {1, 2, 3}), {0, 0, 0}, 1e-14);
    check_vec(transform_point(*view, {1, 2, 8}), {0, 0, 5}, 1e-14);
    check_vec(transform_point(*view, {1, 3, 3}), {0, 1, 0}, 1e-14);
    check_vec(transform_point(*view, {2, 2, 3}), {1, 0, 0}, 1e-14);
    CHECK_FALSE(look_at({1, 1, 1}, {1, 1, 1}, {0, 1, 0}));
    CHECK_FALSE(look_at({0, 0, 0}, {0, 2, 0}, {0, 1, 0}));
    const auto back = inverse(any * translation({1e6, 2, 3}) * scaling({1, -2, 1e-3}));
    REQUIRE(back);
    check_vec(
        transform_point(*back, transform_point(any * translation({1e6, 2, 3}) * scaling({1, -2, 1e-3}), {4, 5, 6})),
        {4, 5, 6}, 1e-6);
    CHECK_FALSE(inverse(scaling({1, 0, 1})));
    for (const Vec3 z : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{-0.3, 2, 1}}) {
        const Matrix frame = frame_along(z);
        check_vec(transform_vector(frame, {0, 0, 1}), normalize(z), 1e-14);
        CHECK(determinant3(frame) == Catch::Approx(1).epsilon(1e-12));
    }

    const Recorder s = loaded(
        "Translate 1 2 3 Scale 2 2 2 Translate 1 0 0" + sphere + "Identity Rotate 90 0 0 1 Translate 1 0 0" + sphere +
        "Transform [1 0 0 0 0 1 0 0 0 0 1 0 7 8 9 1] ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 1 1 1 1]" + sphere);
    check_vec(origin_of(s, 0), {3, 2, 3});
    check_vec(origin_of(s, 1), {0, 1, 0}, 1e-15);
    check_vec(origin_of(s, 2), {8, 9, 10});
    // A transform kept in double: a float would have lost digits.
    const Recorder far = loaded("Translate 16777217 0 0" + sphere);
    CHECK(far.instances[0].raw.object_to_world[12] == 16777217.0);
}

TEST_CASE("pbrt scoping: attributes, transforms, names", "[pbrt]") {
    const std::string v4 = "Film \"rgb\"", v3 = "Film \"image\"";
    const std::string body =
        "MakeNamedMaterial \"a\" \"string type\" \"TYPE\"\nNamedMaterial \"a\"\nAttributeBegin Translate 1 0 0\n"
        "MakeNamedMaterial \"b\" \"string type\" \"TYPE\" NamedMaterial \"b\" ReverseOrientation" +
        sphere + "AttributeEnd" + sphere + "TransformBegin Translate 0 1 0 NamedMaterial \"b\"" + sphere +
        "TransformEnd" + sphere;
    const auto with = [&](const std::string& type) {
        std::string out = body;
        for (auto at = out.find("TYPE"); at != out.npos; at = out.find("TYPE"))
            out.replace(at, 4, type);
        return out;
    };
    const Recorder four = loaded(with("diffuse"), v4);
    check_vec(origin_of(four, 0), {1, 0, 0});
    check_vec(origin_of(four, 1), {0, 0, 0});
    check_vec(origin_of(four, 2), {0, 1, 0});
    check_vec(origin_of(four, 3), {0, 0, 0});
    CHECK(material_of(four, 0) == "b");
    CHECK((four.instances[0].raw.flags & RESTAGE_INSTANCE_REVERSE_ORIENTATION) != 0);
    CHECK(four.instances[1].raw.flags == 0);
    CHECK(material_of(four, 1) == "a");
    CHECK(material_of(four, 2) == "b"); // v4: names are global,
    CHECK(material_of(four, 3) == "a"); // and TransformEnd restores the material

    const Recorder three = loaded(with("matte") + "WorldEnd", v3);
    CHECK(material_of(three, 0) == "b");
    CHECK(material_of(three, 2) == "a"); // v3: "b" ended with its block, and the current one stays (api.cpp),
    CHECK(three.reports("NamedMaterial \"b\": no material has that name"));
    CHECK(material_of(three, 3) == "a"); // and TransformEnd restores only the transform
    check_vec(origin_of(three, 3), {0, 0, 0});
}

TEST_CASE("pbrt scoping: a name used before its definition (v4), textures shadowed (v3)", "[pbrt]") {
    const Recorder r =
        loaded("NamedMaterial \"late\"" + sphere +
                   "MakeNamedMaterial \"late\" \"string type\" \"diffuse\" \"rgb reflectance\" [ .1 .2 .3 ]\n"
                   "MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string materials\" [ \"late\" \"last\" ]\n"
                   "MakeNamedMaterial \"last\" \"string type\" \"conductor\"\n",
               "Film \"rgb\"");
    REQUIRE(r.materials.size() == 3);
    CHECK(material_of(r, 0) == "late");
    CHECK(r.materials[0].values.at("reflectance").v[1] == 0.2f);
    CHECK(r.materials[2].name == "m");
    CHECK(r.materials[2].values.at("first").ref == 1);
    CHECK(r.materials[2].values.at("second").ref == 2);

    const Recorder s = loaded(
        "Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [ 1 0 0 ]\nAttributeBegin\n"
        "Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [ 0 1 0 ]\nMaterial \"matte\" \"texture Kd\" \"t\"" +
            sphere + "AttributeEnd\nMaterial \"matte\" \"texture Kd\" \"t\"" + sphere + "WorldEnd",
        "Film \"image\"");
    REQUIRE(s.materials.size() == 2); // the same text, but not the same texture
    CHECK(s.materials[s.instances[0].raw.material - 1].values.at("reflectance").ref == 2);
    CHECK(s.materials[s.instances[1].raw.material - 1].values.at("reflectance").ref == 1);
}

TEST_CASE("pbrt scoping: coordinate systems, active transforms, Attribute, color spaces", "[pbrt]") {
    const Recorder r = loaded("Translate 1 0 0 CoordinateSystem \"here\" Identity" + sphere +
                                  "CoordSysTransform \"here\"" + sphere + "CoordSysTransform \"camera\"" + sphere +
                                  "CoordSysTransform \"nowhere\"\n"
                                  "Identity ActiveTransform EndTime Translate 0 0 5 ActiveTransform All" +
                                  sphere,
                              "Translate 0 -2 0 Camera \"perspective\"");
    check_vec(origin_of(r, 0), {0, 0, 0});
    check_vec(origin_of(r, 1), {1, 0, 0});
    check_vec(origin_of(r, 2), {0, 2, 0}); // the camera's place in the world
    CHECK(r.reports("CoordSysTransform \"nowhere\": no CoordinateSystem"));
    check_vec(origin_of(r, 3), {0, 0, 0}); // as the shutter opens
    CHECK(r.reports("Shape in motion"));
    CHECK(r.raw_cameras.at(0).camera_to_world[13] == 2);

    const Recorder a = loaded(
        "AttributeBegin Attribute \"shape\" \"float radius\" 2 Attribute \"material\" \"rgb reflectance\" [ .1 .1 .1 "
        "]\n"
        "Material \"diffuse\"" +
        sphere + sphere + "\"float radius\" 3 AttributeEnd Material \"diffuse\"" + sphere);
    REQUIRE(a.meshes.size() == 3);
    const auto radius = [](const restage::pbrt::test::MeshRecord& mesh) { // of the equator of triangles of equal area
        float top = 0;
        for (const float x : mesh.positions)
            top = std::max(top, x);
        return top;
    };
    CHECK(radius(a.meshes[0]) == Catch::Approx(2).epsilon(3e-3));
    CHECK(radius(a.meshes[1]) == Catch::Approx(3).epsilon(3e-3));
    CHECK(radius(a.meshes[2]) == Catch::Approx(1).epsilon(3e-3));
    CHECK(a.materials[a.instances[0].raw.material - 1].values.at("reflectance").v[0] == 0.1f);
    CHECK(a.materials[a.instances[2].raw.material - 1].values.at("reflectance").v[0] == 0.5f);

    const Recorder c =
        loaded("AttributeBegin ColorSpace \"rec2020\" Material \"diffuse\" \"rgb reflectance\" [ .2 .5 .2 ]" + sphere +
               "AttributeEnd Material \"diffuse\" \"rgb reflectance\" [ .2 .5 .2 ]" + sphere);
    const auto& wide = c.materials[c.instances[0].raw.material - 1];
    const auto& narrow = c.materials[c.instances[1].raw.material - 1];
    CHECK(wide.values.at("reflectance").v[1] > 0.5f); // rec2020's green is more saturated
    CHECK(wide.values.at("reflectance").v[0] < 0.1f);
    CHECK(narrow.values.at("reflectance").v[1] == 0.5f);
}

TEST_CASE("pbrt scoping: objects", "[pbrt]") {
    const Recorder r =
        loaded("ObjectBegin \"pair\" Translate 1 0 0" + sphere + "Translate 1 0 0" + sphere + "ObjectEnd" + sphere +
               "Scale 2 2 2 ObjectInstance \"pair\" Translate 0 1 0 ObjectInstance \"pair\" ObjectInstance \"none\"");
    CHECK(r.meshes.size() == 2); // a unit sphere is a unit sphere; and the place of "none"
    REQUIRE(r.instances.size() == 6);
    REQUIRE(r.groups.size() == 2);
    check_vec(origin_of(r, 0), {0, 0, 0}); // the object itself is invisible, and its transforms ended
    check_vec(origin_of(r, 1), {2, 0, 0});
    check_vec(origin_of(r, 2), {4, 0, 0});
    check_vec(origin_of(r, 4), {4, 2, 0});
    CHECK(r.instances[0].raw.group == 0);
    CHECK(r.instances[1].raw.group == 1);
    CHECK(r.instances[4].raw.group == 2);
    CHECK(r.groups[0].name == "pair");
    CHECK(r.reports("ObjectInstance \"none\": no ObjectBegin"));

    const Recorder lit =
        loaded("AreaLightSource \"diffuse\" ObjectBegin \"o\"" + sphere + "ObjectEnd ObjectInstance \"o\"");
    CHECK(lit.instances.at(0).raw.flags == 0);
    CHECK(lit.reports("AreaLightSource in ObjectBegin"));
}

TEST_CASE("pbrt scoping: WorldBegin resets, media", "[pbrt]") {
    const Recorder r = loaded(
        sphere + "MediumInterface \"in\" \"\"" + sphere + "MediumInterface \"in\"" + sphere,
        "MakeNamedMedium \"in\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 2 3 ] \"rgb sigma_s\" [ 0 0 0 ] "
        "\"float scale\" 2\n"
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" MakeNamedMedium \"cloud\" \"string type\" \"cloud\"\n"
        "Translate 5 5 5 MediumInterface \"\" \"fog\" Camera \"perspective\" MediumInterface \"\" \"\"");
    check_vec(origin_of(r, 0), {0, 0, 0});
    REQUIRE(r.raw_media.size() == 3); // that of another kind is clear
    CHECK(r.raw_media[2].sigma_a[2] == 0);
    CHECK(r.raw_media[0].sigma_a[2] == 6);
    CHECK(r.camera_medium == 2);
    CHECK(r.instances[0].raw.has_medium_interface == 0);
    CHECK(r.instances[1].raw.interior == 1);
    CHECK(r.instances[1].raw.exterior == 0);
    CHECK(r.instances[2].raw.exterior == 1); // one name: both sides
    CHECK(r.reports("medium \"fog\": its scattering is not rendered"));
    CHECK_FALSE(r.reports("medium \"in\": its scattering"));
    CHECK(r.reports("medium \"cloud\" (cloud)"));
}

TEST_CASE("pbrt files: Include continues the state, Import has its own, missing ones are reported", "[pbrt]") {
    const Folder folder;
    folder.file("sub/inner.pbrt", "Translate 1 0 0\n" + sphere + "Include \"sibling.pbrt\"\n");
    folder.file("sub/sibling.pbrt", sphere);
    const std::string scene =
        folder.file("s.pbrt", "WorldBegin\nInclude \"sub/inner.pbrt\"" + sphere +
                                  "\nIdentity Import \"sub/inner.pbrt\"" + sphere + "\nInclude \"gone.pbrt\"" + sphere);
    Recorder r;
    REQUIRE(r.load_file(scene) == 1);
    REQUIRE(r.instances.size() == 8); // the last but one: the place of the missing file
    check_vec(origin_of(r, 1), {1, 0, 0}); // found in the including file's folder
    check_vec(origin_of(r, 2), {1, 0, 0});
    check_vec(origin_of(r, 3), {1, 0, 0});
    check_vec(origin_of(r, 5), {0, 0, 0});
    CHECK(r.reports("gone.pbrt"));
    CHECK(r.lines[1].line == 4);
    CHECK(r.lines[1].fate == RESTAGE_DROPPED);
}

TEST_CASE("pbrt files: the user stops an import", "[pbrt]") {
    std::string world;
    for (int i = 0; i < 200; ++i)
        world += sphere;
    Recorder r;
    r.stop_after = 3;
    CHECK(r.load_text("WorldBegin" + world) == 0);
    CHECK_FALSE(r.error.set);
    CHECK(r.instances.size() < 200);
}

TEST_CASE("pbrt versions are detected", "[pbrt]") {
    const auto version = [](const std::string& text) {
        Recorder r;
        REQUIRE(r.load_text(text) == 1);
        return r.lines.at(0).what;
    };
    const std::string four = "read as pbrt-v4", three = "read as pbrt-v3";
    CHECK(version("WorldBegin") == four); // no evidence
    CHECK(version("WorldBegin WorldEnd") == three);
    CHECK(version("Film \"image\" WorldBegin") == three);
    CHECK(version("Film \"rgb\" WorldBegin") == four);
    CHECK(version("Sampler \"random\" WorldBegin") == three);
    CHECK(version("Sampler \"zsobol\" WorldBegin") == four);
    CHECK(version("PixelFilter \"box\" \"float xwidth\" 1 WorldBegin") == three);
    CHECK(version("PixelFilter \"box\" \"float xradius\" 1 WorldBegin") == four);
    CHECK(version("WorldBegin Material \"matte\"") == three);
    CHECK(version("WorldBegin Material \"diffuse\"") == four);
    CHECK(version("WorldBegin LightSource \"infinite\" \"string mapname\" \"x.exr\"") == three);
    CHECK(version("WorldBegin LightSource \"infinite\" \"float illuminance\" 3") == four);
    CHECK(version("SurfaceIntegrator \"path\" WorldBegin") == three);
    CHECK(version("WorldBegin ColorSpace \"srgb\" Shape \"cone\"") == four);
    CHECK(version("WorldBegin Attribute \"shape\" \"float alpha\" 1") == four);
    // A v4 file with one v3 material: v4, and the material keeps its meaning.
    Recorder r;
    REQUIRE(r.load_text("Film \"rgb\" WorldBegin Material \"glass\"" + sphere) == 1);
    CHECK(r.lines.at(0).what == four);
    CHECK(r.materials.at(0).type == "dielectric");
    CHECK(r.materials.at(0).values.at("remap").text == "v3");
}
