// SPDX-License-Identifier: Apache-2.0
// Linked files in the editor: linked by the file browser, selected as a whole, read again when they change.
#include "headless.hpp"

#include "scene/links.hpp"
#include "temporary_folder.hpp"

#include <filesystem>
#include <fstream>
#include <functional>

using namespace restage;
using tests::Headless;

namespace {

constexpr const char* two = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\no left\nf 1 3 2\no right\nf 1 2 4\nf 2 3 4\n";
constexpr const char* three = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\no left\nf 1 3 2\no right\nf 1 2 4\no top\nf 2 3 4\n";

} // namespace

TEST_CASE("a linked file is one thing, follows its file, and is made editable", "[ui][links]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "pair.obj";
    std::ofstream(file) << two;
    Headless h("cornell/cornell.pbrt");
    const std::size_t before = h.scene().instances.live();
    h.play("link", [&](ImGuiTestContext* ctx) {
        h.editor().run("file.link");
        h.wait_for(ctx, "browser.name");
        ctx->Yield(3);
        ctx->KeyCharsReplace(file.string().c_str());
        ctx->Yield(2);
        h.click(ctx, "browser.accept");
        h.wait_until(ctx, [&] { return h.step() == 1; });
        IM_CHECK(h.scene().instances.live() == before + 2);
        IM_CHECK(scene::all_links(h.scene()).size() == 1);
        h.focus(ctx, "Outliner");
        IM_CHECK(h.has(ctx, "outliner.linked.pair"));

        // One of its objects brings the other.
        h.select("left");
        ctx->Yield(2);
        IM_CHECK(h.editor().selection.instances().size() == 2);
        IM_CHECK(h.editor().selection.active() == h.editor().session().find<scene::Instance>("left"));

        std::ofstream(file) << three;
        std::filesystem::last_write_time(file, std::filesystem::last_write_time(file) + std::chrono::seconds(5));
        h.wait_until(ctx, [&] { return h.scene().instances.live() == before + 3; });
        IM_CHECK(h.step() == 2);

        IM_CHECK(h.editor().action_state("edit.make_editable").enabled);
        h.editor().run("edit.make_editable");
        h.wait_until(ctx, [&] { return h.step() == 3; });
        IM_CHECK(!h.has(ctx, "outliner.linked.pair"));
        IM_CHECK(!h.editor().action_state("file.reload_links").enabled);
        h.select("left");
        ctx->Yield(2);
        IM_CHECK(h.editor().selection.instances().size() == 1);
    });
}
