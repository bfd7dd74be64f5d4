// SPDX-License-Identifier: Apache-2.0
// Ctrl+D continues a row; the panel that aligns, distributes, mirrors, repeats and replaces.
#include "headless.hpp"

#include "editor/actions.hpp"
#include "editor/arrange.hpp"
#include "editor/panels/panels.hpp"
#include "query/aside.hpp"
#include "scene/arrange.hpp"

#include <glm/gtc/matrix_transform.hpp>

using namespace restage;
using tests::Headless;

namespace {

void run(Headless& h, ImGuiTestContext* ctx, const char* action) {
    h.editor().run(action);
    ctx->Yield(3);
}

glm::dvec3 middle(Headless& h, editor::InstanceId id) { return scene::world_bounds(h.scene(), id).center(); }

bool close(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-9; }

void select(Headless& h, std::initializer_list<const char*> names) {
    std::vector<editor::InstanceId> ids;
    for (const char* name : names)
        ids.push_back(h.editor().session().find<scene::Instance>(name));
    h.editor().selection.set(ids);
}

void move_selection(Headless& h, ImGuiTestContext* ctx, const glm::dmat4& by) {
    h.editor().edit([ids = h.editor().selection.instances(), by](const scene::Scene& s) {
        return scene::move_instances(s, ids, by);
    });
    ctx->Yield(3);
}

} // namespace

TEST_CASE("Ctrl+D again continues the row, also with a turn, and a copy is seen", "[ui]") {
    Headless h("demo/demo.pbrt");
    h.select("Vase");
    h.play("rows", [&](ImGuiTestContext* ctx) {
        auto& e = h.editor();
        const auto copy = [&] {
            ctx->KeyPress(ImGuiMod_Ctrl | ImGuiKey_D);
            ctx->Yield(3);
            return e.selection.active();
        };
        const editor::InstanceId vase = e.selection.active();
        const editor::InstanceId a = copy(), b = copy(), c = copy();
        IM_CHECK(h.step() == 3 && a != vase);
        IM_CHECK(query::visible_part(e.camera(), e.film_aspect(), scene::world_bounds(h.scene(), a)) > 0.999);
        const glm::dvec3 step = middle(h, a) - middle(h, vase);
        IM_CHECK(glm::length(step) > 0);
        IM_CHECK(close(middle(h, b) - middle(h, a), step) && close(middle(h, c) - middle(h, b), step));

        // Moved and turned: the next one alike.
        const glm::dmat4 before = h.scene().instances[c].object_to_world;
        const glm::dvec3 at = middle(h, c);
        move_selection(h, ctx,
                       glm::translate(glm::dmat4(1), at + glm::dvec3(0.3, 0, 0)) *
                           glm::rotate(glm::dmat4(1), 0.5, glm::dvec3(0, 0, 1)) * glm::translate(glm::dmat4(1), -at));
        const glm::dmat4 by =
            h.scene().instances[c].object_to_world * glm::inverse(h.scene().instances[b].object_to_world);
        const editor::InstanceId d = copy();
        const glm::dmat4 expected = by * h.scene().instances[c].object_to_world;
        for (int i = 0; i < 4; ++i)
            IM_CHECK(glm::length(h.scene().instances[d].object_to_world[i] - expected[i]) < 1e-9);
        IM_CHECK(h.scene().instances[c].object_to_world != before);

        // Forgotten once something else is selected.
        select(h, {"Chair cushion"});
        ctx->Yield(2);
        const editor::InstanceId ids[] = {d};
        e.selection.set(ids);
        ctx->Yield(2);
        const editor::InstanceId fresh = copy();
        const glm::dmat3 same(h.scene().instances[fresh].object_to_world),
            original(h.scene().instances[d].object_to_world);
        IM_CHECK(same == original); // beside it, not turned
        // And when undo removes the copy.
        run(h, ctx, "edit.undo");
        IM_CHECK(e.selection.empty());
    });
    h.play("a light", [&](ImGuiTestContext* ctx) {
        auto& e = h.editor();
        h.focus(ctx, "Scene");
        if (!h.has(ctx, "lights.add_point")) h.click(ctx, "scene.lights");
        h.click(ctx, "lights.add_point");
        const auto place = [&] { return glm::dvec3(h.scene().lights[e.selection.light()].light_to_world[3]); };
        const glm::dvec3 p0 = place();
        run(h, ctx, "edit.duplicate");
        const glm::dvec3 p1 = place();
        run(h, ctx, "edit.duplicate");
        IM_CHECK(glm::length(p1 - p0) > 0 && close(place() - p1, p1 - p0));
    });
}

