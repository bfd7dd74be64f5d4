// SPDX-License-Identifier: Apache-2.0
// Actions of plugins: every call of the edit writer and its refusals; a run is one undo step; an edit made for an older
// scene is rebased onto a newer one, or refused.
#include "document/actions.hpp"
#include "io/edit_writer.hpp"
#include "io/scene_compare.hpp"
#include "paths.hpp"
#include "plugin/adapters.hpp"
#include "plugin/panel.hpp"
#include "plugin/tables.hpp"
#include "scene_room.hpp"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <functional>
#include <stdexcept>

using namespace restage;
using namespace restage::scene;
using Catch::Matchers::ContainsSubstring;

namespace {

using Body = std::function<int(const RestageSceneReader1&, const RestageSelection1&, const RestageValue*, std::uint32_t,
                               RestageEditWriter1&)>;
Body body; // of the action below, which is a C function

int run_body(const RestageSceneReader1* scene, const RestageSelection1* selection, const RestageValue* values,
             std::uint32_t count, RestageEditWriter1* edits) {
    return body(*scene, *selection, values, count, *edits);
}

// A document with the room, and an action with a test's code.
struct Stage {
    Log log{[](LogLevel, std::string_view) {}};
    plugin::Registry registry{log};
    test::Room room;
    document::Session session{registry};
    RestageAction1 native{.size = sizeof(RestageAction1), .id = "test", .label = "Test", .run = run_body};
    model::Action table{.id = "test", .label = "Test", .tooltip = {}, .params = {}};
    plugin::ActionEntry entry{{&table, std::make_shared<const plugin::Entry>(), {}}, &native};

    Stage() { session.adopt(room.scene); }
    const Scene& scene() const { return session.scene(); }
    Result<io::ActionResult> run(Body what, io::ActionRun run = {}) {
        body = std::move(what);
        return io::run_action(scene(), registry, entry, run);
    }
    using Writing = std::function<void(const RestageEditWriter1&, void* ctx)>;
    Result<io::ActionResult> write(const Writing& what) {
        return run([&](auto&, auto&, auto*, auto, RestageEditWriter1& w) {
            what(w, w.ctx);
            return 1;
        });
    }
    document::ActionDone done(const Writing& what) {
        auto result = write(what);
        INFO((result ? "" : result.error().message));
        REQUIRE(result);
        auto applied = document::apply_action(session, std::move(*result));
        REQUIRE(applied);
        return *std::move(applied);
    }
    // The call is refused with a line of the report, and nothing changes.
    void refused(const Writing& what, const char* why) {
        const auto result = write(what);
        REQUIRE(result);
        CHECK(result->edit.changes.empty());
        REQUIRE(result->report.entries.size() == 1);
        CHECK_THAT(io::to_string(result->report.entries[0]), ContainsSubstring(why));
    }
};

RestageInstance copy_of(RestageHandle mesh, RestageHandle material, double x) {
    RestageInstance i{.name = "chair", .mesh = mesh, .material = material};
    i.alpha = 1;
    for (int k = 0; k < 4; ++k)
        i.object_to_world[5 * k] = 1;
    i.object_to_world[12] = x;
    return i;
}

glm::dmat4 at(double x) {
    glm::dmat4 m(1);
    m[3].x = x;
    return m;
}

} // namespace

