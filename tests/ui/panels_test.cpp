// SPDX-License-Identifier: Apache-2.0
// Every panel and every kind of widget: the changes by a drag or a click, that they are one undo step, and that undo
// restores the previous state.
#include "headless.hpp"

#include "editor/panels/panels.hpp"

using namespace restage;
using tests::Headless;

namespace {

// A drag of each of these is one step, and undo reverts it.
void drags_are_steps(Headless& h, ImGuiTestContext* ctx, std::initializer_list<const char*> marks, float pixels = 25) {
    for (const char* mark : marks) {
        const std::size_t before = h.step();
        h.drag(ctx, mark, pixels);
        IM_CHECK_SILENT_RETV(h.step() == before + 1,
                             (ctx->LogError("dragging %s: %zu steps", mark, h.step() - before), void()));
        h.editor().run("edit.undo");
        ctx->Yield(2);
        IM_CHECK_SILENT_RETV(h.step() == before, (ctx->LogError("undo of %s", mark), void()));
    }
}

} // namespace

TEST_CASE("every panel draws, with a scene and with nothing selected", "[ui]") {
    Headless h("demo/demo.pbrt");
    h.play("panels", [&](ImGuiTestContext* ctx) {
        for (const editor::Panel& panel : editor::all_panels()) {
            h.focus(ctx, panel.title);
            const ImGuiWindow* window = ImGui::FindWindowByName(panel.title);
            IM_CHECK_NO_RET(window && window->Active && !window->SkipItems);
        }
        h.editor().run("help.shortcuts"); // was opened above
        ctx->Yield(3);
        IM_CHECK(!h.editor().panel_open("Help"));
    });
}

TEST_CASE("the inspector changes an object and its material", "[ui]") {
    Headless h("spheres/spheres.pbrt");
    editor::InstanceId id;
    h.scene().instances.each([&](editor::InstanceId one, const scene::Instance& i) {
        const scene::Material* m = h.scene().materials.find(i.material);
        if (!id && m && m->name == "Clay") id = one; // without textures
    });
    REQUIRE(id);
    const editor::InstanceId ids[] = {id};
    h.editor().selection.set(ids);
    const auto material = h.scene().instances[id].material;
    h.play("place", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Inspector");
        const glm::dmat4 before = h.scene().instances[id].object_to_world;
        drags_are_steps(h, ctx, {"inspector.position", "inspector.rotation", "inspector.scale"});
        IM_CHECK(h.scene().instances[id].object_to_world == before);
        h.drag(ctx, "inspector.scale"); // locked: all three axes alike
        const glm::dmat3 scaled(h.scene().instances[id].object_to_world), was(before);
        for (int i = 1; i < 3; ++i)
            IM_CHECK(std::abs(glm::length(scaled[i]) / glm::length(was[i]) -
                              glm::length(scaled[0]) / glm::length(was[0])) < 1e-9);
        h.click(ctx, "inspector.as_opened");
        IM_CHECK(h.scene().instances[id].object_to_world == before);
    });
    h.play("name", [&](ImGuiTestContext* ctx) {
        h.click(ctx, "inspector.name");
        ctx->KeyCharsReplaceEnter("renamed");
        ctx->Yield(2);
        IM_CHECK(h.scene().instances[id].name == "renamed");
    });
    h.play("material", [&](ImGuiTestContext* ctx) {
        drags_are_steps(h, ctx, {"material.sigma", "material.reflectance"});
        h.click(ctx, "material.type");
        h.click(ctx, "material.type.coateddiffuse");
        IM_CHECK(h.scene().materials[material].type == "coateddiffuse");
        drags_are_steps(h, ctx, {"material.uroughness"});
        h.drag(ctx, "material.uroughness");
        IM_CHECK(h.scene().materials[material].params.find("uroughness") != nullptr);
        h.click(ctx, "material.uroughness", 1);
        h.click(ctx, "material.uroughness.reset");
        IM_CHECK(h.scene().materials[material].params.find("uroughness") == nullptr);
        h.click(ctx, "material.new");
        const auto fresh = h.scene().instances[id].material;
        IM_CHECK(fresh != material);
        h.click(ctx, "material.copy");
        h.click(ctx, "material.choose");
        h.click(ctx, "material.choose." + h.scene().materials[material].name);
        IM_CHECK(h.scene().instances[id].material == material);
        h.click(ctx, "material.paste");
        IM_CHECK(h.scene().instances[id].material == fresh);
    });
    h.play("light", [&](ImGuiTestContext* ctx) {
        if (!h.has(ctx, "light.emits")) h.click(ctx, "inspector.light");
        h.click(ctx, "light.emits");
        IM_CHECK(h.scene().instances[id].emission.has_value());
        drags_are_steps(h, ctx, {"light.kelvin", "light.strength", "light.power"});
        h.click(ctx, "light.two_sided");
        IM_CHECK(h.scene().instances[id].emission->two_sided);
        h.click(ctx, "light.emits");
        IM_CHECK(!h.scene().instances[id].emission.has_value());
    });
}