TEST_CASE("a copy dragged with Shift is continued by Ctrl+D", "[ui]") {
    Headless h("demo/demo.pbrt");
    h.select("Chair frame");
    h.play("drag", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "gizmo.x");
        const editor::InstanceId chair = h.editor().selection.active();
        const ImVec4 r = h.find(ctx, "gizmo.x");
        ctx->MouseMoveToPos({r.x, r.y});
        ctx->KeyDown(ImGuiMod_Shift);
        ctx->MouseDown();
        for (int i = 1; i <= 4; ++i)
            ctx->MouseMoveToPos({r.x + 12 * float(i), r.y});
        ctx->MouseUp();
        ctx->KeyUp(ImGuiMod_Shift);
        ctx->Yield(3);
        const editor::InstanceId copy = h.editor().selection.active();
        IM_CHECK(copy != chair);
        run(h, ctx, "edit.duplicate");
        IM_CHECK(h.step() == 2);
        const glm::dvec3 step = middle(h, copy) - middle(h, chair);
        IM_CHECK(close(middle(h, h.editor().selection.active()) - middle(h, copy), step));
    });
}

TEST_CASE("an array follows its numbers, and is one step or none", "[ui]") {
    Headless h("demo/demo.pbrt");
    h.select("Vase");
    h.play("array", [&](ImGuiTestContext* ctx) {
        auto& e = h.editor();
        auto& array = e.panel_state->arrange.array;
        const std::size_t objects = h.scene().instances.live();
        ctx->KeyPress(ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_D);
        h.wait_for(ctx, "array.keep");
        IM_CHECK(e.panel_open("Arrange"));
        IM_CHECK(h.step() == 1 && h.scene().instances.live() == objects + 4);
        const std::uint32_t slots = h.scene().instances.size();
        h.drag(ctx, "array.count", 60);
        IM_CHECK(array.count > 5 && h.scene().instances.live() == objects + std::size_t(array.count) - 1);
        h.drag(ctx, "array.step", 30);
        IM_CHECK(h.step() == 1 && e.session().history().size() == 1);
        IM_CHECK(h.scene().instances.size() == slots + std::uint32_t(array.count) - 5); // ids are reused
        ctx->KeyPress(ImGuiKey_Escape);
        ctx->Yield(3);
        IM_CHECK(h.step() == 0 && h.scene().instances.live() == objects && e.selection.instances().size() == 1);
        IM_CHECK(!h.has(ctx, "array.keep"));

        h.click(ctx, "array.kind");
        h.click(ctx, "array.kind.2");
        IM_CHECK(h.step() == 0); // not live: only the setting
        h.click(ctx, "array.make");
        IM_CHECK(h.scene().instances.live() == objects + 8);
        h.click(ctx, "array.kind");
        h.click(ctx, "array.kind.1");
        IM_CHECK(h.step() == 1 && h.scene().instances.live() == objects + std::size_t(array.count) - 1);
        ctx->KeyPress(ImGuiKey_Enter);
        ctx->Yield(3);
        IM_CHECK(h.step() == 1 && e.selection.instances().size() == std::size_t(array.count));
        IM_CHECK(!h.has(ctx, "array.keep"));
        ctx->KeyPress(ImGuiKey_Escape); // clears the selection, and keeps the array
        ctx->Yield(3);
        IM_CHECK(e.selection.empty() && h.step() == 1);
        run(h, ctx, "edit.undo");
        IM_CHECK(h.scene().instances.live() == objects);
    });
    h.play("around the last selected", [&](ImGuiTestContext* ctx) {
        auto& e = h.editor();
        select(h, {"Chair frame", "Chair cushion", "Vase"});
        const editor::InstanceId vase = e.selection.active(), frame = e.selection.instances()[0];
        IM_CHECK(editor::things_of(e).size() == 2); // the parts of a chair, and the vase
        IM_CHECK(editor::things_of(e).back() == scene::Thing{vase});
        h.focus(ctx, "Arrange");
        e.panel_state->arrange.array.count = 4;
        h.click(ctx, "array.suit");
        const std::size_t objects = h.scene().instances.live();
        h.click(ctx, "array.make");
        IM_CHECK(h.scene().instances.live() == objects + 6); // three chairs of two objects
        const auto& copies = e.panel_state->arrange.live->copies;
        const std::vector<editor::InstanceId> chair = {frame, e.selection.instances()[1]};
        const glm::dvec3 first = scene::world_bounds(h.scene(), chair).center() - middle(h, vase);
        const std::vector<editor::InstanceId> opposite = {copies[2], copies[3]};
        const glm::dvec3 second = scene::world_bounds(h.scene(), opposite).center() - middle(h, vase);
        IM_CHECK(std::hypot(first.x + second.x, first.y + second.y) < 1e-9);
        h.click(ctx, "array.cancel");
        IM_CHECK(h.scene().instances.live() == objects && h.step() == 0);
    });
    h.play("kept by going on", [&](ImGuiTestContext* ctx) {
        auto& e = h.editor();
        h.select("Vase");
        h.focus(ctx, "Arrange");
        h.click(ctx, "array.make");
        IM_CHECK(h.step() == 1);
        move_selection(h, ctx, glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 0.1)));
        IM_CHECK(h.step() == 2 && !h.has(ctx, "array.keep"));
        e.panel_state->arrange.array.count = 1000;
        run(h, ctx, "edit.undo");
        run(h, ctx, "edit.undo");
        IM_CHECK(h.step() == 0);
    });
}