TEST_CASE("an action adds things whose handles are valid immediately, as one undo step", "[action]") {
    Stage s;
    const Scene before = s.scene();
    std::uint32_t made = 0;
    const auto done = s.done([&](const RestageEditWriter1& w, void* ctx) {
        const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
        const std::uint32_t indices[] = {0, 1, 2};
        const RestageMesh mesh{
            .name = "triangle", .vertex_count = 3, .triangle_count = 1, .positions = positions, .indices = indices};
        const RestageHandle m = w.add_mesh(ctx, &mesh);
        const float pixels[] = {1, 0, 0};
        RestageImage image{};
        image.width = image.height = 1, image.channels = 3, image.pixels = pixels;
        RestageTexture texture{};
        texture.name = "red", texture.type = "imagemap", texture.image = w.add_image(ctx, &image);
        RestageValue value{};
        value.id = "reflectance", value.type = RESTAGE_COLOR, value.ref = w.add_texture(ctx, &texture);
        RestageMaterialDesc material{};
        material.name = "new", material.type = "diffuse", material.values = &value, material.value_count = 1;
        const RestageHandle its = w.add_material(ctx, &material);
        RestageMedium fog{};
        fog.name = "fog";
        RestageGroup group{};
        group.name = "group", group.parent = s.room.room.value;
        RestageInstance instance = copy_of(m, its, 3);
        instance.group = w.add_group(ctx, &group);
        instance.has_medium_interface = 1, instance.interior = w.add_medium(ctx, &fog);
        made = w.add_instance(ctx, &instance);
        CHECK(made == before.instances.size() + 1);
        // A material's emission is not the object's own.
        instance.flags = RESTAGE_INSTANCE_EMITS | RESTAGE_INSTANCE_EMITS_BY_MATERIAL;
        instance.emission[0] = 5;
        CHECK(w.add_instance(ctx, &instance) == made + 1);
        RestageLight light{};
        light.kind = RESTAGE_LIGHT_POINT, light.value[0] = 1;
        for (int k = 0; k < 4; ++k)
            light.light_to_world[5 * k] = 1;
        CHECK(w.add_light(ctx, &light));
        RestageCamera camera{};
        camera.name = "camera", camera.fov = 30, camera.focal_distance = 1;
        for (int k = 0; k < 4; ++k)
            camera.camera_to_world[5 * k] = 1;
        const RestageHandle second = w.add_camera(ctx, &camera);
        CHECK(w.set_active_camera(ctx, second));
        CHECK(w.set_transform(ctx, made, &at(7)[0][0]));
        w.report(ctx, RESTAGE_KEPT, "one chair", "");
    });
    CHECK(done.changed);
    CHECK(done.selection == std::vector<Id<Instance>>{{made}, {made + 1}});
    REQUIRE(done.report.entries.size() == 1);
    CHECK(done.report.entries[0].what == "one chair");
    const Scene& now = s.scene();
    const Instance& chair = now.instances[{made}];
    CHECK(chair.name == "chair 3"); // "chair" and "chair 2" existed
    CHECK(chair.object_to_world == at(7));
    CHECK(now.groups[chair.group].parent == s.room.room);
    CHECK(now.materials[chair.material].params.texture("reflectance"));
    CHECK(chair.media->interior);
    CHECK(!now.instances[{made + 1}].emission);
    CHECK(now.cameras[now.active_camera.value].fov == 30);
    CHECK(now.lights.live() == 1);
    CHECK(s.session.history().size() == 1);
    CHECK(s.session.history().undo_label() == "Test");
    REQUIRE(s.session.undo());
    CHECK(io::structural_differences(before, s.scene(), s.registry, {.names = true}).empty());
    CHECK(s.scene().instances.live() == before.instances.live());
    CHECK(s.scene().materials.live() == before.materials.live());
    REQUIRE(s.session.redo());
    CHECK(s.scene().instances.find({made}));
}

