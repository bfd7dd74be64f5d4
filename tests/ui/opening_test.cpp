// SPDX-License-Identifier: Apache-2.0
// Opening another scene: from the first frame that shows its outliner, nothing of the previous picture is visible.
#include "headless.hpp"

using namespace restage;
using namespace restage::tests;

TEST_CASE("editor: an opened scene never shows the previous one") {
    Headless h("cornell/cornell.pbrt");
    editor::Editor& e = h.editor();
    h.play("open another scene", [&](ImGuiTestContext* ctx) {
        const auto wait = [&](const std::function<bool()>& done) {
            for (int i = 0; i < 20000 && !done(); ++i) {
                ctx->Yield();
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            }
            IM_CHECK_SILENT(done());
        };
        wait([&] { return e.viewport.shown_request() > 0 && !e.viewport.shows_clay(); });
        const auto document = e.document(), request = e.viewport.shown_request();
        e.open(restage::test::source_dir() / "scenes/demo/demo.pbrt");
        wait([&] { return e.document() != document; });
        // This frame and every later one.
        bool old = false;
        wait([&] {
            old |= e.viewport.shown_request() > 0 && e.viewport.shown_request() <= request;
            return e.viewport.shown_request() > request && !e.viewport.shows_clay();
        });
        IM_CHECK(!old);
    });
}
