// SPDX-License-Identifier: Apache-2.0
// Placing a texture in the picture, and texture coordinates for objects without them.
#include "headless.hpp"

#include "query/navigation.hpp"
#include "scene/box_projection.hpp"
#include "scene/texture_map.hpp"

using namespace restage;
using tests::Headless;

namespace {

ImVec2 middle_of(Headless& h, ImGuiTestContext* ctx, const std::string& mark) {
    const ImVec4 r = h.find(ctx, mark);
    return {(r.x + r.z) / 2, (r.y + r.w) / 2};
}

// From the mark by so many pixels; `keys` are held until the button is released.
void drag(Headless& h, ImGuiTestContext* ctx, const std::string& mark, ImVec2 by, ImGuiKeyChord keys = 0,
          bool release = true) {
    const ImVec2 from = middle_of(h, ctx, mark);
    ctx->MouseMoveToPos(from);
    ctx->MouseDown();
    if (keys) ctx->KeyDown(keys);
    for (int i = 1; i <= 4; ++i)
        ctx->MouseMoveToPos({from.x + by.x * float(i) / 4, from.y + by.y * float(i) / 4});
    ctx->Yield(2);
    if (!release) return;
    ctx->MouseUp();
    ctx->Yield(2);
    if (keys) ctx->KeyUp(keys);
    ctx->Yield(2);
}

struct Tiles {
    Headless h{"spheres/spheres.pbrt"};
    scene::Id<scene::Texture> tiles = h.editor().session().find<scene::Texture>("tiles");
    editor::InstanceId ground = h.editor().session().find<scene::Instance>("Ground");
    scene::TextureMap map() const { return scene::texture_map(h.scene().textures[tiles].params); }
    // Of the ground, which is seen through that point of the window.
    glm::dvec2 uv(ImVec2 at) {
        const auto& e = h.editor();
        const query::ViewRay ray = query::view_ray(e.camera(), e.viewport.film_point(at), e.film_aspect());
        const auto place = query::place_on(h.scene(), ground, ray.origin, ray.direction);
        return query::site_at(h.scene(), *place, 0)->uv;
    }
};

} // namespace

TEST_CASE("a texture is moved, turned and scaled by a frame in the picture", "[ui]") {
    Tiles t;
    Headless& h = t.h;
    editor::Editor& e = h.editor();
    const auto undo = [&](ImGuiTestContext* ctx) {
        e.run("edit.undo");
        ctx->Yield(3);
    };
    h.play("frame", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Viewport");
        h.wait_for(ctx, "axes.x");
        h.select("Ground");
        ctx->KeyPress(ImGuiKey_P);
        h.wait_for(ctx, "placing.middle");
        IM_CHECK(!h.has(ctx, "placing.shared") && !h.has(ctx, "gizmo.center"));
        const scene::TextureMap start = t.map();
        const std::size_t step = h.step();

        const ImVec2 from = middle_of(h, ctx, "placing.middle"), to(from.x + 37, from.y + 12);
        const glm::dvec2 before = start(t.uv(from));
        drag(h, ctx, "placing.middle", {37, 12});
        IM_CHECK(h.step() == step + 1);
        IM_CHECK(e.session().history().undo_label() == "Move texture tiles");
        IM_CHECK(glm::length(t.map()(t.uv(to)) - before) < 1e-2); // what was taken is under the mouse
        IM_CHECK(t.map().linear == start.linear);
        undo(ctx);
        IM_CHECK(t.map() == start);

        drag(h, ctx, "placing.ring", {-20, 25}, ImGuiMod_Shift);
        IM_CHECK(h.step() == step + 1);
        const double turn = std::abs(scene::turn_of(t.map()));
        IM_CHECK(turn > 1 && std::abs(turn / 15 - std::round(turn / 15)) < 1e-3);
        IM_CHECK(std::abs(std::abs(glm::determinant(t.map().linear)) - 900) < 1); // not scaled
        undo(ctx);

        const ImVec2 corner = middle_of(h, ctx, "placing.corner.2"), middle = middle_of(h, ctx, "placing.middle");
        drag(h, ctx, "placing.corner.2", {0.3f * (corner.x - middle.x), 0.3f * (corner.y - middle.y)}, ImGuiMod_Shift);
        IM_CHECK(h.step() == step + 1);
        const double repeats = t.map().linear[0][0];
        IM_CHECK(repeats < 29 && repeats > 10 && std::abs(repeats - std::round(repeats)) < 1e-3);
        undo(ctx);

        drag(h, ctx, "placing.middle", {30, 0}, 0, false);
        IM_CHECK(h.has(ctx, "placing.value"));
        IM_CHECK(t.map() != start);
        ctx->KeyPress(ImGuiKey_Escape);
        ctx->Yield(2);
        ctx->MouseUp();
        ctx->Yield(2);
        IM_CHECK(h.step() == step && t.map() == start);
        IM_CHECK(e.viewport.placing.on); // Esc ended the gesture only
        ctx->KeyPress(ImGuiKey_Escape);
        ctx->Yield(2);
        IM_CHECK(!e.viewport.placing.on && e.selection.contains(t.ground));
        IM_CHECK(h.has(ctx, "gizmo.center"));
    });
}

