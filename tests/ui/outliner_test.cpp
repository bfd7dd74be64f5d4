// SPDX-License-Identifier: Apache-2.0
// The outliner's list of rows: after any edit it equals a newly built list; edits that do not affect rows rebuild
// nothing.
#include "editor/panels/outliner.hpp"
#include "editor/panels/state.hpp"
#include "scene/edits.hpp"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <random>

using namespace restage;
using namespace restage::scene;
using editor::OutlinerState;

namespace {

struct Forest {
    Scene scene;
    std::vector<Id<Group>> groups;
    std::vector<Id<Instance>> trees;
    Id<Material> bark, moss;

    explicit Forest(std::uint32_t count) {
        bark = add(Material{.name = "bark", .type = "diffuse"});
        moss = add(Material{.name = "moss", .type = "diffuse"});
        const auto mesh = add(Mesh{.name = "tree"});
        for (int i = 0; i < 20; ++i)
            groups.push_back(add(Group{.name = "grove " + std::to_string(i),
                                       .parent = i < 5 ? Id<Group>{} : groups[std::size_t(i) % 5]}));
        for (std::uint32_t i = 0; i < count; ++i)
            trees.push_back(add(Instance{.name = "tree number " + std::to_string(i),
                                         .mesh = mesh,
                                         .material = i % 3 ? bark : moss,
                                         .group = i % 2 ? groups[i % 20] : Id<Group>{}}));
        add(Light{.name = "lamp"});
        add(Camera{.name = "camera"});
    }
    template <class T>
    Id<T> add(T item) {
        const Id<T> id = table<T>(scene).next();
        change(id, std::optional<T>(std::move(item)));
        return id;
    }
    template <class T>
    void change(Id<T> id, std::optional<T> item) {
        table<T>(scene).set(id, std::move(item), ++scene.clock);
    }
    template <class T, class F>
    void modify(Id<T> id, F&& f) {
        T item = table<T>(scene)[id];
        f(item);
        change(id, std::optional<T>(std::move(item)));
    }
    void move(Id<Instance> id) {
        modify(id, [](Instance& i) { i.object_to_world[3].x += 1; });
    }
};

// A newly built list.
void check_like_new(const Scene& scene, const OutlinerState& now) {
    OutlinerState fresh;
    fresh.search = now.search, fresh.material = now.material, fresh.open = now.open;
    update_rows(scene, fresh);
    CHECK(now.members == fresh.members);
    CHECK(now.hidden == fresh.hidden);
    const bool same = std::ranges::equal(now.rows, fresh.rows, [](const auto& a, const auto& b) {
        return a.kind == b.kind && a.id == b.id && a.depth == b.depth;
    });
    CHECK(same);
}

} // namespace

TEST_CASE("after any edit the outliner's list equals a newly built one", "[ui]") {
    Forest f(400);
    OutlinerState state;
    std::mt19937 random(7);
    const auto any = [&](auto& of) -> auto& { return of[random() % of.size()]; };
    for (int i = 0; i < 600; ++i) {
        INFO("edit " << i);
        for (unsigned n = random() % 3; n > 0; --n) {
            const Id<Instance> tree = any(f.trees);
            const bool live = f.scene.instances.find(tree);
            switch (random() % 12) {
                case 0:
                    f.add(Instance{.name = "tree again"});
                    break;
                case 1:
                    f.change(tree, std::optional<Instance>());
                    break;
                case 2:
                    f.change(tree, std::optional(Instance{.name = "back", .material = f.moss}));
                    break;
                case 3:
                    if (live) f.modify(tree, [](Instance& t) { t.hidden = !t.hidden; });
                    break;
                case 4:
                    if (live) f.modify(tree, [&](Instance& t) { t.group = any(f.groups); });
                    break;
                case 5:
                    if (live) f.modify(tree, [&](Instance& t) { t.name = random() % 2 ? "oak" : "tree number 1"; });
                    break;
                case 6:
                    if (live) f.modify(tree, [&](Instance& t) { t.material = random() % 2 ? f.bark : f.moss; });
                    break;
                case 7:
                    f.modify(f.bark, [&](Material& m) { m.name = random() % 2 ? "oak bark" : "bark"; });
                    break;
                case 8:
                    f.modify(Id<Light>{1}, [&](Light& l) { l.name = random() % 2 ? "oak lamp" : "lamp"; });
                    break;
                case 9:
                    f.add(Camera{.name = "camera of the oak"});
                    break;
                case 10:
                    f.modify(any(f.groups), [&](Group& g) { g.name = random() % 2 ? "oaks" : "grove"; });
                    break;
                default:
                    if (live) f.move(tree);
            }
        }
        if (random() % 8 == 0) state.search = random() % 2 ? "oak" : "";
        if (random() % 16 == 0) state.material = random() % 2 ? f.moss : Id<Material>{};
        if (random() % 8 == 0) state.open.insert(any(f.groups).value);
        if (random() % 8 == 0) state.open.erase(any(f.groups).value);
        update_rows(f.scene, state);
        check_like_new(f.scene, state);
    }
}

TEST_CASE("moving an object, a light or the camera lists no object again", "[ui]") {
    Forest f(20000);
    for (const char* search : {"", "tree number 7"}) {
        OutlinerState state;
        state.search = search;
        update_rows(f.scene, state);
        const std::size_t lists = state.lists;
        for (int i = 0; i < 20; ++i) {
            f.move(f.trees[std::size_t(i) * 900]);
            update_rows(f.scene, state);
            f.modify(Id<Light>{1}, [](Light& l) { l.value *= 2; });
            f.modify(Id<Camera>{1}, [](Camera& c) { c.fov += 1; });
            update_rows(f.scene, state);
        }
        CHECK(state.lists == lists);
        check_like_new(f.scene, state);
        f.modify(f.trees[3], [](Instance& i) { i.hidden = !i.hidden; });
        update_rows(f.scene, state);
        CHECK(state.lists == lists + 1);
        check_like_new(f.scene, state);
    }
}

TEST_CASE("cost of the outliner's list", "[.][measure]") {
    Forest f(20000);
    for (const char* search : {"", "tree number 7"}) {
        OutlinerState state;
        state.search = search;
        update_rows(f.scene, state);
        const auto median = [&](bool whole) {
            std::vector<double> all;
            for (std::size_t i = 0; i < 101; ++i) {
                f.move(f.trees[i * 190]);
                if (whole) state.made_for = ~Version(0);
                const auto start = std::chrono::steady_clock::now();
                update_rows(f.scene, state);
                all.push_back(
                    std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
            }
            std::ranges::nth_element(all, all.begin() + 50);
            return all[50];
        };
        const double whole = median(true), changed = median(false);
        WARN("20000 objects, search \"" << search << "\": all " << whole << " ms, one moved " << changed << " ms");
    }
}
