// SPDX-License-Identifier: Apache-2.0
// The glTF importer, through the registry as the program uses it: hierarchy, accessors, materials, cameras, lights.
#include "gltf_builder.hpp"

using namespace restage;
using namespace restage::tests;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("gltf: a triangle, with v upwards and a camera for a right-handed world", "[gltf]") {
    ModelFiles files;
    Builder b;
    const auto in = b.load(files);
    const auto& mesh = *in.scene.meshes[thing(in).mesh].data;
    REQUIRE(mesh.positions.size() == 3);
    CHECK(mesh.normals[0] == glm::vec3(0, 0, 1));
    CHECK(mesh.uvs[0] == glm::vec2(0, 1)); // glTF's v starts at the top
    CHECK(mesh.uvs[2] == glm::vec2(0, 0));
    const auto& material = in.scene.materials[thing(in).material];
    CHECK(material.type == "principled");
    CHECK(material.params.number("metallic", -1) == 1); // glTF's defaults
    CHECK(material.params.number("roughness", -1) == 1);
    CHECK(glm::determinant(glm::dmat3(in.scene.cameras[{1}].camera_to_world)) == Approx(-1));
    CHECK(in.scene.environment.value);
}

TEST_CASE("gltf: nodes become groups, and a mesh used twice is stored once", "[gltf]") {
    ModelFiles files;
    Builder b;
    b.root["scenes"][0]["nodes"] = {2};
    b.root["nodes"] = {{{"mesh", 0}, {"name", "left"}, {"translation", {1, 2, 3}}},
                       {{"mesh", 0}, {"name", "right"}, {"scale", {-1, 1, 1}}},
                       {{"name", "both"}, {"children", {0, 1}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}}};
    const auto in = b.load(files);
    CHECK(in.scene.meshes.live() == 1);
    REQUIRE(in.scene.groups.live() == 1);
    CHECK(in.scene.groups[{1}].name == "both");
    CHECK(thing(in, "left").group.value == 1);
    const glm::dvec4 at = thing(in, "left").object_to_world[3]; // rotated by 90 degrees about z
    CHECK(at.x == Approx(-2));
    CHECK(at.y == Approx(1));
    CHECK(at.z == Approx(3));
    CHECK(glm::determinant(glm::dmat3(thing(in, "right").object_to_world)) == Approx(-1));
}

TEST_CASE("gltf: integers are normalised, strides respected, sparse values applied", "[gltf]") {
    ModelFiles files;
    Builder b;
    const int positions =
        b.accessor(raw(std::vector<std::int16_t>{0, 0, 0, 0, 32767, 0, 0, 0, -32767, 16384, 0, 0}), 5122, "VEC3", 3);
    b.root["accessors"][positions]["normalized"] = true;
    b.root["bufferViews"][b.root["accessors"][positions]["bufferView"].get<int>()]["byteStride"] = 8;
    b.root["accessors"][positions]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", b.view(raw(std::vector<std::uint8_t>{2, 0, 0, 0}))}, {"componentType", 5121}}},
        {"values", {{"bufferView", b.view(raw(std::vector<std::int16_t>{0, 32767, 0, 0}))}}}};
    b.root["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", positions}};
    const auto in = b.load(files);
    const auto& mesh = *in.scene.meshes[thing(in).mesh].data;
    CHECK(mesh.positions[1] == glm::vec3(1, 0, 0));
    CHECK(mesh.positions[2] == glm::vec3(0, 1, 0));
    CHECK(mesh.normals.empty()); // flat, as required by glTF
}

TEST_CASE("gltf: strips and fans keep their orientation", "[gltf]") {
    ModelFiles files;
    for (const int mode : {5, 6}) {
        Builder b;
        const int p = mode == 5 ? b.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3", 3)
                                : b.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 3);
        b.root["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", p}}}, {"mode", mode}};
        const auto in = b.load(files);
        const auto& mesh = *in.scene.meshes[thing(in).mesh].data;
        REQUIRE(mesh.triangles.size() == 2);
        for (const auto& t : mesh.triangles)
            CHECK(glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]).z ==
                  1);
    }
}

