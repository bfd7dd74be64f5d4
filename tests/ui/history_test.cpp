// SPDX-License-Identifier: Apache-2.0
// The History panel: its reported size, the saved state after old steps were dropped, and its memory limit.
#include "headless.hpp"

#include "editor/preferences.hpp"
#include "temporary_folder.hpp"

using namespace restage;
using tests::Headless;

namespace {

// This number of steps, each renaming the camera.
void add_steps(Headless& h, int count) {
    auto& session = h.editor().session_for_changes();
    for (int i = 0; i < count; ++i) {
        const auto id = h.scene().active_camera.value;
        scene::Camera camera = h.scene().cameras[id];
        camera.name += "x";
        REQUIRE(session.edit(scene::set_camera(h.scene(), id, camera, "Rename")));
    }
}

bool says(const std::string& words, const char* what) { return words.find(what) != std::string::npos; }

// The row that contains the word "saved"; -1 = none.
int saved_row(Headless& h) {
    const auto* saved = h.editor().find_mark("history.saved");
    for (std::size_t i = 0; saved && i <= h.editor().session().history().size(); ++i)
        if (const auto* row = h.editor().find_mark("history." + std::to_string(i)))
            if (row->y0 <= saved->y0 && saved->y1 <= row->y1) return int(i);
    return -1;
}

} // namespace

TEST_CASE("the history names its oldest state and the saved one, also when steps were dropped", "[ui]") {
    const test::TemporaryFolder folder;
    Headless h("cornell/cornell.pbrt");
    h.play("rows", [&](ImGuiTestContext* ctx) {
        auto& session = h.editor().session_for_changes();
        h.focus(ctx, "History");
        IM_CHECK(says(h.words(ctx), "Opened") && says(h.words(ctx), "0 steps, 0 of"));
        IM_CHECK(saved_row(h) == -1); // nothing was saved
        add_steps(h, 4);
        IM_CHECK(session.save_project((folder.path() / "p.restage").string()));
        add_steps(h, 2);
        std::string words = h.words(ctx);
        IM_CHECK(says(words, "6 steps, 0.0") && !says(words, "dropped"));
        IM_CHECK(saved_row(h) == 4);
        h.click(ctx, "history.4");
        IM_CHECK(h.step() == 4 && !session.modified());
        h.click(ctx, "history.0");
        IM_CHECK(h.step() == 0 && session.modified());
        h.click(ctx, "history.6");
        IM_CHECK(h.step() == 6);

        // Enough for two steps: the saved state is the oldest remaining one.
        session.set_history_budget(session.history().bytes() * 2 / 6 + 1);
        words = h.words(ctx);
        IM_CHECK(session.history().size() == 2 && session.history().dropped() == 4);
        IM_CHECK(says(words, "The oldest remaining state") && !says(words, "Opened"));
        IM_CHECK(says(words, "2 steps, ") && says(words, "4 older steps were dropped"));
        IM_CHECK(saved_row(h) == 0);
        h.click(ctx, "history.0");
        IM_CHECK(h.step() == 0 && !session.modified());
        h.click(ctx, "history.2");

        session.set_history_budget(1); // only the newest: the saved state was dropped
        words = h.words(ctx);
        IM_CHECK(says(words, "5 older steps were dropped") && saved_row(h) == -1);
        h.click(ctx, "history.0");
        IM_CHECK(h.step() == 0 && session.modified());

        h.editor().adopt_scene(scene::Scene(h.scene()));
        words = h.words(ctx);
        IM_CHECK(says(words, "New scene") && !says(words, "dropped") && saved_row(h) == -1);
    });
}

TEST_CASE("the memory limit of the history is entered, applied and stored", "[ui]") {
    const test::TemporaryFolder config;
    constexpr std::size_t mib = 1 << 20;
    {
        Headless h("cornell/cornell.pbrt", 1, {1500, 1000}, config.path());
        const auto budget = [&] { return h.editor().session().history().budget() / mib; };
        CHECK(budget() == 512);
        h.play("limit", [&](ImGuiTestContext* ctx) {
            h.focus(ctx, "History");
            h.double_click(ctx, "history.budget");
            ctx->KeyCharsReplace("64");
            ctx->Yield(2);
            IM_CHECK(budget() == 512); // not after each digit: 6 MiB would drop steps
            ctx->KeyPress(ImGuiKey_Tab);
            ctx->Yield(3);
            IM_CHECK(budget() == 64 && h.editor().preferences.history_mib == 64);
            h.double_click(ctx, "history.budget");
            ctx->KeyCharsReplace("3");
            ctx->KeyPress(ImGuiKey_Escape);
            ctx->Yield(3);
            IM_CHECK(budget() == 64);
            for (const auto& [typed, taken] : {std::pair("3", 16), {"900000", 65536}, {"128", 128}}) {
                h.double_click(ctx, "history.budget");
                ctx->KeyCharsReplaceEnter(typed);
                ctx->Yield(3);
                IM_CHECK(budget() == std::size_t(taken));
            }
            h.editor().adopt_scene(scene::Scene(h.scene()));
            ctx->Yield(2);
            IM_CHECK(budget() == 128); // of the next document, too
        });
    }
    CHECK(editor::read_preferences(config.path()).history_mib == 128);
    Headless again("cornell/cornell.pbrt", 1, {1500, 1000}, config.path());
    CHECK(again.editor().session().history().budget() == 128 * mib);
}
