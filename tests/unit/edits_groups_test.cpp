// SPDX-License-Identifier: Apache-2.0
// Moving objects and groups in the tree of groups.
#include "scene/edits_groups.hpp"

#include <catch2/catch_test_macros.hpp>
#include <vector>

using namespace restage;
using namespace restage::scene;

namespace {

struct Tree { // room > table > (plate, cup), and a lamp at the top level
    Scene scene;
    Id<Group> room, table;
    Id<Instance> plate, cup, lamp;
    Tree() {
        room = add(Group{.name = "room"});
        table = add(Group{.name = "table", .parent = room});
        plate = add(Instance{.name = "plate", .group = table});
        cup = add(Instance{.name = "cup", .group = table});
        lamp = add(Instance{.name = "lamp"});
    }
    template <class T>
    Id<T> add(T item) {
        const Id<T> id = scene::table<T>(scene).next();
        scene::table<T>(scene).set(id, std::move(item), ++scene.clock);
        return id;
    }
    Result<Edit> move(std::vector<Id<Instance>> instances, std::vector<Id<Group>> groups, Id<Group> to) {
        auto edit = reparent(scene, instances, groups, to);
        if (edit) apply(scene, *edit);
        return edit;
    }
};

} // namespace

TEST_CASE("objects and groups move into a group, or out of all, in one edit") {
    Tree t;
    const auto in = t.move({t.lamp}, {}, t.table);
    REQUIRE(in);
    CHECK(in->label == "Move to table");
    CHECK(t.scene.instances[t.lamp].group == t.table);
    const auto out = t.move({t.lamp}, {t.table}, {});
    REQUIRE(out);
    CHECK(!t.scene.groups[t.table].parent);
    CHECK(t.scene.instances[t.lamp].group == t.table); // it came along
    CHECK(t.scene.instances[t.cup].group == t.table);
    CHECK(out->changes.size() == 1);
    REQUIRE(t.move({t.cup}, {}, t.room));
    CHECK(t.scene.instances[t.cup].group == t.room);
}

TEST_CASE("a group is not moved into itself, at any depth, and nothing is not an edit") {
    Tree t;
    CHECK(is_in_group(t.scene, t.table, t.room));
    CHECK_FALSE(is_in_group(t.scene, t.room, t.table));
    const auto inner = t.move({}, {t.room}, t.table);
    REQUIRE_FALSE(inner);
    CHECK(inner.error().message == "\"room\" cannot be moved into itself");
    CHECK_FALSE(t.move({}, {t.room}, t.room));
    CHECK_FALSE(t.move({t.plate}, {}, t.table)); // it is there
    CHECK_FALSE(t.move({t.plate}, {}, Id<Group>{77}));
    CHECK(t.scene.groups[t.table].parent == t.room);
}

TEST_CASE("a loop of groups in a file does not hang") {
    Tree t;
    Group room = t.scene.groups[t.room];
    room.parent = t.table;
    t.scene.groups.set(t.room, room, ++t.scene.clock);
    CHECK_FALSE(is_in_group(t.scene, t.room, Id<Group>{77}));
}