TEST_CASE("an action changes and removes existing things", "[action]") {
    Stage s;
    const test::Room& r = s.room;
    const auto done = s.done([&](const RestageEditWriter1& w, void* ctx) {
        CHECK(w.set_transform(ctx, r.chair.value, &at(2)[0][0]));
        CHECK(w.set_material(ctx, r.chair.value, r.steel.value));
        CHECK(w.set_group(ctx, r.chair.value, 0));
        CHECK(w.set_hidden(ctx, RESTAGE_KIND_INSTANCE, r.chair.value, 1));
        CHECK(w.set_name(ctx, RESTAGE_KIND_INSTANCE, r.chair.value, "stool"));
        CHECK(w.set_name(ctx, RESTAGE_KIND_MATERIAL, r.oak.value, "steel"));
        RestageValue value{};
        value.id = "roughness", value.type = RESTAGE_FLOAT, value.v[0] = 0.5f;
        CHECK(w.set_param(ctx, RESTAGE_KIND_MATERIAL, r.steel.value, &value));
        const RestageHandle both[] = {r.chair2.value};
        CHECK(w.remove(ctx, RESTAGE_KIND_INSTANCE, both, 1)); // and the group of chairs, which is empty now
        CHECK(w.select(ctx, r.chair.value));
        RestageCamera camera{};
        camera.fov = 20, camera.focal_distance = 1;
        for (int k = 0; k < 4; ++k)
            camera.camera_to_world[5 * k] = 1;
        CHECK(w.set_camera(ctx, r.camera.value, &camera));
        RestageEnvironment sky{};
        for (int k = 0; k < 4; ++k)
            sky.light_to_world[5 * k] = 1;
        sky.scale[0] = 3;
        CHECK(w.set_environment(ctx, &sky));
        sky.scale[0] = 2;
        CHECK(w.set_environment(ctx, &sky)); // the last one counts, and this is not a loss
        CHECK(w.progress(ctx, 0.5f, "half"));
    });
    CHECK(done.report.entries.empty());
    CHECK(done.selection == std::vector{r.chair});
    const Scene& now = s.scene();
    const Instance& chair = now.instances[r.chair];
    CHECK(chair.object_to_world == at(2));
    CHECK(chair.material == r.steel);
    CHECK(!chair.group);
    CHECK(chair.hidden);
    CHECK(chair.name == "stool");
    CHECK(now.materials[r.oak].name == "steel 2");
    CHECK(now.materials[r.steel].params.number("roughness", 0) == 0.5f);
    CHECK(!now.instances.find(r.chair2));
    CHECK(!now.groups.find(r.chairs));
    CHECK(now.cameras[r.camera].fov == 20);
    CHECK(now.cameras[r.camera].name == "camera");
    CHECK(now.environment.value->scale.x == 2);
    CHECK(s.session.history().size() == 1);
    s.done([&](const RestageEditWriter1& w, void* ctx) { CHECK(w.set_environment(ctx, nullptr)); });
    CHECK(!s.scene().environment.value);
    REQUIRE(s.session.undo());
    REQUIRE(s.session.undo());
    CHECK(io::structural_differences(r.scene, s.scene(), s.registry, {.names = true}).empty());
    // A run without changes is not an undo step.
    const auto nothing = s.done([&](const RestageEditWriter1& w, void* ctx) {
        CHECK(w.set_hidden(ctx, RESTAGE_KIND_INSTANCE, r.chair.value, 0));
    });
    CHECK(!nothing.changed);
    CHECK(s.session.history().position() == 0);
}

TEST_CASE("invalid changes by an action are refused with a report line", "[action]") {
    Stage s;
    const test::Room& r = s.room;
    using W = const RestageEditWriter1&;
    const glm::dmat4 flat(0);
    s.refused([&](W w, void* c) { CHECK(!w.set_transform(c, 99, &at(1)[0][0])); }, "no instance with id 99");
    s.refused([&](W w, void* c) { CHECK(!w.set_transform(c, r.chair.value, &flat[0][0])); }, "invertible");
    s.refused([&](W w, void* c) { CHECK(!w.set_material(c, r.chair.value, 77)); }, "no material with id 77");
    s.refused([&](W w, void* c) { CHECK(!w.set_group(c, r.chair.value, 77)); }, "no group 77");
    s.refused([&](W w, void* c) { CHECK(!w.set_hidden(c, RESTAGE_KIND_MESH, 1, 1)); }, "only objects and lights");
    s.refused([&](W w, void* c) { CHECK(!w.set_name(c, 40, 1, "x")); }, "no kind 40");
    s.refused([&](W w, void* c) { CHECK(!w.set_active_camera(c, 9)); }, "no camera with id 9");
    s.refused([&](W w, void* c) { CHECK(!w.select(c, 55)); }, "no instance 55");
    s.refused(
        [&](W w, void* c) {
            const RestageHandle used[] = {r.oak.value};
            CHECK(!w.remove(c, RESTAGE_KIND_MATERIAL, used, 1));
        },
        "is used by");
    s.refused(
        [&](W w, void* c) {
            const RestageHandle some[] = {r.chair.value, 99}; // all or none
            CHECK(!w.remove(c, RESTAGE_KIND_INSTANCE, some, 2));
        },
        "no instance with id 99");
    s.refused(
        [&](W w, void* c) {
            const RestageInstance i = copy_of(88, r.oak.value, 0);
            CHECK(!w.add_instance(c, &i));
        },
        "no mesh 88");
    s.refused(
        [&](W w, void* c) {
            RestageValue value{};
            value.id = "roughness", value.type = RESTAGE_FLOAT, value.v[0] = test::not_a_number;
            CHECK(!w.set_param(c, RESTAGE_KIND_MATERIAL, r.steel.value, &value));
        },
        "not a finite number");
    s.refused(
        [&](W w, void* c) {
            RestageEnvironment sky{}; // its transform is all zero: not affine
            CHECK(!w.set_environment(c, &sky));
        },
        "the environment");
    // A run cannot remove things it has added; its other changes stay.
    const auto result = s.write([&](W w, void* c) {
        const RestageInstance i = copy_of(r.mesh.value, r.oak.value, 0);
        const RestageHandle made[] = {w.add_instance(c, &i)};
        CHECK(!w.remove(c, RESTAGE_KIND_INSTANCE, made, 1));
    });
    REQUIRE(result);
    CHECK(result->edit.changes.size() == 1);
    CHECK(result->report.count(io::Fate::dropped) == 1);
}

