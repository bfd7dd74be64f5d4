// SPDX-License-Identifier: Apache-2.0
// How the picture is shown: false-colour exposure, backdrop, and lights that are muted or soloed in the view only.
#include "headless.hpp"

using namespace restage;
using tests::Headless;

TEST_CASE("the exposure in false colours has a legend, and ends where it began", "[ui]") {
    Headless h("demo/demo.pbrt");
    h.play("exposure", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "picture");
        IM_CHECK(!h.has(ctx, "exposure.legend"));
        const std::size_t before = h.step();
        h.editor().run("view.exposure");
        IM_CHECK(h.has(ctx, "exposure.legend"));
        IM_CHECK(h.editor().view.display.layer == view::exposure_layer);
        IM_CHECK(h.editor().action_state("view.exposure").checked);
        h.editor().run("view.exposure");
        IM_CHECK(!h.has(ctx, "exposure.legend"));
        IM_CHECK(h.editor().view.display.layer == view::picture_layer);
        IM_CHECK(h.step() == before);
    });
}

TEST_CASE("a hidden sky leaves a backdrop", "[ui]") {
    Headless h("demo/demo.pbrt");
    const auto backdrop = [&] { return h.scene().film.value.development.backdrop; };
    h.play("backdrop", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Scene");
        IM_CHECK(!h.has(ctx, "sky.backdrop"));
        h.click(ctx, "sky.hidden");
        h.click(ctx, "sky.backdrop");
        h.click(ctx, "sky.backdrop.color");
        IM_CHECK(backdrop() == scene::Backdrop::color);
        IM_CHECK(h.has(ctx, "sky.backdrop_color"));
        h.click(ctx, "sky.backdrop");
        h.click(ctx, "sky.backdrop.transparent");
        IM_CHECK(backdrop() == scene::Backdrop::transparent);
        h.editor().run("edit.undo");
        ctx->Yield(2);
        IM_CHECK(backdrop() == scene::Backdrop::color);
    });
}

TEST_CASE("muting and soloing lights changes the view, not the document", "[ui]") {
    Headless h("demo/demo.pbrt");
    const view::LightBoard& board = h.editor().panel_state->lights;
    h.play("lights", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Scene");
        h.click(ctx, "scene.lights");
        h.click(ctx, "lights.add_spot");
        const auto spot = h.editor().selection.light();
        IM_CHECK(spot);
        const std::size_t before = h.step();
        h.click(ctx, "lights.mute.sky");
        IM_CHECK(board.muted(view::sky_key) && !board.shines(view::sky_key));
        h.click(ctx, "lights.solo.Spot light");
        IM_CHECK(board.shines(view::key_of(spot)) && !board.shines(view::sky_key));
        h.editor().run("view.solo_light"); // it is selected: no longer
        ctx->Yield(2);
        IM_CHECK(!board.soloed(view::key_of(spot)));
        h.click(ctx, "lights.all");
        IM_CHECK(!board.any() && !h.has(ctx, "lights.all"));
        IM_CHECK(h.step() == before);
        IM_CHECK(!h.scene().lights[spot].hidden);
        h.editor().run("view.solo_light");
        ctx->Yield(2);
        IM_CHECK(board.soloed(view::key_of(spot)));
        h.editor().later([&] { h.editor().adopt_scene(h.scene()); }); // another document begins with all lights
        ctx->Yield(2);
        IM_CHECK(!board.any());
    });
}
