// SPDX-License-Identifier: Apache-2.0
// Ways to see a scene: layers with a note and a way back, the axes, the measure tool; and dragging in the outliner.
#include "headless.hpp"

#include <vector>

using namespace restage;
using tests::Headless;

namespace {

ImVec2 picture_point(const editor::Editor& e, float x, float y) {
    const editor::Viewport& v = e.viewport;
    return {v.corner.x + x * v.size.x, v.corner.y + y * v.size.y};
}

void click_at(ImGuiTestContext* ctx, ImVec2 at) {
    ctx->MouseMoveToPos(at);
    ctx->MouseClick();
    ctx->Yield(2);
}

} // namespace

TEST_CASE("layers are shown by keys, with a note and a way back", "[ui]") {
    Headless h("demo/demo.pbrt");
    editor::Editor& e = h.editor();
    h.play("layers", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Viewport");
        h.wait_for(ctx, "axes.x"); // there is a picture
        IM_CHECK(!h.has(ctx, "layer.back"));
        ctx->KeyPress(ImGuiMod_Alt | ImGuiKey_3);
        ctx->Yield(2);
        IM_CHECK(e.view.display.layer == view::wire_layer);
        h.wait_for(ctx, "layer.back");
        for (int i = 0; i < 20000 && !(e.shown_frame() && e.shown_frame()->look); ++i) {
            ctx->Yield();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        IM_CHECK(e.shown_frame()->look == render::ClayLook::wires);
        IM_CHECK(!h.has(ctx, "progress")); // it is not waiting for a picture
        IM_CHECK(!h.has(ctx, "layer.legend"));
        h.click(ctx, "layer.back");
        IM_CHECK(e.view.display.layer == view::picture_layer);
        ctx->KeyPress(ImGuiMod_Alt | ImGuiKey_8);
        ctx->Yield(2);
        IM_CHECK(e.view.display.layer == view::error_layer);
        h.wait_for(ctx, "layer.legend");
        ctx->KeyPress(ImGuiMod_Alt | ImGuiKey_8); // again: back
        ctx->Yield(2);
        IM_CHECK(e.view.display.layer == view::picture_layer);
        ctx->KeyPress(ImGuiKey_G);
        ctx->Yield(2);
        IM_CHECK(e.view.show_grid);
    });
    CHECK(h.step() == 0);
}

TEST_CASE("a click on the axes looks along one", "[ui]") {
    Headless h("demo/demo.pbrt");
    editor::Editor& e = h.editor();
    h.play("axes", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "axes.y");
        const editor::Marks::Mark at = *e.find_mark("axes.y");
        click_at(ctx, {(at.x0 + at.x1) / 2, (at.y0 + at.y1) / 2});
        const glm::dvec3 forward(e.camera().camera_to_world[2]);
        IM_CHECK(glm::length(glm::normalize(forward) - glm::dvec3(0, -1, 0)) < 1e-9);
        IM_CHECK(e.selection.empty()); // the click selected nothing
    });
    CHECK(h.step() == 0); // only the view
}

TEST_CASE("the measure tool shows a distance until Esc", "[ui]") {
    Headless h("demo/demo.pbrt");
    editor::Editor& e = h.editor();
    h.play("measure", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Viewport");
        h.wait_for(ctx, "axes.x");
        h.select("Floor");
        ctx->KeyPress(ImGuiKey_M);
        ctx->Yield(2);
        IM_CHECK(h.has(ctx, "measure.hint"));
        click_at(ctx, picture_point(e, 0.4f, 0.6f));
        IM_CHECK(e.viewport.measurement.points.size() == 1);
        click_at(ctx, picture_point(e, 0.6f, 0.7f));
        IM_CHECK(e.viewport.measurement.points.size() == 2);
        IM_CHECK(h.has(ctx, "measure.result"));
        IM_CHECK(h.scene().instances[e.selection.active()].name == "Floor"); // clicks select nothing
        click_at(ctx, picture_point(e, 0.5f, 0.5f));
        IM_CHECK(e.viewport.measurement.points.size() == 1); // the next one begins
        ctx->KeyPress(ImGuiKey_Escape);
        ctx->Yield(2);
        IM_CHECK(!e.viewport.measurement.on);
        IM_CHECK(!e.selection.empty()); // Esc ended the tool, and only that
    });
    CHECK(h.step() == 0);
}

TEST_CASE("groups are dragged into groups and out of them", "[ui]") {
    Headless h("demo/demo.pbrt");
    editor::Editor& e = h.editor();
    std::vector<editor::InstanceId> all;
    h.scene().instances.each([&](editor::InstanceId id, const scene::Instance&) { all.push_back(id); });
    REQUIRE(all.size() > 6);
    h.play("drag", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Outliner");
        std::vector<editor::GroupId> groups;
        for (std::size_t i = 0; i < 4; i += 2) { // two groups of two
            const editor::InstanceId ids[] = {all[i], all[i + 1]};
            e.selection.set(ids);
            e.run("edit.group");
            ctx->Yield(2);
            groups.push_back(h.scene().instances[all[i]].group);
        }
        e.panel_state->outliner.search = "Group"; // only rows that are drawn have marks
        ctx->Yield(2);
        const auto drag = [&](const std::string& from, const std::string& to) {
            const ImVec4 a = h.find(ctx, from); // the other row is near it
            ctx->MouseMoveToPos({a.x + 20, (a.y + a.w) / 2});
            ctx->MouseDown();
            ctx->MouseMoveToPos({a.x + 30, (a.y + a.w) / 2 + 4});
            ctx->Yield(3);
            IM_CHECK_SILENT_RETV(e.find_mark(to), std::string("there is no " + to));
            const editor::Marks::Mark b = *e.find_mark(to);
            ctx->MouseMoveToPos({b.x0 + 25, (b.y0 + b.y1) / 2});
            ctx->Yield(2);
            const std::string problem = e.panel_state->outliner.drop_problem;
            ctx->MouseUp();
            ctx->Yield(2);
            return problem;
        };
        const auto row = [&](editor::GroupId id) { return "outliner.group." + h.scene().groups[id].name; };
        const std::size_t before = h.step();
        IM_CHECK_STR_EQ(drag(row(groups[1]), row(groups[0])).c_str(), "");
        IM_CHECK(h.step() == before + 1);
        IM_CHECK(h.scene().groups[groups[1]].parent == groups[0]);
        IM_CHECK(h.scene().instances[all[2]].group == groups[1]); // its objects came along
        IM_CHECK(!drag(row(groups[0]), row(groups[1])).empty()); // refused, and said
        IM_CHECK(h.step() == before + 1);
        IM_CHECK_STR_EQ(drag(row(groups[1]), "outliner.root").c_str(), "");
        IM_CHECK(h.step() == before + 2);
        IM_CHECK(!h.scene().groups[groups[1]].parent);
        e.run("edit.undo");
        ctx->Yield(2);
        IM_CHECK(h.scene().groups[groups[1]].parent == groups[0]);
    });
}
