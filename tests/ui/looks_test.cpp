// SPDX-License-Identifier: Apache-2.0
// The panel Looks: recording, going to a look, renaming, reordering, keys; and comparing with a kept picture.
#include "headless.hpp"

#include "document/looks.hpp"

using namespace restage;
using tests::Headless;

namespace {

const document::Looks& looks(Headless& h) { return h.editor().session().looks(); }

std::string names(Headless& h) {
    std::string text;
    for (std::size_t i = 0; i < looks(h).list.size(); ++i)
        text += looks(h).list[i].name + (i == looks(h).current ? "* " : " ");
    return text;
}

void expose(Headless& h, float exposure) {
    scene::Film film = h.scene().film.value;
    film.exposure = exposure;
    REQUIRE(h.editor().session_for_changes().edit(scene::set_film(h.scene(), film)));
}

bool says(const std::string& words, const char* what) { return words.find(what) != std::string::npos; }

} // namespace

TEST_CASE("looks are recorded, gone to and changed in their panel", "[ui]") {
    Headless h("cornell/cornell.pbrt");
    h.play("looks", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Looks");
        IM_CHECK(says(h.words(ctx), "No looks yet"));
        h.click(ctx, "look.new");
        expose(h, 3);
        IM_CHECK(says(h.words(ctx), "Look 1 *")); // it has changed since
        h.click(ctx, "look.new");
        IM_CHECK_STR_EQ(names(h).c_str(), "Look 1 Look 2* ");
        const std::size_t step = h.step();
        h.click(ctx, "look.Look 1");
        IM_CHECK(h.scene().film.value.exposure == 1.f && h.step() == step + 1);
        IM_CHECK_STR_EQ(names(h).c_str(), "Look 1* Look 2 ");
        h.editor().run("edit.undo");
        ctx->Yield(2);
        IM_CHECK(h.scene().film.value.exposure == 3.f);
        IM_CHECK_STR_EQ(names(h).c_str(), "Look 1 Look 2* ");

        ctx->KeyPress(ImGuiKey_F2);
        h.wait_for(ctx, "looks.name");
        ctx->KeyChars("Bright");
        ctx->KeyPress(ImGuiKey_Enter);
        ctx->Yield(3);
        IM_CHECK_STR_EQ(names(h).c_str(), "Look 1 Bright* ");
        ctx->KeyPress(ImGuiKey_RightArrow); // around
        ctx->Yield(3);
        IM_CHECK_STR_EQ(names(h).c_str(), "Look 1* Bright ");
        h.editor().run("look.previous");
        ctx->Yield(3);
        IM_CHECK_STR_EQ(names(h).c_str(), "Look 1 Bright* ");

        const ImVec4 from = h.find(ctx, "look.Bright"), to = h.find(ctx, "look.Look 1");
        ctx->MouseMoveToPos({(from.x + from.z) / 2, from.y + 20});
        ctx->MouseDown();
        ctx->MouseMoveToPos({(to.x + to.z) / 2, to.y + 20});
        ctx->Yield(2);
        ctx->MouseUp();
        ctx->Yield(3);
        IM_CHECK_STR_EQ(names(h).c_str(), "Bright* Look 1 ");

        expose(h, 5);
        h.click(ctx, "looks.update");
        IM_CHECK(looks(h).list[0].state->film.value.exposure == 5.f);
        h.click(ctx, "look.Look 1", 1);
        h.click(ctx, "looks.menu.delete");
        IM_CHECK_STR_EQ(names(h).c_str(), "Bright* ");
        h.click(ctx, "looks.delete");
        IM_CHECK_STR_EQ(names(h).c_str(), "");
    });
}

TEST_CASE("a look remembers the view, and going to it shows it", "[ui]") {
    Headless h("cornell/cornell.pbrt");
    h.play("view", [&](ImGuiTestContext* ctx) {
        glm::dmat4 place = h.editor().camera().camera_to_world;
        place[3].x += 0.25;
        h.editor().look_from(place);
        ctx->Yield(2);
        h.focus(ctx, "Looks");
        h.click(ctx, "look.new");
        IM_CHECK(!says(h.words(ctx), "Look 1 *"));
        h.editor().views.go(std::nullopt);
        ctx->Yield(2);
        IM_CHECK(says(h.words(ctx), "Look 1 *"));
        h.click(ctx, "look.Look 1");
        IM_CHECK(h.editor().camera().camera_to_world == place && !h.editor().views.now());
    });
}

TEST_CASE("the contact sheet has a picture of each look", "[ui]") {
    Headless h("cornell/cornell.pbrt");
    h.play("pictures", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Looks");
        h.click(ctx, "look.new");
        const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(5);
        while (says(h.words(ctx), "rendering ...") && std::chrono::steady_clock::now() < limit)
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        IM_CHECK(!says(h.words(ctx), "rendering ..."));
        h.click(ctx, "looks.delete");
    });
}

TEST_CASE("a kept picture is compared with the live one, and brings its scene back", "[ui]") {
    Headless h("cornell/cornell.pbrt");
    h.play("kept", [&](ImGuiTestContext* ctx) {
        const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(5);
        const auto pictured = [&] { return h.editor().shown_frame() && !h.editor().shown_frame()->clay; };
        while (!pictured() && std::chrono::steady_clock::now() < limit) {
            ctx->Yield();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        IM_CHECK(pictured());
        h.focus(ctx, "Looks");
        h.click(ctx, "look.keep");
        auto& kept = h.editor().panel_state->kept;
        IM_CHECK(kept.list().size() == 1 && !kept.wiping && !h.has(ctx, "wipe"));
        const auto lights = h.scene().lights.live();
        IM_CHECK(h.editor().session_for_changes().edit(scene::insert(h.scene(), scene::Light{.name = "new"}, "Add")));
        expose(h, 4);
        h.click(ctx, "kept.wipe");
        h.wait_for(ctx, "wipe");
        const ImVec4 line = h.find(ctx, "wipe");
        ctx->MouseMoveToPos({(line.x + line.z) / 2, (line.y + line.w) / 2});
        ctx->MouseDown();
        ctx->MouseMoveToPos({h.editor().viewport.corner.x + 0.25f * h.editor().viewport.size.x, line.y + 30});
        ctx->MouseUp();
        ctx->Yield(2);
        IM_CHECK(std::abs(kept.line - 0.25f) < 0.02f);
        IM_CHECK(h.editor().selection.empty()); // the line took the mouse
        const std::size_t step = h.step();
        h.click(ctx, "kept.bring");
        IM_CHECK(h.scene().film.value.exposure == 1.f && h.scene().lights.live() == lights && h.step() == step + 1);
        h.click(ctx, "kept.delete");
        IM_CHECK(kept.list().empty() && !h.has(ctx, "wipe"));
    });
}
