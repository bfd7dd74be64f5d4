// SPDX-License-Identifier: Apache-2.0
// Editing lights, the clipboard, the outliner's keys, the target of a dropped image, fonts, layout.
#include "headless.hpp"

#include "editor/actions.hpp"
#include "editor/fonts.hpp"
#include "editor/panels/panels.hpp"
#include "temporary_folder.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <span>

using namespace restage;
using tests::Headless;

namespace {

using LightId = scene::Id<scene::Light>;

LightId add_light(Headless& h, ImGuiTestContext* ctx, const char* button) {
    h.focus(ctx, "Scene");
    if (!h.has(ctx, button)) h.click(ctx, "scene.lights");
    h.click(ctx, button);
    return h.editor().selection.light();
}

void run(Headless& h, ImGuiTestContext* ctx, const char* action) {
    h.editor().run(action);
    ctx->Yield(3);
}

// Waits for work on a thread, however long it takes on a busy machine.
void wait_until(ImGuiTestContext* ctx, const std::function<bool()>& there) {
    const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!there() && std::chrono::steady_clock::now() < limit) {
        ctx->Yield();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

// An OpenType file with only a character map: one segment (format 4), or one group (format 12).
std::string font_of(char32_t first, char32_t last, bool groups) {
    std::string out;
    const auto put = [&](std::uint32_t n, int bytes) {
        for (int i = bytes - 1; i >= 0; --i)
            out += char(n >> (8 * i));
    };
    put(0x00010000, 4), put(1, 2), put(0, 2), put(0, 2), put(0, 2);
    out += "cmap";
    put(0, 4), put(28, 4), put(100, 4);
    put(0, 2), put(1, 2), put(3, 2), put(groups ? 10 : 1, 2), put(12, 4); // cmap: one table, 12 behind its start
    if (groups) {
        put(12, 2), put(0, 2), put(28, 4), put(0, 4), put(1, 4), put(first, 4), put(last, 4), put(1, 4);
    } else {
        put(4, 2), put(32, 2), put(0, 2), put(4, 2), put(0, 2), put(0, 2), put(0, 2); // two segments
        put(last, 2), put(0xffff, 2), put(0, 2), put(first, 2), put(0xffff, 2), put(1, 2), put(1, 2), put(0, 2),
            put(0, 2);
    }
    return out;
}

} // namespace

TEST_CASE("a light is duplicated, switched off and on, and removed", "[ui]") {
    Headless h("demo/demo.pbrt");
    h.play("light", [&](ImGuiTestContext* ctx) {
        const std::size_t lights = h.scene().lights.live();
        const LightId id = add_light(h, ctx, "lights.add_point");
        IM_CHECK(bool(id));
        run(h, ctx, "edit.duplicate");
        const LightId copy = h.editor().selection.light();
        IM_CHECK(copy && copy != id && h.scene().lights.live() == lights + 2);
        IM_CHECK(h.scene().lights[copy].name == "Point light 2");
        IM_CHECK(h.scene().lights[copy].light_to_world != h.scene().lights[id].light_to_world); // beside it
        const std::size_t before = h.step();
        run(h, ctx, "select.hide");
        IM_CHECK(h.scene().lights[copy].hidden && !h.scene().lights[id].hidden && h.step() == before + 1);
        IM_CHECK(h.editor().session().history().undo_label() == "Hide Point light 2");
        h.focus(ctx, "Outliner");
        h.click(ctx, "outliner.search");
        ctx->KeyCharsReplaceEnter("point light");
        h.click(ctx, "outliner.eye.light.Point light");
        IM_CHECK(h.scene().lights[id].hidden);
        h.click(ctx, "outliner.eye.light.Point light");
        IM_CHECK(!h.scene().lights[id].hidden);
        run(h, ctx, "select.show_all");
        IM_CHECK(!h.scene().lights[copy].hidden);
        h.editor().selection.set_light(copy);
        run(h, ctx, "edit.delete");
        IM_CHECK(h.scene().lights.live() == lights + 1);
    });
}

TEST_CASE("the handle of a spot's cone changes its angle, as one step", "[ui]") {
    Headless h("demo/demo.pbrt");
    h.play("cone", [&](ImGuiTestContext* ctx) {
        const LightId id = add_light(h, ctx, "lights.add_spot");
        IM_CHECK(bool(id));
        h.wait_for(ctx, "light.cone_handle");
        const float angle = h.scene().lights[id].cone_angle;
        const std::size_t before = h.step();
        const auto drag = [&](float by, bool cancel) {
            const ImVec4 r = h.find(ctx, "light.cone_handle");
            const ImVec2 from((r.x + r.z) / 2, (r.y + r.w) / 2);
            ctx->MouseMoveToPos(from);
            ctx->MouseDown();
            for (int i = 1; i <= 4; ++i)
                ctx->MouseMoveToPos({from.x + by * float(i) / 4, from.y});
            if (cancel) ctx->KeyPress(ImGuiKey_Escape);
            ctx->MouseUp();
            ctx->Yield(3);
        };
        drag(40, false);
        IM_CHECK(h.scene().lights[id].cone_angle > angle + 1 && h.step() == before + 1);
        run(h, ctx, "edit.undo");
        IM_CHECK(h.scene().lights[id].cone_angle == angle);
        drag(-20, true);
        IM_CHECK(h.scene().lights[id].cone_angle == angle && h.step() == before);
    });
}

TEST_CASE("objects and lights are copied within a window and into another one", "[ui]") {
    std::string held;
    {
        Headless h("demo/demo.pbrt");
        h.select("Chair frame");
        h.play("copy", [&](ImGuiTestContext* ctx) {
            const std::size_t objects = h.scene().instances.live(), meshes = h.scene().meshes.live();
            run(h, ctx, "edit.copy");
            held = ImGui::GetClipboardText();
            run(h, ctx, "edit.paste");
            IM_CHECK(h.scene().instances.live() == objects + 1 &&
                     h.scene().meshes.live() == meshes); // shared with the original
            const LightId id = add_light(h, ctx, "lights.add_spot");
            run(h, ctx, "edit.copy");
            run(h, ctx, "edit.paste");
            wait_until(ctx, [&] { return h.editor().selection.light() != id; });
            IM_CHECK(h.editor().selection.light() && h.editor().selection.light() != id);
        });
    }
    Headless other("cornell/cornell.pbrt");
    other.play("paste", [&](ImGuiTestContext* ctx) {
        const std::size_t objects = other.scene().instances.live();
        ImGui::SetClipboardText(held.c_str());
        run(other, ctx, "edit.paste");
        wait_until(ctx, [&] { return other.scene().instances.live() > objects; });
        IM_CHECK(other.scene().instances.live() == objects + 1 && other.step() == 1);
        const scene::Instance& made = other.scene().instances[other.editor().selection.active()];
        IM_CHECK(made.name == "Chair frame" && other.scene().meshes.find(made.mesh)->data);
        IM_CHECK(other.scene().materials.find(made.material) != nullptr);
    });
}

TEST_CASE("arrows move through the outliner's rows, and names fit next to their eyes", "[ui]") {
    Headless h("demo/demo.pbrt");
    h.play("arrows", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Outliner");
        h.click(ctx, "outliner.search");
        ctx->KeyCharsReplaceEnter("lemon");
        ctx->Yield(3);
        std::vector<editor::InstanceId> found;
        for (const auto& row : h.editor().panel_state->outliner.rows)
            if (row.kind == editor::OutlinerState::Row::Kind::instance) found.push_back({row.id});
        IM_CHECK(found.size() >= 2);
        h.click(ctx, "outliner." + h.scene().instances[found[0]].name);
        IM_CHECK(h.editor().selection.active() == found[0]);
        ctx->KeyPress(ImGuiKey_DownArrow);
        ctx->Yield(2);
        IM_CHECK(h.editor().selection.active() == found[1] && h.editor().selection.instances().size() == 1);
        ctx->KeyPress(ImGuiMod_Shift | ImGuiKey_UpArrow);
        ctx->Yield(2);
        IM_CHECK(h.editor().selection.instances().size() == 2);

        const std::string name(200, 'm');
        h.editor().edit([&, id = found[0]](const scene::Scene& s) { return scene::rename(s, id, name); });
        h.click(ctx, "outliner.search");
        ctx->KeyCharsReplaceEnter("mmmm");
        ctx->Yield(3);
        const ImVec4 eye = h.find(ctx, "outliner.eye." + name);
        const ImGuiWindow* panel = ImGui::FindWindowByName("Outliner");
        IM_CHECK(eye.z <= panel->Pos.x + panel->Size.x);
        h.click(ctx, "outliner.eye." + name);
        IM_CHECK(h.scene().instances[found[0]].hidden);
    });
}

