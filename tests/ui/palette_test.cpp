// SPDX-License-Identifier: Apache-2.0
// The command palette by keys and mouse: it finds, chooses and remembers.
#include "headless.hpp"

using namespace restage;
using tests::Headless;

TEST_CASE("the palette finds actions, panels and things of the scene", "[ui]") {
    Headless h("demo/demo.pbrt");
    editor::Editor& e = h.editor();
    const auto open = [&](ImGuiTestContext* ctx) {
        ctx->KeyPress(ImGuiMod_Ctrl | ImGuiKey_P);
        ctx->Yield(2);
    };
    const auto shown = [&](ImGuiTestContext* ctx) { return h.has(ctx, "palette.query"); };
    const auto type = [&](ImGuiTestContext* ctx, const char* text) {
        ctx->KeyChars(text);
        ctx->Yield(2);
    };
    h.play("an action", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Viewport");
        open(ctx);
        IM_CHECK(shown(ctx));
        type(ctx, "sel all");
        ctx->KeyPress(ImGuiKey_Enter);
        IM_CHECK(!shown(ctx));
        IM_CHECK(e.selection.instances().size() > 5);
        open(ctx);
        type(ctx, "none");
        ctx->KeyPress(ImGuiKey_Enter);
        ctx->Yield(2);
        IM_CHECK(e.selection.empty());
    });
    h.play("what is not possible stays", [&](ImGuiTestContext* ctx) {
        open(ctx);
        type(ctx, "Ungroup");
        IM_CHECK(!e.action_state("edit.ungroup").enabled);
        ctx->KeyPress(ImGuiKey_Enter);
        IM_CHECK(shown(ctx));
        ctx->KeyPress(ImGuiKey_Escape);
        ctx->Yield(2);
        IM_CHECK(!shown(ctx));
    });
    h.play("an object, by arrow keys, and in the inspector", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Scene");
        open(ctx);
        type(ctx, "chair");
        const auto& p = e.panel_state->palette;
        IM_CHECK(p.found.size() > 1);
        IM_CHECK(p.cursor == 0);
        ctx->KeyPress(ImGuiKey_DownArrow, 2);
        ctx->KeyPress(ImGuiKey_UpArrow);
        IM_CHECK(p.cursor == 1);
        while (p.items[p.found[std::size_t(p.cursor)]].kind != editor::PaletteItem::Kind::object)
            ctx->KeyPress(ImGuiKey_DownArrow);
        const std::string name(p.names.name(p.found[std::size_t(p.cursor)]));
        ctx->KeyPress(ImGuiMod_Ctrl | ImGuiKey_Enter);
        ctx->Yield(3);
        IM_CHECK(!shown(ctx));
        IM_CHECK(h.scene().instances[e.selection.active()].name == name);
        IM_CHECK_STR_EQ(ctx->UiContext->NavWindow->RootWindow->Name, "Inspector");
        open(ctx); // what was used is first
        type(ctx, "chair");
        IM_CHECK(p.names.name(p.found[0]) == name);
        ctx->KeyPress(ImGuiKey_Escape);
    });
    h.play("a panel, by a click", [&](ImGuiTestContext* ctx) {
        open(ctx);
        type(ctx, "statist");
        h.click(ctx, "palette.Panel.Statistics");
        IM_CHECK(!shown(ctx));
        IM_CHECK(e.panel_open("Statistics"));
        IM_CHECK(h.has(ctx, "statistics.Triangles"));
    });
    h.play("a material selects its users, framed", [&](ImGuiTestContext* ctx) {
        scene::Id<scene::Material> used = h.scene().instances[e.selection.active()].material;
        e.selection.clear();
        open(ctx);
        type(ctx, h.scene().materials[used].name.c_str());
        const std::size_t views = e.views.version();
        const auto& p = e.panel_state->palette;
        while (p.items[p.found[std::size_t(p.cursor)]].kind != editor::PaletteItem::Kind::material)
            ctx->KeyPress(ImGuiKey_DownArrow);
        ctx->KeyPress(ImGuiMod_Shift | ImGuiKey_Enter);
        ctx->Yield(3);
        IM_CHECK(!e.selection.empty());
        for (const auto id : e.selection.instances())
            IM_CHECK(h.scene().instances[id].material == used);
        IM_CHECK(e.views.version() != views);
    });
    CHECK(h.step() == 0); // none of this changes the document
}