TEST_CASE("the panel aligns, distributes, mirrors and replaces", "[ui]") {
    Headless h("demo/demo.pbrt");
    h.play("buttons", [&](ImGuiTestContext* ctx) {
        auto& e = h.editor();
        h.focus(ctx, "Arrange");
        IM_CHECK(!h.has(ctx, "align.x.0")); // nothing is selected
        select(h, {"Chair frame", "Vase"});
        const editor::InstanceId chair = e.selection.instances()[0], vase = e.selection.instances()[1];
        const auto box = [&](editor::InstanceId id) { return scene::world_bounds(h.scene(), id); };
        const glm::dvec3 stays = box(vase).lower;
        h.click(ctx, "align.x.0");
        IM_CHECK(h.step() == 1 && std::abs(box(chair).lower.x - box(vase).lower.x) < 1e-9);
        h.click(ctx, "align.y.1");
        IM_CHECK(h.step() == 2 && std::abs(box(chair).center().y - box(vase).center().y) < 1e-9);
        IM_CHECK(box(vase).lower == stays);
        IM_CHECK(e.session().history().undo_label() == "Align 2 things");
        h.click(ctx, "distribute.x.0"); // needs three
        IM_CHECK(h.step() == 2);

        run(h, ctx, "edit.mirror_x");
        IM_CHECK(h.step() == 3 && glm::determinant(glm::dmat3(h.scene().instances[chair].object_to_world)) != 0);
        run(h, ctx, "edit.undo");
        select(h, {"Vase"});
        h.click(ctx, "mirror.copy");
        h.click(ctx, "mirror.about");
        h.click(ctx, "mirror.about.2");
        const std::size_t objects = h.scene().instances.live();
        h.click(ctx, "mirror.0");
        const editor::InstanceId image = e.selection.active();
        IM_CHECK(image != vase && h.scene().instances.live() == objects + 1);
        IM_CHECK(std::abs(box(image).lower.x - box(vase).upper.x) < 1e-9);
        IM_CHECK(glm::determinant(glm::dmat3(h.scene().instances[image].object_to_world)) *
                     glm::determinant(glm::dmat3(h.scene().instances[vase].object_to_world)) <
                 0);
        run(h, ctx, "edit.undo");

        const scene::Bounds before = box(chair);
        select(h, {"Chair frame", "Vase"});
        h.click(ctx, "edit.replace");
        IM_CHECK(!h.scene().instances.find(chair) && h.scene().instances.find(vase));
        const scene::Bounds now = box(e.selection.active());
        IM_CHECK(e.selection.active() != vase && h.scene().instances.live() == objects);
        IM_CHECK(std::abs(now.lower.z - before.lower.z) < 1e-9);
        IM_CHECK(std::abs(now.center().x - before.center().x) < 1e-9);
        run(h, ctx, "edit.undo");
        IM_CHECK(h.scene().instances.find(chair) != nullptr);
        select(h, {"Vase"});
        run(h, ctx, "edit.copy");
        select(h, {"Chair frame"});
        h.click(ctx, "edit.replace_copied");
        IM_CHECK(!h.scene().instances.find(chair) && h.scene().instances.live() == objects);
    });
}
