// SPDX-License-Identifier: Apache-2.0
// scene: edits and their inverses, history and gestures, builders that refuse what would leave a dangling id, validate.
#include "scene/bounds.hpp"
#include "scene/edits.hpp"
#include "scene/history.hpp"
#include "scene/uses.hpp"
#include "scene/validate.hpp"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

using namespace restage;
using namespace restage::scene;

namespace {

std::shared_ptr<MeshData> triangle() {
    auto data = std::make_shared<MeshData>();
    data->positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
    data->triangles = {{0, 1, 2}};
    compute_bounds(*data);
    return data;
}

struct Room { // two chairs and a lamp in groups, two materials, one camera
    Scene scene;
    Id<Mesh> mesh;
    Id<Material> oak, steel;
    Id<Group> room, chairs;
    Id<Instance> chair, chair2, lamp;
    Id<Camera> camera;

    template <class T>
    Id<T> add(T item) {
        const Id<T> id = table<T>(scene).next();
        apply(scene, insert(scene, std::move(item), "add"));
        return id;
    }
    Room() {
        mesh = add(Mesh{.name = "triangle", .data = triangle()});
        oak = add(Material{.name = "oak", .type = "diffuse"});
        steel = add(Material{.name = "steel", .type = "conductor"});
        room = add(Group{.name = "room"});
        chairs = add(Group{.name = "chairs", .parent = room});
        chair = add(Instance{.name = "chair", .mesh = mesh, .material = oak, .group = chairs});
        chair2 = add(Instance{.name = "chair 2", .mesh = mesh, .material = oak, .group = chairs});
        lamp = add(Instance{.name = "lamp", .mesh = mesh, .material = steel, .group = room});
        camera = add(Camera{.name = "camera"});
        apply(scene, *set_active_camera(scene, camera));
    }
};

// All that a scene holds, as a comparable value: what undo must restore. Versions move on and are left out.
std::vector<AnyChange> contents(const Scene& scene) {
    std::vector<AnyChange> all;
    const auto push = [&]<class T>(const Table<T>& slots) {
        slots.each([&](Id<T> id, const T& item) { all.push_back(Change<T>{id, std::nullopt, item}); });
    };
    push(scene.meshes), push(scene.images), push(scene.textures), push(scene.materials), push(scene.media);
    push(scene.groups), push(scene.instances), push(scene.lights), push(scene.cameras);
    all.push_back(ChangeOne<std::optional<Environment>>{{}, scene.environment.value});
    all.push_back(ChangeOne<Id<Camera>>{{}, scene.active_camera.value});
    all.push_back(ChangeOne<Film>{{}, scene.film.value});
    all.push_back(ChangeOne<Settings>{{}, scene.settings.value});
    return all;
}

bool same(const Scene& a, const Scene& b) {
    const auto x = contents(a), y = contents(b);
    if (x.size() != y.size()) return false;
    for (std::size_t i = 0; i < x.size(); ++i)
        if (x[i].index() != y[i].index() || !std::visit(
                                                [&]<class C>(const C& c) {
                                                    const C& d = std::get<C>(y[i]);
                                                    if constexpr (requires { c.id; })
                                                        return c.id == d.id && c.after == d.after;
                                                    else
                                                        return c.after == d.after;
                                                },
                                                x[i]))
            return false;
    return true;
}

bool mentions(const std::vector<Problem>& problems, Problem::Severity severity, std::string_view part) {
    return std::any_of(problems.begin(), problems.end(), [&](const Problem& p) {
        return p.severity == severity && p.sentence.find(part) != std::string::npos;
    });
}

constexpr auto error = Problem::Severity::error;
constexpr auto warning = Problem::Severity::warning;
const float not_a_number = std::numeric_limits<float>::quiet_NaN();

} // namespace

TEST_CASE("a table names slots for good", "[scene]") {
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
    CHECK(choice_index("v4|v3|none", "v4") == 0);
    CHECK(choice_index("v4|v3|none", "none") == 2);
    CHECK_FALSE(choice_index("v4|v3|none", "v"));
    const RestageParam line{.id = "remap",
                            .label = "",
                            .type = RESTAGE_ENUM,
                            .def = {2},
                            .unit = "",
                            .choices = "v4|v3|none",
                            .tooltip = ""};
    CHECK(default_value(line).text == "none");
    RestageParam beyond = line;
    beyond.def[0] = 9;
    CHECK(default_value(beyond).text.empty()); // a broken table, but no crash
    const RestageParam color{.id = "c", .label = "", .type = RESTAGE_COLOR, .def = {1, 2, 3, 4}};
    CHECK(default_value(color) == Value::color(1, 2, 3));
}

