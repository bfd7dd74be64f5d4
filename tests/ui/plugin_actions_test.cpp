// SPDX-License-Identifier: Apache-2.0
// Actions and panels of plugins: the menu, the dialog of an action, its background run, one undo step, and the panel
// that runs it.
#include "headless.hpp"

#include "base/file.hpp"
#include "editor/files.hpp"
#include "editor/panels/plugin_panels.hpp"
#include "temporary_folder.hpp"

#include <algorithm>
#include <functional>

using namespace restage;
using tests::Headless;

namespace {

// Waits for work on a thread, however long that takes on a busy machine.
void wait_until(ImGuiTestContext* ctx, const std::function<bool()>& there) {
    const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!there() && std::chrono::steady_clock::now() < limit) {
        ctx->Yield();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

// A pin and a floor of triangles; the demo's shapes are quadrics.
std::vector<scene::Id<scene::Instance>> add_meadow(Headless& h) {
    const auto shape = [](std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles) {
        auto data = std::make_shared<scene::MeshData>();
        data->positions = std::move(positions), data->triangles = std::move(triangles);
        scene::compute_bounds(*data);
        return data;
    };
    auto& session = h.editor().session_for_changes();
    const auto add = [&]<class T>(T item) {
        const scene::Id<T> id = scene::table<T>(session.scene()).next();
        const bool added = session.edit(scene::insert(session.scene(), std::move(item), "add")).has_value();
        REQUIRE(added);
        return id;
    };
    const auto material = add(scene::Material{.name = "grass", .type = "diffuse"});
    const auto blade =
        add(scene::Mesh{.name = "blade", .data = shape({{0, 0, 0}, {.1f, 1, 0}, {-.1f, 1, 0}}, {{0, 1, 2}})});
    const auto floor = add(scene::Mesh{
        .name = "floor", .data = shape({{-5, 0, -5}, {5, 0, -5}, {5, 0, 5}, {-5, 0, 5}}, {{0, 2, 1}, {0, 3, 2}})});
    return {add(scene::Instance{.name = "blade", .mesh = blade, .material = material}),
            add(scene::Instance{.name = "meadow", .mesh = floor, .material = material})};
}

// A folder with the action and panel "stack" of tests/plugins_broken.
struct Stack {
    test::TemporaryFolder folder;
    explicit Stack(const std::string& which) {
        std::filesystem::create_directory(folder.path() / "stack");
        REQUIRE(write_file_atomic(folder.path() / "stack/plugin.json", R"({"id": "org.example.broken",
            "provides": ["restage.action/1", "restage.panel/1"], "version": "1.0.0", "needs": {"host": ">=0.2"},
            "licence": "MIT", "library": "stack"})"));
        rebuild(which);
    }
    void rebuild(const std::string& which) const {
        const auto bytes = read_file(restage::test::build_dir() / "tests/plugins_broken" / (which + ".so"));
        REQUIRE(bytes);
        REQUIRE(write_file_atomic(folder.path() / "stack/stack.so", *bytes));
    }
};

bool told(Headless& h, const std::string& what) {
    const auto lines = h.editor().notices.lines();
    return std::ranges::any_of(lines, [&](const auto& line) { return line.text.find(what) != std::string::npos; });
}

// The panel "stack" in front, with something selected.
void open_stack(Headless& h, ImGuiTestContext* ctx, const std::vector<scene::Id<scene::Instance>>& ids) {
    h.click(ctx, "menu.panels");
    h.click(ctx, "panels.stack");
    ctx->KeyPress(ImGuiKey_Escape); // closes the menu, and drops the selection
    h.editor().selection.set(ids);
}

} // namespace

TEST_CASE("an action of a plugin runs from the menu, and is one undo step", "[ui]") {
    Headless h("demo/demo.pbrt");
    const auto ids = add_meadow(h);
    const std::size_t objects = h.scene().instances.live(), steps = h.step();
    h.play("menu", [&](ImGuiTestContext* ctx) {
        h.click(ctx, "menu.tools");
        h.click(ctx, "tools.scatter"); // nothing is selected: it is disabled
        IM_CHECK(!h.has(ctx, "action.run"));
        ctx->KeyPress(ImGuiKey_Escape);
        h.editor().selection.set(ids);
        h.click(ctx, "menu.tools");
        h.click(ctx, "tools.scatter");
        h.click(ctx, "action.cancel");
        IM_CHECK(!h.has(ctx, "action.run") && h.step() == steps);
        h.click(ctx, "menu.tools");
        h.click(ctx, "tools.scatter");
        h.drag(ctx, "action.scatter.rotation", -40);
        h.click(ctx, "action.run");
        wait_until(ctx, [&] { return h.step() == steps + 1; });
        IM_CHECK(h.scene().instances.live() == objects + 100);
        IM_CHECK(h.editor().selection.instances().size() == 100);
        IM_CHECK(h.editor().session().history().undo_label() == "Scatter");
        const auto& asked = h.editor().panel_state->plugins.asked["scatter"];
        IM_CHECK(asked.number("rotation", 180) < 180);
        h.editor().run("edit.undo");
        ctx->Yield(3);
        IM_CHECK(h.step() == steps && h.scene().instances.live() == objects);
        IM_CHECK(h.editor().selection.empty());
    });
}

TEST_CASE("an action that fails or is stopped changes nothing", "[ui]") {
    Headless h("demo/demo.pbrt");
    const auto ids = add_meadow(h);
    const std::size_t steps = h.step();
    const auto entry = h.registry().catalogue()->actions.at(0);
    h.play("refused", [&](ImGuiTestContext* ctx) {
        h.editor().selection.set(std::vector{ids[1]});
        h.click(ctx, "menu.tools");
        h.click(ctx, "tools.scatter");
        h.click(ctx, "action.run");
        wait_until(ctx, [&] { return !h.editor().files().jobs.running(); });
        ctx->Yield(3);
        IM_CHECK(h.step() == steps);
        IM_CHECK(h.editor().notices.lines().back().text.find("at least two objects") != std::string::npos);
    });
}

TEST_CASE("a panel of a plugin stores its values and runs its action", "[ui]") {
    const test::TemporaryFolder config;
    for (const bool again : {false, true}) {
        Headless h("demo/demo.pbrt", 1, {1500, 1000}, config.path());
        const auto ids = add_meadow(h);
        const std::size_t objects = h.scene().instances.live(), steps = h.step();
        const model::Panel& panel = *h.registry().catalogue()->panels.at(0).table;
        h.play("panel", [&](ImGuiTestContext* ctx) {
            h.click(ctx, "menu.panels");
            h.click(ctx, "panels.scatter");
            ctx->KeyPress(ImGuiKey_Escape);
            IM_CHECK(h.editor().panel_open(editor::panel_title(panel)));
            IM_CHECK(!h.has(ctx, "panel.scatter.ui.button.1")); // nothing is selected
            if (!again) {
                h.click(ctx, "panel.scatter.count");
                ctx->KeyDown(ImGuiMod_Ctrl);
                h.click(ctx, "panel.scatter.count");
                ctx->KeyUp(ImGuiMod_Ctrl);
                ctx->KeyCharsReplaceEnter("17");
                ctx->Yield(3);
            }
            h.editor().selection.set(ids);
            h.click(ctx, "panel.scatter.ui.button.1");
            wait_until(ctx, [&] { return h.step() == steps + 1; });
            IM_CHECK(h.scene().instances.live() == objects + 17); // also in the second program
            h.editor().run("edit.undo");
            ctx->Yield(3);
            IM_CHECK(h.scene().instances.live() == objects);
        });
    }
}

TEST_CASE("a rebuilt plugin's action and panel keep their values by id", "[ui]") {
    const Stack stack("action_sound");
    Headless h("demo/demo.pbrt", 1, {1500, 1000}, {}, stack.folder.path());
    const std::vector<scene::Id<scene::Instance>> ids{add_meadow(h)[0]};
    const std::size_t objects = h.scene().instances.live(), steps = h.step();
    h.play("rebuilt", [&](ImGuiTestContext* ctx) {
        open_stack(h, ctx, ids);
        auto& state = h.editor().panel_state->plugins;
        state.panels["stack"].set("copies", scene::Value::integer(17));
        state.panels["stack"].set("step", scene::Value::number(2.5f));
        h.click(ctx, "menu.tools"); // its dialog stays open meanwhile
        h.click(ctx, "tools.stack");
        state.asked["stack"].set("copies", scene::Value::integer(9));
        state.asked["stack"].set("step", scene::Value::number(2.5f));
        IM_CHECK(h.has(ctx, "action.stack.step") && !h.has(ctx, "action.stack.gap"));
        stack.rebuild("action_rebuilt");
        wait_until(ctx, [&] { return told(h, "org.example.broken was reloaded"); });
        IM_CHECK(h.has(ctx, "action.stack.gap") && !h.has(ctx, "action.stack.step"));
        h.click(ctx, "action.run");
        wait_until(ctx, [&] { return h.step() == steps + 1; });
        IM_CHECK(h.scene().instances.live() == objects + 9);
        h.editor().run("edit.undo");
        ctx->Yield(3);
        h.editor().selection.set(ids);
        IM_CHECK(h.has(ctx, "panel.stack.gap"));
        h.click(ctx, "panel.stack.ui.button.0");
        wait_until(ctx, [&] { return h.step() == steps + 1; });
        IM_CHECK(h.scene().instances.live() == objects + 17);
        IM_CHECK(state.panels["stack"].entries().size() == 1); // "step" was removed
    });
}

TEST_CASE("an action and a panel that throw change nothing, and work again once rebuilt", "[ui]") {
    const Stack stack("action_throws");
    Headless h("demo/demo.pbrt", 1, {1500, 1000}, {}, stack.folder.path());
    const std::vector<scene::Id<scene::Instance>> ids{add_meadow(h)[0]};
    const std::size_t objects = h.scene().instances.live(), steps = h.step();
    const scene::Version version = h.scene().clock;
    h.play("thrown", [&](ImGuiTestContext* ctx) {
        h.editor().selection.set(ids);
        h.click(ctx, "menu.tools");
        h.click(ctx, "tools.stack");
        h.click(ctx, "action.run");
        wait_until(ctx, [&] { return told(h, "no room on the stack"); });
        IM_CHECK(told(h,
                      "Stack: threw an exception: no room on the stack. Nothing was changed. This is a bug in the "
                      "plugin org.example.broken"));
        open_stack(h, ctx, ids);
        h.wait_for(ctx, "panel.stack.broken");
        IM_CHECK(told(h, "Stack: draw() threw an exception: nothing to draw with"));
        const auto told_once = h.editor().notices.count();
        ctx->Yield(5);
        IM_CHECK(h.editor().notices.count() == told_once); // not in each frame
        IM_CHECK(!h.editor().panel_state->plugins.panels["stack"].find("copies")); // its previous values
        h.click(ctx, "panel.stack.again");
        h.wait_for(ctx, "panel.stack.broken");
        IM_CHECK(h.editor().notices.count() == told_once + 1);
        IM_CHECK(h.step() == steps && h.scene().clock == version);
        h.click(ctx, "tab.Outliner"); // others are still drawn
        stack.rebuild("action_rebuilt");
        h.wait_for(ctx, "panel.stack.gap");
        IM_CHECK(!h.has(ctx, "panel.stack.broken"));
        h.editor().selection.set(ids);
        h.click(ctx, "panel.stack.ui.button.0");
        wait_until(ctx, [&] { return h.step() == steps + 1; });
        IM_CHECK(h.scene().instances.live() == objects + 4);
    });
}

TEST_CASE("frame times with 10,000 scattered copies", "[.][measure]") {
    Headless h("demo/demo.pbrt");
    const auto ids = add_meadow(h);
    const std::size_t steps = h.step();
    h.play("many", [&](ImGuiTestContext* ctx) {
        const auto median = [&] { // of a frame [ms]
            std::vector<double> all;
            for (int i = 0; i < 41; ++i) {
                const auto start = std::chrono::steady_clock::now();
                ctx->Yield();
                all.push_back(
                    std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
            }
            std::ranges::nth_element(all, all.begin() + 20);
            return all[20];
        };
        h.editor().selection.set(ids);
        ctx->Yield(3);
        const double before = median();
        h.editor().panel_state->plugins.asked["scatter"].set("count", scene::Value::integer(10000));
        h.click(ctx, "menu.tools");
        h.click(ctx, "tools.scatter");
        const auto start = std::chrono::steady_clock::now();
        h.click(ctx, "action.run");
        wait_until(ctx, [&] { return h.step() == steps + 1; });
        const double done = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        ctx->Yield(3);
        const double selected = median();
        h.editor().selection.clear();
        ctx->Yield(3);
        const double after = median();
        h.editor().run("edit.undo");
        const auto undo = std::chrono::steady_clock::now();
        wait_until(ctx, [&] { return h.step() == steps; });
        const double undone =
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - undo).count();
        WARN("frame before " << before << " ms, from Run to the copies " << done << " ms, frame with all selected "
                             << selected << " ms, with none " << after << " ms, undo " << undone << " ms");
    });
}
