// SPDX-License-Identifier: Apache-2.0
// Dragged things stop at others if Collide is on; Shift lets them through; off, nothing changes.
#include "headless.hpp"

#include "query/navigation.hpp"
#include "scene/bounds.hpp"
#include "scene/tables.hpp"

#include <glm/gtc/matrix_transform.hpp>

using namespace restage;
using tests::Headless;

namespace {

using InstanceId = scene::Id<scene::Instance>;

// Two crates far above the demo room's floor, beside each other along x, of side 0.4 and 0.3 apart.
struct Crates {
    InstanceId held, other;
    glm::dvec3 place;
};

Crates add_crates(Headless& h) {
    auto data = std::make_shared<scene::MeshData>();
    for (int i = 0; i < 8; ++i)
        data->positions.emplace_back(0.4f * float(i & 1), 0.4f * float(i >> 1 & 1), 0.4f * float(i >> 2));
    data->triangles = {{0, 3, 1}, {0, 2, 3}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                       {2, 7, 3}, {2, 6, 7}, {0, 6, 2}, {0, 4, 6}, {1, 3, 7}, {1, 7, 5}};
    scene::compute_bounds(*data);
    editor::Editor& e = h.editor();
    document::Session& session = e.session_for_changes();
    const auto mesh = session.scene().meshes.next();
    REQUIRE(session.edit(scene::insert(session.scene(), scene::Mesh{.name = "crate", .data = data}, "add")));
    Crates made;
    const scene::Bounds room = scene::world_bounds(session.scene());
    made.place = room.center();
    for (const double x : {0.0, 0.7}) {
        InstanceId& id = x == 0 ? made.held : made.other;
        id = session.scene().instances.next();
        scene::Instance crate{.name = x == 0 ? "held crate" : "other crate",
                              .mesh = mesh,
                              .material = session.scene().materials.next(),
                              .object_to_world = glm::translate(glm::dmat4(1), made.place + glm::dvec3(x, 0, 0))};
        session.scene().materials.each(
            [&](scene::Id<scene::Material> m, const scene::Material&) { crate.material = m; });
        const auto added = session.edit(scene::insert(session.scene(), std::move(crate), "add"));
        REQUIRE(added);
    }
    session.end_gesture();
    return made;
}

glm::dvec3 moved(const Headless& h, const Crates& c) {
    return glm::dvec3(h.scene().instances[c.held].object_to_world[3]) - c.place;
}

} // namespace

TEST_CASE("a crate stops at another one, unless Shift is held or Collide is off", "[ui]") {
    Headless h("demo/demo.pbrt");
    editor::Editor& e = h.editor();
    e.selection.whole_things = false;
    const Crates crates = add_crates(h);
    const std::size_t before = h.step();
    h.select("held crate");
    h.play("collide", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "gizmo.x");
        // Far along the x handle; `keys`: pressed on the way.
        const auto drag = [&](ImGuiKeyChord keys) {
            const ImVec4 r = h.find(ctx, "gizmo.x"), middle = h.find(ctx, "gizmo.center");
            const ImVec2 from((r.x + r.z) / 2, (r.y + r.w) / 2);
            const ImVec2 step((from.x - middle.x) * 0.5f, (from.y - middle.y) * 0.5f);
            ctx->MouseMoveToPos(from);
            ctx->MouseDown();
            for (int i = 1; i <= 8; ++i) {
                if (i == 2 && keys) ctx->KeyDown(keys);
                ctx->MouseMoveToPos({from.x + step.x * float(i), from.y + step.y * float(i)});
            }
            ctx->Yield(2);
        };
        const auto release = [&] {
            ctx->MouseUp();
            ctx->Yield(3);
        };
        drag(0); // off, as it was
        IM_CHECK(!h.has(ctx, "collide.hint"));
        release();
        IM_CHECK(h.step() == before + 1 && moved(h, crates).x > 0.7);
        const double far = moved(h, crates).x;
        e.run("edit.undo");
        ctx->Yield(3);

        h.click(ctx, "view.collide");
        IM_CHECK(e.preferences.collide);
        drag(0);
        IM_CHECK(h.has(ctx, "collide.hint"));
        release();
        IM_CHECK(h.step() == before + 1);
        IM_CHECK(glm::length(moved(h, crates) - glm::dvec3(0.3, 0, 0)) < 1e-5);
        IM_CHECK(!h.has(ctx, "collide.hint"));
        e.run("edit.undo");
        ctx->Yield(3);
        IM_CHECK(moved(h, crates) == glm::dvec3(0) && h.step() == before);

        drag(ImGuiMod_Shift);
        release();
        ctx->KeyUp(ImGuiMod_Shift);
        ctx->Yield(3);
        IM_CHECK(std::abs(moved(h, crates).x - far) < 1e-3);
        e.run("edit.undo");
        ctx->Yield(3);

        ctx->KeyPress(ImGuiMod_Ctrl | ImGuiKey_K);
        ctx->Yield(2);
        IM_CHECK(!e.preferences.collide);
    });
}

