// SPDX-License-Identifier: Apache-2.0
// The tour goes on when its steps are done and can be left; the render region is drawn and closed; a saved scene has a
// picture; a project is packed.
#include "headless.hpp"

#include "document/pack.hpp"
#include "editor/files.hpp"
#include "editor/scene_pictures.hpp"
#include "temporary_folder.hpp"

using namespace restage;
using tests::Headless;

namespace {

void until(ImGuiTestContext* ctx, const std::function<bool()>& done) {
    const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!done() && std::chrono::steady_clock::now() < limit) {
        ctx->Yield();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    IM_CHECK(done());
}

ImVec2 in_picture(Headless& h, float x, float y) {
    const editor::Viewport& v = h.editor().viewport;
    return {v.corner.x + x * v.size.x, v.corner.y + y * v.size.y};
}

} // namespace

TEST_CASE("the tour goes on when a step is done, by Next, and ends by Skip", "[ui]") {
    Headless h("spheres/spheres.pbrt");
    editor::Editor& e = h.editor();
    h.play("tour", [&](ImGuiTestContext* ctx) {
        IM_CHECK(!h.has(ctx, "tour.next"));
        e.tour.start();
        h.wait_for(ctx, "tour.next");
        IM_CHECK_EQ(e.tour.step(), 0u);
        e.selection.set(std::vector<editor::InstanceId>{editor::InstanceId{1}});
        until(ctx, [&] { return e.tour.step() == 1; });
        e.edit([](const scene::Scene& s) {
            const editor::InstanceId ids[] = {editor::InstanceId{1}};
            glm::dmat4 by(1);
            by[3].x = 1;
            return scene::move_instances(s, ids, by);
        });
        until(ctx, [&] { return e.tour.step() == 2; });
        h.click(ctx, "tour.next"); // the material
        IM_CHECK_EQ(e.tour.step(), 3u);
        h.click(ctx, "tour.next"); // the sky
        glm::dmat4 place = e.camera().camera_to_world;
        place[3].x += 1;
        e.look_from(place);
        until(ctx, [&] { return e.tour.step() == 5; });
        h.click(ctx, "tour.next");
        IM_CHECK(!e.tour.running());
        e.tour.start();
        h.click(ctx, "tour.skip");
        IM_CHECK(!e.tour.running());
    });
}

TEST_CASE("a render region is drawn by a drag, and closed by its button, by Esc and by another view", "[ui]") {
    Headless h("spheres/spheres.pbrt");
    editor::Editor& e = h.editor();
    const auto draw = [&](ImGuiTestContext* ctx) {
        e.run("view.region");
        ctx->Yield(2);
        IM_CHECK(e.viewport.region.choosing);
        ctx->MouseMoveToPos(in_picture(h, 0.25f, 0.25f));
        ctx->MouseDown();
        ctx->MouseMoveToPos(in_picture(h, 0.75f, 0.5f));
        ctx->MouseUp();
        ctx->Yield(2);
        IM_CHECK(e.viewport.region.area.has_value());
    };
    h.play("region", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "picture.note");
        draw(ctx);
        const glm::vec4 area = e.viewport.region.area.value_or(glm::vec4(0));
        IM_CHECK(glm::length(area - glm::vec4(0.25f, 0.75f, 0.25f, 0.5f)) < 0.02f);
        IM_CHECK(h.step() == 0); // not an edit
        IM_CHECK(e.selection.empty());
        h.click(ctx, "region.close");
        IM_CHECK(!e.viewport.region.active());
        draw(ctx);
        ctx->KeyPress(ImGuiKey_Escape);
        ctx->Yield(2);
        IM_CHECK(!e.viewport.region.active());
        draw(ctx);
        glm::dmat4 place = e.camera().camera_to_world;
        place[3].x += 1;
        e.look_from(place);
        until(ctx, [&] { return !e.viewport.region.active(); });
        e.run("view.region");
        ctx->Yield(2);
        ctx->MouseMoveToPos(in_picture(h, 0.5f, 0.5f));
        ctx->MouseClick(); // no rectangle
        ctx->Yield(2);
        IM_CHECK(e.viewport.region.choosing && !e.viewport.region.area);
    });
}

TEST_CASE("a saved scene has a small picture, and is packed", "[ui]") {
    const test::TemporaryFolder config;
    Headless h("spheres/spheres.pbrt", 1, {1500, 1000}, config.path());
    editor::Editor& e = h.editor();
    h.play("pictures", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "picture.note"); // a traced picture
        IM_CHECK(e.session_for_changes().save_project(config / "saved.restage").has_value());
        e.view.denoise = false;
        editor::keep_scene_picture(e);
        std::size_t kept = 0;
        for (const auto& file : std::filesystem::directory_iterator(config / "scene pictures"))
            kept += file.path().extension() == ".png";
        IM_CHECK_EQ(kept, 1u);
        bool shown = false;
        e.show_modal("Picture", [&](editor::PanelContext& context) {
            editor::draw_scene_picture(context, config / "saved.restage", 64, "kept");
            editor::draw_scene_picture(context, config / "none.restage", 64, "none");
            return !shown;
        });
        until(ctx, [&] { return e.find_mark("kept") != nullptr; });
        IM_CHECK(e.find_mark("none.icon") != nullptr);
        shown = true;
        ctx->Yield(3);
    });
    h.play("pack", [&](ImGuiTestContext* ctx) {
        e.run("file.pack");
        h.find(ctx, "browser.name");
        ctx->KeyCharsReplaceEnter((config / "packed.zip").string().c_str());
        until(ctx, [&] { return std::filesystem::exists(config / "packed.zip") && !e.files().jobs.running(); });
    });
    CHECK(document::unpack_project(config / "packed.zip"));
}
