// SPDX-License-Identifier: Apache-2.0
// Appearance of glTF files: tangents, texture coordinates, vertex colours, emission, visibility; and allowed
// variations (extensions, scenes, file names, lengths of buffers).
#include "document/exposure.hpp"
#include "document/session.hpp"
#include "gltf_builder.hpp"
#include "io/export.hpp"
#include "io/material_emission.hpp"

#include <fstream>
#include <sstream>

using namespace restage;
using namespace restage::tests;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace {

// 2 x 1 pixels, red and blue 188 (0.5 when linear).
const char* const picture =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAADUlEQVR42mP4zwAEewAGvQG8H9PpOwAAAABJRU5ErkJggg==";

json texture(int set = 0) { return {{"index", 0}, {"texCoord", set}}; }

// A square of two triangles with its corners at uv (0,0) to (1,1), v downwards; one material, one picture.
struct Square : Builder {
    explicit Square(bool mirrored = false) {
        root["accessors"] = json::array(), root["bufferViews"] = json::array(), bytes.clear();
        const int p = floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 3),
                  n = floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3),
                  t = floats(mirrored ? std::vector<float>{1, 1, 0, 1, 0, 0, 1, 0}
                                      : std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0},
                             "VEC2", 2),
                  i = accessor(raw(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}), 5123, "SCALAR", 6);
        root["meshes"] = {{{"primitives",
                            {{{"attributes", {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", t}}},
                              {"indices", i},
                              {"material", 0}}}}}};
        root["images"] = {{{"uri", picture}}};
        root["textures"] = {{{"source", 0}}};
        root["materials"] = {{{"name", "m"}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}}};
    }
    json& material() { return root["materials"][0]; }
    json& attributes() { return root["meshes"][0]["primitives"][0]["attributes"]; }
};

const scene::MeshData& mesh_of(const io::ImportedScene& in) { return *in.scene.meshes[thing(in).mesh].data; }
const scene::Material& material_of(const io::ImportedScene& in) { return in.scene.materials[thing(in).material]; }

const scene::Texture& texture_of(const io::ImportedScene& in, const scene::ParamSet& params, const char* id) {
    const auto texture = params.texture(id);
    if (!texture) FAIL("no texture for " << id);
    return in.scene.textures[texture];
}

} // namespace

TEST_CASE("gltf: tangents follow uv, and their sign is that of the mirroring", "[gltf]") {
    ModelFiles files;
    for (const bool mirrored : {false, true}) {
        Square b(mirrored);
        b.material()["normalTexture"] = texture();
        const auto in = b.load(files);
        const auto& mesh = mesh_of(in);
        REQUIRE(mesh.tangents.size() == mesh.positions.size());
        for (const glm::vec4& t : mesh.tangents) // uv grow to the right, v upwards here
            CHECK(t == glm::vec4(mirrored ? -1 : 1, 0, 0, mirrored ? -1 : 1));
    }
    Square plain; // unused
    CHECK(mesh_of(plain.load(files)).tangents.empty());
}

