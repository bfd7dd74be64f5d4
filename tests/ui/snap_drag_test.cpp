// SPDX-License-Identifier: Apache-2.0
// Snapping of drags: chosen in the toolbar, shown by a hint, suspended by Ctrl, kept in the preferences.
#include "headless.hpp"

#include "editor/preferences.hpp"
#include "temporary_folder.hpp"

using namespace restage;
using tests::Headless;

TEST_CASE("a dragged thing snaps to the grid, with a hint, unless Ctrl is held", "[ui]") {
    Headless h("demo/demo.pbrt");
    editor::Editor& e = h.editor();
    e.selection.whole_things = false;
    h.select("Chair frame");
    const auto id = e.selection.active();
    e.view.snap_move = 0.25f;
    h.play("grid", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "gizmo.center");
        h.click(ctx, "toolbar.snap");
        h.click(ctx, "snap.grid");
        ctx->KeyPress(ImGuiKey_Escape);
        ctx->Yield(2);
        IM_CHECK(e.preferences.snap_to.grid);
        h.select("Chair frame");
        ctx->Yield(2);
        const auto off_grid = [&] { // of the middle of its underside
            const scene::Instance& chair = h.scene().instances[id];
            scene::Bounds box; // of its vertices
            for (const glm::vec3& p : h.scene().meshes[chair.mesh].data->positions)
                box.add(glm::dvec3(chair.object_to_world * glm::dvec4(glm::dvec3(p), 1)));
            const glm::dvec3 middle = box.center() / 0.25;
            return std::max(std::abs(middle.x - std::round(middle.x)), std::abs(middle.y - std::round(middle.y)));
        };
        const auto start = [&](ImGuiKeyChord keys) {
            const ImVec4 r = h.find(ctx, "gizmo.center");
            const ImVec2 from((r.x + r.z) / 2, (r.y + r.w) / 2);
            ctx->MouseMoveToPos(from);
            if (keys) ctx->KeyDown(keys);
            ctx->MouseDown();
            for (int i = 1; i <= 5; ++i)
                ctx->MouseMoveToPos({from.x + 12 * float(i), from.y + 8 * float(i)});
            ctx->Yield(2);
        };
        start(0);
        IM_CHECK(h.has(ctx, "snap.grid 0.25"));
        ctx->MouseUp();
        ctx->Yield(3);
        IM_CHECK(h.step() == 1 && off_grid() < 1e-4);
        IM_CHECK(!h.has(ctx, "snap.grid 0.25"));
        e.run("edit.undo");
        ctx->Yield(3);
        start(ImGuiMod_Ctrl);
        IM_CHECK(!h.has(ctx, "snap.grid 0.25"));
        ctx->MouseUp();
        ctx->KeyUp(ImGuiMod_Ctrl);
        ctx->Yield(3);
        IM_CHECK(h.step() == 1 && off_grid() > 1e-3); // in steps from where it was
    });
}

TEST_CASE("what things snap to is remembered", "[ui]") {
    const test::TemporaryFolder folder;
    editor::Preferences preferences;
    preferences.snap_to = {.grid = true, .wall = true};
    editor::write_preferences(folder.path(), preferences);
    CHECK((editor::read_preferences(folder.path()).snap_to == preferences.snap_to));
}
