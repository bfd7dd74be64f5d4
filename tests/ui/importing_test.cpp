// SPDX-License-Identifier: Apache-2.0
// Options of importers in the editor: chosen in the file browser by mouse and keys, kept per format and when
// the file is reread, and changed from the import report.
#include "headless.hpp"

#include "io/options.hpp"
#include "scene/bounds.hpp"
#include "temporary_folder.hpp"

#include <filesystem>
#include <fstream>
#include <functional>

using namespace restage;
using tests::Headless;

namespace {

constexpr const char* obj = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\no a\nf 1 3 2\no b\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

struct Files {
    test::TemporaryFolder folder;
    std::string write(const char* name, const char* bytes = obj) const {
        std::ofstream(folder.path() / name) << bytes;
        return (folder.path() / name).string();
    }
};

std::string text_of(const scene::ParamSet& options) {
    std::string text;
    for (const auto& [id, value] : options.entries())
        text += id + "=" + io::option_text(value) + " ";
    return text;
}

// In the file browser's field; the keyboard is in it.
void type_file(Headless& h, ImGuiTestContext* ctx, const char* action, const std::string& file) {
    h.editor().run(action);
    h.wait_for(ctx, "browser.name");
    ctx->Yield(3);
    ctx->KeyCharsReplace(file.c_str());
    ctx->Yield(2);
}

void opened(Headless& h, ImGuiTestContext* ctx, const std::function<void()>& how) {
    const std::uint64_t before = h.editor().document();
    how();
    h.wait_until(ctx, [&] { return h.editor().document() != before; });
    ctx->Yield(2);
}

} // namespace

TEST_CASE("a file's options are chosen when it is opened or inserted", "[ui]") {
    const Files files;
    const std::string file = files.write("t.obj"), other = files.write("other.obj");
    Headless h("cornell/cornell.pbrt");
    ImGui::GetIO().ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard; // as in the program
    h.play("open", [&](ImGuiTestContext* ctx) {
        type_file(h, ctx, "file.open", files.folder.path().string() + "/room.pbrt");
        IM_CHECK(!h.has(ctx, "browser.options")); // pbrt has none
        ctx->KeyCharsReplace(file.c_str());
        IM_CHECK(h.has(ctx, "browser.options") && !h.has(ctx, "import.obj.units"));
        ctx->KeyPress(ImGuiMod_Alt | ImGuiKey_O); // they unfold, and have the keyboard
        ctx->Yield(4);
        IM_CHECK(h.has(ctx, "import.obj.units") && h.has(ctx, "import.obj.up"));
        ctx->KeyPress(ImGuiKey_Space);
        ctx->Yield(3);
        ctx->KeyPress(ImGuiKey_Escape); // closes the list, and not the browser
        ctx->Yield(3);
        IM_CHECK(h.has(ctx, "import.obj.units"));
        ctx->KeyPress(ImGuiKey_Space);
        ctx->Yield(3);
        ctx->KeyPress(ImGuiKey_DownArrow, 2); // as is, mm, cm
        ctx->KeyPress(ImGuiKey_Enter);
        ctx->Yield(3);
        h.click(ctx, "import.obj.merge");
        opened(h, ctx, [&] { h.click(ctx, "browser.accept"); });
        IM_CHECK((ImGui::GetIO().ConfigFlags & ImGuiConfigFlags_NavEnableKeyboard) == 0); // keys move the view again
        IM_CHECK(h.editor().session().path() == file);
        IM_CHECK_STR_EQ(text_of(h.editor().session().base().options).c_str(), "units=cm merge=true ");
        IM_CHECK(h.scene().instances.live() == 1);
        IM_CHECK(std::abs(scene::world_bounds(h.scene()).size().z - 0.03) < 1e-9);

        // Another file of the format starts with the last ones, and a reread file keeps its own.
        type_file(h, ctx, "file.insert", other);
        h.click(ctx, "import.obj.merge"); // off again
        h.click(ctx, "browser.accept");
        h.wait_until(ctx, [&] { return h.step() == 1; });
        IM_CHECK(h.scene().instances.live() == 3);
        const document::DataSource* source = nullptr;
        h.scene().meshes.each([&](auto, const scene::Mesh& m) {
            if (const auto* found = h.editor().session().sources().find(m.data.get())) source = found;
        });
        IM_CHECK(source != nullptr);
        IM_CHECK_STR_EQ(text_of(source->options).c_str(), "units=cm ");
        h.editor().run("file.revert");
        opened(h, ctx, [&] { h.click(ctx, "revert.revert"); });
        IM_CHECK_STR_EQ(text_of(h.editor().session().base().options).c_str(), "units=cm merge=true ");
    });
}

