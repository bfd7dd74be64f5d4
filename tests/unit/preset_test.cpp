// SPDX-License-Identifier: Apache-2.0
// Material presets: those that come with Restage fit the plugins' tables and name their sources; errors name the line;
// writing and reading keeps textures and components; an equal material of the scene is reused.
#include "document/preset.hpp"
#include "document/projected.hpp"
#include "document/session.hpp"
#include "paths.hpp"
#include "project_room.hpp"
#include "scene/bounds.hpp"
#include "scene/box_projection.hpp"
#include "scene/same_material.hpp"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <map>
#include <set>

using namespace restage;
using namespace restage::scene;
using test::Fixture;
namespace fs = std::filesystem;

namespace {

std::string error_of(const Fixture& f, std::string_view text) {
    const std::string file = f.at("broken.json");
    REQUIRE(write_file_atomic(file, text));
    const auto read = document::read_preset(file, f.registry);
    REQUIRE_FALSE(read);
    REQUIRE(read.error().message.starts_with(file + ":"));
    return read.error().message.substr(file.size() + 1);
}

const char* const planks = R"({
  "restage": "material", "name": "Planks", "category": "Wood", "type": "mix",
  "params": {
    "first": {"material": "oak"},
    "second": {"material": "steel"},
    "amount": {"texture": "mask"}
  },
  "materials": {
    "oak": {"type": "coateddiffuse", "params": {"reflectance": {"texture": "grain"}, "max_depth": 3}},
    "steel": {"type": "conductor", "params": {"distribution": "beckmann", "use_reflectance": true, "reflectance": 0.6}}
  },
  "textures": {
    "grain": {"type": "imagemap", "image": {"file": "scenes/wood.png", "encoding": "gamma", "gamma": 1.8},
              "params": {"uscale": 3}},
    "mask": {"type": "checkerboard", "float": true, "params": {"tex1": 0.25, "tex2": {"texture": "mask 2"}}},
    "mask 2": {"type": "scale", "float": true, "params": {}}
  },
  "x-note": "ignored"
})";

} // namespace

TEST_CASE("the presets that come with Restage fit the tables of the plugins", "[presets]") {
    const Fixture f;
    const auto all = document::presets_in(test::source_dir() / "materials", f.registry);
    for (const std::string& problem : all.problems)
        UNSCOPED_INFO(problem);
    CHECK(all.problems.empty());
    CHECK(all.presets.size() >= 60);
    std::set<std::string> names;
    std::map<std::string, std::size_t> categories;
    for (const document::Preset& preset : all.presets) {
        INFO(preset.file.string());
        CHECK(names.insert(preset.name).second);
        CHECK(preset.source.size() > 20);
        CHECK(preset.file.filename() == document::preset_file_name(preset.name));
        CHECK(preset.parts.materials.find(preset.material) != nullptr);
        ++categories[preset.category];
    }
    for (const char* category : {"Metal", "Glass", "Plastic", "Fabric", "Wood", "Stone", "Ceramic", "Car paint", "Wax",
                                 "Skin", "Liquid", "Paint", "Paper"})
        CHECK(categories[category] > 0);
}

