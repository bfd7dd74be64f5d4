// SPDX-License-Identifier: Apache-2.0
// Shadow catchers in the editor: a floor of one action, and the flag of any object.
#include "headless.hpp"

using namespace restage;
using tests::Headless;

TEST_CASE("a shadow catcher floor is one step, and the inspector's flag another", "[ui]") {
    Headless h("cornell/cornell.pbrt");
    const std::size_t before = h.scene().instances.live();
    h.play("catcher", [&](ImGuiTestContext* ctx) {
        h.editor().run("select.shadow_floor");
        ctx->Yield(3);
        IM_CHECK(h.step() == 1 && h.scene().instances.live() == before + 1);
        const auto floor = h.editor().selection.active();
        const auto catches = [&] { return h.scene().instances[floor].catcher; };
        IM_CHECK(catches());
        const double bottom = glm::dot(scene::world_bounds(h.scene(), floor).center(), h.editor().up());
        h.scene().instances.each([&](auto id, const scene::Instance&) { // all stand on it
            const scene::Bounds box = scene::world_bounds(h.scene(), id);
            const double lowest =
                glm::dot(box.center(), h.editor().up()) - 0.5 * glm::dot(box.size(), glm::abs(h.editor().up()));
            IM_CHECK_SILENT(lowest >= bottom - 1e-9);
        });
        h.focus(ctx, "Inspector");
        h.click(ctx, "inspector.object");
        h.click(ctx, "inspector.catcher");
        IM_CHECK(h.step() == 2 && !catches());
        h.editor().run("edit.undo");
        ctx->Yield(2);
        IM_CHECK(catches());
        h.editor().run("edit.undo");
        ctx->Yield(2);
        IM_CHECK(h.scene().instances.live() == before);
    });
}
