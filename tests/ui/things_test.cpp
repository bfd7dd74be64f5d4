// SPDX-License-Identifier: Apache-2.0
// A click takes the whole thing, a double click goes into it; copies stay whole.
#include "headless.hpp"
#include "temporary_folder.hpp"

#include <imgui_te_internal.h>
#include <algorithm>
#include <chrono>
#include <fstream>
#include <optional>
#include <set>
#include <vector>

using namespace restage;
using tests::Headless;

namespace {

std::set<std::string> selected(Headless& h) {
    std::set<std::string> names;
    for (const auto id : h.editor().selection.instances())
        names.insert(h.scene().instances[id].name);
    return names;
}

// A table of five objects and a box on it, over a floor; nothing is grouped.
std::string table() {
    std::string text =
        "LookAt 0 -3 2  0 0 0.4  0 0 1\nCamera \"perspective\" \"float fov\" 45\n"
        "Film \"rgb\" \"integer xresolution\" 640 \"integer yresolution\" 360\nWorldBegin\n"
        "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\nMaterial \"diffuse\"\n";
    const auto box = [&](const char* name, double x, double y, double z, double a, double b, double c) {
        text += "# " + std::string(name) + "\nAttributeBegin\nTranslate " + std::to_string(x) + " " +
                std::to_string(y) + " " + std::to_string(z) + "\nScale " + std::to_string(a) + " " + std::to_string(b) +
                " " + std::to_string(c) +
                "\nShape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1 ] "
                "\"integer indices\" [ 0 1 3 0 3 2 4 5 7 4 7 6 0 1 5 0 5 4 2 3 7 2 7 6 0 2 6 0 6 4 1 3 7 1 7 5 ]\n"
                "AttributeEnd\n";
    };
    box("Floor", -4, -4, -0.1, 8, 8, 0.1);
    box("Top", -0.6, -0.4, 0.7, 1.2, 0.8, 0.05);
    for (int i = 0; i < 4; ++i)
        box(i ? "Leg" : "First leg", i & 1 ? 0.55 : -0.6, i & 2 ? 0.35 : -0.4, 0, 0.05, 0.05, 0.7);
    box("Box", -0.1, -0.1, 0.75, 0.25, 0.2, 0.2);
    return text;
}

} // namespace

TEST_CASE("a click takes all of a thing, a double click a part of it, and its copies are things", "[ui]") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path() / "table.pbrt") << table();
    Headless h((folder.path() / "table.pbrt").string());
    editor::Editor& e = h.editor();
    e.view.resolution = 0.3f; // enough for a click
    const auto parts = [&](std::size_t n) { return h.editor().selection.instances().size() == n; };
    const auto id = e.session().find<scene::Instance>("Top");
    // Where the picture shows it: the middle one of its pixels; none if it does not.
    const auto screen = [&](const char* name) -> std::optional<ImVec2> {
        const auto frame = e.shown_frame();
        const auto* picture = e.find_mark("picture");
        if (!frame || !picture) return std::nullopt;
        const auto wanted = e.session().find<scene::Instance>(name).value;
        std::vector<std::size_t> pixels;
        for (std::size_t i = 0; i < frame->image.instance_id.size(); ++i)
            if (frame->image.instance_id[i] == wanted) pixels.push_back(i);
        if (pixels.empty()) return std::nullopt;
        const std::size_t i = pixels[pixels.size() / 2], width = frame->image.width;
        return ImVec2(
            picture->x0 + (picture->x1 - picture->x0) * (float(i % width) + 0.5f) / float(width),
            picture->y0 + (picture->y1 - picture->y0) * (float(i / width) + 0.5f) / float(frame->image.height));
    };
    h.play("things", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "picture");
        const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(5);
        while ((e.selection.things.number(id) == 0 || !screen("Top") || !screen("Box")) &&
               std::chrono::steady_clock::now() < limit)
            ctx->Yield();
        const auto click = [&](bool twice) {
            ctx->MouseMoveToPos(*screen("Top"));
            if (twice)
                ctx->MouseDoubleClick();
            else
                ctx->MouseClick();
            ctx->Yield(3);
        };
        click(false);
        IM_CHECK(parts(5) && !selected(h).contains("Box"));
        IM_CHECK(e.selection.active() == id);
        IM_CHECK(editor::selection_note(e) == "Top: 5 parts as one; a double click goes into it");
        ctx->MouseMoveToPos(*screen("Box"));
        ctx->MouseClick(); // elsewhere, so that the next is not the object behind
        ctx->Yield(3);
        IM_CHECK(selected(h) == std::set<std::string>{"Box"});
        // A second press soon after a click drags all of it.
        click(false);
        const ImVec2 from = *screen("Top");
        const auto before = h.scene().instances[id].object_to_world;
        ctx->Inputs->MouseButtonsValue = 1; // MouseDown() prevents double clicks
        ctx->Yield(2);
        IM_CHECK(ctx->UiContext->IO.MouseClickedLastCount[0] == 2);
        ctx->MouseMoveToPos({from.x + 40, from.y});
        ctx->MouseUp();
        ctx->Yield(3);
        IM_CHECK(parts(5) && h.scene().instances[id].object_to_world != before);
        e.run("edit.undo");
        e.run("select.none");
        ctx->Yield(3);

        click(true);
        IM_CHECK(selected(h) == std::set<std::string>{"Top"});
        IM_CHECK(bool(e.selection.entered()));
        e.run("select.none");
        ctx->Yield(3);
        IM_CHECK(!e.selection.entered());

        e.run("select.whole_things"); // off
        ctx->Yield(3);
        click(false);
        IM_CHECK(selected(h) == std::set<std::string>{"Top"});
        e.run("select.whole_things");
        ctx->Yield(3);

        e.selection.set(e.selection.click_target(h.scene(), id));
        e.run("edit.duplicate");
        ctx->Yield(3);
        const auto copies = e.selection.instances();
        IM_CHECK(copies.size() == 5);
        auto taken = e.selection.click_target(h.scene(), copies[0]);
        std::sort(taken.begin(), taken.end());
        auto sorted = copies;
        std::sort(sorted.begin(), sorted.end());
        IM_CHECK(taken == sorted);
        // Things among objects from elsewhere are found, too.
        const std::size_t known = e.selection.things.of.size();
        e.insert(restage::test::source_dir() / "scenes/spheres/spheres.pbrt");
        while (e.selection.things.of.size() == known && std::chrono::steady_clock::now() < limit)
            ctx->Yield();
        IM_CHECK(e.selection.things.of.size() == h.scene().instances.size() + 1);

        // A copy that is made before the things are found hides none of them.
        e.panel_state->things.stop();
        e.selection.things = {};
        ctx->Yield(); // they are looked for
        IM_CHECK(e.panel_state->things.running());
        const std::vector originals{id};
        const std::vector<editor::InstanceId> copied{{h.scene().instances.size()}};
        e.selection.things.copied(originals, copied);
        while (e.panel_state->things.running() && std::chrono::steady_clock::now() < limit)
            ctx->Yield();
        IM_CHECK(e.selection.things.number(id) != 0);
    });
}