TEST_CASE("undo restores the scene, redo does it again, for every kind of edit", "[scene]") {
    Room r;
    History history;
    const Scene start = r.scene;
    const Id<Instance> both[] = {r.chair, r.lamp};
    const auto push = [&](Result<Edit> edit) {
        REQUIRE(edit);
        const Version before = r.scene.clock;
        REQUIRE(history.push(r.scene, std::move(*edit)));
        CHECK(r.scene.clock > before);
    };
    push(insert(r.scene, Light{.name = "sun", .kind = RESTAGE_LIGHT_DISTANT}, "Add sun"));
    push(duplicate_instances(r.scene, both, glm::translate(glm::dmat4(1), {1, 0, 0}))->edit);
    push(remove_instances(r.scene, std::array{r.chair, r.chair2}));
    push(set_material(r.scene, std::array{r.lamp, Id<Instance>{5}}, r.oak)); // 5: the copy of the lamp
    push(remove(r.scene, r.steel));
    push(set_param(r.scene, r.oak, "reflectance", Value::color(1, 0, 0)));
    push(reset_param(r.scene, r.oak, "reflectance"));
    push(set_emission(r.scene, r.lamp, Emission{{1, 1, 1}, false}));
    push(set_hidden(r.scene, std::array{r.lamp}, true));
    push(set_environment(r.scene, Environment{.name = "sky"}));
    push(set_film(r.scene, Film{.width = 10, .height = 10}));
    push(set_settings(r.scene, Settings{.max_depth = 3}));
    push(rename(r.scene, r.lamp, "light"));
    push(set_transform(r.scene, r.lamp, glm::scale(glm::dmat4(1), {2, 2, 2})));
    const Scene end = r.scene;
    CHECK_FALSE(same(start, end));
    const std::size_t n = history.size();
    for (std::size_t i = 0; i < n; ++i)
        REQUIRE(history.undo(r.scene));
    CHECK_FALSE(history.undo(r.scene));
    CHECK(same(start, r.scene));
    while (history.redo(r.scene)) {
    }
    CHECK(history.position() == n);
    CHECK(same(end, r.scene));
}

TEST_CASE("a drag is one edit, and one that returns is none", "[scene]") {
    Room r;
    History history;
    const Scene start = r.scene;
    for (int i = 1; i <= 10; ++i)
        REQUIRE(
            history.push(r.scene, *set_transform(r.scene, r.chair, glm::translate(glm::dmat4(1), {i, 0, 0})), "drag"));
    CHECK(history.size() == 1);
    CHECK(r.scene.instances[r.chair].object_to_world[3].x == 10);
    history.end_gesture();
    history.push(r.scene, *set_transform(r.scene, r.chair, glm::translate(glm::dmat4(1), {20, 0, 0})), "drag");
    CHECK(history.size() == 2);
    history.undo(r.scene);
    CHECK(r.scene.instances[r.chair].object_to_world[3].x == 10);
    history.undo(r.scene);
    CHECK(same(start, r.scene));
    history.push(r.scene, *set_transform(r.scene, r.chair, glm::translate(glm::dmat4(1), {1, 0, 0})), "d");
    history.push(r.scene, *set_transform(r.scene, r.chair, glm::dmat4(1)), "d");
    CHECK(history.size() == 0); // also: pushing dropped what could be redone
    CHECK(same(start, r.scene));
    CHECK_FALSE(history.push(r.scene, *set_transform(r.scene, r.chair, glm::dmat4(1)))); // changes nothing
    CHECK(history.size() == 0);
}

TEST_CASE("a gesture may insert and then move what it inserted", "[scene]") {
    Room r;
    History history;
    const Scene start = r.scene;
    const auto copy = duplicate_instances(r.scene, std::array{r.lamp}, glm::dmat4(1));
    history.push(r.scene, copy->edit, "alt-drag");
    history.push(r.scene, *move_instances(r.scene, copy->copies, glm::translate(glm::dmat4(1), {0, 5, 0})), "alt-drag");
    CHECK(history.size() == 1);
    CHECK(r.scene.instances[copy->copies[0]].object_to_world[3].y == 5);
    history.undo(r.scene);
    CHECK(same(start, r.scene));
    history.redo(r.scene);
    CHECK(r.scene.instances[copy->copies[0]].object_to_world[3].y == 5);
}