TEST_CASE("the scene panel changes sky, camera, picture, lights and rendering", "[ui]") {
    Headless h("demo/demo.pbrt");
    h.play("sky", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Scene");
        drags_are_steps(h, ctx, {"sky.rotation", "sky.strength"});
        h.click(ctx, "sky.kind");
        h.click(ctx, "sky.kind.None");
        IM_CHECK(!h.scene().environment.value.has_value());
        h.click(ctx, "sky.kind");
        h.click(ctx, "sky.kind.Neutral studio");
        IM_CHECK(h.scene().environment.value && h.scene().environment.value->image);
        h.click(ctx, "sky.hidden");
        IM_CHECK(h.scene().environment.value->hidden_from_camera);
        h.editor().run("edit.undo");
        ctx->Yield(2);
        IM_CHECK(!h.scene().environment.value->hidden_from_camera);
    });
    h.play("camera", [&](ImGuiTestContext* ctx) {
        drags_are_steps(h, ctx, {"camera.fov", "camera.focus"});
        h.click(ctx, "camera.dof");
        IM_CHECK(h.editor().camera().lens_radius > 0);
        drags_are_steps(h, ctx, {"camera.fnumber", "camera.lens"});
        h.click(ctx, "camera.pick_focus");
        IM_CHECK(h.editor().pick_tool.has_value());
        ctx->KeyPress(ImGuiKey_Escape);
        ctx->Yield(2);
        IM_CHECK(!h.editor().pick_tool.has_value());
    });
    h.play("picture", [&](ImGuiTestContext* ctx) {
        h.click(ctx, "scene.film");
        h.click(ctx, "film.size");
        h.click(ctx, "film.size.1024x1024");
        IM_CHECK(h.scene().film.value.width == 1024 && h.scene().film.value.height == 1024);
        drags_are_steps(h, ctx, {"film.wh", "film.exposure", "film.filter_radius"});
        h.click(ctx, "scene.film");
    });
    h.play("development", [&](ImGuiTestContext* ctx) {
        h.click(ctx, "scene.development");
        drags_are_steps(h, ctx,
                        {"development.white_balance", "development.tint", "development.vignette", "development.bloom"});
        const auto tone = [&] { return h.scene().film.value.development.tone; };
        h.click(ctx, "development.tone");
        h.click(ctx, "development.tone.agx");
        IM_CHECK(tone() == scene::ToneCurve::agx);
        h.click(ctx, "toolbar.tone"); // shows and sets the same
        h.click(ctx, "toolbar.tone.neutral");
        IM_CHECK(tone() == scene::ToneCurve::neutral);
        h.drag(ctx, "development.vignette");
        h.click(ctx, "development.reset");
        IM_CHECK(h.scene().film.value.development == scene::Development{});
        h.editor().run("edit.undo");
        ctx->Yield(2);
        IM_CHECK(tone() == scene::ToneCurve::neutral && h.scene().film.value.development.vignette > 0);
        h.click(ctx, "scene.development");
    });
    h.play("lights", [&](ImGuiTestContext* ctx) {
        h.click(ctx, "scene.lights");
        const auto lights = h.scene().lights.live();
        const auto objects = h.scene().instances.live();
        for (const char* add : {"lights.add_point", "lights.add_spot", "lights.add_distant", "lights.add_area"})
            h.click(ctx, add);
        IM_CHECK(h.scene().lights.live() == lights + 3);
        IM_CHECK(h.scene().instances.live() == objects + 1);
        h.click(ctx, "lights.Spot light");
        h.focus(ctx, "Inspector");
        drags_are_steps(h, ctx, {"light.strength", "light.position", "light.azimuth", "light.cone"});
        drags_are_steps(h, ctx, {"light.elevation"}, -25); // it emits straight down: the highest elevation
        h.click(ctx, "light.remove");
        IM_CHECK(h.scene().lights.live() == lights + 2);
        h.focus(ctx, "Scene");
        h.click(ctx, "scene.lights");
    });
    h.play("rendering", [&](ImGuiTestContext* ctx) {
        h.click(ctx, "scene.render");
        drags_are_steps(h, ctx, {"render.samples", "render.depth", "render.clamp_direct", "render.clamp_indirect"});
        h.drag(ctx, "render.clamp_direct");
        IM_CHECK(h.scene().settings.value.clamp_direct > 0);
        h.click(ctx, "render.reference");
        IM_CHECK(h.scene().settings.value.clamp_direct == 0 && h.scene().settings.value.clamp_indirect == 0);
        const bool roulette = h.scene().settings.value.russian_roulette;
        h.click(ctx, "render.roulette");
        IM_CHECK(h.scene().settings.value.russian_roulette != roulette);
        IM_CHECK(!h.scene().settings.value.spectral);
        h.click(ctx, "render.spectral");
        IM_CHECK(h.scene().settings.value.spectral);
        h.click(ctx, "render.adaptive");
        IM_CHECK(h.scene().settings.value.adaptive);
        IM_CHECK(h.scene().settings.value.caustics == scene::Technique::off); // by "reference"
        h.click(ctx, "render.caustics");
        h.click(ctx, "render.caustics.on");
        IM_CHECK(h.scene().settings.value.caustics == scene::Technique::on);
        h.click(ctx, "render.guiding");
        h.click(ctx, "render.guiding.off");
        IM_CHECK(h.scene().settings.value.guiding == scene::Technique::off);
        const std::size_t before = h.step(); // settings of this machine are not steps
        h.drag(ctx, "render.error");
        IM_CHECK(h.editor().view.error > 0);
        IM_CHECK(h.step() == before);
    });
    h.play("undo all, redo all", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "History");
        const std::size_t all = h.step();
        h.click(ctx, "history.0");
        IM_CHECK(h.step() == 0);
        IM_CHECK(!h.editor().session().modified());
        h.editor().later([&] {
            while (h.editor().session_for_changes().redo()) {
            }
        });
        ctx->Yield(2);
        IM_CHECK(h.step() == all);
    });
}

