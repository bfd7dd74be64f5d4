// SPDX-License-Identifier: Apache-2.0
// Actions and panels of plugins: the menu, the dialog of an action, its run in the background, one step to undo, and
// the panel that runs it.
#include "headless.hpp"

#include "editor/files.hpp"
#include "editor/panels/plugin_panels.hpp"
#include "temporary_folder.hpp"

#include <functional>

using namespace restage;
using tests::Headless;

namespace {

// For what a thread does, however long that takes on a busy machine.
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
        REQUIRE(session.edit(scene::insert(session.scene(), std::move(item), "add")));
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

} // namespace

TEST_CASE("an action of a plugin runs from the menu, and is one step to undo", "[ui]") {
    Headless h("demo/demo.pbrt");
    const auto ids = add_meadow(h);
    const std::size_t objects = h.scene().instances.live(), steps = h.step();
    h.play("menu", [&](ImGuiTestContext* ctx) {
        h.click(ctx, "menu.tools");
        h.click(ctx, "tools.scatter"); // nothing is selected: it is grey
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
        IM_CHECK(h.editor().notices.lines().back().text.find("two objects at least") != std::string::npos);
    });
}

TEST_CASE("a panel of a plugin remembers its values and runs its action", "[ui]") {
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
            IM_CHECK(h.scene().instances.live() == objects + 17); // in the second program, too
            h.editor().run("edit.undo");
            ctx->Yield(3);
            IM_CHECK(h.scene().instances.live() == objects);
        });
    }
}
