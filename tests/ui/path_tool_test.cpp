// SPDX-License-Identifier: Apache-2.0
// An array along a path drawn in the picture.
#include "headless.hpp"

#include "editor/actions.hpp"
#include "editor/arrange.hpp"

using namespace restage;
using tests::Headless;

TEST_CASE("copies follow a path that is drawn in the picture", "[ui]") {
    Headless h("demo/demo.pbrt");
    editor::Editor& e = h.editor();
    h.play("path", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "axes.x");
        h.select("Vase");
        const auto vase = e.selection.active();
        const std::size_t objects = h.scene().instances.live();
        e.run("edit.arrange");
        ctx->Yield(3);
        editor::ArrangeState& a = e.panel_state->arrange;
        h.click(ctx, "array.kind");
        h.click(ctx, "array.kind.3");
        IM_CHECK(!h.has(ctx, "array.make")); // there is no path yet
        const auto draw = [&] {
            h.click(ctx, "array.draw");
            h.wait_for(ctx, "path.hint");
            for (const auto& [x, y] : {std::pair(0.3f, 0.85f), {0.6f, 0.9f}}) {
                ctx->MouseMoveToPos(
                    {e.viewport.corner.x + x * e.viewport.size.x, e.viewport.corner.y + y * e.viewport.size.y});
                ctx->MouseClick();
                ctx->Yield(3);
            }
        };
        draw();
        IM_CHECK(a.array.path.size() == 2 && h.step() == 1);
        IM_CHECK(h.scene().instances.live() == objects + 4);
        IM_CHECK(e.selection.active() == vase); // clicks select nothing
        const scene::Bounds last = scene::world_bounds(h.scene(), a.live->copies.back());
        IM_CHECK(std::abs(last.lower.z - a.array.path[1].z) < 1e-3); // it stands on the point
        IM_CHECK(std::abs(last.center().x - a.array.path[1].x) < 0.02);
        ctx->KeyPress(ImGuiKey_Backspace);
        ctx->Yield(3);
        IM_CHECK(a.array.path.size() == 1 && h.step() == 1);
        ctx->KeyPress(ImGuiKey_Enter); // ends drawing; the numbers can still be changed
        ctx->Yield(3);
        IM_CHECK(!a.drawing && editor::array_is_live(e));
        IM_CHECK(!h.has(ctx, "path.hint"));
        h.click(ctx, "array.by");
        h.click(ctx, "array.by.1");
        ctx->Yield(3);
        IM_CHECK(a.array.by_spacing && h.step() == 1);
        ctx->KeyPress(ImGuiKey_Enter); // keeps it
        ctx->Yield(3);
        IM_CHECK(!a.live && h.step() == 1 &&
                 e.selection.instances().size() == h.scene().instances.live() - objects + 1);

        e.run("edit.undo");
        ctx->Yield(3);
        h.select("Vase");
        a.array.by_spacing = false;
        ctx->Yield(3);
        draw();
        IM_CHECK(h.scene().instances.live() == objects + 4);
        ctx->KeyPress(ImGuiKey_Escape);
        ctx->Yield(3);
        IM_CHECK(!a.drawing && !a.live && h.scene().instances.live() == objects);
        IM_CHECK(e.selection.active() == vase);
    });
}
