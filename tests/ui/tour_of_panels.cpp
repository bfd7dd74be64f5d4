// SPDX-License-Identifier: Apache-2.0
#include "tour_of_panels.hpp"

#include "editor/panels/panels.hpp"

namespace restage::tests {

namespace {

struct Tour {
    Headless& h;
    ImGuiTestContext* ctx;
    const Look& look;

    // Dialogs settle in their first five frames.
    void settle() const { ctx->Yield(8); }
    void home() const {
        if (ImGui::GetCurrentContext()->OpenPopupStack.Size > 0) ImGui::ClosePopupToLevel(0, true);
        settle();
        IM_CHECK(ImGui::GetCurrentContext()->OpenPopupStack.Size == 0);
        ctx->MouseMoveToPos({ImGui::GetIO().DisplaySize.x - 3, 3});
    }
    // A panel as it is, or with this section of it open.
    void panel(const char* name, const char* state = nullptr, const char* section = nullptr) const {
        h.focus(ctx, name);
        if (section) h.click(ctx, section);
        settle();
        look(ctx, state ? state : name, name);
        if (section) h.click(ctx, section);
    }
    void dialog(const char* action) const {
        h.editor().run(action);
        for (int i = 0; i < 600 && ImGui::GetCurrentContext()->OpenPopupStack.Size == 0; ++i)
            ctx->Yield(); // some look at files first
        IM_CHECK(ImGui::GetCurrentContext()->OpenPopupStack.Size > 0);
        settle();
        look(ctx, action, "");
        home();
    }
    // What a click on this opens.
    void popup(const char* panel, const char* mark, int button = 0) const {
        h.focus(ctx, panel);
        h.click(ctx, mark, button);
        settle();
        look(ctx, mark, "");
        home();
    }
};

void panels(const Tour& t) {
    for (const editor::Panel& panel : editor::all_panels())
        t.panel(panel.title);
    t.h.editor().run("select.none"); // closes those that float
    t.settle();
    t.h.focus(t.ctx, "Scene");
    for (const char* section : {"scene.sky", "scene.camera"}) // the others have the panel to themselves
        t.h.click(t.ctx, section);
    for (const char* section :
         {"scene.sky", "scene.camera", "scene.film", "scene.development", "scene.lights", "scene.render"})
        t.panel("Scene", section, section);
    for (const char* mark : {"materials.category"})
        t.popup("Materials", mark);
}

void inspector(const Tour& t) {
    t.h.select("Floor");
    t.panel("Inspector", "inspector");
    for (const char* section : {"inspector.light", "inspector.object"})
        t.panel("Inspector", section, section);
    t.panel("Arrange", "arrange");
    for (const char* mark : {"material.type", "material.choose", "material.reflectance.texture"}) {
        t.h.select("Floor");
        t.popup("Inspector", mark);
    }
    t.h.click(t.ctx, "outliner.search");
    t.ctx->KeyCharsReplaceEnter("floor");
    t.popup("Outliner", "outliner.Floor", 1);
    t.h.editor().run("select.all");
    t.panel("Inspector", "inspector of several");
    t.h.editor().run("edit.place_texture");
    t.settle();
    t.h.focus(t.ctx, "Viewport");
    t.look(t.ctx, "viewport", "Viewport");
    const auto& lights = t.h.scene().lights;
    lights.each([&](auto id, const scene::Light&) { t.h.editor().selection.set_light(id); });
    t.panel("Inspector", "light");
    t.h.editor().run("select.none");
}

void menus(const Tour& t) {
    for (const char* menu : {"menu.file", "menu.edit", "menu.select", "menu.look", "menu.view", "menu.show",
                             "menu.help", "menu.tools", "menu.panels"})
        t.popup("Viewport", menu);
    for (const char* mark : {"toolbar.steps", "toolbar.snap"})
        t.popup("Viewport", mark);
}

void dialogs(const Tour& t) {
    for (const char* action :
         {"file.open", "file.save_as", "file.export", "file.save_image", "file.final", "file.pack", "edit.find"})
        t.dialog(action);
    t.h.select("Floor");
    t.h.editor().run("select.hide"); // a change, to ask about
    t.settle();
    for (const char* action : {"file.quit", "file.revert", "edit.project_texture"})
        t.dialog(action);
    t.h.editor().run("look.new");
    t.panel("Looks", "looks");
}

} // namespace

void tour_of_panels(Headless& h, const Look& look) {
    for (const auto part : {panels, inspector, menus, dialogs})
        h.play("tour of panels", [&, part](ImGuiTestContext* ctx) { part({h, ctx, look}); });
}

} // namespace restage::tests