TEST_CASE("errors of a preset name its file, the line and what would be right", "[presets]") {
    const Fixture f;
    CHECK(error_of(f, "{\n\"restage\": }").starts_with("2:12: not JSON"));
    CHECK(error_of(f, "{\"restage\": \"scene\"}").starts_with("1: not a material preset"));
    const auto with = [&](const std::string& type, const std::string& rest) {
        return error_of(f, "{\"restage\": \"material\", \"name\": \"a\", \"category\": \"b\",\n\"type\": \"" + type +
                               "\",\n" + rest + "}");
    };
    CHECK(with("none such", "\"params\": {}") == R"(2: no plugin provides the material type "none such")");
    CHECK(with("diffuse", "\"params\": {\n\"sheen\": 1}") == R"(4: a diffuse has no parameter "sheen")");
    CHECK(with("diffuse", "\"params\": {\n\n\"sigma\": 100}") == R"(5: "sigma" is 100; it must be from 0 to 90)");
    CHECK(with("diffuse", "\"params\": {\"reflectance\": [1, 2]}") ==
          R"(3: "reflectance" must be a colour: one number or three)");
    CHECK(with("dielectric", "\"params\": {\"thin\": 1}") == R"(3: "thin" must be true or false)");
    CHECK(with("dielectric", "\"params\": {\"eta\": {\"texture\": \"t\"}}") == R"(3: "eta" must be a value)");
    CHECK(with("conductor", "\"params\": {\"distribution\": \"gauss\"}") ==
          R"(3: "distribution" must be one of ggx|beckmann)");
    CHECK(with("diffuse", "\"params\": {\"reflectance\": {\"texture\": \"t\"}}") ==
          R"(3: there is no "t" in "textures")");
    CHECK(with("diffuse",
               "\"params\": {\"reflectance\": {\"texture\": \"t\"}},\n\"textures\": {\"t\": {\"type\": "
               "\"scale\", \"params\": {\n\"tex\": {\"texture\": \"t\"}}}}") == R"(4: "t" refers to itself)");
    CHECK(with("diffuse",
               "\"params\": {\"reflectance\": {\"texture\": \"t\"}},\n\"textures\": {\"t\": {\"type\": "
               "\"imagemap\",\n\"image\": {\"file\": \"none.png\"}}}")
              .starts_with("5: " + f.at("none.png")));
    CHECK(with("diffuse", "\"parms\": {}") == R"(3: "parms" is not known here)");
}

TEST_CASE("a preset keeps its textures and components when it is written and read", "[presets]") {
    Fixture f;
    REQUIRE(write_file_atomic(f.at("planks.json"), planks));
    auto read = document::read_preset(f.at("planks.json"), f.registry);
    INFO((read ? "" : read.error().message));
    REQUIRE(read);
    REQUIRE(document::read_images(*read));
    CHECK(read->name == "Planks");
    CHECK(read->category == "Wood");
    CHECK(read->parts.materials.live() == 3);
    CHECK(read->parts.textures.live() == 3);

    fs::create_directories(f.folder / "own");
    const fs::path to = f.folder / "own" / document::preset_file_name("My planks, old");
    CHECK(to.filename() == "my-planks-old.json");
    REQUIRE(document::write_preset(*read, to));
    CHECK(fs::exists(f.folder / "own/my-planks-old-wood.png"));
    auto again = document::read_preset(to, f.registry);
    INFO((again ? "" : again.error().message));
    REQUIRE(again);
    REQUIRE(document::read_images(*again));
    CHECK(material_hash(again->parts, again->material) == material_hash(read->parts, read->material));
    CHECK_FALSE(same_material(again->parts, again->material, read->parts, read->material)); // another file
    REQUIRE(document::write_preset(*again, to)); // over itself
    const auto third = document::read_preset(to, f.registry);
    REQUIRE(third);
    CHECK(same_material(again->parts, again->material, third->parts, third->material));
}

TEST_CASE("an image without a file is saved beside the preset", "[presets]") {
    Fixture f;
    Scene s;
    const auto pixels = std::make_shared<const PixelData>(
        PixelData{.width = 2, .height = 1, .channels = 3, .values = {0.1f, 0.2f, 0.3f, 4, 5, 6}});
    apply(s, insert(s, Image{.name = "made", .data = pixels}, ""));
    apply(s, insert(s, Texture{.name = "made", .type = "imagemap", .image = {1}}, ""));
    Material material{.name = "Glow", .type = "diffuse"};
    material.params.set("reflectance", {.type = model::ParamType::color, .texture = {1}});
    apply(s, insert(s, material, ""));
    const auto preset = document::preset_of(s, {1});
    REQUIRE(preset);
    REQUIRE(document::write_preset(*preset, f.at("glow.json")));
    auto read = document::read_preset(f.at("glow.json"), f.registry);
    REQUIRE(read);
    REQUIRE(document::read_images(*read));
    read->parts.images.each([&](auto, const Image& i) { CHECK(i.data->values == pixels->values); });
}

