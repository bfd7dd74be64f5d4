// SPDX-License-Identifier: Apache-2.0
// Things: which objects of a scene without names a user takes for one.
#include "query/wholes.hpp"
#include "scene_room.hpp"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <glm/gtc/matrix_transform.hpp>

using namespace restage;
using namespace restage::scene;

namespace {

using Ids = std::vector<Id<Instance>>;

// A floor of 8 by 8, a wall, and boxes [m]; all turned by `turned`, with up as its third axis.
struct Shop {
    Scene scene;
    glm::dmat4 turned;
    Id<Group> group; // of what is added

    template <class T>
    Id<T> add(T item) {
        const Id<T> id = table<T>(scene).next();
        apply(scene, insert(scene, std::move(item), "add"));
        return id;
    }
    explicit Shop(const glm::dmat4& turn = glm::dmat4(1)) : turned(turn) {
        box({-4, -4, -0.1}, {4, 4, 0});
        box({-4, 3.9, 0}, {4, 4, 2.5});
    }
    Id<Mesh> cube() { // a mesh of its own, as in files
        auto data = std::make_shared<MeshData>();
        for (int i = 0; i < 8; ++i)
            data->positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
        data->triangles = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                           {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
        compute_bounds(*data);
        return add(Mesh{.name = "cube", .data = std::move(data)});
    }
    Id<Instance> box(glm::dvec3 lower, glm::dvec3 upper, Id<Mesh> mesh = {}) {
        return add(
            Instance{.name = "box",
                     .mesh = mesh ? mesh : cube(),
                     .group = group,
                     .object_to_world = turned * glm::scale(glm::translate(glm::dmat4(1), lower), upper - lower)});
    }
    Id<Instance> boxes(const std::vector<std::pair<glm::dvec3, glm::dvec3>>& all) { // of one mesh
        const Id<Mesh> one = cube();
        const MeshData& unit = *scene.meshes[one].data;
        auto data = std::make_shared<MeshData>();
        for (const auto& [lower, upper] : all) {
            const auto first = std::uint32_t(data->positions.size());
            for (const glm::vec3& p : unit.positions)
                data->positions.push_back(glm::vec3(lower) + p * glm::vec3(upper - lower));
            for (const glm::uvec3& t : unit.triangles)
                data->triangles.push_back(t + first);
        }
        compute_bounds(*data);
        return add(Instance{.name = "boxes",
                            .mesh = add(Mesh{.name = "boxes", .data = std::move(data)}),
                            .group = group,
                            .object_to_world = turned});
    }
    // Four legs, a seat, a back.
    Ids chair(glm::dvec3 at) {
        Ids parts;
        for (int i = 0; i < 4; ++i) {
            const glm::dvec3 leg = at + glm::dvec3(i & 1 ? 0.36 : 0.0, i & 2 ? 0.36 : 0.0, 0);
            parts.push_back(box(leg, leg + glm::dvec3(0.04, 0.04, 0.42)));
        }
        parts.push_back(box(at + glm::dvec3(0, 0, 0.42), at + glm::dvec3(0.4, 0.4, 0.46)));
        parts.push_back(box(at + glm::dvec3(0, 0.37, 0.46), at + glm::dvec3(0.4, 0.4, 0.9)));
        return parts;
    }
    query::Things find(std::uint32_t imported_groups = 1000) const {
        return query::find_things(scene, glm::dvec3(turned[2]), imported_groups);
    }
};

// What a click on the object takes.
Ids taken(const Shop& shop, const query::Things& things, Id<Instance> id) {
    const auto wholes = query::wholes_around(shop.scene, things, id);
    Ids ids = wholes.empty() ? Ids{id} : query::members_of(shop.scene, things, wholes.front());
    std::sort(ids.begin(), ids.end());
    return ids;
}

} // namespace

TEST_CASE("a click takes all parts of a chair, and neither the floor nor its neighbours", "[things]") {
    const double angle = GENERATE(0.0, 0.7);
    Shop shop(glm::rotate(glm::rotate(glm::dmat4(1), angle, glm::dvec3(0, 0, 1)), 2 * angle, glm::dvec3(1, 0, 0)));
    const Ids chair = shop.chair({0, 0, 0}), other = shop.chair({0.5, 0, 0});
    const Ids by_the_wall = shop.chair({-2, 3.45, 0}); // 5 cm from it
    const query::Things things = shop.find();
    for (const auto id : chair)
        CHECK((taken(shop, things, id) == chair));
    CHECK((taken(shop, things, other[3]) == other));
    CHECK((taken(shop, things, by_the_wall[0]) == by_the_wall));
    CHECK((taken(shop, things, {1}) == Ids{{1}}));
    CHECK((taken(shop, things, {2}) == Ids{{2}}));
}

TEST_CASE("what rests on something is a thing of its own", "[things]") {
    Shop shop;
    Ids table;
    for (int i = 0; i < 4; ++i) {
        const glm::dvec3 leg(i & 1 ? 1.1 : 0, i & 2 ? 0.7 : 0, 0);
        table.push_back(shop.box(leg, leg + glm::dvec3(0.05, 0.05, 0.7)));
    }
    table.push_back(shop.box({0, 0, 0.7}, {1.2, 0.8, 0.74}));
    const Ids vase{shop.box({0.4, 0.4, 0.74}, {0.5, 0.5, 1.0})};
    // A lamp: its shade is wide, and stands on a thin pole.
    const Ids lamp{shop.box({0.8, 0.3, 0.74}, {0.9, 0.4, 0.76}), shop.box({0.845, 0.345, 0.76}, {0.855, 0.355, 1.0}),
                   shop.box({0.75, 0.25, 1.0}, {0.95, 0.45, 1.2})};
    // Plates are copies of one mesh: a pile is not one thing.
    const auto plate = shop.cube();
    const Ids plates{shop.box({0.1, 0.1, 0.74}, {0.3, 0.3, 0.75}, plate),
                     shop.box({0.1, 0.1, 0.75}, {0.3, 0.3, 0.76}, plate)};
    const Ids rug{shop.box({-0.5, -0.5, 0}, {-0.4, -0.4, 0.01})}; // not under the table
    const query::Things things = shop.find();
    CHECK((taken(shop, things, table[4]) == table));
    CHECK((taken(shop, things, table[0]) == table));
    CHECK((taken(shop, things, vase[0]) == vase));
    CHECK((taken(shop, things, lamp[0]) == lamp));
    CHECK((taken(shop, things, lamp[2]) == lamp));
    CHECK((taken(shop, things, plates[0]) == Ids{plates[0]}));
    CHECK((taken(shop, things, plates[1]) == Ids{plates[1]}));
    CHECK((taken(shop, things, rug[0]) == rug));
}

TEST_CASE("a laid table is its top and legs, at a panel of the wall, and what is laid in one mesh", "[things]") {
    Shop shop;
    const auto four = [&](glm::dvec3 lower, glm::dvec3 upper, glm::dvec2 apart) {
        std::vector<std::pair<glm::dvec3, glm::dvec3>> all;
        for (int i = 0; i < 4; ++i) {
            const glm::dvec3 at(i & 1 ? apart.x : 0, i & 2 ? apart.y : 0, 0);
            all.emplace_back(lower + at, upper + at);
        }
        return shop.boxes(all);
    };
    const auto legs = four({0, 2, 0}, {0.08, 2.08, 0.7}, {1.02, 1.7});
    const auto top = shop.box({-0.05, 1.97, 0.7}, {1.15, 3.84, 0.74});
    const auto apron = shop.box({0.08, 2.03, 0.6}, {1.02, 3.81, 0.67}); // between the legs, below the top
    const bool wide = GENERATE(true, false);
    const auto panel = shop.box({wide ? -0.5 : 0.1, 3.83, 0}, {wide ? 1.6 : 1.0, 3.9, 0.72});
    const auto mats = four({0.05, 2.1, 0.74}, {0.48, 2.4, 0.745}, {0.55, 1.3});
    const auto plates = four({0.15, 2.15, 0.745}, {0.38, 2.35, 0.765}, {0.55, 1.3});
    const query::Things things = shop.find();
    Ids table{legs, top, apron};
    std::sort(table.begin(), table.end());
    CHECK(taken(shop, things, top) == table);
    CHECK(taken(shop, things, legs) == table);
    for (const auto id : {panel, mats, plates})
        CHECK(taken(shop, things, id) == Ids{id});
}

TEST_CASE("furniture on a rug, cabinets in a row and knobs", "[things]") {
    Shop shop;
    const Ids rug{shop.box({-1, -1, 0}, {1, 1, 0.01})};
    const Ids sofa{shop.box({-0.9, -0.5, 0.01}, {0.9, 0.3, 0.4}), shop.box({-0.9, 0.3, 0.2}, {0.9, 0.4, 0.8})};
    Ids row;
    for (int i = 0; i < 3; ++i)
        row.push_back(shop.box({-3 + 0.6 * i, 3.3, 0}, {-2.4 + 0.6 * i, 3.9, 0.85}));
    const auto knob = shop.box({-2.72, 3.28, 0.5}, {-2.68, 3.3, 0.54});
    const query::Things things = shop.find();
    CHECK((taken(shop, things, rug[0]) == rug));
    CHECK((taken(shop, things, sofa[1]) == sofa));
    CHECK((taken(shop, things, row[0]) == Ids{row[0], knob}));
    CHECK((taken(shop, things, row[1]) == Ids{row[1]}));
}

TEST_CASE("a table's top belongs to its leg even where the model has a gap", "[things]") {
    Shop shop;
    const Ids table{shop.box({0, 0, 0}, {0.3, 0.3, 0.55}), shop.box({-0.4, -0.4, 0.58}, {0.7, 0.7, 0.62})};
    const Ids glass{shop.box({0.5, 0.5, 0.62}, {0.56, 0.56, 0.75})};
    const query::Things things = shop.find();
    CHECK((taken(shop, things, table[1]) == table));
    CHECK((taken(shop, things, glass[0]) == glass));
}

TEST_CASE("groups of files are whole, collections are looked through", "[things]") {
    Shop shop;
    const auto room = shop.add(Group{.name = "room"});
    const auto chairs = shop.add(Group{.name = "chairs", .parent = room});
    Ids groups[2];
    for (int i = 0; i < 2; ++i) {
        shop.group = shop.add(Group{.name = "chair", .parent = chairs});
        groups[i] = shop.chair({1.5 * i, 0, 0});
    }
    shop.group = room;
    const auto loose = shop.chair({-2, 0, 0});
    const query::Things things = shop.find();
    CHECK(things.is_collection(room));
    CHECK(things.is_collection(chairs));
    CHECK((taken(shop, things, groups[0][2]) == groups[0]));
    CHECK((taken(shop, things, groups[1][0]) == groups[1]));
    CHECK((taken(shop, things, loose[0]) == loose));
}

TEST_CASE("a user's own group comes before what is found, whether made before or after", "[things]") {
    Shop shop;
    const Ids a = shop.chair({0, 0, 0}), b = shop.chair({1, 0, 0});
    const query::Things found = shop.find(0);
    const auto set = shop.add(Group{.name = "set"});
    Ids both = a;
    both.insert(both.end(), b.begin(), b.end());
    for (const auto id : both)
        apply(shop.scene, *modify(shop.scene, id, "", [&](Instance& i) { i.group = set; }));
    CHECK((taken(shop, found, a[0]) == both));
    const auto inside = query::wholes_around(shop.scene, found, a[0]);
    REQUIRE(inside.size() == 2); // the set, and the chair in it
    Ids chair = query::members_of(shop.scene, found, inside[1]);
    CHECK((chair == a));

    // Half a chair in a group: the other half is the thing.
    for (const auto id : both)
        apply(shop.scene, *modify(shop.scene, id, "", [&](Instance& i) { i.group = {}; }));
    for (int i = 0; i < 3; ++i)
        apply(shop.scene, *modify(shop.scene, a[std::size_t(i)], "", [&](Instance& in) { in.group = set; }));
    CHECK((taken(shop, found, a[0]) == Ids(a.begin(), a.begin() + 3)));
    CHECK((taken(shop, found, a[4]) == Ids(a.begin() + 3, a.end())));
    const query::Things again = shop.find(0); // as when the project is opened again
    CHECK((taken(shop, again, a[0]) == Ids(a.begin(), a.begin() + 3)));
}

TEST_CASE("copies of a thing are a thing, wherever they are", "[things]") {
    Shop shop;
    const Ids a = shop.chair({0, 0, 0});
    query::Things things = shop.find();
    const auto made = *duplicate_instances(shop.scene, a, glm::translate(glm::dmat4(1), glm::dvec3(0.1, 0, 0)));
    apply(shop.scene, made.edit);
    things.copied(a, made.copies);
    CHECK((taken(shop, things, made.copies[0]) == made.copies));
    CHECK((taken(shop, things, a[0]) == a));
    const auto seat = *duplicate_instances(shop.scene, Ids{a[4]}, glm::dmat4(1));
    apply(shop.scene, seat.edit);
    things.copied(Ids{a[4]}, seat.copies);
    CHECK((taken(shop, things, seat.copies[0]) == seat.copies));
    CHECK(things.of.size() == shop.scene.instances.size() + 1);
}

TEST_CASE("scenes with nothing to find", "[things]") {
    CHECK(query::find_things({}, {0, 1, 0}, 0).members.size() == 1);
    Shop shop;
    CHECK(shop.find().members.size() == 1);
    auto flat = std::make_shared<MeshData>();
    flat->positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    flat->triangles = {{0, 1, 2}};
    compute_bounds(*flat);
    const auto mesh = shop.add(Mesh{.name = "line", .data = flat});
    shop.add(Instance{.name = "line", .mesh = mesh});
    shop.add(Instance{.name = "point", .mesh = mesh, .object_to_world = glm::scale(glm::dmat4(1), glm::dvec3(0))});
    shop.add(Instance{.name = "no mesh"});
    CHECK(shop.find().members.size() == 1);
    // A product without a floor: all of it is one thing.
    Scene s;
    shop.scene = s;
    const Ids chair = shop.chair({0, 0, 0});
    CHECK((taken(shop, shop.find(), chair[2]) == chair));
    // Asked to stop.
    CHECK(query::find_things(shop.scene, {0, 0, 1}, 0, [] { return true; }).members.size() == 1);
}

TEST_CASE("several copies of a thing are as many things", "[things]") {
    Shop shop;
    const Ids a = shop.chair({0, 0, 0});
    query::Things things = shop.find();
    Ids all;
    for (int i = 1; i < 4; ++i) {
        const auto made = *duplicate_instances(shop.scene, a, glm::translate(glm::dmat4(1), glm::dvec3(i, 0, 0)));
        apply(shop.scene, made.edit);
        all.insert(all.end(), made.copies.begin(), made.copies.end());
    }
    things.copied(a, all);
    CHECK((taken(shop, things, all[7]) == Ids(all.begin() + 6, all.begin() + 12)));
    things.copied(Ids{a[0]}, Ids{all[7]}); // the id was used again
    CHECK((taken(shop, things, all[7]) == Ids{all[7]}));
    CHECK((taken(shop, things, all[17]) == Ids(all.begin() + 12, all.end())));
}
