// SPDX-License-Identifier: Apache-2.0
// Every panel and dialog at 1x, 1.5x and 2x: nothing is cut off, out of reach or over something else.
#include "painter.hpp"
#include "tour_of_panels.hpp"

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace restage::tests {

namespace {

// The window and what it covers on screen: of the topmost popup if the name is empty.
ImGuiWindow* window_of(const std::string& name) {
    const auto& popups = ImGui::GetCurrentContext()->OpenPopupStack;
    if (name.empty()) return popups.Size > 0 ? popups.back().Window : nullptr;
    return ImGui::FindWindowByName(name.c_str());
}

// The draw data after the next frame.
void after_frame(ImGuiTestContext* ctx, std::function<void(const ImDrawData&)> work) {
    ImGuiContextHook hook;
    hook.Type = ImGuiContextHookType_RenderPost;
    hook.UserData = &work;
    hook.Callback = [](ImGuiContext*, ImGuiContextHook* of) {
        (*static_cast<std::function<void(const ImDrawData&)>*>(of->UserData))(*ImGui::GetDrawData());
    };
    const ImGuiID id = ImGui::AddContextHook(ImGui::GetCurrentContext(), &hook);
    ctx->Yield();
    ImGui::RemoveContextHook(ImGui::GetCurrentContext(), id);
}

bool glyph(const ImDrawVert* v) { // the four corners of one, as ImFont::RenderText writes them
    return v[0].pos.y == v[1].pos.y && v[2].pos.y == v[3].pos.y && v[0].pos.x == v[3].pos.x &&
           v[1].pos.x == v[2].pos.x && v[0].uv.x < v[1].uv.x && v[0].uv.y < v[2].uv.y;
}

// Letters of which a vertical part is not drawn: text that does not fit. Their places.
std::vector<ImVec4> cut_letters(const ImDrawData& data, const ImGuiWindow& window) {
    std::vector<ImVec4> cut;
    for (const ImDrawList* list : data.CmdLists) {
        const std::string owner = list->_OwnerName ? list->_OwnerName : "";
        if (owner != window.Name && !owner.starts_with(std::string(window.Name) + "/")) continue;
        for (const ImDrawCmd& command : list->CmdBuffer) {
            if (command.UserCallback || command.TexRef._TexData != ImGui::GetIO().Fonts->TexData) continue;
            for (unsigned i = 0; i + 5 < command.ElemCount; ++i) {
                const ImDrawIdx* index = &list->IdxBuffer[int(command.IdxOffset + i)];
                const unsigned k = index[0];
                const bool quad =
                    index[1] == k + 1 && index[2] == k + 2 && index[3] == k && index[4] == k + 2 && index[5] == k + 3;
                if (!quad) continue;
                const ImDrawVert* v = &list->VtxBuffer[int(k + command.VtxOffset)];
                if (!glyph(v)) continue;
                i += 5;
                const ImVec4& clip = command.ClipRect;
                const float slack = 1.5f * ImGui::GetStyle().FontScaleMain; // sides of a letter are transparent
                const bool seen =
                    v[2].pos.y > clip.y && v[0].pos.y < clip.w && v[1].pos.x > clip.x && v[0].pos.x < clip.z;
                if (seen && (v[0].pos.x < clip.x - slack || v[1].pos.x > clip.z + slack))
                    cut.emplace_back(v[0].pos.x, v[0].pos.y, v[1].pos.x, v[2].pos.y);
            }
        }
    }
    return cut;
}

std::map<std::string, editor::Marks::Mark> marks_of(const editor::Editor& e) {
    std::map<std::string, editor::Marks::Mark> all;
    const auto state = nlohmann::json::parse(e.probe());
    for (const auto& [name, place] : state["marks"].items())
        if (const auto* mark = e.find_mark(name)) all.emplace(name, *mark);
    return all;
}

std::string nearest(const editor::Editor& e, const ImVec4& place) {
    std::string best = "?";
    float least = 1e30f;
    for (const auto& [name, m] : marks_of(e)) {
        const float dx = std::max({m.x0 - place.x, 0.f, place.z - m.x1}),
                    dy = std::max({m.y0 - place.y, 0.f, place.w - m.y1});
        const float distance = std::hypot(dx, dy) + 1e-4f * (m.x1 - m.x0) * (m.y1 - m.y0);
        if (distance < least) least = distance, best = name;
    }
    return best;
}

std::vector<std::string> faults(ImGuiTestContext* ctx, const editor::Editor& e, const ImGuiWindow& window) {
    std::vector<std::string> found;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    if (window.Flags & ImGuiWindowFlags_Modal)
        if (window.Pos.x < 0 || window.Pos.y < 0 || window.Pos.x + window.Size.x > screen.x ||
            window.Pos.y + window.Size.y > screen.y)
            found.push_back("the dialog is larger than the screen");
    if (window.ScrollbarX) found.push_back("a horizontal scroll bar");
    struct Item {
        std::string name;
        ImRect box;
        const ImGuiWindow* window;
    };
    std::vector<Item> items;
    for (const auto& [name, mark] : marks_of(e)) {
        const bool row = name.starts_with("outliner.") && name != "outliner.search"; // buttons lie on rows
        if (!mark.item || row || name.starts_with("axes.")) continue; // the axes' ends are in front of each other
        const ImGuiTestItemInfo info = ctx->ItemInfo(mark.item, ImGuiTestOpFlags_NoError);
        if (!info.ID || !info.Window || info.Window->RootWindow != window.RootWindow) continue;
        const ImRect box(mark.x0, mark.y0, mark.x1, mark.y1);
        const ImRect room = info.Window->InnerRect;
        const float touch = 2 * ImGui::GetStyle().FontScaleMain; // rows that can be clicked meet
        const bool list =
            (window.RootWindow->Flags & ImGuiWindowFlags_Popup) && !(window.RootWindow->Flags & ImGuiWindowFlags_Modal);
        if (!list && (box.Min.x < room.Min.x - 1 || box.Max.x > room.Max.x + 1)) // rows of lists cover their padding
            found.push_back(name + " reaches out of its window");
        for (const Item& other : items) {
            ImRect both = box;
            both.ClipWith(other.box);
            const bool inside = other.box.Contains(box) || box.Contains(other.box); // buttons in a row
            if (other.window == info.Window && !inside && both.GetWidth() > touch && both.GetHeight() > touch)
                found.push_back(name + " overlaps " + other.name);
        }
        items.push_back({name, box, info.Window});
    }
    return found;
}

} // namespace

// For looking at: RESTAGE_UI_PICTURES=FOLDER restage_ui_tests "[pictures]" writes SCALE-THEME-STATE.ppm.
TEST_CASE("pictures of every panel", "[.pictures]") {
    const char* folder = std::getenv("RESTAGE_UI_PICTURES");
    REQUIRE(folder);
    struct Setting {
        const char* name;
        float scale;
        ImVec2 size;
    };
    for (const Setting& s : {Setting{"1x", 1, {1300, 900}}, Setting{"1.5x", 1.5f, {1950, 1350}},
                             Setting{"2x", 2, {2600, 1800}}, Setting{"2x-small", 2, {1280, 720}}})
        for (const auto theme : {editor::Theme::dark, editor::Theme::light}) {
            Headless h("demo/demo.pbrt", s.scale, s.size);
            h.editor().preferences.theme = theme;
            editor::apply_colors(theme); // the test engine restores the style after each test
            tour_of_panels(h, [&](ImGuiTestContext* ctx, const std::string& state, const std::string& name) {
                after_frame(ctx, [&](const ImDrawData& data) {
                    const ImGuiWindow* w = window_of(name);
                    const ImVec2 lower = w ? w->Pos : ImVec2(0, 0);
                    const ImVec2 upper = w ? ImVec2(w->Pos.x + w->Size.x, w->Pos.y + w->Size.y) : s.size;
                    const std::string file =
                        std::string(s.name) + (theme == editor::Theme::dark ? "-dark-" : "-light-") + state;
                    Painter(data, {std::max(lower.x, 0.f), std::max(lower.y, 0.f)},
                            {std::min(upper.x, s.size.x), std::min(upper.y, s.size.y)})
                        .write_ppm(std::filesystem::path(folder) / (file + ".ppm"));
                });
            });
        }
}

TEST_CASE("nothing is cut off or overlaps, in any panel at any scale", "[ui]") {
    struct Setting {
        float scale;
        ImVec2 size;
    };
    for (const Setting& s :
         {Setting{1, {1300, 900}}, Setting{1.5f, {1950, 1350}}, Setting{2, {2600, 1800}}, Setting{2, {1280, 720}}}) {
        Headless h("demo/demo.pbrt", s.scale, s.size);
        std::set<std::string> all;
        ImGui::GetStyle().AntiAliasedLines = false; // else lines look like letters
        tour_of_panels(h, [&](ImGuiTestContext* ctx, const std::string& state, const std::string& name) {
            ImGuiWindow* window = window_of(name);
            IM_CHECK_SILENT(window);
            for (const std::string& fault : faults(ctx, h.editor(), *window))
                all.insert(state + ": " + fault);
            after_frame(ctx, [&](const ImDrawData& data) {
                for (const ImVec4& place : cut_letters(data, *window))
                    if (window->InnerRect.Contains(ImVec2(place.x, place.y))) // tabs scroll
                        all.insert(state + ": a letter is cut near " + nearest(h.editor(), place));
            });
        });
        for (const std::string& fault : all)
            FAIL_CHECK(s.scale << "x, " << s.size.x << "x" << s.size.y << ", " << fault);
    }
}

} // namespace restage::tests
