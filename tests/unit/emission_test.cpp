// SPDX-License-Identifier: Apache-2.0
// Materials that emit (restage/emission.h): refusals, resulting values, and round trips through pbrt files.
#include "scene/emission.hpp"
#include "paths.hpp"

#include "document/session.hpp"
#include "export_scene.hpp"
#include "io/material_emission.hpp"
#include "io/services.hpp"
#include "plugin_folder.hpp"

#include <catch2/matchers/catch_matchers_string.hpp>
#include <limits>

using namespace restage;
using namespace restage::scene;
using Catch::Matchers::ContainsSubstring;
using test::Folder, test::Plugins, test::version;

namespace {

std::string json_with(const std::string& emission) {
    return R"({"id": "org.example.velvet", "provides": ["restage.material/1"], "version": "1.0.0", "licence": "MIT", "needs": {"host": ">=0.2"},
 "materials": [{"type": "glow", "glsl": "velvet.glsl", "params": [
   {"id": "light", "type": "color", "flags": ["texturable"], "default": [1, 0.5, 0]},
   {"id": "strength", "type": "float", "max": 100, "default": 4},
   {"id": "pattern", "type": "float", "flags": ["texturable"]},
   {"id": "both", "type": "bool"}], "emission": )" +
           emission + "}]}";
}

const std::string sphere_of_emissive =
    "WorldBegin\nMaterial \"emissive\" \"rgb radiance\" [ 1 0.5 0.25 ] \"float scale\" 8 "
    "\"bool two_sided\" true\nShape \"sphere\"\n";

} // namespace

TEST_CASE("a manifest names the parameters by which a material emits", "[emission]") {
    test::PluginFolder folder;
    folder.add("p", json_with(R"({"radiance": "light", "scale": "strength", "two_sided": "both"})"), nullptr);
    plugin::Registry registry(folder.log);
    folder.scan(registry);
    const auto entry = registry.find_material("glow");
    REQUIRE(entry);
    REQUIRE(entry->table->emission);
    ParamSet params;
    auto e = emission_of(*entry->table, params);
    REQUIRE(e);
    CHECK(e->radiance == glm::vec3(4, 2, 0));
    CHECK_FALSE(e->two_sided);
    params.set("both", Value::boolean(true));
    params.set("light", Value::number(0.5f)); // a grey
    e = emission_of(*entry->table, params);
    REQUIRE(e);
    CHECK(e->radiance == glm::vec3(2));
    CHECK(e->two_sided);
    Value texture = Value::color(0, 0, 0);
    texture.texture = {7};
    params.set("light", texture);
    e = emission_of(*entry->table, params);
    REQUIRE(e);
    CHECK(e->radiance == glm::vec3(4)); // the texture replaces the colour, not the scale
    CHECK(e->texture.value == 7);
    for (const float dark : {0.f, -1.f, std::numeric_limits<float>::infinity()}) {
        params.set("strength", Value::number(dark));
        CHECK_FALSE(emission_of(*entry->table, params));
    }
}

TEST_CASE("an emission that does not match its material is refused", "[emission]") {
    test::PluginFolder folder;
    const auto refused = [&](const char* emission) { return folder.refusal_of(json_with(emission), nullptr); };
    CHECK_THAT(refused("{}"), ContainsSubstring("\"radiance\" is missing"));
    CHECK_THAT(refused("[]"), ContainsSubstring("must be an object"));
    CHECK_THAT(refused(R"({"radiance": "light", "power": "strength"})"), ContainsSubstring("\"power\" is unknown"));
    CHECK_THAT(refused(R"({"radiance": "strength"})"),
               ContainsSubstring("its radiance \"strength\" is not a parameter of type COLOR"));
    CHECK_THAT(refused(R"({"radiance": "light", "scale": "brightness"})"),
               ContainsSubstring("its scale \"brightness\" is not a parameter of type FLOAT"));
    CHECK_THAT(refused(R"({"radiance": "light", "scale": "pattern"})"), ContainsSubstring("only the radiance may"));
    CHECK_THAT(refused(R"({"radiance": "light", "two_sided": "strength"})"),
               ContainsSubstring("its two_sided \"strength\" is not a parameter of type BOOL"));
}

TEST_CASE("pbrt gets an area light for an emitting material, and returns the material", "[emission][pbrt]") {
    Plugins plugins;
    Folder folder;
    document::Session session{plugins.registry};
    REQUIRE(write_file_atomic(folder.file("in.pbrt"), sphere_of_emissive));
    REQUIRE(session.open(folder.file("in.pbrt")));
    const auto expect = [&](const glm::vec3& radiance) {
        const Scene& s = session.scene();
        const Instance* ball = s.instances.find(Id<Instance>{1});
        REQUIRE(ball);
        CHECK_FALSE(ball->emission);
        const auto e = io::MaterialEmissions(plugins.registry, s).of(ball->material);
        REQUIRE(e);
        CHECK(e->radiance == radiance);
        CHECK(e->two_sided);
    };
    expect({8, 4, 2});
    // edited: else the material is written back verbatim
    REQUIRE(session.set_param(session.scene().instances[{1}].material, "scale", Value::number(6)));
    for (const char* v : {"v4", "v3"}) {
        INFO(v);
        const std::string file = folder.file(v) + ".pbrt";
        REQUIRE(session.export_to(file, version(v)));
        const std::string text = read_file(file).value();
        CHECK_THAT(text, ContainsSubstring("AreaLightSource \"diffuse\" \"rgb L\" [ 6 3 1.5 ]") &&
                             ContainsSubstring("\"string plugin\" [ \"emissive\" ]") && ContainsSubstring("twosided") &&
                             ContainsSubstring("# emission: \"emissive\""));
        REQUIRE(session.open(file));
        expect({6, 3, 1.5f});
    }
}

TEST_CASE("if the plugin is missing, a pbrt file's light stays a light", "[emission][pbrt]") {
    Plugins plugins;
    Folder folder;
    {
        document::Session session{plugins.registry};
        REQUIRE(write_file_atomic(folder.file("in.pbrt"), sphere_of_emissive));
        REQUIRE(session.open(folder.file("in.pbrt")));
        REQUIRE(session.set_param(session.scene().instances[{1}].material, "scale", Value::number(6)));
        REQUIRE(session.export_to(folder.file("out.pbrt"), version("v4")));
    }
    const std::filesystem::path all = restage::test::build_dir() / "lib/restage/plugins";
    Log log{[](LogLevel, std::string_view) {}};
    plugin::Registry registry{log, io::with_services()};
    registry.scan(std::vector<plugin::SearchPath>{{all / "importer-pbrt", true}, {all / "material-diffuse", true}});
    document::Session session{registry};
    REQUIRE(session.open(folder.file("out.pbrt")));
    const Instance* ball = session.scene().instances.find(Id<Instance>{1});
    REQUIRE(ball);
    REQUIRE(ball->emission);
    CHECK(ball->emission->radiance == glm::vec3(6, 3, 1.5f));
    CHECK(session.scene().materials[ball->material].type == "diffuse");
}

TEST_CASE("an emissive texture is written to pbrt as its mean", "[emission][pbrt]") {
    Plugins plugins;
    Folder folder;
    document::Session session{plugins.registry};
    REQUIRE(write_file_atomic(folder.file("in.pbrt"),
                              "WorldBegin\nTexture \"squares\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [ 1 0.5 0 ] "
                              "\"rgb tex2\" [ 0 0 0 ]\nMaterial \"emissive\" \"texture radiance\" \"squares\" "
                              "\"float scale\" 6\nShape \"sphere\"\n"));
    REQUIRE(session.open(folder.file("in.pbrt")));
    const Instance* ball = session.scene().instances.find(Id<Instance>{1});
    REQUIRE(ball);
    const auto texture = session.scene().materials[ball->material].params.texture("radiance");
    REQUIRE(texture);
    CHECK(io::mean_of(session.scene(), texture) == glm::vec3(0.5f, 0.25f, 0));
    CHECK(io::mean_of(session.scene(), {}) == glm::vec3(1));
    REQUIRE(session.set_param(ball->material, "scale", Value::number(4)));
    const auto report = session.export_to(folder.file("out.pbrt"), version("v4"));
    REQUIRE(report);
    CHECK_THAT(read_file(folder.file("out.pbrt")).value(), ContainsSubstring("\"rgb L\" [ 2 1 0 ]"));
    bool said = false;
    for (const io::ReportEntry& entry : report->entries)
        said = said || io::to_string(entry).find("the mean of its texture is written") != std::string::npos;
    CHECK(said);
    REQUIRE(session.open(folder.file("out.pbrt")));
    ball = session.scene().instances.find(Id<Instance>{1});
    REQUIRE(ball);
    CHECK(session.scene().materials[ball->material].params.texture("radiance"));
}
