// SPDX-License-Identifier: Apache-2.0
// Looks: a contact sheet of the document's looks, and the pictures put aside to compare with.
#include "looks.hpp"
#include "panels.hpp"

#include "actions.hpp"
#include "document/looks.hpp"
#include "panel_context.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <misc/cpp/imgui_stdlib.h>
#include <algorithm>
#include <cmath>

namespace restage::editor {

using document::Looks;

namespace {

constexpr float card_side = 112; // the longer side of a card's picture [at scale 1]

struct Card {
    ImVec2 corner, size; // of its picture
    bool clicked = false;
};

// A picture with room for its name below, the picture fitted into it; the item is the whole card.
Card card(const char* id, const Texture* texture, ImVec2 pixels, const char* instead, bool strong,
          const std::string& name) {
    const float scale = ImGui::GetStyle().FontScaleMain;
    const ImVec2 room(card_side * scale, card_side * 0.625f * scale);
    Card result{ImGui::GetCursorScreenPos(), room};
    result.clicked = ImGui::InvisibleButton(id, {room.x, room.y + ImGui::GetTextLineHeight() + 6 * scale});
    const bool hovered = ImGui::IsItemHovered();
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImVec2 end(result.corner.x + room.x, result.corner.y + room.y);
    draw->AddRectFilled(result.corner, end, ImGui::GetColorU32(hovered ? ImGuiCol_FrameBgHovered : ImGuiCol_FrameBg));
    if (texture && texture->ready()) {
        const float fit = std::min(room.x / pixels.x, room.y / pixels.y);
        const ImVec2 shown(std::floor(pixels.x * fit), std::floor(pixels.y * fit));
        const ImVec2 at(std::floor(result.corner.x + (room.x - shown.x) / 2),
                        std::floor(result.corner.y + (room.y - shown.y) / 2));
        draw->AddImage(texture->ref(), at, {at.x + shown.x, at.y + shown.y});
    } else {
        const ImVec2 extent = ImGui::CalcTextSize(instead);
        ImGui::PushStyleColor(ImGuiCol_Text, colors::dim);
        ImGui::RenderText({result.corner.x + (room.x - extent.x) / 2, result.corner.y + (room.y - extent.y) / 2},
                          instead);
        ImGui::PopStyleColor();
    }
    if (strong || hovered)
        draw->AddRect(result.corner, end, ImGui::GetColorU32(strong ? colors::accent : colors::hover), 0,
                      (strong ? 2 : 1) * scale);
    const ImVec2 text(result.corner.x, end.y + 3 * scale);
    ImGui::RenderTextEllipsis(draw, text, {end.x, text.y + ImGui::GetTextLineHeight()}, end.x, name.c_str(), nullptr,
                              nullptr);
    return result;
}

// Places the next card in the row, or begins the next row.
void next_card(bool first) {
    if (!first) flow(card_side * ImGui::GetStyle().FontScaleMain);
}

void start_renaming(LooksState& state, std::size_t index, const std::string& name) {
    state.renaming = index;
    state.new_name = name;
    state.focus_name = true;
}

// --- looks

void menu_of_look(SelectContext& e, LooksState& state, std::size_t index) {
    if (!ImGui::BeginPopupContextItem()) return;
    const std::string& name = e.session().looks().list[index].name;
    const auto entry = [&](const char* label, const char* mark, const char* key = nullptr) {
        const bool chosen = ImGui::MenuItem(label, key);
        e.mark(std::string("looks.menu.") + mark);
        return chosen;
    };
    if (entry("Go to it", "go")) go_to_look(e, index);
    if (entry("Update it", "update")) update_look(e, index);
    if (entry("Rename", "rename", "F2")) start_renaming(state, index, name);
    if (entry("Duplicate", "duplicate"))
        e.change([index](document::Session& s) { (void)document::duplicate_look(s, index); });
    if (entry("Delete", "delete")) e.change([index](document::Session& s) { (void)document::remove_look(s, index); });
    ImGui::EndPopup();
}

void name_of_look(EditContext& e, LooksState& state, std::size_t index, const Card& at) {
    const float scale = ImGui::GetStyle().FontScaleMain;
    ImGui::SetCursorScreenPos({at.corner.x, at.corner.y + at.size.y + scale});
    ImGui::SetNextItemWidth(at.size.x);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0, 0));
    if (std::exchange(state.focus_name, false)) ImGui::SetKeyboardFocusHere();
    ImGui::InputText("##name", &state.new_name, ImGuiInputTextFlags_AutoSelectAll);
    ImGui::PopStyleVar();
    e.mark("looks.name");
    if (ImGui::IsItemDeactivated()) {
        state.renaming.reset();
        if (ImGui::IsItemDeactivatedAfterEdit() && !ImGui::IsKeyPressed(ImGuiKey_Escape, false))
            e.change([&e, index, name = state.new_name](document::Session& s) {
                if (auto done = document::rename_look(s, index, name); !done)
                    e.notices.add(LogLevel::error, done.error().message);
            });
    }
}

