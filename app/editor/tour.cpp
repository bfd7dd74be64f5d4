// SPDX-License-Identifier: Apache-2.0
#include "tour.hpp"

#include "base/file.hpp"
#include "document/session.hpp"
#include "editor.hpp"
#include "saving.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <iterator>
#include <system_error>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

enum class Task { select, move, material, sky, camera, save };

struct Step {
    Task task;
    const char* panel; // opened for it; null = none
    const char* mark; // what it points at
    const char* text;
    const char* blender_text = nullptr; // with the Blender-like keys, if it differs
};
constexpr Step steps[] = {
    {Task::select, nullptr, "picture", "Click a thing in the picture, the chair for example: it gets an outline."},
    {Task::move, nullptr, "picture",
     "Drag one of its arrows to move it, or drag the thing itself. Ctrl+Z takes anything back."},
    {Task::material, "Materials", "tab.Materials", "Drag a material from here onto a thing in the picture."},
    {Task::sky, "Scene", "tab.Scene", "Choose another sky here, or turn or brighten the one there is."},
    {Task::camera, nullptr, "picture", "Look around: drag with Alt held, and turn the wheel to come nearer.",
     "Look around: drag with the middle button, and turn the wheel to come nearer."},
    {Task::save, nullptr, "menu.file", "Press Ctrl+S to save your version. The file you opened is never changed."},
};

template <class T, class F>
bool differs(const scene::Table<T>& before, const scene::Table<T>& now, F&& same) {
    bool found = before.live() != now.live();
    now.each([&](scene::Id<T> id, const T& item) {
        const T* old = found ? nullptr : before.find(id);
        found = found || !old || !same(*old, item);
    });
    return found;
}

bool is_saved(const DocumentContext& e) { return document::is_project(e.session().path()) && !e.session().modified(); }

} // namespace

void Tour::start() {
    running_ = true;
    begun_ = false;
    step_ = 0;
}

void Tour::begin_step(PanelContext& e) {
    begun_ = true;
    e.preferences.hint_seen = true; // the tour says more
    before_ = e.scene();
    view_ = e.views.version();
    document_ = e.document();
    was_saved_ = is_saved(e);
    if (steps[step_].panel) e.open_panel(steps[step_].panel);
}

void Tour::update(Editor& e) {
    if (!running_ || e.scene().instances.live() == 0 || e.opening().running()) return;
    if (!begun_) begin_step(e);
    if (e.document() != document_) { // another scene; at first the room, which was still being opened
        if (step_ > 0) return end();
        begin_step(e);
    }
    const auto done = [&] {
        const scene::Scene& now = e.scene();
        switch (steps[step_].task) {
            case Task::select:
                return !e.selection.empty();
            case Task::move:
                return differs(before_.instances, now.instances,
                               [](const auto& a, const auto& b) { return a.object_to_world == b.object_to_world; });
            case Task::material:
                return differs(before_.instances, now.instances,
                               [](const auto& a, const auto& b) { return a.material == b.material; }) ||
                       differs(before_.materials, now.materials, [](const auto& a, const auto& b) { return a == b; });
            case Task::sky:
                return !(before_.environment.value == now.environment.value);
            case Task::camera:
                return e.views.version() != view_ ||
                       differs(before_.cameras, now.cameras, [](const auto& a, const auto& b) { return a == b; });
            case Task::save:
                return is_saved(e) && !was_saved_;
        }
        return false;
    };
    bool next = !ImGui::IsAnyMouseDown() && done(); // not in the middle of a drag

    const Step& step = steps[step_];
    const float scale = ImGui::GetStyle().FontScaleMain, width = 300 * scale, gap = 14 * scale;
    const ImVec2 room = ImGui::GetMainViewport()->Size;
    ImVec2 lower(room.x / 2, room.y / 2), upper = lower;
    if (const Marks::Mark* at = e.find_mark(step.mark)) lower = {at->x0, at->y0}, upper = {at->x1, at->y1};
    ImGui::GetForegroundDrawList()->AddRect({lower.x - 2 * scale, lower.y - 2 * scale},
                                            {upper.x + 2 * scale, upper.y + 2 * scale},
                                            ImGui::GetColorU32(colors::accent), 4 * scale, 2 * scale);
    // Inside large places, else below or above small ones.
    const bool large = upper.y - lower.y > room.y / 3;
    ImVec2 place(large ? lower.x + gap : lower.x, large ? lower.y + 3 * gap : upper.y + gap);
    if (place.y > room.y * 0.75f) place.y = lower.y - 8 * gap;
    place = {std::clamp(place.x, gap, std::max(gap, room.x - width - gap)), std::max(place.y, gap)};
    ImGui::SetNextWindowPos(place);
    ImGui::PushStyleColor(ImGuiCol_Border, ImGui::GetColorU32(colors::accent));
    ImGui::Begin("##tour", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoDocking | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoNavFocus);
    ImGui::PopStyleColor();
    dialog_width(280);
    ImGui::TextColored(colors::dim, "%s", fmt::format("{} of {}", step_ + 1, std::size(steps)).c_str());
    const bool blender = e.view.keys == KeyPreset::blender && step.blender_text;
    ImGui::TextWrapped("%s", blender ? step.blender_text : step.text);
    const bool last = step_ + 1 == std::size(steps);
    if (ImGui::Button(last ? "Done" : "Next")) next = true;
    e.mark("tour.next");
    ImGui::SameLine();
    const bool skip = !last && ImGui::Button("Skip the tour");
    if (!last) e.mark("tour.skip");
    ImGui::End();
    if (skip) return end();
    if (!next) return;
    if (last) {
        e.notices.add(LogLevel::info, "That was the tour. Ctrl+P finds everything else; ? shows all keys");
        return end();
    }
    ++step_;
    begun_ = false;
}

fs::path example_room() {
    const auto bin = executable_dir();
    if (!bin) return {};
    fs::path room = bin->parent_path() / "share/restage/scenes/demo/demo.pbrt";
    std::error_code none;
    return fs::exists(room, none) ? room : fs::path();
}

void start_tour(Editor& e) {
    const fs::path room = example_room();
    if (room.empty()) return e.tour.start();
    ask_unsaved(e, "opening the example room", [room](Editor& editor) {
        editor.open_now({.path = room});
        editor.tour.start();
    });
}

} // namespace restage::editor