TEST_CASE("menus name the step to undo, the first group is called Group, keys show their characters", "[ui]") {
    Headless h("cornell/cornell.pbrt");
    h.play("labels", [&](ImGuiTestContext* ctx) {
        const editor::Action& undo = *editor::find_action("edit.undo");
        IM_CHECK(editor::label_of(h.editor(), undo) == "Undo");
        const std::size_t groups = h.scene().groups.live();
        run(h, ctx, "select.all");
        run(h, ctx, "edit.group");
        IM_CHECK(h.scene().groups.live() == groups + 1);
        bool first = false;
        h.scene().groups.each([&](auto, const scene::Group& g) { first |= g.name == "Group"; });
        IM_CHECK(first);
        IM_CHECK(editor::label_of(h.editor(), undo) == "Undo Group");
        IM_CHECK(editor::key_text(ImGuiMod_Shift | ImGuiKey_Slash) == "?");
        IM_CHECK(editor::key_text(ImGuiKey_LeftBracket) == "[");
        for (const editor::Action& action : editor::all_actions())
            for (const auto preset : {editor::KeyPreset::standard, editor::KeyPreset::blender}) {
                const std::string text = editor::key_text(editor::key_of(action, preset));
                IM_CHECK_STR_EQ(
                    text.find("Slash") == text.npos && text.find("Bracket") == text.npos ? "" : text.c_str(), "");
            }
        for (int i = 0; i < 4; ++i)
            run(h, ctx, "edit.duplicate");
        IM_CHECK(h.step() == 5);
        // In one frame; each counts.
        const std::vector<ImGuiKeyChord> keys{ImGuiMod_Ctrl | ImGuiKey_Z, ImGuiMod_Ctrl | ImGuiKey_Z,
                                              ImGuiMod_Ctrl | ImGuiKey_Y, ImGuiMod_Ctrl | ImGuiKey_Z};
        editor::run_shortcuts(h.editor(), &keys);
        ctx->Yield(2);
        IM_CHECK(h.step() == 3);
    });
}

