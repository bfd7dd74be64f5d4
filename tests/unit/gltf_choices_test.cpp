// SPDX-License-Identifier: Apache-2.0
// Scenes and material variants of glTF files: what there is to choose from is told, and a choice is read.
#include "document/looks.hpp"
#include "document/variants.hpp"
#include "gltf_builder.hpp"
#include "io/choices.hpp"

using namespace restage;
using namespace restage::tests;

namespace {

// Two scenes of one mesh each; the first has two variants, of which "Night" replaces its red by blue.
Builder shop() {
    Builder b;
    const auto color = [](const char* name, float r, float g, float bl) {
        return json{{"name", name}, {"pbrMetallicRoughness", {{"baseColorFactor", {r, g, bl, 1}}}}};
    };
    b.root["materials"] = {color("red", 1, 0, 0), color("blue", 0, 0, 1)};
    b.root["meshes"].push_back(b.root["meshes"][0]);
    b.root["meshes"][0]["primitives"][0]["material"] = 0;
    b.root["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
        {{"material", 0}, {"variants", {0}}}, {{"material", 1}, {"variants", {1}}}};
    b.root["nodes"] = {{{"mesh", 0}, {"name", "chair"}}, {{"mesh", 1}, {"name", "table"}}};
    b.root["scenes"] = {{{"name", "Shop"}, {"nodes", {0}}}, {{"name", "Store"}, {"nodes", {1}}}};
    b.root["extensionsUsed"] = {"KHR_materials_variants"};
    b.root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "Day"}}, {{"name", "Night"}}};
    return b;
}

struct Read : ModelFiles {
    Read() { write("shop.gltf", shop().text()); }
    io::ImportedScene with(const char* option, const char* value) const {
        io::ImportOptions options;
        if (*option) options.values.set(option, {.type = scene::ParamType::text, .text = value});
        return load("shop.gltf", options);
    }
    static std::string first(const io::ImportedScene& in) { // "chair blue"
        std::string text;
        in.scene.instances.each([&](auto, const scene::Instance& i) {
            if (text.empty()) text = i.name + " " + in.scene.materials[i.material].name;
        });
        return text;
    }
};

} // namespace

TEST_CASE("a glTF file tells its scenes and variants", "[gltf]") {
    const Read files;
    const auto choices = io::choices_of(files.with("", "").report);
    REQUIRE(choices.size() == 2);
    for (const io::Choices& one : choices) {
        if (one.option == "scene")
            CHECK(one.values == std::vector<std::string>{"Shop", "Store"});
        else
            CHECK(one.values == std::vector<std::string>{"Day", "Night"});
    }
}

TEST_CASE("a variant of a glTF file has its own materials", "[gltf]") {
    const Read files;
    CHECK(Read::first(files.with("", "")) == "chair red");
    CHECK(Read::first(files.with("variant", "Day")) == "chair red");
    CHECK(Read::first(files.with("variant", "Night")) == "chair blue");
    CHECK(Read::first(files.with("variant", "2")) == "chair blue");
    CHECK(Read::first(files.with("scene", "Store")).starts_with("table"));
    io::ImportOptions options;
    options.values.set("variant", {.type = scene::ParamType::text, .text = "Dusk"});
    const auto none = io::import_scene(files.path("shop.gltf"), files.registry, options);
    REQUIRE_FALSE(none);
    CHECK_THAT(none.error().message,
               Catch::Matchers::ContainsSubstring("there is no variant \"Dusk\"; there are 1 \"Day\", 2 \"Night\""));
}

TEST_CASE("a variant that names a missing material is an error", "[gltf]") {
    const Read files;
    Builder b = shop();
    b.root["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"][1]["material"] = 7;
    files.write("bad.gltf", b.text());
    io::ImportOptions options;
    options.values.set("variant", {.type = scene::ParamType::text, .text = "Night"});
    const auto in = io::import_scene(files.path("bad.gltf"), files.registry, options);
    REQUIRE_FALSE(in);
    CHECK_THAT(in.error().message, Catch::Matchers::ContainsSubstring("material 7"));
}

TEST_CASE("each variant becomes a look in which only materials differ", "[gltf][looks]") {
    const Read files;
    document::Session session(files.registry);
    REQUIRE(session.open(files.path("shop.gltf")));
    const auto chair = session.find<scene::Instance>("chair");
    const auto material = [&](const document::Session& s) {
        return s.scene().materials[s.scene().instances[chair].material].name;
    };
    const std::vector<std::string> names = document::variants_of(session);
    REQUIRE(names == std::vector<std::string>{"Day", "Night"});
    const auto read = document::read_variants(session.base(), names, files.registry);
    REQUIRE(read);
    const auto made = document::looks_from_variants(session, *read);
    REQUIRE(made);
    CHECK(*made == names);
    CHECK(session.history().size() == 1); // one step
    CHECK(material(session) == "red"); // the scene stays as it is

    scene::Instance before = session.scene().instances[chair];
    REQUIRE(document::go_to_look(session, 1));
    CHECK(material(session) == "blue");
    scene::Instance after = session.scene().instances[chair];
    after.material = before.material;
    CHECK(after == before);

    REQUIRE(session.save_project(files.path("shop.restage")));
    document::Session again(files.registry);
    REQUIRE(again.open(files.path("shop.restage")));
    REQUIRE(again.looks().list.size() == 2);
    CHECK(material(again) == "blue");
    REQUIRE(document::go_to_look(again, 0));
    CHECK(material(again) == "red");

    REQUIRE(session.undo());
    REQUIRE(session.undo());
    CHECK(session.looks().list.empty());
    CHECK(document::looks_from_variants(session, {}).error().message.ends_with(": the file has no variants"));
}