TEST_CASE("a shared texture says so, and is made the object's own", "[ui]") {
    Tiles t;
    Headless& h = t.h;
    editor::Editor& e = h.editor();
    h.play("own", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Viewport");
        h.wait_for(ctx, "axes.x");
        e.change([&](document::Session& session) {
            auto made = scene::duplicate_instances(session.scene(), std::span(&t.ground, 1), glm::dmat4(1));
            IM_CHECK_SILENT(session.edit(std::move(made->edit)));
        });
        ctx->Yield(2);
        h.select("Ground");
        const auto shared = h.scene().instances[t.ground].material;
        ctx->KeyPress(ImGuiKey_P);
        h.wait_for(ctx, "placing.own");
        const std::size_t step = h.step();
        h.click(ctx, "placing.own");
        IM_CHECK(h.step() == step + 1);
        IM_CHECK(h.scene().instances[t.ground].material != shared);
        IM_CHECK(!h.has(ctx, "placing.shared") && e.viewport.placing.on);
        const scene::TextureMap start = t.map();
        drag(h, ctx, "placing.middle", {30, 5});
        IM_CHECK(h.step() == step + 2);
        IM_CHECK(t.map() == start); // the others' stays
        const auto own = e.viewport.placing.textures[0];
        IM_CHECK(own != t.tiles && scene::texture_map(h.scene().textures[own].params) != start);
        h.click(ctx, "placing.done");
        IM_CHECK(!e.viewport.placing.on);
    });
}

TEST_CASE("the inspector's row of a texture starts placing it, and turns it", "[ui]") {
    Tiles t;
    Headless& h = t.h;
    h.play("row", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "axes.x");
        h.select("Ground");
        h.focus(ctx, "Inspector");
        const std::string of = "material.reflectance.of";
        h.click(ctx, of); // unfolds it
        const std::size_t step = h.step();
        h.drag(ctx, of + ".turn");
        IM_CHECK(h.step() == step + 1);
        IM_CHECK(std::abs(scene::turn_of(t.map())) > 0.1);
        IM_CHECK(std::abs(glm::determinant(t.map().linear) - 900) < 1);
        h.click(ctx, of + ".place");
        h.wait_for(ctx, "placing.middle");
        IM_CHECK(h.editor().viewport.placing.textures[0] == t.tiles);
    });
}

TEST_CASE("an image dropped on a mesh without texture coordinates is projected on it", "[ui]") {
    Headless h("cornell/cornell.pbrt");
    editor::Editor& e = h.editor();
    h.play("drop", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Viewport");
        h.wait_for(ctx, "axes.x");
        const ImVec2 at(e.viewport.corner.x + 0.5f * e.viewport.size.x,
                        e.viewport.corner.y + 0.92f * e.viewport.size.y);
        const query::ViewRay ray = query::view_ray(e.camera(), e.viewport.film_point(at), e.film_aspect());
        editor::InstanceId on;
        h.scene().instances.each([&](editor::InstanceId id, const scene::Instance& i) {
            if (!on && i.name == "Floor") on = id;
        });
        IM_CHECK(on && query::place_on(h.scene(), on, ray.origin, ray.direction));
        const auto mesh_of = [&]() -> const scene::Mesh& { return h.scene().meshes[h.scene().instances[on].mesh]; };
        IM_CHECK(!scene::has_uv(mesh_of()));
        e.drop({restage::test::source_dir() / "scenes/demo/textures/walnut.png"}, at);
        ctx->Yield(2);
        if (h.has(ctx, "scope.alone")) h.click(ctx, "scope.alone");
        const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(2);
        while (h.step() == 0 && std::chrono::steady_clock::now() < limit) {
            ctx->Yield();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        IM_CHECK(h.step() == 1); // texture and coordinates together
        IM_CHECK(scene::has_uv(mesh_of()));

        // Again with another size.
        const editor::InstanceId ids[] = {on};
        e.selection.set(ids);
        const glm::vec2 before = mesh_of().data->uvs[1] - mesh_of().data->uvs[0];
        e.run("edit.project_texture");
        h.wait_for(ctx, "project.do");
        h.click(ctx, "project.size");
        ctx->KeyDown(ImGuiMod_Ctrl);
        h.click(ctx, "project.size");
        ctx->KeyUp(ImGuiMod_Ctrl);
        ctx->KeyCharsReplaceEnter("0.25");
        ctx->Yield(2);
        if (h.has(ctx, "project.do")) h.click(ctx, "project.do");
        IM_CHECK(h.step() == 2);
        const glm::vec2 after = mesh_of().data->uvs[1] - mesh_of().data->uvs[0];
        IM_CHECK(glm::length(after) != glm::length(before));
    });
}