TEST_CASE("an action that fails, is cancelled or makes the scene invalid changes nothing", "[action]") {
    Stage s;
    const test::Room& r = s.room;
    const auto message = [&](const Body& what, io::ActionRun run = {}) {
        const auto result = s.run(what, std::move(run));
        REQUIRE(!result);
        return result.error();
    };
    CHECK_THAT(message([&](auto&, auto&, auto*, auto, auto& w) {
                   w.set_transform(w.ctx, r.chair.value, &at(2)[0][0]);
                   w.error(w.ctx, "no floor: make one");
                   w.error(w.ctx, "another");
                   return 0;
               }).message,
               ContainsSubstring("Test: no floor: make one"));
    CHECK_THAT(
        message([](auto&, auto&, auto*, auto, auto&) { return 0; }).message,
        ContainsSubstring("Test: failed without giving a reason. Nothing was changed. This is a bug in the plugin "));
    CHECK_THAT(message([&](auto&, auto&, auto*, auto, auto& w) -> int {
                   w.set_transform(w.ctx, r.chair.value, &at(2)[0][0]);
                   throw std::runtime_error("lost count");
               }).message,
               ContainsSubstring("Test: threw an exception: lost count. Nothing was changed."));
    CHECK_THAT(message([](auto&, auto&, auto*, auto, auto&) -> int { throw 7; }).message,
               ContainsSubstring("Test: threw an exception. Nothing was changed."));
    CHECK_THAT(message([](auto& scene, auto&, auto*, auto, auto&) {
                   scene.error(scene.ctx, "file", "broken");
                   return 1;
               }).message,
               ContainsSubstring("broken"));
    int calls = 0;
    const Error stopped = message(
        [](auto&, auto&, auto*, auto, auto& w) {
            int all = 0;
            while (w.progress(w.ctx, 0.1f, "") && all < 10)
                ++all;
            return all == 10;
        },
        {.selection = {}, .values = {}, .progress = [&](float, std::string_view) { return ++calls < 3; }});
    CHECK(stopped.cancelled());
    // A mix or group that contains itself: not detected by a single call.
    const Error circle = message([&](auto&, auto&, auto*, auto, auto& w) {
        RestageValue value{};
        value.id = "first", value.type = RESTAGE_MATERIAL, value.ref = r.oak.value;
        return w.set_param(w.ctx, RESTAGE_KIND_MATERIAL, r.oak.value, &value);
    });
    CHECK_THAT(circle.message, ContainsSubstring("contains itself"));
    CHECK(s.scene().clock == s.session.version());
    CHECK(s.session.history().size() == 0);
}