TEST_CASE("gltf: material extensions reach the principled material", "[gltf]") {
    ModelFiles files;
    Builder b;
    b.root["meshes"][0]["primitives"][0]["material"] = 0;
    b.root["materials"] = {
        {{"name", "m"},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.25}, {"roughnessFactor", 0.75}}},
         {"alphaMode", "BLEND"},
         {"doubleSided", true},
         {"emissiveFactor", {1, 0.5, 0}},
         {"extensions",
          {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}},
           {"KHR_materials_ior", {{"ior", 1.2345678}}},
           {"KHR_materials_transmission", {{"transmissionFactor", 0.5}}},
           {"KHR_materials_volume",
            {{"thicknessFactor", 1}, {"attenuationDistance", 2}, {"attenuationColor", {0.5, 1, 1}}}},
           {"KHR_materials_clearcoat", {{"clearcoatFactor", 0.6}, {"clearcoatRoughnessFactor", 0.3}}},
           {"KHR_materials_sheen", {{"sheenColorFactor", {0.25, 0.5, 1}}, {"sheenRoughnessFactor", 0.7}}},
           {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}, {"anisotropyRotation", 1.5707963267948966}}},
           {"KHR_materials_iridescence",
            {{"iridescenceFactor", 0.75}, {"iridescenceIor", 1.8}, {"iridescenceThicknessMaximum", 550}}},
           {"KHR_materials_dispersion", {{"dispersion", 0.1}}}}}}};
    const auto in = b.load(files);
    const auto& i = thing(in);
    const auto& p = in.scene.materials[i.material].params;
    CHECK(p.color("base_color", {})[2] == Approx(0.3));
    CHECK(p.number("metallic", -1) == Approx(0.25));
    CHECK(p.number("roughness", -1) == Approx(0.75));
    CHECK(p.number("ior", -1) == 1.2345678f);
    CHECK(p.number("transmission", -1) == Approx(0.5));
    CHECK(p.find("thin"));
    CHECK(p.number("thin", -1) == 0); // it has a thickness
    CHECK(p.number("clearcoat", -1) == Approx(0.6));
    CHECK(i.alpha == Approx(0.4));
    REQUIRE(i.emission);
    CHECK(i.emission->radiance == glm::vec3(4, 2, 0));
    CHECK(i.emission->two_sided);
    REQUIRE(i.media);
    CHECK(in.scene.media[i.media->interior].sigma_a.x == Approx(std::log(2.0) / 2));
    CHECK(in.scene.media[i.media->interior].sigma_a.y == 0);
    CHECK(p.color("sheen_color", {})[1] == Approx(0.5));
    CHECK(p.number("sheen_roughness", -1) == Approx(0.7));
    CHECK(p.number("anisotropy", -1) == Approx(0.5));
    CHECK(p.number("anisotropy_rotation", -1) == Approx(90));
    CHECK(p.number("iridescence", -1) == Approx(0.75));
    CHECK(p.number("iridescence_ior", -1) == Approx(1.8));
    CHECK(p.number("iridescence_thickness", -1) == Approx(550)); // without a texture the maximum applies
    const auto& values = in.scene.materials[i.material].origin.values; // for spectral rendering
    REQUIRE(values.size() == 1);
    CHECK(values[0].id == "spectrum:ior");
    CHECK(values[0].text.starts_with("1.2345678 1.2345678 1.2345678 360 1.23"));
    CHECK(!says(in, io::Fate::dropped, "a.gltf", "KHR_materials_dispersion"));
    CHECK(says(in, io::Fate::approximated, "a.gltf", "dispersion"));
    CHECK_FALSE(says(in, io::Fate::dropped, "a.gltf", "sheen"));
}

TEST_CASE("gltf: vertex colours interpolate exactly as a texture", "[gltf]") {
    ModelFiles files;
    Builder b;
    b.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = b.floats({1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3", 3);
    const auto in = b.load(files);
    const auto& mesh = *in.scene.meshes[thing(in).mesh].data;
    const scene::Value* color = in.scene.materials[thing(in).material].params.find("base_color");
    REQUIRE(color);
    const auto* texture = in.scene.textures.find(color->texture);
    REQUIRE(texture);
    const auto& image = *in.scene.images[texture->image].data;
    REQUIRE(image.width == 2);
    for (std::size_t corner = 0; corner < 3; ++corner) { // the texel whose centre the corner's uv is
        const auto x = static_cast<std::size_t>(mesh.uvs[corner].x * 2),
                   y = static_cast<std::size_t>((1 - mesh.uvs[corner].y) * 2);
        for (std::size_t c = 0; c < 3; ++c)
            CHECK(image.values[(y * 2 + x) * 3 + c] == (c == corner ? 1.f : 0.f));
    }
}

TEST_CASE("gltf: cameras and lights look along -z, and angles are those of the shorter side", "[gltf]") {
    ModelFiles files;
    Builder b;
    b.root["scenes"][0]["nodes"] = {0, 1, 2};
    b.root["nodes"].push_back({{"camera", 0}, {"translation", {0, 0, 5}}});
    b.root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"name", "lamp"}});
    b.root["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"aspectRatio", 0.5}, {"znear", 0.1}}}}};
    b.root["extensions"] = {{"KHR_lights_punctual",
                             {{"lights",
                               {{{"type", "spot"},
                                 {"intensity", 3},
                                 {"color", {1, 0.5, 0}},
                                 {"spot", {{"outerConeAngle", 0.5}, {"innerConeAngle", 0.25}}}}}}}}};
    const auto in = b.load(files);
    REQUIRE(in.scene.cameras.live() == 1);
    const auto& camera = in.scene.cameras[{1}];
    CHECK(glm::dvec3(camera.camera_to_world[2]) == glm::dvec3(0, 0, -1));
    CHECK(camera.camera_to_world[3].z == 5);
    CHECK(glm::radians(camera.fov) == Approx(2 * std::atan(std::tan(0.5) * 0.5)));
    CHECK(in.scene.film.value.width * 2 == Approx(in.scene.film.value.height).epsilon(0.01));
    REQUIRE(in.scene.lights.live() == 1);
    const auto& light = in.scene.lights[{1}];
    CHECK(light.name == "lamp");
    CHECK(light.kind == scene::LightKind::spot);
    CHECK(light.value == glm::vec3(3, 1.5f, 0));
    CHECK(glm::radians(light.cone_angle) == Approx(0.5));
    CHECK(glm::radians(light.cone_delta) == Approx(0.25));
    CHECK(glm::dvec3(light.light_to_world[2]) == glm::dvec3(0, 0, -1));
    CHECK_FALSE(in.scene.environment.value); // the file has its own light
}

