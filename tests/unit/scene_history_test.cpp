// SPDX-License-Identifier: Apache-2.0
// scene: history and gestures: undo restores the previous state, a drag is one edit, clean means as saved.
#include "scene/edits_light.hpp"
#include "scene/history.hpp"
#include "scene_room.hpp"

#include <array>
#include <catch2/catch_test_macros.hpp>
#include <glm/gtc/matrix_transform.hpp>

using namespace restage;
using namespace restage::scene;
using test::Room;

namespace {

// All contents of a scene as a comparable value: what undo must restore. Versions only grow and are left out.
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

} // namespace

TEST_CASE("undo restores the scene, redo repeats the edit, for every kind of edit", "[scene]") {
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
    push(insert(r.scene, Light{.name = "sun", .kind = scene::LightKind::distant}, "Add sun"));
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

TEST_CASE("a drag is one edit, and one that returns to its start is no edit", "[scene]") {
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
    CHECK(history.size() == 0); // also: pushing dropped the redo history
    CHECK(same(start, r.scene));
    CHECK_FALSE(history.push(r.scene, *set_transform(r.scene, r.chair, glm::dmat4(1)))); // changes nothing
    CHECK(history.size() == 0);
}

TEST_CASE("a gesture may insert an object and then move it", "[scene]") {
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

TEST_CASE("a cancelled drag leaves everything as it was, including the redo history", "[scene]") {
    Room r;
    History history;
    const auto move = [&](double x) {
        return *set_transform(r.scene, r.chair, glm::translate(glm::dmat4(1), {x, 0, 0}));
    };
    history.push(r.scene, move(1));
    history.push(r.scene, move(2));
    history.mark_clean();
    history.undo(r.scene);
    const Scene start = r.scene;
    history.push(r.scene, move(3), "drag");
    history.push(r.scene, move(4), "drag");
    CHECK(history.size() == 2);
    CHECK(history.cancel_gesture(r.scene));
    CHECK(same(start, r.scene));
    CHECK(history.position() == 1);
    CHECK(history.clean_position() == 2);
    CHECK_FALSE(history.cancel_gesture(r.scene)); // none runs
    CHECK(history.redo(r.scene));
    CHECK(r.scene.instances[r.chair].object_to_world[3].x == 2);
    CHECK(history.clean());
    history.push(r.scene, move(5), "drag");
    history.end_gesture();
    CHECK_FALSE(history.cancel_gesture(r.scene)); // it ended
    CHECK(r.scene.instances[r.chair].object_to_world[3].x == 5);
}

TEST_CASE("a light is duplicated", "[scene]") {
    Scene scene;
    apply(scene, insert(scene, Light{.name = "Spot", .kind = scene::LightKind::spot}, "Add"));
    const Id<Light> spot{1};
    const auto made = duplicate_light(scene, spot, glm::translate(glm::dmat4(1), {0, 3, 0}));
    REQUIRE(made);
    apply(scene, made->edit);
    CHECK(scene.lights[made->copy].name == "Spot 2");
    CHECK(scene.lights[made->copy].light_to_world[3].y == 3);
    CHECK_FALSE(duplicate_light(scene, Id<Light>{7}, glm::dmat4(1)));
}

TEST_CASE("clean means equal to the file", "[scene]") {
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
    change(3); // the saved state is no longer reachable
    CHECK_FALSE(history.clean());
    history.undo(r.scene);
    CHECK_FALSE(history.clean());
}

TEST_CASE("the history keeps its byte budget", "[scene]") {
    Room r;
    History history;
    const auto change = [&](std::uint32_t width) {
        return history.push(r.scene, set_film(r.scene, Film{.width = width, .height = 8}));
    };
    REQUIRE(change(1));
    const std::size_t one = history.bytes(); // all edits of a film are alike
    REQUIRE(one > 0);
    history.set_budget(3 * one);
    history.mark_clean(); // at 1
    REQUIRE((change(2) && change(3)));
    CHECK(history.dropped() == 0);
    CHECK(history.size() == 3);
    CHECK(history.clean_position() == 1);

    REQUIRE(change(4)); // the edit to 1 is dropped; the saved state is the oldest reachable one
    CHECK(history.dropped() == 1);
    CHECK((history.size() == 3 && history.position() == 3));
    CHECK(history.bytes() <= history.budget());
    CHECK(history.clean_position() == 0);
    while (history.undo(r.scene)) {
    }
    CHECK(r.scene.film.value.width == 1);
    CHECK(history.clean());
    while (history.redo(r.scene)) {
    }
    CHECK(r.scene.film.value.width == 4);

    REQUIRE(change(5)); // the saved state is dropped as well
    CHECK(history.dropped() == 2);
    CHECK_FALSE(history.clean_position());
    while (history.undo(r.scene)) {
    }
    CHECK(r.scene.film.value.width == 2);
    CHECK_FALSE(history.clean());

    REQUIRE(change(6)); // the redo history is dropped
    CHECK(history.bytes() == one);
    history.set_budget(1); // the newest edit stays, however large
    CHECK(history.size() == 1);
    REQUIRE(change(7));
    CHECK((history.size() == 1 && history.position() == 1));
    REQUIRE(history.undo(r.scene));
    CHECK(r.scene.film.value.width == 6);
    REQUIRE(history.redo(r.scene));
    CHECK(r.scene.film.value.width == 7);
    CHECK(history.bytes() == one);
}

TEST_CASE("geometry counts once, and only while only the history holds it", "[scene]") {
    Room r;
    History history;
    auto data = test::triangle();
    data->positions.resize(100'000, glm::vec3(0));
    const std::size_t heavy = data->positions.size() * sizeof(glm::vec3);
    std::shared_ptr<const MeshData> held = std::move(data);
    REQUIRE(history.push(r.scene, insert(r.scene, Mesh{.name = "rock", .data = held}, "Add rock")));
    const Id<Mesh> rock = find_by_name<Mesh>(r.scene, "rock");
    CHECK(history.bytes() < heavy); // the scene has it
    REQUIRE(history.push(r.scene, *remove(r.scene, rock)));
    CHECK(history.bytes() < heavy); // the test has it
    held.reset();
    CHECK(history.bytes() > heavy);
    CHECK(history.bytes() < 2 * heavy);
    REQUIRE(history.undo(r.scene));
    CHECK(history.bytes() < heavy);
    REQUIRE(history.redo(r.scene));
    history.set_budget(heavy); // even the edit that removed it stays: it is the newest
    CHECK((history.size() == 1 && history.dropped() == 1));
    CHECK(history.bytes() > heavy);
}

TEST_CASE("a drag beyond the budget is still one edit that can be cancelled", "[scene]") {
    Room r;
    History history;
    const auto change = [&](std::uint32_t width, std::string_view gesture) {
        return history.push(r.scene, set_film(r.scene, Film{.width = width, .height = 8}), gesture);
    };
    REQUIRE((change(1, {}) && change(2, {})));
    history.mark_clean();
    REQUIRE(history.undo(r.scene));
    history.set_budget(1);
    REQUIRE((change(3, "drag") && change(4, "drag")));
    CHECK((history.size() == 1 && history.dropped() == 1));
    CHECK_FALSE(history.clean());
    REQUIRE(history.cancel_gesture(r.scene)); // the redo history, which contains the saved state, is restored
    CHECK(r.scene.film.value.width == 1);
    CHECK((history.size() == 1 && history.position() == 0));
    REQUIRE(history.redo(r.scene));
    CHECK(r.scene.film.value.width == 2);
    CHECK(history.clean());
}
