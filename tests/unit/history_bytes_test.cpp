// SPDX-License-Identifier: Apache-2.0
// The bytes counted by the history: everything of variable length in an edit. The fields are those of project files
// (document/project_fields.hpp), so that a field added there but not counted fails here.
#include "document/project_fields.hpp"
#include "scene/edit.hpp"
#include "scene/history.hpp"

#include <catch2/catch_test_macros.hpp>

using namespace restage;
using namespace restage::scene;

namespace {

constexpr std::size_t length = 10'000;

// Gives every text, table of values and origin something of that length.
struct Fill {
    std::size_t texts = 0;

    std::string text() {
        ++texts;
        return std::string(length, 'x');
    }
    void operator()(const char*, std::string& field) { field = text(); }
    void operator()(const char*, ParamSet& field) { field.set(text(), Value::choice(text())); }
    void operator()(const char*, Origin& field) {
        field.verbatim = text(), field.format = text();
        field.values.push_back({text(), text()});
    }
    template <class T>
    void operator()(const char*, T&) {} // its size
    void path(const char*, std::string& field) { field = text(); }
    template <class T>
    void mesh(T&) {} // shared, and counted once (scene_history_test.cpp)
    template <class T>
    void image(T&) {}
};

// The bytes in a history with one edit that inserts the item.
std::size_t held(AnyChange change) {
    Scene scene;
    History history;
    const std::size_t empty = history.bytes();
    Edit edit{.label = "x", .changes = {std::move(change)}};
    REQUIRE(history.push(scene, std::move(edit)));
    return history.bytes() - empty;
}

} // namespace

TEST_CASE("everything of variable length is counted in the bytes of the history", "[scene]") {
    std::size_t kinds_seen = 0;
    each_kind([&]<class T>(const Kind<T>& kind) {
        T item{};
        Fill fill;
        document::fields(fill, item);
        INFO(kind.name << ", " << fill.texts << " texts");
        REQUIRE(fill.texts > 0);
        const Scene scene;
        const Id<T> id = (scene.*kind.table).next();
        const std::size_t bytes = held(Change<T>{id, std::nullopt, item});
        CHECK(bytes >= fill.texts * length);
        CHECK(bytes < fill.texts * length + 10'000);
        ++kinds_seen;
    });
    CHECK(kinds_seen == std::tuple_size_v<decltype(kinds)>);

    Film film;
    Fill fill;
    document::fields(fill, film);
    REQUIRE(fill.texts == 1);
    CHECK(held(ChangeOne<Film>{Film{}, film}) >= length);

    Environment environment;
    Fill of_sky;
    document::fields(of_sky, environment);
    CHECK(held(ChangeOne<std::optional<Environment>>{std::nullopt, environment}) >= of_sky.texts * length);

    Settings settings;
    Fill of_settings;
    document::fields(of_settings, settings);
    CHECK(held(ChangeOne<Settings>{Settings{}, settings}) >= of_settings.texts * length);
}