TEST_CASE("gltf: a skin follows its nodes", "[gltf]") {
    ModelFiles files;
    Builder b;
    auto& attributes = b.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = b.accessor(std::string(12, '\0'), 5121, "VEC4", 3);
    attributes["WEIGHTS_0"] = b.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
    b.root["scenes"][0]["nodes"] = {0, 1};
    b.root["nodes"][0]["skin"] = 0;
    b.root["nodes"][0]["translation"] = {9, 9, 9}; // is ignored
    b.root["nodes"].push_back({{"translation", {0, 0, 7}}});
    b.root["skins"] = {{{"joints", {1}}}};
    const auto in = b.load(files);
    CHECK(thing(in).object_to_world == glm::dmat4(1));
    CHECK(in.scene.meshes[thing(in).mesh].data->positions[1] == glm::vec3(1, 0, 7));
    CHECK(says(in, io::Fate::approximated, "", "skins"));
}

TEST_CASE("gltf: errors name things by their glTF index", "[gltf]") {
    ModelFiles files;
    const auto broken = [&](auto&& change) {
        Builder b;
        change(b);
        return b.error(files);
    };
    CHECK_THAT(broken([](Builder& b) { b.root["accessors"][0]["count"] = 4; }),
               ContainsSubstring("accessor 0 reads 4 elements"));
    CHECK_THAT(broken([](Builder& b) { b.root["accessors"][0]["bufferView"] = 9; }),
               ContainsSubstring("buffer view 9"));
    CHECK_THAT(broken([](Builder& b) { b.root["bufferViews"][0]["byteLength"] = 4000; }),
               ContainsSubstring("buffer view 0 reaches to byte"));
    CHECK_THAT(broken([](Builder& b) { b.root["nodes"][0]["children"] = {0}; }),
               ContainsSubstring("node 0 occurs in the hierarchy twice"));
    CHECK_THAT(broken([](Builder& b) { b.root["nodes"][0]["mesh"] = 3; }), ContainsSubstring("mesh 3"));
    CHECK_THAT(broken([](Builder& b) {
                   b.root["meshes"][0]["primitives"][0]["indices"] =
                       b.accessor(raw(std::vector<std::uint16_t>{0, 1, 5}), 5123, "SCALAR", 3);
               }),
               ContainsSubstring("vertex 5 of 3"));
    CHECK_THAT(broken([](Builder& b) { b.root["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }),
               ContainsSubstring("KHR_draco_mesh_compression"));
    CHECK_THAT(broken([](Builder& b) { b.root["asset"]["version"] = "1.0"; }), ContainsSubstring("glTF 1.0"));
    CHECK_THAT(broken([](Builder& b) { b.root["asset"]["minVersion"] = "2.1"; }), ContainsSubstring("minVersion"));
    files.write("a.gltf", " \n");
    CHECK_THAT(files.error("a.gltf"), ContainsSubstring("the file is empty"));
    files.write("a.gltf", "{\n  \"asset\": {\"version\": \"2.0\"},\n  nodes\n}\n");
    CHECK_THAT(files.error("a.gltf"), ContainsSubstring("a.gltf:3:4: "));
    files.write("a.glb", std::string("glTF\2\0\0\0\xff\0\0\0", 12) + std::string(20, '\0'));
    CHECK_THAT(files.error("a.glb"), ContainsSubstring("byte 8: the file is cut: 255 bytes declared, 32 found"));
}