TEST_CASE("a dropped image asks whether to change one object or all that share the material", "[ui]") {
    test::TemporaryFolder folder;
    const auto file = folder.path() / "red.tga";
    std::ofstream(file, std::ios::binary)
        << std::string("\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x18\0", 18) << "\x10\x10\xf0";
    Headless h("demo/demo.pbrt");
    h.play("shared", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "picture");
        const ImVec4 r = h.find(ctx, "picture");
        const ImVec2 at(r.x + 0.62f * (r.z - r.x), r.y + 0.88f * (r.w - r.y)); // a chair; there are three
        const std::size_t materials = h.scene().materials.live();
        h.editor().drop({file}, at);
        h.wait_for(ctx, "scope.alone");
        h.click(ctx, "scope.cancel");
        ctx->Yield(3);
        IM_CHECK(h.step() == 0);
        for (const bool alone : {true, false}) {
            h.editor().drop({file}, at);
            h.wait_for(ctx, "scope.alone");
            h.click(ctx, alone ? "scope.alone" : "scope.all");
            wait_until(ctx, [&] { return h.step() > 0; });
            IM_CHECK(h.step() == 1 && h.scene().materials.live() == materials + (alone ? 1 : 0));
            run(h, ctx, "edit.undo");
            IM_CHECK(h.scene().materials.live() == materials);
        }
    });
}