TEST_CASE("a textured material gives coordinates to objects that have none, if its textures need some", "[presets]") {
    Fixture f;
    document::Session session(f.registry);
    f.opened(session);
    REQUIRE(write_file_atomic(f.at("planks.json"), planks));
    auto planks_read = document::read_preset(f.at("planks.json"), f.registry);
    auto gold = document::read_preset(test::source_dir() / "materials/gold.json", f.registry);
    REQUIRE(planks_read);
    REQUIRE(gold);
    REQUIRE(document::read_images(*planks_read));
    Scene s = session.scene();
    const auto bare = s.meshes.next(), mapped = Id<Mesh>{bare.value + 1};
    auto with = std::make_shared<MeshData>();
    with->positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}};
    with->triangles = {{0, 1, 2}};
    compute_bounds(*with);
    apply(s, insert(s, Mesh{.name = "bare", .data = std::make_shared<MeshData>(*with)}, ""));
    with->uvs = {{0, 0}, {1, 0}, {0, 1}};
    apply(s, insert(s, Mesh{.name = "mapped", .data = with}, ""));
    const auto first = s.instances.next();
    const Id<Instance> both[] = {first, {first.value + 1}};
    apply(s, insert(s, Instance{.name = "a", .mesh = bare}, ""));
    apply(s, insert(s, Instance{.name = "b", .mesh = mapped}, ""));
    const auto give = [&](const document::Preset& preset) {
        return document::project_where_needed(s, document::give_preset(s, preset, both).value(), both, f.registry,
                                              {0, 1, 0});
    };
    CHECK(give(*gold).objects.empty()); // has no textures
    const document::Projected given = give(*planks_read);
    CHECK(given.objects == std::vector{first});
    CHECK(given.edit.label == "Material Planks");
    apply(s, given.edit);
    CHECK(s.instances[both[1]].mesh == mapped);
    const Mesh& made = s.meshes[s.instances[first].mesh];
    REQUIRE(has_uv(made));
    float widest = 0;
    for (const glm::vec2& uv : made.data->uvs)
        widest = std::max({widest, uv.x, uv.y});
    CHECK(widest == 1); // covers it once
    CHECK(give(*planks_read).objects.empty()); // it has them now
    const auto material = s.instances[first].material;
    apply(s, set_param(s, material, "amount", Value::number(0.5f)).value());
    const Id<Instance> third[] = {s.instances.next()};
    apply(s, insert(s, Instance{.name = "c", .mesh = bare, .material = material}, ""));
    CHECK(document::project_where_needed(s, {}, third, f.registry, {0, 1, 0}).objects.size() == 1); // its oak
}

TEST_CASE("giving a preset reuses an equal material, else adds one, as one step", "[presets]") {
    Fixture f;
    document::Session session(f.registry);
    f.opened(session);
    REQUIRE(write_file_atomic(f.at("planks.json"), planks));
    auto preset = document::read_preset(f.at("planks.json"), f.registry);
    REQUIRE(preset);
    REQUIRE(document::read_images(*preset));
    std::vector<Id<Instance>> ids;
    session.scene().instances.each([&](Id<Instance> id, const Instance&) { ids.push_back(id); });
    const auto give = [&](std::size_t to) {
        const Id<Instance> one[] = {ids[to]};
        const auto done = session.edit(document::give_preset(session.scene(), *preset, one));
        INFO((done ? "" : done.error().message));
        REQUIRE(done);
        return session.scene().instances[ids[to]].material;
    };
    const std::size_t before = session.scene().materials.live(), objects = session.scene().instances.live();
    const auto first = give(0);
    CHECK(session.scene().materials.live() == before + 3); // with its components
    CHECK(session.scene().instances.live() == objects);
    CHECK(session.scene().materials[first].name == "Planks");
    CHECK(session.history().position() == 1);
    CHECK(session.history().undo_label() == "Material Planks");
    CHECK(give(1) == first);
    CHECK(session.scene().materials.live() == before + 3);
    REQUIRE(session.edit(set_param(session.scene(), first, "amount", Value::number(0.5f))));
    CHECK(give(2) != first); // no longer equal
    CHECK(session.scene().instances[ids[1]].material == first);
    REQUIRE(session.undo());
    REQUIRE(session.undo());
    REQUIRE(session.undo());
    REQUIRE(session.undo());
    CHECK(session.scene().materials.live() == before);
}
