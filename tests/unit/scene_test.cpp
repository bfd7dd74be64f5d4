// SPDX-License-Identifier: Apache-2.0
// scene: tables, parameters, bounds, and builders of edits that refuse to leave a dangling id.
#include "scene/history.hpp"
#include "scene/uses.hpp"
#include "scene/validate.hpp"
#include "scene_room.hpp"

#include <array>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

using namespace restage;
using namespace restage::scene;
using test::not_a_number;
using test::Room;

TEST_CASE("a table never reuses an id", "[scene]") {
    Table<Group> table;
    table.set(table.next(), Group{.name = "a"}, 1);
    table.set(table.next(), Group{.name = "b"}, 2);
    table.set({1}, std::nullopt, 3);
    CHECK(table.size() == 2);
    CHECK(table.live() == 1);
    CHECK(table.find({1}) == nullptr);
    CHECK(table.version({1}) == 3);
    CHECK(table.next().value == 3);
    CHECK(table.find({0}) == nullptr);
    CHECK(table.find({99}) == nullptr);
}

TEST_CASE("ParamSet keeps the order of first setting and finds by id", "[scene]") {
    ParamSet params;
    params.set("b", Value::number(1));
    params.set("a", Value::color(1, 2, 3));
    params.set("b", Value::number(2));
    REQUIRE(params.entries().size() == 2);
    CHECK(params.entries()[0].id == "b");
    CHECK(params.number("b", 0) == 2);
    CHECK(params.number("c", 7) == 7);
    CHECK(params.color("a", {}) == std::array<float, 3>{1, 2, 3});
    params.remove("b");
    CHECK(params.find("b") == nullptr);
}

TEST_CASE("choices and defaults come from the table line", "[scene]") {
    const model::Param line{
        .id = "remap", .type = model::ParamType::choice, .int_def = 2, .choices = {"v4", "v3", "none"}};
    CHECK(line.choice_index("v4") == 0);
    CHECK(line.choice_index("none") == 2);
    CHECK_FALSE(line.choice_index("v"));
    CHECK(default_value(line).text == "none");
    CHECK(misfit(line, Value::choice("v3")).empty());
    CHECK(misfit(line, Value::choice("v2")) == " cannot be \"v2\"; v4|v3|none are possible");
    CHECK(misfit(line, Value::number(1)) == " has a different type");
    model::Param beyond = line;
    beyond.int_def = 9;
    CHECK(default_value(beyond).text.empty()); // a broken table, but no crash
    const model::Param count{.id = "n", .type = model::ParamType::integer, .int_max = 3};
    CHECK(misfit(count, Value::integer(3)).empty());
    CHECK(misfit(count, Value::integer(4)) == ": 4 is out of its range, 0 to 3");
    CHECK(Value::integer(16777217).i == 16777217); // which is not a float
    const model::Param color{.id = "c", .type = model::ParamType::color, .def = {1, 2, 3, 4}};
    CHECK(default_value(color) == Value::color(1, 2, 3));
}

TEST_CASE("things in use are not removed", "[scene]") {
    Room r;
    const auto refused = remove(r.scene, r.oak);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message ==
          "material \"oak\" is used by instance \"chair\", instance \"chair 2\": change these first");
    CHECK_FALSE(remove(r.scene, r.camera)); // the active one
    CHECK_FALSE(remove(r.scene, r.chairs));
    CHECK_FALSE(remove(r.scene, Id<Material>{77}));
    r.add(Material{.name = "blend", .type = "mix"});
    Value steel{.type = model::ParamType::material, .material = r.steel};
    apply(r.scene, *set_param(r.scene, Id<Material>{3}, "first", steel));
    apply(r.scene, *set_material(r.scene, std::array{r.lamp}, r.oak));
    CHECK_FALSE(remove(r.scene, r.steel));
    apply(r.scene, remove_unused(r.scene)); // blend and steel only refer to each other
    CHECK(r.scene.materials.live() == 1);
    CHECK(validate(r.scene).empty());
}

TEST_CASE("removing the last of a group removes the group", "[scene]") {
    Room r;
    apply(r.scene, *remove_instances(r.scene, std::array{r.chair}));
    CHECK(r.scene.groups.find(r.chairs));
    apply(r.scene, *remove_instances(r.scene, std::array{r.chair2, r.chair2}));
    CHECK_FALSE(r.scene.groups.find(r.chairs));
    CHECK(r.scene.groups.find(r.room));
    apply(r.scene, *remove_instances(r.scene, std::array{r.lamp}));
    CHECK(r.scene.groups.live() == 0);
    CHECK(r.scene.materials.live() == 2);
    CHECK_FALSE(remove_instances(r.scene, std::array{r.lamp}));
}