TEST_CASE("a scene is reread with other options from the import report", "[ui]") {
    const Files files;
    Headless h("cornell/cornell.pbrt");
    h.play("again", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Import report");
        IM_CHECK(!h.has(ctx, "report.import_again")); // pbrt has no options
        type_file(h, ctx, "file.open", files.write("t.obj"));
        opened(h, ctx, [&] { ctx->KeyPress(ImGuiKey_Enter); });
        IM_CHECK(h.scene().instances.live() == 2);
        h.focus(ctx, "Import report");
        IM_CHECK(h.words(ctx).find("Read with the default options") != std::string::npos);
        h.click(ctx, "report.import_again");
        h.wait_for(ctx, "import.again");
        h.click(ctx, "import.obj.merge");
        h.click(ctx, "import.cancel");
        IM_CHECK(h.editor().session().base().options.entries().empty());
        h.click(ctx, "report.import_again");
        h.wait_for(ctx, "import.again");
        h.click(ctx, "import.obj.merge");
        opened(h, ctx, [&] { h.click(ctx, "import.again"); });
        IM_CHECK(h.scene().instances.live() == 1 && !h.editor().session().modified());
        IM_CHECK(h.words(ctx).find("Read with merge=true") != std::string::npos);

        // For a project: its changes are kept, and it counts as modified.
        const std::string project = (files.folder.path() / "p.restage").string();
        IM_CHECK(h.editor().session_for_changes().save_project(project));
        h.click(ctx, "report.import_again");
        h.wait_for(ctx, "import.again");
        h.click(ctx, "import.obj.merge");
        opened(h, ctx, [&] { h.click(ctx, "import.again"); });
        IM_CHECK(h.scene().instances.live() == 2 && h.editor().session().path() == project);
        IM_CHECK(h.editor().session().modified());

        // Unsaved work is asked about.
        h.click(ctx, "report.import_again");
        h.wait_for(ctx, "import.again");
        h.click(ctx, "import.again");
        h.wait_for(ctx, "unsaved.cancel");
        h.click(ctx, "unsaved.cancel");
        ctx->Yield(3);
        IM_CHECK(h.editor().session().modified());
    });
}

TEST_CASE("the name of a scene is not carried over to another file", "[ui]") {
    const Files files;
    const std::string day = files.write("day.gltf"), night = files.write("night.gltf");
    Headless h("cornell/cornell.pbrt");
    h.play("text", [&](ImGuiTestContext* ctx) {
        auto& chosen = h.editor().panel_state->importing.options["gltf"];
        type_file(h, ctx, "file.open", day);
        h.click(ctx, "browser.options");
        h.click(ctx, "import.gltf.scene");
        ctx->KeyCharsReplace("Day");
        ctx->KeyPress(ImGuiKey_Tab);
        ctx->Yield(2);
        chosen.set("units", scene::Value::choice("cm"));
        IM_CHECK_STR_EQ(text_of(chosen).c_str(), "scene=Day units=cm ");
        h.click(ctx, "browser.name");
        ctx->KeyCharsReplace(night.c_str());
        ctx->Yield(3);
        IM_CHECK_STR_EQ(text_of(chosen).c_str(), "units=cm ");
        h.click(ctx, "browser.cancel");
    });
}