TEST_CASE("an action receives its parameters and selection", "[action]") {
    Stage s;
    const test::Room& r = s.room;
    s.table.params = {
        {.id = "count", .label = "Count", .type = ParamType::integer, .int_min = 1, .int_max = 9, .int_def = 4},
        {.id = "size", .label = "Size", .type = ParamType::number, .min = 0, .max = 2, .def = {0.5f}}};
    s.table.needs_selection = true;
    io::ActionRun run{.selection = {r.lamp, r.chair}, .values = {}, .progress = {}};
    run.values.set("size", Value::number(1.5f));
    bool called = false;
    CHECK(s.run(
        [&](const RestageSceneReader1& scene, const RestageSelection1& selection, const RestageValue* values,
            std::uint32_t count, RestageEditWriter1& w) {
            called = true;
            CHECK(selection.size == sizeof(RestageSelection1));
            REQUIRE(selection.instance_count == 2);
            CHECK(selection.instances[1] == r.chair.value);
            REQUIRE(count == 2);
            CHECK(values[0].i == 4);
            CHECK(values[1].v[0] == 1.5f);
            // The reader keeps showing the scene as it was.
            CHECK(w.set_transform(w.ctx, r.chair.value, &at(2)[0][0]));
            RestageInstance chair{};
            CHECK(scene.instance(scene.ctx, r.chair.value, &chair));
            CHECK(chair.object_to_world[12] == 0);
            return 1;
        },
        run));
    CHECK(called);
    const auto refusal = [&](const io::ActionRun& wrong) {
        called = false;
        const auto result = s.run(
            [&](auto&&...) {
                called = true;
                return 1;
            },
            wrong);
        CHECK(!called);
        REQUIRE(!result);
        return result.error().message;
    };
    CHECK_THAT(refusal({}), ContainsSubstring("nothing is selected"));
    CHECK_THAT(refusal({.selection = {{99}}, .values = {}, .progress = {}}), ContainsSubstring("99 does not exist"));
    CHECK_THAT(refusal({.selection = {r.chair, r.chair}, .values = {}, .progress = {}}), ContainsSubstring("twice"));
    io::ActionRun wrong = run;
    wrong.values.set("count", Value::integer(10));
    CHECK_THAT(refusal(wrong), ContainsSubstring("\"count\""));
    wrong = run;
    wrong.values.set("nothing", Value::integer(10));
    CHECK_THAT(refusal(wrong), ContainsSubstring("known: count, size"));
}

TEST_CASE("edits made for an older scene are rebased onto a newer one, or refused", "[action]") {
    Stage s;
    const test::Room& r = s.room;
    const auto adds_and_moves = [&](const RestageEditWriter1& w, void* c) {
        RestageMaterialDesc material{};
        material.name = "new", material.type = "diffuse";
        const RestageInstance i = copy_of(r.mesh.value, w.add_material(c, &material), 1);
        w.add_instance(c, &i);
        w.set_transform(c, r.lamp.value, &at(5)[0][0]);
    };
    SECTION("other things were changed or added") {
        auto result = s.write(adds_and_moves);
        REQUIRE(result);
        REQUIRE(s.session.duplicate(std::vector{r.chair}, at(1)));
        REQUIRE(s.session.edit(insert(s.scene(), Material{.name = "other", .type = "diffuse"}, "add")));
        REQUIRE(s.session.move(std::vector{r.chair}, at(3)));
        const auto done = document::apply_action(s.session, std::move(*result));
        REQUIRE(done);
        REQUIRE(done->selection.size() == 1);
        const Instance& made = s.scene().instances[done->selection[0]];
        CHECK(s.scene().materials[made.material].name == "new");
        CHECK(s.scene().instances[r.lamp].object_to_world == at(5));
        CHECK(s.scene().instances[r.chair].object_to_world == at(3));
        CHECK(s.scene().instances.live() == 5);
        REQUIRE(s.session.undo());
        CHECK(s.scene().instances.live() == 4);
    }
    const auto refused = [&](Result<io::ActionResult> result, const char* why) {
        REQUIRE(result);
        const Version before = s.session.version();
        const auto done = document::apply_action(s.session, std::move(*result));
        REQUIRE(!done);
        CHECK_THAT(done.error().message, ContainsSubstring(why));
        CHECK(s.session.version() == before);
    };
    SECTION("a thing that it changes was changed") {
        auto result = s.write(adds_and_moves);
        REQUIRE(s.session.move(std::vector{r.lamp}, at(1)));
        refused(std::move(result), "instance \"lamp\" has changed meanwhile: run it again");
    }
    SECTION("a thing that it refers to was removed") {
        auto result = s.write([&](const RestageEditWriter1& w, void* c) {
            const RestageInstance i = copy_of(r.mesh.value, r.steel.value, 1);
            w.add_instance(c, &i);
        });
        REQUIRE(s.session.set_material(std::vector{r.lamp}, r.oak));
        REQUIRE(s.session.edit(remove(s.scene(), r.steel)));
        refused(std::move(result), "material \"steel\" has been removed meanwhile");
    }
    SECTION("a thing that it removes is in use by now") {
        REQUIRE(s.session.edit(insert(s.scene(), Material{.name = "spare", .type = "diffuse"}, "add")));
        const Id<Material> spare = s.session.find<Material>("spare");
        auto result = s.write([&](const RestageEditWriter1& w, void* c) {
            const RestageHandle unused[] = {spare.value};
            CHECK(w.remove(c, RESTAGE_KIND_MATERIAL, unused, 1));
        });
        REQUIRE(s.session.set_material(std::vector{r.lamp}, spare));
        refused(std::move(result), "does not exist");
    }
    SECTION("another document") {
        auto result = s.write(adds_and_moves);
        s.session.adopt(r.scene);
        refused(std::move(result), "another document");
    }
}