TEST_CASE("the layout is reset, and keeps room for the picture in a small window", "[ui]") {
    Headless h("cornell/cornell.pbrt", 1, {1000, 600});
    h.play("layout", [&](ImGuiTestContext* ctx) {
        ctx->Yield(3);
        const auto wide = [] { return ImGui::FindWindowByName("Viewport")->Size.x; };
        const float first = wide();
        IM_CHECK(first >= 450);
        for (const char* panel : {"Inspector", "Scene", "Outliner"}) // everything at the right
            h.editor().open_panel(panel, false);
        ctx->Yield(3);
        IM_CHECK(wide() > first);
        run(h, ctx, "view.reset_layout");
        ctx->Yield(3);
        IM_CHECK(h.editor().panel_open("Inspector") && std::abs(wide() - first) < 2);
    });
}

TEST_CASE("missing glyphs are reported, and fonts' character maps are read", "[ui]") {
    test::TemporaryFolder folder;
    const auto korean = folder.path() / "a.ttf", chinese = folder.path() / "b.otf";
    std::ofstream(korean, std::ios::binary) << font_of(0xac00, 0xd7a3, true);
    std::ofstream(chinese, std::ios::binary) << font_of(0x4e00, 0x9fa5, false);
    std::ofstream(folder.path() / "c.ttf", std::ios::binary) << "no font";
    CHECK(editor::font_has(korean, 0, 0xc758));
    CHECK_FALSE(editor::font_has(korean, 0, 0x6905));
    CHECK(editor::font_has(chinese, 0, 0x6905));
    CHECK_FALSE(editor::font_has(chinese, 0, 0xac00));
    CHECK_FALSE(editor::font_has(folder.path() / "c.ttf", 0, 'a'));
    const std::array folders{folder.path(), folder.path() / "not there"};
    const auto found = editor::find_fallback_fonts(folders);
    CHECK(found.fonts.size() == 2);
    CHECK(std::ranges::find(found.missing, "Korean") == found.missing.end());
    CHECK(std::ranges::find(found.missing, "Japanese") != found.missing.end());

    // In the system's folders; of several with the script, the regular one for many scripts.
    const auto system = folder.path() / "fonts/truetype";
    std::filesystem::create_directories(system);
    for (const char* name : {"AnyMincho-Bold.otf", "PlainSansCJK-Bold.otf", "PlainSansCJK-Regular.otf"})
        std::ofstream(system / name, std::ios::binary) << font_of(0x3040, 0x9fff, true);
    const char* before = std::getenv("XDG_DATA_HOME");
    const std::string kept = before ? before : "";
    setenv("XDG_DATA_HOME", folder.path().c_str(), 1);
    const auto system_folders = editor::system_font_folders();
    before ? setenv("XDG_DATA_HOME", kept.c_str(), 1) : unsetenv("XDG_DATA_HOME");
    REQUIRE(system_folders.front() == folder.path() / "fonts");
    const auto cjk = editor::find_fallback_fonts(std::span(system_folders).first(1));
    REQUIRE(cjk.fonts.size() == 1);
    CHECK(cjk.fonts[0].file == system / "PlainSansCJK-Regular.otf");

    Headless h("cornell/cornell.pbrt"); // with Dear ImGui's own font only
    scene::Scene named = h.scene();
    scene::apply(named, *scene::rename(named, scene::Id<scene::Instance>{1}, "\xec\x9d\x98\xec\x9e\x90"));
    h.editor().adopt_scene(named);
    const auto lines = h.editor().notices.lines();
    CHECK(std::ranges::any_of(
        lines, [](const auto& line) { return line.text.find("Names here are Korean") != line.text.npos; }));
}
