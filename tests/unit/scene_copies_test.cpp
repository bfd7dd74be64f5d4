// SPDX-License-Identifier: Apache-2.0
// Copies of tables and scenes share unchanged data: a frame of a drag among many objects copies none of the
// others.
#include "document/session.hpp"
#include "io/services.hpp"
#include "scene/edit.hpp"

#include <catch2/catch_test_macros.hpp>

#include <array>
#include <thread>
#include <utility>
#include <vector>

using namespace restage;
using namespace restage::scene;

namespace {

struct Counted { // number of copies made
    int number = 0;
    inline static int copies = 0;
    explicit Counted(int n) : number(n) {}
    Counted(const Counted& other) : number(other.number) { ++copies; }
    Counted(Counted&&) = default;
    Counted& operator=(const Counted& other) {
        number = other.number;
        ++copies;
        return *this;
    }
    Counted& operator=(Counted&&) = default;
    ~Counted() = default;
};

Table<Counted> numbers(std::uint32_t count) {
    Table<Counted> table;
    for (std::uint32_t i = 1; i <= count; ++i)
        table.set({i}, Counted(int(i)), i);
    return table;
}

Scene crowd(std::uint32_t count) {
    Scene s;
    s.clock = 1;
    s.meshes.set({1}, Mesh{.name = "mesh", .data = {}, .source_file = {}, .primitive = {}, .origin = {}}, 1);
    for (std::uint32_t i = 1; i <= count; ++i) {
        Instance instance;
        instance.name = "a name that does not fit into the string itself " + std::to_string(i);
        instance.mesh = {1};
        s.instances.set({i}, std::move(instance), 1);
    }
    return s;
}

} // namespace

TEST_CASE("a copy of a table shares its items until they are changed") {
    Table<Counted> table = numbers(1000);
    Counted::copies = 0;
    const Table<Counted> before = table;
    table.set({500}, Counted(-1), 1001);
    table.set({7}, std::nullopt, 1002);
    table.set(table.next(), Counted(1001), 1003);
    CHECK(Counted::copies == 0);
    CHECK(before.size() == 1000);
    CHECK(before.live() == 1000);
    CHECK(before[{500}].number == 500);
    CHECK(before[{7}].number == 7);
    CHECK(before.version() == 1000);
    CHECK(table.size() == 1001);
    CHECK(table.live() == 1000);
    CHECK(table[{500}].number == -1);
    CHECK_FALSE(table.find({7}));
    CHECK(table.version({7}) == 1002);
    CHECK(table.version({8}) == 8);
    for (std::uint32_t i = 1; i <= 1000; ++i)
        if (i != 500 && i != 7) CHECK(&table[{i}] == &before[{i}]);
    table.set_versions(2000);
    CHECK(Counted::copies == 0);
    CHECK(table.version({8}) == 2000);
    CHECK(before.version({8}) == 8);
}

TEST_CASE("changes after a version are found without visiting the rest") {
    Table<Counted> table = numbers(1000);
    table.set({130}, Counted(-130), 1001);
    table.set({999}, std::nullopt, 1002);
    const auto changed = [&](Version since) {
        std::vector<std::pair<std::uint32_t, bool>> found;
        table.each_changed(since, [&](Id<Counted> id, const Counted* item) { found.emplace_back(id.value, item); });
        return found;
    };
    CHECK(changed(1000) == std::vector<std::pair<std::uint32_t, bool>>{{130, true}, {999, false}});
    CHECK(changed(1001) == std::vector<std::pair<std::uint32_t, bool>>{{999, false}});
    CHECK(changed(1002).empty());
    CHECK(changed(0).size() == 1000);
}

TEST_CASE("a table may be changed while it is walked: the walk visits the old items") {
    Table<Counted> table = numbers(300);
    int sum = 0;
    table.each([&](Id<Counted> id, const Counted& item) {
        table.set(id, std::nullopt, 301);
        table.set(table.next(), Counted(item.number), 302);
        sum += item.number;
    });
    CHECK(sum == 300 * 301 / 2);
    CHECK(table.size() == 600);
    CHECK(table.live() == 300);
}

TEST_CASE("a moved-from table is empty") {
    Table<Counted> table = numbers(3);
    const Table<Counted> other = std::move(table);
    CHECK(other.live() == 3);
    CHECK(table.size() == 0); // NOLINT(bugprone-use-after-move): the moved-from state is specified
    CHECK_FALSE(table.find({1}));
    table.set(table.next(), Counted(9), 1);
    CHECK(table[{1}].number == 9);
}

TEST_CASE("a frame of a drag among many objects copies no other object") {
    Log log;
    const plugin::Registry registry(log, io::with_services());
    document::Session session(registry);
    session.adopt(crowd(20'000));
    Scene shown = session.scene(); // the live picture's copy
    glm::dmat4 by(1);
    by[3].x = 1;
    for (int frame = 1; frame <= 3; ++frame) {
        const Id<Instance> dragged[] = {{777}};
        REQUIRE(session.move(dragged, by, "drag"));
        const Scene before = std::exchange(shown, session.scene());
        std::uint32_t copied = 0;
        shown.instances.each(
            [&](Id<Instance> id, const Instance& i) { copied += &i != before.instances.find(id) && id.value != 777; });
        CHECK(copied == 0);
        CHECK(&shown.meshes[{1}] == &before.meshes[{1}]);
        CHECK(shown.instances[{777}].object_to_world != before.instances[{777}].object_to_world);
    }
}

TEST_CASE("copies are read and dropped on other threads while the scene is edited") {
    Scene scene = crowd(500);
    std::array<double, 20> sums{};
    std::vector<std::thread> readers;
    for (double& sum : sums) {
        readers.emplace_back([copy = scene, &sum] {
            copy.instances.each([&](auto, const Instance& i) { sum += i.object_to_world[3].x; });
        });
        Instance moved = scene.instances[{250}];
        moved.object_to_world[3].x += 1;
        scene.instances.set({250}, std::move(moved), ++scene.clock);
    }
    for (std::thread& reader : readers)
        reader.join();
    for (std::size_t i = 0; i < sums.size(); ++i)
        CHECK(sums[i] == double(i));
}