TEST_CASE("a duplicate shares geometry, moves in world space and includes whole groups", "[scene]") {
    Room r;
    apply(r.scene, *set_transform(r.scene, r.chair, glm::scale(glm::dmat4(1), {2, 2, 2})));
    const auto copies =
        duplicate_instances(r.scene, std::array{r.chair, r.chair2}, glm::translate(glm::dmat4(1), {3, 0, 0}));
    REQUIRE(copies);
    apply(r.scene, copies->edit);
    const Instance& copy = r.scene.instances[copies->copies[0]];
    CHECK(copy.mesh == r.mesh);
    CHECK(copy.name == "chair 3");
    CHECK(r.scene.instances[copies->copies[1]].name == "chair 4");
    CHECK(copy.object_to_world[3].x == 3);
    CHECK(copy.object_to_world[0].x == 2);
    CHECK(copy.group != r.chairs); // all chairs: the group was copied
    CHECK(r.scene.groups[copy.group].name == "chairs 2");
    CHECK(r.scene.groups[copy.group].parent == r.room); // the lamp was not selected: the room was not copied
    const auto lamp = duplicate_instances(r.scene, std::array{r.lamp}, glm::dmat4(1));
    apply(r.scene, lamp->edit);
    CHECK(r.scene.instances[lamp->copies[0]].group == r.room);
    CHECK(r.scene.meshes.live() == 1);
    CHECK(validate(r.scene).empty());
    CHECK_FALSE(duplicate_instances(r.scene, std::array{r.lamp}, glm::dmat4(0)));
}

TEST_CASE("builders refuse invalid input", "[scene]") {
    Room r;
    CHECK_FALSE(set_transform(r.scene, r.chair, glm::dmat4(0)));
    CHECK_FALSE(set_transform(r.scene, r.chair, glm::dmat4(std::numeric_limits<double>::quiet_NaN())));
    CHECK_FALSE(set_transform(r.scene, Id<Instance>{99}, glm::dmat4(1)));
    CHECK_FALSE(set_material(r.scene, std::array{r.chair}, Id<Material>{99}));
    CHECK_FALSE(set_param(r.scene, r.oak, "reflectance", Value::number(not_a_number)));
    CHECK_FALSE(set_param(r.scene, r.oak, "reflectance", Value{.type = model::ParamType::color, .texture = {5}}));
    CHECK_FALSE(set_active_camera(r.scene, {4}));
}

TEST_CASE("the original text of a value is dropped when the value is edited", "[scene]") {
    Room r;
    const OriginValue eta{"eta", "\"spectrum eta\" [ \"metal-Au-eta\" ]"}, k{"k", "\"spectrum k\" [ \"metal-Au-k\" ]"};
    const Origin kept{"\"float x\" [ 1 ]\n", "pbrt-v4", {eta, k}};
    apply(r.scene, *modify(r.scene, r.steel, "", [&](Material& m) { m.origin = kept; }));
    History history;
    history.push(r.scene, *set_param(r.scene, r.steel, "roughness", Value::number(1)));
    CHECK(r.scene.materials[r.steel].origin == kept);
    history.push(r.scene, *set_param(r.scene, r.steel, "eta", Value::color(1, 1, 1)));
    CHECK(r.scene.materials[r.steel].origin == Origin{kept.verbatim, kept.format, {k}});
    history.undo(r.scene);
    CHECK(r.scene.materials[r.steel].origin == kept);
    history.push(r.scene, *set_material_type(r.scene, r.steel, "diffuse"));
    CHECK(r.scene.materials[r.steel].origin == Origin{kept.verbatim, kept.format, {}});
    Origin whole{"\"float y\" [ 2 ]", "pbrt-v4", {{"*", "\"string type\" [ \"hair\" ]"}, {"*", "\"float x\" [ 1 ]"}}};
    forget_edited(whole, "anything");
    CHECK(whole == Origin{"\"float y\" [ 2 ]", "pbrt-v4", {}});
}

TEST_CASE("bounds follow the transform", "[scene]") {
    Room r;
    apply(r.scene, *set_transform(r.scene, r.chair, glm::rotate(glm::dmat4(1), glm::radians(90.0), {0, 0, 1})));
    const Bounds b = world_bounds(r.scene, r.chair);
    CHECK(b.lower.x == Catch::Approx(-2));
    CHECK(b.upper.y == Catch::Approx(1));
    apply(r.scene, *set_transform(r.scene, r.lamp, glm::translate(glm::dmat4(1), {0, 0, 50})));
    CHECK(world_bounds(r.scene).upper.z == 50);
    apply(r.scene, *set_hidden(r.scene, std::array{r.lamp}, true));
    CHECK(world_bounds(r.scene).upper.z == 0);
    CHECK(world_bounds(Scene{}).empty());
    CHECK(world_bounds(Scene{}).radius() == 0);
}

TEST_CASE("free names for many copies are found quickly", "[edits]") {
    std::set<std::string> taken, again;
    TriedNumbers tried;
    for (int i = 1; i <= 20000; ++i)
        taken.insert("oak " + std::to_string(i));
    taken.insert("elm 3");
    again = taken;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 1; i <= 20000; ++i)
        CHECK_FALSE(next_name("oak " + std::to_string(i), taken, &tried).empty());
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(2)); // 200 million lookups took a minute
    CHECK(taken.size() == 40001);
    CHECK(taken.contains("oak 40000"));
    // The same names with and without the cache.
    tried.clear();
    for (const char* name : {"elm", "elm", "elm 2", "elm 3", "elm", "elm 9", "elm 4", "elm"}) {
        std::set<std::string> plain = again;
        CHECK(next_name(name, again, &tried) == next_name(name, plain));
    }
}
