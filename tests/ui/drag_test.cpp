// SPDX-License-Identifier: Apache-2.0
// The same rules for every way of dragging the selection: by its handles, by the knob between them, directly.
#include "headless.hpp"

#include <functional>

using namespace restage;
using tests::Headless;

namespace {

struct Drag {
    const char* name;
    const char* mark; // where the drag starts
    ImGuiKeyChord keys = 0;
    ImVec2 by{40, 25}; // [pixel]
    enum class End { release, escape, right_click } end = End::release;
};

void play(ImGuiTestContext* ctx, Headless& h, const Drag& drag) {
    const ImVec4 r = h.find(ctx, drag.mark);
    const ImVec2 from((r.x + r.z) / 2, (r.y + r.w) / 2);
    ctx->MouseMoveToPos(from);
    if (drag.keys) ctx->KeyDown(drag.keys);
    ctx->MouseDown();
    for (int i = 1; i <= 5; ++i)
        ctx->MouseMoveToPos({from.x + drag.by.x * float(i) / 5, from.y + drag.by.y * float(i) / 5});
    if (drag.end == Drag::End::escape) ctx->KeyPress(ImGuiKey_Escape);
    if (drag.end == Drag::End::right_click) { // MouseClick() requires all buttons up
        ctx->MouseDown(ImGuiMouseButton_Right);
        ctx->MouseUp(ImGuiMouseButton_Right);
    }
    if (drag.end != Drag::End::release) ctx->MouseMoveToPos({from.x + 2 * drag.by.x, from.y}); // is not dragged on
    ctx->MouseUp();
    if (drag.keys) ctx->KeyUp(drag.keys);
    ctx->Yield(3);
}

} // namespace

TEST_CASE("a drag stays on the floor, copies, moves in steps, lifts and is cancelled, however it is started", "[ui]") {
    Headless h("demo/demo.pbrt");
    h.select("Chair frame");
    const auto id = h.editor().selection.active();
    const glm::dvec3 start(h.scene().instances[id].object_to_world[3]);
    const std::size_t objects = h.scene().instances.live();
    const auto moved = [&](editor::InstanceId one) {
        return glm::dvec3(h.scene().instances[one].object_to_world[3]) - start;
    };
    h.play("drags", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "gizmo.center");
        for (const char* mark : {"gizmo.center", "gizmo.x", "gizmo.y"}) {
            INFO(mark);
            const auto check = [&](const char* what, bool holds) {
                IM_CHECK_SILENT_RETV(holds, (ctx->LogError("%s: %s", mark, what), void()));
            };
            // A click is not a drag.
            const ImVec4 r = h.find(ctx, mark);
            ctx->MouseMoveToPos({(r.x + r.z) / 2, (r.y + r.w) / 2});
            ctx->MouseClick();
            ctx->Yield(3);
            check("a click is a step", h.step() == 0);
            h.select("Chair frame");
            ctx->Yield(3);

            play(ctx, h, {"plain", mark});
            check("no step", h.step() == 1 && h.editor().session().history().undo_label() == "Move Chair frame");
            check("off the floor", std::abs(moved(id).z) < 1e-5);
            check("not moved", glm::length(moved(id)) > 0.02);
            h.editor().run("edit.undo");
            ctx->Yield(3);

            play(ctx, h, {"alt", mark, ImGuiMod_Alt, {10, -40}});
            check("not lifted", h.step() == 1 && moved(id).z > 0.02);
            check("moved aside", std::hypot(moved(id).x, moved(id).y) < 1e-5);
            h.editor().run("edit.undo");
            ctx->Yield(3);

            h.editor().view.snap_move = 0.05f;
            play(ctx, h, {"ctrl", mark, ImGuiMod_Ctrl, {60, 35}});
            for (int i = 0; i < 3; ++i)
                check("not in steps", std::abs(moved(id)[i] / 0.05 - std::round(moved(id)[i] / 0.05)) < 1e-3);
            check("not moved in steps", glm::length(moved(id)) > 0.02);
            h.editor().run("edit.undo");
            ctx->Yield(3);

            play(ctx, h, {"shift", mark, ImGuiMod_Shift});
            check("no copy", h.scene().instances.live() == objects + 1 && h.step() == 1);
            check("the original moved", moved(id) == glm::dvec3(0));
            check("the copy is not selected", h.editor().selection.active() != id);
            check("the copy is off the floor", std::abs(moved(h.editor().selection.active()).z) < 1e-5);
            h.editor().run("edit.undo");
            ctx->Yield(3);
            check("the copy stayed", h.scene().instances.live() == objects);
            h.select("Chair frame");
            ctx->Yield(3);

            for (const ImGuiKeyChord keys : {ImGuiKeyChord(0), ImGuiKeyChord(ImGuiMod_Shift)})
                for (const auto end : {Drag::End::escape, Drag::End::right_click}) {
                    play(ctx, h, {"cancelled", mark, keys, {40, 25}, end});
                    check("not cancelled", h.step() == 0 && moved(id) == glm::dvec3(0));
                    check("a cancelled copy stayed", h.scene().instances.live() == objects);
                    check("nothing is selected", h.editor().selection.contains(id));
                    // The redo history is kept.
                    check("the redo is gone", h.editor().session().history().size() == 1);
                }
        }
    });
}