// Where its picture is: "rendering, 12 s", "after 2 others".
std::string awaited(const LookPictures::Shown& shown) {
    if (shown.failed) return "no picture";
    if (!shown.place) return "";
    if (shown.place->before == 0) return fmt::format("rendering, {:.0f} s", shown.place->seconds);
    return shown.place->before == 1 ? "the next one" : fmt::format("after {} others", shown.place->before);
}

void draw_look(SelectContext& e, PictureView& picture, LooksState& state, std::size_t index) {
    const Looks& looks = e.session().looks();
    const document::Look& look = looks.list[index];
    const bool current = index == looks.current;
    const bool changed = current && !state.differs.empty();
    const bool visible = ImGui::IsRectVisible(
        {card_side * ImGui::GetStyle().FontScaleMain, card_side * ImGui::GetStyle().FontScaleMain});
    LookPictures::Shown shown;
    if (visible)
        shown = state.pictures.picture({e.registry(), e.log(), e.options().renderer}, e.scene(), look,
                                       picture.view.display);
    ImGui::PushID(int(index));
    ImGui::BeginGroup();
    const bool renaming = state.renaming == index;
    const Card drawn = card("look", shown.texture, shown.size, awaited(shown).c_str(), current,
                            renaming ? "" : look.name + (changed ? " *" : ""));
    e.mark("look." + look.name);
    if (drawn.clicked) go_to_look(e, index);
    if (ImGui::BeginDragDropSource(ImGuiDragDropFlags_SourceNoDisableHover)) {
        ImGui::SetDragDropPayload("restage.look", &index, sizeof index);
        ImGui::TextUnformatted(look.name.c_str());
        ImGui::EndDragDropSource();
    }
    if (ImGui::BeginDragDropTarget()) {
        if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload("restage.look")) {
            const std::size_t from = *static_cast<const std::size_t*>(payload->Data);
            e.change([from, index](document::Session& s) { (void)document::move_look(s, from, index); });
        }
        ImGui::EndDragDropTarget();
    }
    menu_of_look(e, state, index);
    tip((look.name +
         (changed   ? "\nChanged since: " + state.differs
          : current ? std::string("\nThe scene looks like this")
                    : std::string("\nClick: go to it. Drag: another place. Right click: more")) +
         (shown.stale ? "\nThe picture is older than the scene: " + awaited(shown) : ""))
            .c_str());
    if (shown.stale) {
        const float radius = 4 * ImGui::GetStyle().FontScaleMain;
        ImGui::GetWindowDrawList()->AddCircleFilled(
            {drawn.corner.x + drawn.size.x - 2 * radius, drawn.corner.y + 2 * radius}, radius,
            ImGui::GetColorU32(colors::warning));
        e.mark("look.stale." + look.name);
    }
    if (renaming) name_of_look(e, state, index, drawn);
    ImGui::EndGroup();
    ImGui::PopID();
}

void keys(SelectContext& e, LooksState& state) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows) || io.WantTextInput || io.KeyCtrl || io.KeyAlt)
        return;
    const Looks& looks = e.session().looks();
    if (ImGui::IsKeyPressed(ImGuiKey_RightArrow)) step_look(e, 1);
    if (ImGui::IsKeyPressed(ImGuiKey_LeftArrow)) step_look(e, -1);
    if (ImGui::IsKeyPressed(ImGuiKey_F2, false) && looks.current < looks.list.size())
        start_renaming(state, looks.current, looks.list[looks.current].name);
}