TEST_CASE("tables of actions and panels are validated before use", "[action]") {
    const RestageParam params[] = {RESTAGE_INT_PARAM("copies", "Copies", 1, 9, 3, 0, "", "How many."),
                                   RESTAGE_FLOAT_PARAM("step", "Step", 0, 1, 0.5f, 0, "m", "How far.")};
    RestageAction1 a{.size = sizeof(RestageAction1),
                     .id = "row",
                     .label = "Row",
                     .tooltip = nullptr,
                     .params = params,
                     .param_count = 2,
                     .flags = RESTAGE_ACTION_NEEDS_SELECTION,
                     .run = run_body};
    const auto action = plugin::read_action1(a);
    REQUIRE(action);
    CHECK(action->needs_selection);
    CHECK(action->find("copies")->int_def == 3);
    CHECK(plugin::check_action(*action).empty());
    const auto wrong = [&](const auto& change) {
        model::Action copy = *action;
        change(copy);
        return plugin::check_action(copy);
    };
    CHECK_THAT(wrong([](model::Action& t) { t.id = "A row"; }), ContainsSubstring("without a proper id"));
    CHECK_THAT(wrong([](model::Action& t) { t.label = ""; }), ContainsSubstring("has no label"));
    CHECK_THAT(wrong([](model::Action& t) { t.params[1].id = "copies"; }), ContainsSubstring("is a duplicate"));
    CHECK_THAT(wrong([](model::Action& t) { t.params[1].texturable = true; }), ContainsSubstring("texturable"));
    CHECK_THAT(wrong([](model::Action& t) { t.params[1].type = ParamType::table; }), ContainsSubstring("TABLE"));
    a.run = nullptr;
    CHECK_THAT(plugin::read_action1(a).error().message, ContainsSubstring("lacks run"));
    a.size = 16;
    CHECK_THAT(plugin::read_action1(a).error().message, ContainsSubstring("has 16 bytes"));
    model::Panel panel{.id = "row", .label = "Row", .params = {{.id = "of", .label = "Of"}}};
    CHECK(plugin::check_panel(panel).empty());
    panel.params[0].type = ParamType::material;
    CHECK_THAT(plugin::check_panel(panel), ContainsSubstring("cannot refer to things of a document"));
    const RestagePanel1 empty{.size = sizeof(RestagePanel1), .id = "row", .label = "Row"};
    CHECK_THAT(plugin::read_panel1(empty).error().message, ContainsSubstring("lacks draw"));
}

namespace {

struct Silent final : plugin::PanelWidgets { // simulates a passive user
    void param(const char*) override {}
    void hide(const char*) override {}
    void slider(const char*, const char*, float, float, bool) override {}
    void color(const char*, const char*) override {}
    void texture(const char*, const char*) override {}
    int combo(const char*, const char* const*, std::uint32_t, int) override { return -1; }
    bool button(const char*, const char*) override { return true; }
    void text(const char*) override {}
    bool begin_group(const char*) override { return false; }
    void end_group() override {}
    void plot(const char*, const float*, std::uint32_t, std::uint32_t, float, float, float, float) override {}
    void curve(const char*, const char* const*, std::uint32_t) override {}
    void image(const char*, const float*, std::uint32_t, std::uint32_t) override {}
    std::optional<plugin::PluginValue> get(const char*) override { return std::nullopt; }
    void set(const char*, std::span<const plugin::PluginValue>) override {}
    bool run(const char* action) override {
        ran = action;
        return true;
    }
    std::uint32_t selected() override { return 7; }
    std::string ran;
};

} // namespace

TEST_CASE("a panel runs actions and gets the number of selected objects", "[action]") {
    const RestagePanel1 native{
        .size = sizeof(RestagePanel1), .id = "row", .label = "Row", .draw = [](const RestageUi1* ui, void* ctx) {
            if (ui->selected(ctx) == 7 && ui->button(ctx, "Row", "")) ui->run(ctx, "row");
        }};
    plugin::PanelEntry entry;
    entry.native = &native;
    Silent widgets;
    plugin::draw_panel(entry, widgets);
    CHECK(widgets.ran == "row");
}