TEST_CASE("a crate dragged by the knob slides along another one and comes down on it", "[ui]") {
    Headless h("demo/demo.pbrt");
    editor::Editor& e = h.editor();
    e.selection.whole_things = false;
    e.preferences.collide = true;
    const Crates crates = add_crates(h);
    h.select("held crate");
    const std::size_t before = h.step();
    h.play("slide", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "gizmo.center");
        const auto screen = [&](const glm::dvec3& by) { // of the middle of the crate, moved by that
            const auto at = e.viewport.on_screen(e, crates.place + glm::dvec3(0.2) + by);
            return at.value_or(ImVec2(0, 0));
        };
        const int up = std::abs(e.up().y) > 0.5 ? 1 : 2, across = 3 - up;
        const auto by = [&](double x, double a, double u) {
            glm::dvec3 v(x, 0, 0);
            v[across] = a;
            v[up] = u;
            return v;
        };
        ctx->MouseMoveToPos(screen(by(0, 0, 0)));
        ctx->MouseDown();
        for (int i = 1; i <= 5; ++i)
            ctx->MouseMoveToPos(screen(by(0.1 * i, 0.03 * i, 0)));
        ctx->Yield(2);
        IM_CHECK(glm::length(moved(h, crates) - by(0.3, 0.15, 0)) < 0.02); // the mouse is in whole pixels
        IM_CHECK(std::abs(moved(h, crates).x - 0.3) < 1e-5);
        ctx->KeyDown(ImGuiMod_Alt); // now up, along it
        for (int i = 1; i <= 5; ++i)
            ctx->MouseMoveToPos(screen(by(0.5, 0.15, 0.12 * i)));
        ctx->Yield(2);
        IM_CHECK(std::abs(moved(h, crates).x - 0.3) < 1e-5);
        IM_CHECK(moved(h, crates)[up] > 0.45);
        ctx->KeyUp(ImGuiMod_Alt);
        ctx->Yield(2);
        const ImVec2 now = ImGui::GetIO().MousePos;
        const ImVec2 a = screen(moved(h, crates)), b = screen(moved(h, crates) + by(0.3, 0, 0));
        ctx->MouseMoveToPos({now.x + b.x - a.x, now.y + b.y - a.y});
        ctx->Yield(2);
        IM_CHECK(moved(h, crates).x > 0.4); // above it
        ctx->KeyDown(ImGuiMod_Alt);
        for (int i = 1; i <= 8; ++i) {
            const ImVec2 c = screen(moved(h, crates)), d = screen(moved(h, crates) - by(0, 0, 0.1));
            const ImVec2 mouse = ImGui::GetIO().MousePos;
            ctx->MouseMoveToPos({mouse.x + d.x - c.x, mouse.y + d.y - c.y});
        }
        ctx->Yield(2);
        IM_CHECK(std::abs(moved(h, crates)[up] - 0.4) < 1e-5); // on top of it
        ctx->MouseUp();
        ctx->KeyUp(ImGuiMod_Alt);
        ctx->Yield(3);
        IM_CHECK(h.step() == before + 1);
    });
}