TEST_CASE("clean means: as the file holds it", "[scene]") {
    Room r;
    History history;
    const auto change = [&](std::uint32_t width) {
        history.push(r.scene, set_film(r.scene, Film{.width = width, .height = 8}), "film");
    };
    CHECK(history.clean());
    change(1);
    CHECK_FALSE(history.clean());
    history.mark_clean();
    change(2); // not merged into the saved entry
    CHECK(history.size() == 2);
    CHECK_FALSE(history.clean());
    history.undo(r.scene);
    CHECK(history.clean());
    history.undo(r.scene);
    change(3); // the saved state can no longer be reached
    CHECK_FALSE(history.clean());
    history.undo(r.scene);
    CHECK_FALSE(history.clean());
}

TEST_CASE("what is in use is not removed", "[scene]") {
    Room r;
    const auto refused = remove(r.scene, r.oak);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message ==
          "material \"oak\" is used by instance \"chair\", instance \"chair 2\": change these first");
    CHECK_FALSE(remove(r.scene, r.camera)); // the active one
    CHECK_FALSE(remove(r.scene, r.chairs));
    CHECK_FALSE(remove(r.scene, Id<Material>{77}));
    r.add(Material{.name = "blend", .type = "mix"});
    Value steel{.type = RESTAGE_MATERIAL, .material = r.steel};
    apply(r.scene, *set_param(r.scene, Id<Material>{3}, "first", steel));
    apply(r.scene, *set_material(r.scene, std::array{r.lamp}, r.oak));
    CHECK_FALSE(remove(r.scene, r.steel));
    apply(r.scene, remove_unused(r.scene)); // blend and steel only hold each other
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