TEST_CASE("labels fit at any scale, and panels in any window", "[ui]") {
    for (const float scale : {1.f, 2.f}) {
        Headless h("demo/demo.pbrt", scale, {1600, 1000});
        h.play("layout", [&](ImGuiTestContext* ctx) {
            ctx->Yield(3);
            const auto width = [](const char* panel) { return ImGui::FindWindowByName(panel)->Size.x; };
            IM_CHECK(width("Inspector") >= 290 * scale); // three numbers beside a label
            IM_CHECK(width("Outliner") >= 200 * scale);
            IM_CHECK(width("Viewport") > 0.5f * 1600);
            for (const char* panel : {"Inspector", "Scene"}) {
                h.focus(ctx, panel);
                h.select("Floor");
                ctx->Yield(3);
                const ImGuiWindow* window = ImGui::FindWindowByName(panel);
                IM_CHECK(window->ContentSize.x <= window->Size.x); // nothing exceeds it
            }
        });
    }
}

TEST_CASE("the outliner finds, selects, hides, locks and renames", "[ui]") {
    Headless h("demo/demo.pbrt");
    h.play("outliner", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Outliner");
        const std::size_t rows = h.editor().panel_state->outliner.rows.size();
        h.click(ctx, "outliner.search");
        ctx->KeyCharsReplaceEnter("lemon");
        ctx->Yield(3);
        const auto& found = h.editor().panel_state->outliner.rows;
        IM_CHECK(!found.empty() && found.size() < rows);
        editor::InstanceId id;
        for (const auto& row : found)
            if (!id && row.kind == editor::OutlinerState::Row::Kind::instance) id = {row.id};
        IM_CHECK(bool(id));
        const std::string name = h.scene().instances[id].name;
        h.click(ctx, "outliner." + name);
        IM_CHECK(h.editor().selection.contains(id));
        h.click(ctx, "outliner.eye." + name);
        IM_CHECK(h.scene().instances[id].hidden);
        h.click(ctx, "outliner.eye." + name);
        IM_CHECK(!h.scene().instances[id].hidden);
        h.click(ctx, "outliner.lock." + name);
        IM_CHECK(h.editor().locked.contains(id.value));
        h.double_click(ctx, "outliner." + name);
        ctx->KeyCharsReplaceEnter("lemon of another name");
        ctx->Yield(2);
        IM_CHECK(h.scene().instances[id].name == "lemon of another name");
    });
}

TEST_CASE("log, report, convergence, assets and help work", "[ui]") {
    Headless h("demo/demo.pbrt");
    h.play("log", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Log");
        h.click(ctx, "log.info");
        IM_CHECK(!h.editor().panel_state->log.info);
        IM_CHECK(!h.editor().panel_state->log.details); // developers' lines are hidden by default
        h.click(ctx, "log.details");
        IM_CHECK(h.editor().panel_state->log.details);
        h.click(ctx, "log.copy");
        h.click(ctx, "log.clear");
        IM_CHECK(h.editor().panel_state->log.cleared == h.editor().notices.count());
    });
    h.play("convergence", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Convergence");
        h.click(ctx, "convergence.samples");
        IM_CHECK(h.editor().panel_state->convergence.against_samples);
    });
    h.play("help", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Help");
        h.click(ctx, "help.blender");
        IM_CHECK(h.editor().view.keys == editor::KeyPreset::blender);
        h.click(ctx, "help.standard");
        h.editor().run("select.all");
        h.editor().run("select.none"); // Esc closes floating panels first
        ctx->Yield(2);
        IM_CHECK(!h.editor().panel_open("Help"));
        IM_CHECK(!h.editor().selection.instances().empty());
        h.editor().run("select.none");
        ctx->Yield(2);
        IM_CHECK(h.editor().selection.instances().empty());
    });
    h.play("assets", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Assets");
        h.click(ctx, "assets.search");
        ctx->KeyCharsReplaceEnter("zzz");
        ctx->Yield(2);
        IM_CHECK(h.editor().panel_state->assets.search == "zzz");
    });
}