TEST_CASE("gltf: TANGENT is kept, and rotated with the skin", "[gltf]") {
    ModelFiles files;
    Square b;
    b.material()["normalTexture"] = texture();
    std::vector<float> tangents;
    for (int i = 0; i < 4; ++i)
        tangents.insert(tangents.end(), {0, 1, 0, -1});
    b.attributes()["TANGENT"] = b.floats(tangents, "VEC4", 4);
    CHECK(mesh_of(b.load(files)).tangents == std::vector<glm::vec4>(4, {0, 1, 0, -1}));
    b.attributes()["JOINTS_0"] = b.accessor(std::string(16, '\0'), 5121, "VEC4", 4);
    b.attributes()["WEIGHTS_0"] = b.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
    b.root["scenes"][0]["nodes"] = {0, 1};
    b.root["nodes"][0]["skin"] = 0;
    b.root["nodes"].push_back({{"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}});
    b.root["skins"] = {{{"joints", {1}}}};
    const auto skinned = b.load(files);
    for (const glm::vec4& t : mesh_of(skinned).tangents)
        CHECK(glm::length(t - glm::vec4(-1, 0, 0, -1)) < 1e-6f);
    b.attributes()["TANGENT"] = b.floats({1, 0, 0, 1}, "VEC4", 4);
    CHECK_THAT(b.error(files), ContainsSubstring("different numbers of vertices"));
}

TEST_CASE("gltf: a vertex between mirrored and unmirrored triangles is split", "[gltf]") {
    ModelFiles files;
    Square b; // folded along its diagonal: the second triangle has the uv of the first, mirrored
    b.attributes()["TEXCOORD_0"] = b.floats({0, 1, 1, 1, 1, 0, 1, 1}, "VEC2", 2);
    b.material()["normalTexture"] = texture();
    const auto in = b.load(files);
    const auto& mesh = mesh_of(in);
    CHECK(mesh.positions.size() == 6);
    CHECK(mesh.normals.size() == 6);
    CHECK(mesh.uvs.size() == 6);
    REQUIRE(mesh.tangents.size() == 6);
    for (int t = 0; t < 2; ++t)
        for (int k = 0; k < 3; ++k)
            CHECK(mesh.tangents[mesh.triangles[t][k]].w == (t == 0 ? 1 : -1));
    CHECK(mesh.positions[mesh.triangles[1][0]] == glm::vec3(0));
}

TEST_CASE("gltf: a rotated normal map rotates its tangents", "[gltf]") {
    ModelFiles files;
    Square b;
    b.material()["normalTexture"] = texture();
    b.material()["normalTexture"]["extensions"]["KHR_texture_transform"] = {{"rotation", 1.5707963267948966}};
    b.material()["pbrMetallicRoughness"]["baseColorTexture"] = texture();
    const auto in = b.load(files);
    // u' = v (downwards), v' = -u: the picture's u goes down the square, so that u of the picture is -y.
    for (const glm::vec4& t : mesh_of(in).tangents)
        CHECK(glm::length(t - glm::vec4(0, -1, 0, 1)) < 1e-6f);
    const auto& map = texture_of(in, material_of(in).params, "normalmap");
    CHECK(map.params.number("uscale", 9) == Approx(0).margin(1e-6));
    CHECK(map.params.number("ushear", 9) == Approx(-1)); // st.x = 1 - v of the mesh, which counts upwards
    CHECK(map.params.number("udelta", 9) == Approx(1));
    CHECK(map.params.number("vshear", 9) == Approx(1));
    CHECK_FALSE(texture_of(in, material_of(in).params, "base_color").params.find("ushear"));
    CHECK(in.report.count(io::Fate::approximated) == 0);
}

TEST_CASE("gltf: textures use their own sets of texture coordinates", "[gltf]") {
    ModelFiles files;
    Square b;
    b.attributes()["TEXCOORD_1"] = b.floats({0.5f, 0, 0.5f, 0, 0.5f, 0, 0.5f, 0}, "VEC2", 2);
    b.attributes()["TEXCOORD_2"] = b.floats({0, 0, 0, 0, 0, 0, 0, 0}, "VEC2", 2);
    b.material()["pbrMetallicRoughness"]["baseColorTexture"] = texture(0);
    b.material()["pbrMetallicRoughness"]["metallicFactor"] = 1;
    b.material()["pbrMetallicRoughness"]["metallicRoughnessTexture"] = texture(1);
    const auto in = b.load(files);
    CHECK(mesh_of(in).uvs[0] == glm::vec2(0, 0));
    REQUIRE(mesh_of(in).uvs2.size() == 4);
    CHECK(mesh_of(in).uvs2[0] == glm::vec2(0.5f, 1));
    CHECK(texture_of(in, material_of(in).params, "base_color").params.number("uvset", 0) == 0);
    CHECK(texture_of(in, material_of(in).params, "roughness").params.number("uvset", 0) == 1);
    CHECK(in.report.count(io::Fate::approximated) == 0);
    b.material()["emissiveTexture"] = texture(2);
    b.material()["emissiveFactor"] = {1, 1, 1};
    CHECK(says(b.load(files), io::Fate::approximated, "a.gltf", "TEXCOORD_2: objects have two sets"));
    b.material()["emissiveTexture"] = texture(7); // the file has no such set
    b.material()["pbrMetallicRoughness"].erase("metallicRoughnessTexture");
    CHECK(says(b.load(files), io::Fate::approximated, "a.gltf", "TEXCOORD_7, which it lacks"));
}

TEST_CASE("gltf: vertex colours multiply a texture, and their alpha is coverage", "[gltf]") {
    ModelFiles files;
    Square b;
    b.attributes()["COLOR_0"] = b.floats({1, 0, 0, 1, 0, 1, 0, 0.5f, 0, 0, 1, 0, 1, 1, 1, 0.25f}, "VEC4", 4);
    b.material()["pbrMetallicRoughness"]["baseColorTexture"] = texture();
    b.material()["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.5};
    b.material()["alphaMode"] = "BLEND";
    const auto in = b.load(files);
    const auto& base = texture_of(in, material_of(in).params, "base_color");
    CHECK(base.type == "scale");
    CHECK(texture_of(in, base.params, "tex").params.number("uvset", 0) == 0);
    const auto& colors = texture_of(in, base.params, "scale");
    CHECK(colors.params.number("uvset", 0) == 1);
    const auto& mesh = mesh_of(in);
    REQUIRE(mesh.uvs2.size() == 6);
    CHECK(mesh.uvs[1] == glm::vec2(1, 0)); // the placement of the picture has not changed
    const auto& image = *in.scene.images[colors.image].data;
    const auto texel = [](const scene::PixelData& p, glm::vec2 uv) {
        const auto x = std::size_t(uv.x * float(p.width)), y = std::size_t((1 - uv.y) * float(p.height));
        return &p.values[(y * p.width + x) * p.channels];
    };
    CHECK(texel(image, mesh.uvs2[1])[1] == 1); // the second corner is green
    CHECK(texel(image, mesh.uvs2[1])[0] == 0);
    REQUIRE(thing(in).alpha_texture);
    const auto& scaled = in.scene.textures[thing(in).alpha_texture]; // half of both
    CHECK(scaled.params.number("scale", 9) == Approx(0.5));
    const auto& product = texture_of(in, scaled.params, "tex");
    const auto& alpha = texture_of(in, product.params, "scale");
    CHECK(texel(*in.scene.images[alpha.image].data, mesh.uvs2[1])[0] == 0.5f);
    CHECK(in.report.count(io::Fate::approximated) == 0);
    b.material().erase("alphaMode");
    CHECK_FALSE(thing(b.load(files)).alpha_texture);
}

TEST_CASE("gltf: a uniform alpha of vertex colours becomes the object's", "[gltf]") {
    ModelFiles files;
    Builder b;
    b.root["meshes"][0]["primitives"][0]["material"] = 0;
    b.root["materials"] = {{{"alphaMode", "BLEND"}}};
    b.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        b.floats({1, 1, 1, 0.25f, 1, 1, 1, 0.25f, 1, 1, 1, 0.25f}, "VEC4", 4);
    CHECK(thing(b.load(files)).alpha == Approx(0.25));
    b.root["materials"][0]["alphaMode"] = "MASK"; // below the cutoff, 0.5
    CHECK(thing(b.load(files)).alpha == 0);
    b.root["materials"][0]["alphaCutoff"] = 0.2;
    CHECK(thing(b.load(files)).alpha == 1);
}

TEST_CASE("gltf: an emissive texture emits as a texture, on top of its material", "[gltf]") {
    ModelFiles files;
    Square b;
    b.material()["pbrMetallicRoughness"]["baseColorFactor"] = {0.1, 0.2, 0.3, 1};
    b.material()["emissiveFactor"] = {1, 0.5, 1};
    b.material()["emissiveTexture"] = texture();
    b.material()["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", 4}};
    const auto in = b.load(files);
    CHECK(in.scene.instances.live() == 1);
    CHECK_FALSE(thing(in).emission);
    CHECK(material_of(in).type == "principled");
    CHECK(material_of(in).params.color("base_color", {})[2] == Approx(0.3));
    CHECK(material_of(in).params.number("emission_scale", 0) == 4);
    CHECK(texture_of(in, material_of(in).params, "emission_color").type == "scale");
    CHECK(in.report.count(io::Fate::approximated) == 0);
    const io::MaterialEmissions emissions(files.registry, in.scene);
    const auto shines = emissions.of(thing(in).material);
    REQUIRE(shines);
    CHECK(shines->radiance == glm::vec3(4));
    CHECK_FALSE(shines->two_sided);
    // pbrt has one colour: the mean, with a report line.
    document::Session session(files.registry);
    session.adopt(in.scene);
    const auto report = session.export_to(files.path("out.pbrt"));
    REQUIRE(report);
    std::stringstream text;
    text << std::ifstream(files.path("out.pbrt")).rdbuf();
    CHECK_THAT(text.str(), ContainsSubstring("AreaLightSource \"diffuse\" \"rgb L\" [ 2 0"));
    CHECK(std::ranges::any_of(report->entries, [](const io::ReportEntry& e) {
        return e.fate == io::Fate::approximated && e.note.find("the mean of its emission's texture") != e.note.npos;
    }));
    // An unreadable picture emits nothing.
    b.root["images"][0]["uri"] = "none.png";
    const auto dark = b.load(files);
    CHECK_FALSE(io::MaterialEmissions(files.registry, dark.scene).of(thing(dark).material));
    CHECK(says(dark, io::Fate::dropped, "", "none.png"));
}

TEST_CASE("gltf: unlit textures show their colours", "[gltf]") {
    ModelFiles files;
    Square b;
    b.material()["extensions"]["KHR_materials_unlit"] = json::object();
    b.material()["pbrMetallicRoughness"]["baseColorTexture"] = texture();
    const auto in = b.load(files);
    const auto shines = io::MaterialEmissions(files.registry, in.scene).of(thing(in).material);
    REQUIRE(shines);
    CHECK(shines->radiance == glm::vec3(1));
    CHECK(shines->texture);
    CHECK(shines->two_sided);
    CHECK(says(in, io::Fate::approximated, "a.gltf", "it emits its colour"));
}

TEST_CASE("gltf: specular-glossiness metals and bright speculars keep their colour", "[gltf]") {
    ModelFiles files;
    Builder b;
    b.root["meshes"][0]["primitives"][0]["material"] = 0;
    b.root["materials"] = {
        {{"extensions",
          {{"KHR_materials_pbrSpecularGlossiness",
            {{"diffuseFactor", {0, 0, 0, 1}}, {"specularFactor", {1, 0.77, 0.34}}, {"glossinessFactor", 0.9}}}}}}};
    const auto gold = b.load(files);
    const auto& metal = material_of(gold).params;
    CHECK(metal.number("metallic", 0) == 1);
    CHECK(metal.color("base_color", {})[1] == Approx(0.77));
    CHECK(metal.number("roughness", 0) == Approx(0.1));
    b.root["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"] = {
        {"diffuseFactor", {0.5, 0.25, 0, 0.5}}, {"specularFactor", {0.2, 0.1, 0.04}}};
    const auto paint = b.load(files);
    const auto& coated = material_of(paint).params;
    CHECK(coated.number("metallic", 9) == 0);
    CHECK(coated.color("base_color", {})[0] == Approx(0.4)); // diffuse * (1 - max(specular))
    CHECK(coated.color("specular_color", {})[0] == Approx(5)); // F0 of ior 1.5 is 0.04
    b.root["materials"] = {{{"extensions", {{"KHR_materials_specular", {{"specularColorFactor", {4, 1, 0.5}}}}}}}};
    const auto in = b.load(files);
    CHECK(material_of(in).params.color("specular_color", {})[0] == 4);
    CHECK(in.report.count(io::Fate::approximated) == 0);
}

TEST_CASE("gltf: a film thickness texture interpolates its two bounds", "[gltf]") {
    ModelFiles files;
    Square b;
    b.material()["name"] = "a bubble of soap with a long name";
    b.material()["extensions"]["KHR_materials_iridescence"] = {{"iridescenceFactor", 1},
                                                               {"iridescenceThicknessMinimum", 150},
                                                               {"iridescenceThicknessMaximum", 550},
                                                               {"iridescenceThicknessTexture", texture()}};
    const auto in = b.load(files);
    const auto& mix = texture_of(in, material_of(in).params, "iridescence_thickness");
    CHECK(mix.name == "a bubble of soap with a long name film");
    CHECK(mix.type == "mix");
    CHECK(mix.params.number("tex1", 0) == 150);
    CHECK(mix.params.number("tex2", 0) == 550);
    CHECK(mix.params.texture("amount"));
}

TEST_CASE("gltf: a coat that does not follow the normal map below is reported", "[gltf]") {
    ModelFiles files;
    Square b;
    b.material()["normalTexture"] = texture();
    b.material()["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1}};
    CHECK(says(b.load(files), io::Fate::approximated, "a.gltf", "the coat is smooth in the file"));
    b.material()["extensions"]["KHR_materials_clearcoat"]["clearcoatNormalTexture"] = texture();
    CHECK(b.load(files).report.count(io::Fate::approximated) == 0);
}

TEST_CASE("gltf: nodes that are not visible are hidden objects", "[gltf]") {
    ModelFiles files;
    Builder b;
    b.root["scenes"][0]["nodes"] = {0, 1};
    b.root["nodes"].push_back({{"name", "away"},
                               {"children", {2}},
                               {"translation", {100, 0, 0}},
                               {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
    b.root["nodes"].push_back({{"mesh", 0}, {"name", "other"}});
    const auto in = b.load(files);
    CHECK_FALSE(thing(in).hidden);
    CHECK(thing(in, "other").hidden); // like its parent
    CHECK(in.scene.cameras[{1}].camera_to_world[3].x < 50); // it looks at the visible objects
    b.root["nodes"][0]["extensions"] = {{"KHR_node_visibility", {{"visible", false}}}};
    CHECK(thing(b.load(files)).hidden);
}

TEST_CASE("gltf: a light whose node is not visible is switched off", "[gltf]") {
    ModelFiles files;
    Builder b;
    b.root["scenes"][0]["nodes"] = {0, 1};
    b.root["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}, {"intensity", 3}}}}}}};
    b.root["nodes"].push_back({{"name", "lamp"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const auto lit = b.load(files);
    REQUIRE(lit.scene.lights.live() == 1);
    CHECK_FALSE(lit.scene.lights[{1}].hidden);
    CHECK_FALSE(lit.scene.environment.value);
    b.root["nodes"][1]["extensions"]["KHR_node_visibility"] = {{"visible", false}};
    const auto off = b.load(files);
    REQUIRE(off.scene.lights.live() == 1);
    CHECK(off.scene.lights[{1}].hidden);
    CHECK(off.scene.environment.value); // the studio: nothing else emits light
}

TEST_CASE("gltf: unknown extensions are refused if required, else reported", "[gltf]") {
    ModelFiles files;
    Builder b;
    b.root["extensionsUsed"] = {"ACME_geometry", "MSFT_lod", "KHR_texture_transform"};
    const auto in = b.load(files);
    CHECK(says(in, io::Fate::dropped, "a.gltf", "not read: ACME_geometry, MSFT_lod"));
    b.root["extensionsRequired"] = {"ACME_geometry"};
    CHECK_THAT(b.error(files), ContainsSubstring("requires unknown extensions: ACME_geometry"));
}

TEST_CASE("gltf: without scenes the root nodes are shown", "[gltf]") {
    ModelFiles files;
    Builder b;
    b.root.erase("scene");
    b.root["nodes"].push_back({{"children", {0}}, {"translation", {0, 0, 3}}});
    CHECK(b.load(files).scene.instances.live() == 1); // no default: the first
    b.root.erase("scenes");
    const auto in = b.load(files);
    CHECK(thing(in).object_to_world[3].z == 3);
    b.root["scenes"] = {{{"name", "empty"}}, {{"nodes", {1}}}};
    CHECK(b.load(files).scene.instances.live() == 1); // the first non-empty one
}

TEST_CASE("gltf: a buffer's file may be longer, and have any name", "[gltf]") {
    ModelFiles files;
    Builder b;
    const auto with = [&](const char* uri, const char* name, std::size_t more) {
        b.root["buffers"] = {{{"byteLength", b.bytes.size()}, {"uri", uri}}};
        files.write(name, b.bytes + std::string(more, 'x'));
        files.write("a.gltf", b.root.dump());
        const auto in = files.load("a.gltf");
        std::remove(files.path(name).c_str());
        return in.scene.instances.live();
    };
    CHECK(with("data.bin", "data.bin", 100) == 1);
    CHECK(with("my%20data.bin", "my data.bin", 0) == 1);
    CHECK(with("100%25.bin", "100%.bin", 0) == 1);
    CHECK(with("100%.bin", "100%.bin", 0) == 1); // not properly encoded, but unambiguous
    CHECK(with("a%20b.bin", "a%20b.bin", 0) == 1);
    CHECK(with("a+b.bin", "a+b.bin", 7) == 1);
    b.root["buffers"] = {{{"byteLength", b.bytes.size() + 1}, {"uri", "short.bin"}}};
    files.write("short.bin", b.bytes);
    files.write("a.gltf", b.root.dump());
    CHECK_THAT(files.error("a.gltf"), ContainsSubstring("short.bin"));
}