TEST_CASE("a duplicate shares geometry, moves in world space and takes whole groups along", "[scene]") {
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

TEST_CASE("builders refuse what cannot be", "[scene]") {
    Room r;
    CHECK_FALSE(set_transform(r.scene, r.chair, glm::dmat4(0)));
    CHECK_FALSE(set_transform(r.scene, r.chair, glm::dmat4(std::numeric_limits<double>::quiet_NaN())));
    CHECK_FALSE(set_transform(r.scene, Id<Instance>{99}, glm::dmat4(1)));
    CHECK_FALSE(set_material(r.scene, std::array{r.chair}, Id<Material>{99}));
    CHECK_FALSE(set_param(r.scene, r.oak, "reflectance", Value::number(not_a_number)));
    CHECK_FALSE(set_param(r.scene, r.oak, "reflectance", Value{.type = RESTAGE_COLOR, .texture = {5}}));
    CHECK_FALSE(set_active_camera(r.scene, {4}));
}

TEST_CASE("what stood for a value goes when the value is edited", "[scene]") {
    Room r;
    const std::string kept =
        "\"float x\" [ 1 ]\n=eta \"spectrum eta\" [ \"metal-Au-eta\" ]\n=k \"spectrum k\" [ \"metal-Au-k\" ]\n";
    apply(r.scene, *modify(r.scene, r.steel, "", [&](Material& m) { m.origin = {kept, "pbrt-v4"}; }));
    History history;
    history.push(r.scene, *set_param(r.scene, r.steel, "roughness", Value::number(1)));
    CHECK(r.scene.materials[r.steel].origin.verbatim == kept);
    history.push(r.scene, *set_param(r.scene, r.steel, "eta", Value::color(1, 1, 1)));
    CHECK(r.scene.materials[r.steel].origin.verbatim == "\"float x\" [ 1 ]\n=k \"spectrum k\" [ \"metal-Au-k\" ]\n");
    history.undo(r.scene);
    CHECK(r.scene.materials[r.steel].origin.verbatim == kept);
    history.push(r.scene, *set_material_type(r.scene, r.steel, "diffuse"));
    CHECK(r.scene.materials[r.steel].origin.verbatim == "\"float x\" [ 1 ]\n");
    Origin whole{"=* \"string type\" [ \"hair\" ]\n\"float y\" [ 2 ]", "pbrt-v4"};
    forget_edited(whole, "anything");
    CHECK(whole.verbatim == "\"float y\" [ 2 ]\n");
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

TEST_CASE("validate is silent about a sound scene and names what is wrong with another", "[scene]") {
    Room r;
    REQUIRE(validate(r.scene).empty());
    const auto with = [&](auto&& change) {
        Room broken;
        change(broken);
        return validate(broken.scene);
    };
    const auto change = [](Room& b, auto id, auto&& f) { apply(b.scene, *modify(b.scene, id, "", f)); };
    CHECK(mentions(with([&](Room& b) { change(b, b.chair, [](Instance& i) { i.material = {9}; }); }), error,
                   "instance \"chair\": material 9 does not exist"));
    CHECK(mentions(with([&](Room& b) { change(b, b.chair, [](Instance& i) { i.mesh = {}; }); }), error, "has no mesh"));
    CHECK(mentions(
        with([&](Room& b) { change(b, b.chair, [](Instance& i) { i.object_to_world[1][1] = not_a_number; }); }), error,
        "not a finite number"));
    CHECK(mentions(with([&](Room& b) { change(b, b.chair, [](Instance& i) { i.object_to_world[1][3] = 1; }); }), error,
                   "projective"));
    CHECK(mentions(with([&](Room& b) { change(b, b.chair, [](Instance& i) { i.object_to_world[1] = {}; }); }), warning,
                   "flattens"));
    CHECK(mentions(with([&](Room& b) { change(b, b.room, [&](Group& g) { g.parent = b.chairs; }); }), error,
                   "group \"chairs\" contains itself through group \"room\""));
    CHECK(mentions(with([&](Room& b) {
                       change(b, b.oak, [&](Material& m) {
                           m.params.set("first", Value{.type = RESTAGE_MATERIAL, .material = b.oak});
                       });
                   }),
                   error, "material \"oak\" contains itself"));
    CHECK(mentions(with([&](Room& b) {
                       const auto t = b.add(Texture{.name = "t", .type = "scale"});
                       const auto u = b.add(Texture{.name = "u", .type = "scale"});
                       change(b, t, [&](Texture& x) { x.params.set("tex", {.type = RESTAGE_COLOR, .texture = u}); });
                       change(b, u, [&](Texture& x) { x.params.set("tex", {.type = RESTAGE_COLOR, .texture = t}); });
                   }),
                   error, "texture \"u\" contains itself through texture \"t\""));
    CHECK(
        mentions(with([&](Room& b) { change(b, b.camera, [](Camera& c) { c.fov = 180; }); }), error, "field of view"));
    CHECK(mentions(with([&](Room& b) { apply(b.scene, set_film(b.scene, Film{.width = 1000000, .height = 1000000})); }),
                   error, "the film has 1000000x1000000 pixels"));
    CHECK(mentions(with([&](Room& b) { apply(b.scene, set_film(b.scene, Film{.width = 0})); }), error,
                   "the film has 0x"));
    CHECK(mentions(
        with([&](Room& b) { change(b, b.oak, [](Material& m) { m.params.set("x", Value::number(not_a_number)); }); }),
        error, "parameter \"x\" is not a finite number"));
    CHECK(mentions(with([&](Room& b) {
                       PixelData pixels{.width = 2, .height = 2, .channels = 3, .values = std::vector<float>(11)};
                       b.add(Image{.name = "i", .data = std::make_shared<PixelData>(pixels)});
                   }),
                   error, "11 values for 2x2 pixels"));
    CHECK(mentions(with([&](Room& b) { b.add(Image{.name = "i", .path = "/gone.png"}); }), warning,
                   "/gone.png was not read"));
    // Many of one kind are counted, not listed.
    const auto many = with([&](Room& b) {
        for (int i = 0; i < 100; ++i)
            b.add(Instance{.name = "x", .mesh = b.mesh, .material = {50}});
    });
    CHECK(many.size() == 9);
    CHECK(mentions(many, error, "92 more of this kind"));
}

TEST_CASE("check_mesh finds the first thing that is wrong", "[scene]") {
    MeshData data = *triangle();
    CHECK(check_mesh(data).empty());
    data.triangles.push_back({0, 1, 3});
    CHECK(check_mesh(data) == "triangle 1 refers to vertex 3 of 3");
    data = *triangle();
    data.positions[2].y = not_a_number;
    CHECK(check_mesh(data) == "the position of vertex 2 is not a finite number");
    data = *triangle();
    data.uvs.resize(2);
    CHECK(check_mesh(data) == "2 texture coordinates for 3 vertices");
    CHECK(check_mesh(MeshData{}) == "has no triangles");
}
