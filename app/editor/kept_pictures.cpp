// SPDX-License-Identifier: Apache-2.0
#include "kept_pictures.hpp"

#include "document/session.hpp"
#include "looks.hpp"
#include "panel_context.hpp"
#include "panels/state.hpp"
#include "scene/development.hpp"
#include "scene/difference.hpp"
#include "theme.hpp"
#include "view/display.hpp"
#include "view/live_view.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace restage::editor {

void KeptPictures::add(std::string name, scene::Scene scene, std::uint32_t width, std::uint32_t height,
                       std::span<const std::uint32_t> rgba) {
    if (list_.size() == most) list_.pop_back();
    Picture picture{.name = std::move(name),
                    .scene = std::move(scene),
                    .size = {float(width), float(height)},
                    .texture = pool_.take()};
    picture.texture->set(width, height, rgba);
    list_.insert(list_.begin(), std::move(picture));
    ++added_;
    compared_ = 0;
}

void KeptPictures::remove(std::size_t index) {
    list_.erase(list_.begin() + std::ptrdiff_t(index));
    if (compared_ > index || compared_ >= list_.size()) compared_ = compared_ > 0 ? compared_ - 1 : 0;
    if (list_.empty()) wiping = false;
}

void KeptPictures::forget() {
    list_.clear();
    wiping = false;
    added_ = compared_ = 0;
}

void keep_picture(PanelContext& e) {
    const auto frame = e.shown_frame();
    if (!frame || frame->clay) return e.notices.add(LogLevel::info, "There is no picture yet");
    view::DisplaySettings settings = e.view.display;
    settings.scale = e.scene().film.value.exposure;
    settings.development = scene::development_of(e.scene());
    std::vector<std::uint32_t> rgba;
    view::to_display(frame->image, settings, rgba);
    view::over_checkers(frame->image.width, rgba);
    KeptPictures& kept = e.panel_state->kept;
    const std::string name = fmt::format("Picture {}", kept.number());
    kept.add(name, scene_as_seen(e), frame->image.width, frame->image.height, rgba);
    e.notices.add(LogLevel::info, name + " is kept: compare it in the panel Looks, or hold J");
}

void bring_back(SelectContext& e, std::size_t index) {
    const auto& list = e.panel_state->kept.list();
    if (index >= list.size()) return;
    e.edit([scene = list[index].scene, name = list[index].name](const scene::Scene& now) -> Result<scene::Edit> {
        return scene::difference(now, scene, "Bring back " + name);
    });
    e.later([&e] { e.views.go(std::nullopt); });
}

void draw_comparison(PanelContext& e, ImVec2 corner, ImVec2 size) {
    KeptPictures& kept = e.panel_state->kept;
    const KeptPictures::Picture* picture = kept.compared();
    if (!picture || !picture->texture->ready()) return;
    const ImVec2 end(corner.x + size.x, corner.y + size.y);
    const bool flipped = ImGui::IsKeyDown(ImGuiKey_J) && !ImGui::GetIO().WantTextInput &&
                         ImGui::IsMouseHoveringRect(corner, end) && ImGui::IsWindowHovered();
    if (!kept.wiping && !flipped) return;
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const float scale = ImGui::GetStyle().FontScaleMain, part = flipped ? 1.f : kept.line;
    // Fitted into the picture, if the film has another shape now.
    const float fit = std::min(size.x / picture->size.x, size.y / picture->size.y);
    const ImVec2 shown(picture->size.x * fit, picture->size.y * fit);
    const ImVec2 at(corner.x + (size.x - shown.x) / 2, corner.y + (size.y - shown.y) / 2);
    const float x = std::floor(corner.x + size.x * part);
    draw->PushClipRect(corner, {x, end.y}, true);
    draw->AddRectFilled(corner, end, ImGui::GetColorU32(ImGuiCol_FrameBg));
    draw->AddImage(picture->texture->ref(), at, {at.x + shown.x, at.y + shown.y});
    draw->PopClipRect();
    const auto label = [&](const std::string& text, bool right) {
        const ImVec2 extent = ImGui::CalcTextSize(text.c_str()), pad(6 * scale, 3 * scale);
        const ImVec2 place(right ? x + pad.x : std::max(corner.x, x - extent.x - 3 * pad.x), corner.y + pad.x);
        draw->AddRectFilled(place, {place.x + extent.x + 2 * pad.x, place.y + extent.y + 2 * pad.y},
                            ImGui::GetColorU32(ImGuiCol_PopupBg, 0.85f), 3 * scale);
        draw->AddText({place.x + pad.x, place.y + pad.y}, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
    };
    draw->PushClipRect(corner, end, true);
    label(picture->name, false);
    if (!flipped) label("Now", true);
    draw->PopClipRect();
    if (flipped) return;
    const bool held = ImGui::IsMouseHoveringRect({x - 6 * scale, corner.y}, {x + 6 * scale, end.y});
    draw->AddLine({x, corner.y}, {x, end.y}, ImGui::GetColorU32(held ? colors::pointed : colors::selected),
                  std::max(1.f, 2 * scale));
    const ImVec2 cursor = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos({x - 6 * scale, corner.y});
    ImGui::InvisibleButton("##wipe", {12 * scale, size.y});
    if (ImGui::IsItemHovered() || ImGui::IsItemActive()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (ImGui::IsItemActive())
        kept.line = std::clamp((ImGui::GetIO().MousePos.x - corner.x) / std::max(size.x, 1.f), 0.f, 1.f);
    e.mark("wipe");
    tip("Drag to compare: at the left the kept picture, at the right the live one. Hold J over the picture to flip");
    ImGui::SetCursorScreenPos(cursor);
}

} // namespace restage::editor