TEST_CASE("rotating and scaling copy with Shift, and are cancelled", "[ui]") {
    Headless h("demo/demo.pbrt");
    h.select("Chair frame");
    const auto id = h.editor().selection.active();
    const glm::dmat4 start = h.scene().instances[id].object_to_world;
    const std::size_t objects = h.scene().instances.live();
    h.play("stretch", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "gizmo.center");
        h.editor().run("view.gizmo_scale");
        ctx->Yield(3);
        play(ctx, h, {"scale", "gizmo.x"});
        IM_CHECK(h.step() == 1 && h.scene().instances[id].object_to_world != start);
        h.editor().run("edit.undo");
        ctx->Yield(3);
        play(ctx, h, {"scale, cancelled", "gizmo.x", 0, {40, 25}, Drag::End::escape});
        IM_CHECK(h.step() == 0 && h.scene().instances[id].object_to_world == start);
        play(ctx, h, {"scale, a copy", "gizmo.x", ImGuiMod_Shift});
        IM_CHECK(h.step() == 1 && h.scene().instances.live() == objects + 1);
        IM_CHECK(h.scene().instances[id].object_to_world == start);
    });
}

TEST_CASE("a light is dragged like an object", "[ui]") {
    Headless h("demo/demo.pbrt");
    h.play("light", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Scene");
        if (!h.has(ctx, "lights.add_point")) h.click(ctx, "scene.lights");
        h.click(ctx, "lights.add_point");
        const auto id = h.editor().selection.light();
        IM_CHECK(bool(id));
        const glm::dmat4 start = h.scene().lights[id].light_to_world;
        const std::size_t before = h.step(), lights = h.scene().lights.live();
        h.wait_for(ctx, "gizmo.center");
        play(ctx, h, {"a copy", "gizmo.center", ImGuiMod_Shift});
        IM_CHECK(h.scene().lights.live() == lights + 1 && h.step() == before + 1);
        IM_CHECK(h.scene().lights[id].light_to_world == start);
        const auto copy = h.editor().selection.light();
        IM_CHECK(copy && copy != id);
        const glm::dvec3 by = glm::dvec3(h.scene().lights[copy].light_to_world[3] - start[3]);
        IM_CHECK(std::abs(by.z) < 1e-5 && glm::length(by) > 0.02);
        play(ctx, h, {"cancelled", "gizmo.center", ImGuiMod_Shift, {40, 25}, Drag::End::escape});
        IM_CHECK(h.scene().lights.live() == lights + 1 && h.editor().selection.light() == copy);
    });
}
