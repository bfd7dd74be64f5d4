// SPDX-License-Identifier: Apache-2.0
// Light: the mixer, whose faders change the picture without tracing and the scene only when they are applied;
// highlights by pointing; a blurred sky.
#include "headless.hpp"

#include "query/navigation.hpp"
#include "query/raycast.hpp"
#include "scene/sky.hpp"

#include <cmath>

using namespace restage;
using tests::Headless;

namespace {

double mean(const editor::Editor& e) {
    double sum = 0;
    const auto frame = e.shown_frame();
    if (!frame) return 0;
    for (const glm::vec3& c : frame->image.color)
        sum += double(c.y);
    return sum / double(frame->image.pixels());
}

} // namespace

TEST_CASE("the light mixer mixes the lights' pictures, applies them as one step and undoes it", "[ui]") {
    Headless h("demo/demo.pbrt");
    editor::Editor& e = h.editor();
    editor::LightMixing& mixing = e.panel_state->mixing;
    const auto shown = [&](ImGuiTestContext* ctx) {
        const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(5);
        while (!mixing.shown() && std::chrono::steady_clock::now() < limit) {
            ctx->Yield();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        ctx->Yield(3);
        IM_CHECK_RETV(mixing.shown(), void());
    };
    h.play("mix", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Light mixer");
        shown(ctx);
        const auto layers = mixing.layers();
        IM_CHECK(layers.size() >= 2);
        const std::size_t before = h.step();
        const double all = mean(e);
        IM_CHECK(all > 0);
        const std::string first = "mixer." + layers[0].name;
        h.drag(ctx, first + ".stops", -200); // to its lower end
        IM_CHECK(mixing.changed());
        const double dimmed = mean(e);
        IM_CHECK(dimmed < all * 0.999);
        IM_CHECK(h.step() == before); // only the mix
        h.click(ctx, "mixer.reset");
        IM_CHECK(std::abs(mean(e) - all) < 1e-3 * all || !mixing.done());
        h.click(ctx, first + ".mute");
        IM_CHECK(e.panel_state->lights.any());
        ctx->Yield(2);
        IM_CHECK(mean(e) < all * 0.999);
        h.click(ctx, "mixer.all");

        // A spot: the shares of its light, and a click that doubles it.
        h.click(ctx, "mixer.spot");
        const editor::Viewport& v = e.viewport;
        ctx->MouseMoveToPos({v.corner.x + 0.5f * v.size.x, v.corner.y + 0.7f * v.size.y});
        ctx->MouseClick();
        ctx->Yield(3);
        IM_CHECK(mixing.spot.has_value());
        IM_CHECK(mixing.shares().size() == layers.size());
        h.wait_for(ctx, "picture.spot");
        double sum = 0;
        std::size_t most = 0;
        for (std::size_t i = 0; i < layers.size(); ++i) {
            sum += mixing.shares()[i];
            if (mixing.shares()[i] > mixing.shares()[most]) most = i;
        }
        IM_CHECK(std::abs(sum - 1) < 1e-6);
        const double share = mixing.shares()[most];
        h.click(ctx, "mixer." + layers[most].name + ".share");
        IM_CHECK(std::abs(double(mixing.weights[most].x) - (share + 1) / share) < 0.02 * (share + 1) / share);
        h.click(ctx, "mixer.reset");

        mixing.weights[0] = glm::vec3(0.5f);
        ctx->Yield(2);
        h.click(ctx, "mixer.apply");
        ctx->Yield(2);
        IM_CHECK(h.step() == before + 1);
        IM_CHECK(!mixing.changed());
        IM_CHECK(mixing.shown()); // the pictures are those of before: nothing flashes
        IM_CHECK(std::string(e.session().history().undo_label()) == "Mix lights");
        e.run("edit.undo");
        ctx->Yield(2);
        IM_CHECK(h.step() == before);
        shown(ctx); // rendered again
        e.open_panel("Light mixer", false);
        ctx->Yield(3);
        IM_CHECK(!mixing.shown());
    });
}

TEST_CASE("a highlight is placed by pointing", "[ui]") {
    Headless h("demo/demo.pbrt");
    editor::Editor& e = h.editor();
    h.play("highlight", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Viewport");
        h.wait_for(ctx, "axes.x"); // there is a picture
        scene::Light sun{.name = "sun", .kind = scene::LightKind::distant};
        const auto id = h.scene().lights.next();
        IM_CHECK(bool(e.session_for_changes().edit(scene::insert(h.scene(), sun, "Add sun"))));
        e.selection.set_light(id);
        const std::size_t before = h.step();
        e.run("edit.highlight");
        ctx->Yield(2);
        IM_CHECK(e.pick_tool.has_value());
        const editor::Viewport& v = e.viewport;
        ctx->MouseMoveToPos({v.corner.x + 0.5f * v.size.x, v.corner.y + 0.9f * v.size.y}); // the floor
        ctx->MouseClick();
        ctx->Yield(2);
        IM_CHECK(h.step() == before + 1);
        // It comes from where that surface mirrors it into the camera.
        const glm::dvec3 shines = glm::normalize(glm::dvec3(h.scene().lights[id].light_to_world[2]));
        const query::ViewRay ray = query::view_ray(e.camera(), v.film_point(ImGui::GetIO().MousePos), e.film_aspect());
        const auto hits = query::raycast_all(h.scene(), ray.origin, ray.direction);
        IM_CHECK(!hits.empty());
        const glm::dvec3 mirrored = glm::reflect(glm::normalize(ray.direction), hits[0].normal);
        IM_CHECK(glm::length(shines + mirrored) < 1e-6);
        e.run("edit.undo");
        ctx->Yield(2);
        IM_CHECK(h.step() == before);
    });
}

TEST_CASE("the sky's image is blurred from the Scene panel, in one step", "[ui]") {
    Headless h("demo/demo.pbrt");
    editor::Editor& e = h.editor();
    h.play("blur", [&](ImGuiTestContext* ctx) {
        IM_CHECK(bool(e.session_for_changes().edit(scene::studio_sky(h.scene(), e.up()))));
        const std::size_t before = h.step();
        const auto sharp = h.scene().environment.value->image;
        h.focus(ctx, "Scene");
        h.click(ctx, "sky.blur");
        const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(5);
        while (h.step() == before && std::chrono::steady_clock::now() < limit) {
            ctx->Yield();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        IM_CHECK(h.step() == before + 1);
        IM_CHECK(h.scene().environment.value->image != sharp);
        IM_CHECK(h.scene().environment.value->mapping == scene::Mapping::octahedral);
        e.run("edit.undo");
        ctx->Yield(2);
        IM_CHECK(h.scene().environment.value->image == sharp);
    });
}