void buttons(SelectContext& e, const LooksState& state) {
    const std::size_t current = e.session().looks().current;
    const bool none = !has_current_look(e);
    action_button(e, "look.new");
    const auto button = [&](const char* label, const char* mark, const char* tooltip) {
        flow(ImGui::CalcTextSize(label).x + 2 * ImGui::GetStyle().FramePadding.x);
        const bool pressed = ImGui::Button(label);
        tip(tooltip);
        e.mark(mark);
        return pressed;
    };
    ImGui::BeginDisabled(none || state.differs.empty());
    if (button("Update", "looks.update", "Records the scene as it is now under the current look's name"))
        update_look(e, current);
    ImGui::EndDisabled();
    ImGui::BeginDisabled(none);
    if (button("Delete", "looks.delete", "Deletes the current look; the scene stays as it is"))
        e.change([current](document::Session& s) { (void)document::remove_look(s, current); });
    ImGui::EndDisabled();
    const auto ids = e.selection.instances();
    ImGui::BeginDisabled(!has_looks(e) || ids.empty());
    if (button("Selection to all looks", "looks.share", "Every look gets the selected objects as they are now"))
        e.change([&e, ids](document::Session& s) {
            if (auto done = document::use_in_all_looks(s, ids); !done)
                e.notices.add(LogLevel::error, done.error().message);
        });
    ImGui::EndDisabled();
    flow(ImGui::CalcTextSize("Keep picture").x + 2 * ImGui::GetStyle().FramePadding.x);
    action_button(e, "look.keep");
}

// --- kept pictures

void draw_kept(SelectContext& e, KeptPictures& kept) {
    const KeptPictures::Picture* compared = kept.compared();
    ImGui::SeparatorText("Kept pictures");
    ImGui::Checkbox("Wipe", &kept.wiping);
    tip("Covers the live picture with the chosen one, to the left of a line to drag. Or hold J over the picture to "
        "flip");
    e.mark("kept.wipe");
    const float gap = 2 * ImGui::GetStyle().FramePadding.x;
    flow(ImGui::CalcTextSize("Bring back its scene").x + gap);
    if (ImGui::Button("Bring back its scene")) bring_back(e, kept.compared_index());
    tip("The scene and the camera become as they were in the chosen picture: one undo step");
    e.mark("kept.bring");
    flow(ImGui::CalcTextSize("Delete").x + gap);
    const bool remove = ImGui::Button("Delete##kept");
    tip("Deletes the chosen picture; the scene stays as it is");
    e.mark("kept.delete");
    for (std::size_t i = 0; i < kept.list().size(); ++i) {
        const KeptPictures::Picture& one = kept.list()[i];
        next_card(i == 0);
        ImGui::PushID(int(i));
        const Card drawn = card("kept", one.texture.get(), one.size, "", &one == compared, one.name);
        e.mark("kept." + one.name);
        if (drawn.clicked) kept.compare(i);
        if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) kept.wiping = true;
        tip("Click: compare the live picture with it. Double click: wipe");
        ImGui::PopID();
    }
    if (remove) kept.remove(kept.compared_index());
}

} // namespace

void draw_looks(SelectContext& e, PictureView& picture) {
    LooksState& state = e.panel_state->looks;
    KeptPictures& kept = e.panel_state->kept;
    const Looks& looks = e.session().looks();
    const LooksState::Seen now{e.session().version(), e.views.version(), e.document()};
    if (!(state.seen == now)) {
        state.seen = now;
        state.differs = has_current_look(e) ? difference_from_look(e, looks.current) : "";
    }
    if (state.renaming && *state.renaming >= looks.list.size()) state.renaming.reset();
    buttons(e, state);
    if (!ImGui::BeginChild("sheet")) return ImGui::EndChild();
    keys(e, state);
    if (looks.list.empty())
        empty_note(
            "No looks yet. New look records how things are now: places, visibility, materials, lights, sky, "
            "exposure and camera. Change them, record another one, and click to go from one to the other. "
            "They are saved with the project.");
    for (std::size_t i = 0; i < looks.list.size(); ++i) {
        next_card(i == 0);
        draw_look(e, picture, state, i);
    }
    if (!kept.list().empty()) draw_kept(e, kept);
    ImGui::EndChild();
}

} // namespace restage::editor
