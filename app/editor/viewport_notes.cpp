// SPDX-License-Identifier: Apache-2.0
// The viewport's toolbar, its state display, and the first-start hints.
#include "actions.hpp"
#include "files.hpp"
#include "linking.hpp"
#include "opening.hpp"
#include "panel_context.hpp"
#include "panels/scene_development.hpp"
#include "panels/scene_panel.hpp"
#include "panels/state.hpp"
#include "scene/links.hpp"
#include "scene_pictures.hpp"
#include "snap_drag.hpp"
#include "theme.hpp"
#include "tour.hpp"
#include "view/live_view.hpp"
#include "viewport.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>

namespace restage::editor {

namespace {

// Snap steps of drags with Ctrl; kept in the preferences.
void draw_steps(PanelContext& e) {
    if (!ImGui::BeginPopup("steps")) return;
    dialog_width(230);
    ImGui::TextColored(colors::dim, "Dragging with Ctrl moves in steps of");
    const auto row = [&](const char* label, const char* tooltip, float* value, float least, float most,
                         const char* format, const char* mark) {
        ImGui::PushID(mark);
        form_row(label, tooltip);
        ImGui::DragFloat("##step", value, drag_speed(*value), least, most, format, ImGuiSliderFlags_AlwaysClamp);
        e.mark(mark);
        ImGui::PopID();
    };
    row("Move", "In scene units, usually metres", &e.view.snap_move, 1e-4f, 1e6f, "%.4g", "steps.move");
    row("Turn", "Of a rotation", &e.view.snap_angle, 0.1f, 180, "%.4g°", "steps.angle");
    row("Stretch", "Of the factor", &e.view.snap_scale, 1e-3f, 100, "%.4g×", "steps.scale");
    ImGui::EndPopup();
}

} // namespace

void Viewport::draw_toolbar(PanelContext& e) {
    const float scale = ImGui::GetStyle().FontScaleMain, margin = 6 * scale;
    ImGui::SetCursorPos({margin, ImGui::GetCursorPosY() + 4 * scale});
    // Items that do not fit wrap to the next line; `joined` ones are placed close together.
    const auto next = [&](float width, bool joined = false) {
        ImGui::SameLine(0, joined ? 2 * scale : -1);
        if (ImGui::GetContentRegionAvail().x >= width + margin) return;
        ImGui::NewLine();
        ImGui::SetCursorPosX(margin);
    };
    const auto button = [&](const char* id, const char* label, bool joined = false) {
        next(ImGui::CalcTextSize(label).x + 2 * ImGui::GetStyle().FramePadding.x, joined);
        action_button(e, id, label);
    };
    action_button(e, "view.gizmo_select", "Select");
    button("view.gizmo_move", "Move", true);
    button("view.gizmo_rotate", "Rotate", true);
    button("view.gizmo_scale", "Scale", true);
    button("view.local", e.view.local_axes ? "Local axes" : "World axes");
    next(ImGui::CalcTextSize("Steps").x + 2 * ImGui::GetStyle().FramePadding.x);
    if (ImGui::Button("Steps")) ImGui::OpenPopup("steps");
    tip("Step sizes of drags with Ctrl");
    e.mark("toolbar.steps");
    draw_steps(e);
    next(ImGui::CalcTextSize("Snap").x + 2 * ImGui::GetStyle().FramePadding.x, true);
    snap_button(e);
    button("view.collide", "Collide", true);
    const std::string missing = e.live().denoiser_missing();
    ImGui::BeginDisabled(!missing.empty());
    button("view.denoise", "Denoise");
    ImGui::EndDisabled();
    if (!missing.empty()) tip(("Not available: " + missing).c_str());
    const auto combo = [&](const char* id, int& now, std::span<const char* const> choices, float width,
                           const char* tooltip, const char* mark) {
        next(width * scale);
        ImGui::SetNextItemWidth(width * scale);
        const bool changed = ImGui::Combo(id, &now, choices.data(), int(choices.size()));
        tip(tooltip);
        e.mark(mark);
        return changed;
    };
    std::vector<const char*> layers;
    int layer = 0;
    for (const view::LayerChoice& choice : view::layer_choices()) {
        if (choice.name == e.view.display.layer) layer = int(layers.size());
        layers.push_back(choice.label);
    }
    if (combo("##layer", layer, layers, 96,
              "The displayed layer: the picture, first hits (clay, triangles, texture coordinates), the denoiser's "
              "guides, "
              "objects and materials by colour, samples, or the estimated error. A note in the picture explains it",
              "toolbar.layer"))
        e.view.display.layer = view::layer_choices()[std::size_t(layer)].name;
    next(84 * scale);
    ImGui::SetNextItemWidth(84 * scale);
    ImGui::DragFloat("##exposure", &e.view.display.exposure, 0.02f, -10, 10, "%+.1f EV");
    tip("Exposure of the view, in stops: +1 is twice as bright. Does not change files. Ctrl+click to type");
    e.mark("toolbar.exposure");
    scene::Development development = e.scene().film.value.development;
    next(88 * scale);
    ImGui::SetNextItemWidth(88 * scale);
    if (tone_combo(e, development, "toolbar.tone")) ask_development(e, development, "Tone curve");
}

// For the shown picture, not for the one being rendered.
std::string picture_note(const view::Frame& shown, const std::string& compiling, bool beside_camera) {
    const std::uint32_t samples = std::max(shown.image.samples, 1u);
    std::string text = fmt::format("{} × {}, {} sample{} per pixel", shown.image.width, shown.image.height, samples,
                                   samples == 1 ? "" : "s");
    if (shown.relative_error < 1) text += fmt::format(", error {:.1f} %", shown.relative_error * 100);
    if (shown.denoised) text += ", denoised";
    if (beside_camera) text += ", seen from beside the camera";
    if (!compiling.empty()) text += fmt::format("\n{} is being compiled; until then it is shown simplified", compiling);
    return text;
}

std::string selection_note(const SelectContext& e) {
    const Selection& selected = e.selection;
    const auto& ids = selected.instances();
    if (ids.empty()) return "";
    if (const auto link = selected_link(e)) {
        const scene::Group& group = e.scene().groups[link];
        const std::filesystem::path file = scene::link_source(group)->file;
        return fmt::format("{}: linked from {}", group.name, file.filename().string());
    }
    const Whole whole = selected.click_whole(e.scene(), selected.active());
    if (whole && ids.size() > 1 && selected.click_target(e.scene(), selected.active()).size() == ids.size()) {
        const scene::Group* group = whole.thing ? nullptr : e.scene().groups.find(whole.group);
        return fmt::format("{}: {} parts as one; a double click goes into it",
                           group ? group->name : e.scene().instances[selected.active()].name, ids.size());
    }
    std::string text = ids.size() == 1 ? e.scene().instances[ids[0]].name : fmt::format("{} objects", ids.size());
    if (selected.entered()) text += ", inside the whole; Esc leaves it";
    return text;
}

void Viewport::draw_status(PanelContext& e) {
    const float scale = ImGui::GetStyle().FontScaleMain;
    const ImVec2 end(corner.x + size.x, corner.y + size.y);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const view::ViewStatus status = e.live().status();
    std::string text;
    if (status.state == view::ViewState::failed)
        text = status.text;
    else if (drawn_ && !drawn_->clay)
        text = picture_note(*drawn_, status.compiling, e.views.now().has_value()) +
               (e.panel_state->mixing.shown() ? "\nA mix of the lights' own pictures" : "") +
               (e.panel_state->lights.any() ? "\nSome lights are muted in the view" : "") +
               (region.area ? "\nOnly the region is refined; Esc ends it" : "");
    if (const std::string selected = selection_note(e); !selected.empty() && status.state != view::ViewState::failed)
        text = selected + (text.empty() ? "" : "\n") + text;
    if (!text.empty() && (e.view.show_overlays || status.state == view::ViewState::failed)) {
        const float wrap = std::max(size.x - 20 * scale, 60.f);
        const ImVec2 extent = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
        const ImVec2 a(corner.x + 8 * scale, end.y - extent.y - 10 * scale);
        draw->AddRectFilled({a.x - 4 * scale, a.y - 3 * scale},
                            {a.x + extent.x + 4 * scale, a.y + extent.y + 3 * scale},
                            ImGui::GetColorU32(colors::over_picture), 3 * scale);
        draw->AddText(ImGui::GetFont(), ImGui::GetFontSize(), a,
                      ImGui::GetColorU32(status.state == view::ViewState::failed ? colors::error : colors::dim),
                      text.c_str(), nullptr, wrap);
        e.mark("picture.note", a, {a.x + extent.x, a.y + extent.y});
    }
}

void Viewport::draw_progress(PanelContext& e) {
    const view::ViewStatus status = e.live().status();
    const bool opening = e.opening().running();
    const bool waits = !opening && e.scene().instances.live() > 0 && status.state != view::ViewState::failed &&
                       (!drawn_ || (drawn_->clay && !drawn_->look));
    if (!opening && !waits) {
        most_compiling_ = 0;
        return;
    }
    const float scale = ImGui::GetStyle().FontScaleMain;
    ImGui::SetCursorScreenPos({corner.x + 12 * scale, corner.y + 12 * scale});
    ImGui::BeginChild("progress", {std::min(320 * scale, size.x - 24 * scale), 0},
                      ImGuiChildFlags_Borders | ImGuiChildFlags_AutoResizeY);
    if (opening) {
        ImGui::Text("Opening %s", e.opening().path().filename().string().c_str());
        ImGui::ProgressBar(e.opening().progress(), {-1, 0}, e.opening().stage().c_str());
        if (ImGui::Button("Cancel")) e.opening().cancel();
        e.mark("opening.cancel");
    } else if (status.compiling_left > 0) {
        most_compiling_ = std::max(most_compiling_, status.compiling_left);
        const std::size_t done = most_compiling_ - status.compiling_left;
        ImGui::Text("Compiling %zu shader%s", most_compiling_, most_compiling_ == 1 ? "" : "s");
        ImGui::ProgressBar(float(done) / float(most_compiling_), {-1, 0}, status.compiling.c_str());
    } else {
        // Unknown duration: an indeterminate bar. It need not move, as frames are drawn on events.
        ImGui::TextUnformatted(status.state == view::ViewState::starting ? "Starting the renderer"
                                                                         : "Preparing the scene");
        ImGui::ProgressBar(0, {-1, 0}, drawn_ ? "rendering the first picture" : "reading geometry and textures");
    }
    e.mark("progress");
    ImGui::EndChild();
}

void Viewport::draw_darkness(PanelContext& e) {
    if (e.opening().running() || e.scene().instances.live() == 0 || has_light(e)) return;
    const float scale = ImGui::GetStyle().FontScaleMain, width = std::min(340 * scale, size.x - 24 * scale);
    ImGui::SetCursorScreenPos({corner.x + (size.x - width) / 2, corner.y + size.y * 0.4f});
    ImGui::BeginChild("darkness", {width, 0}, ImGuiChildFlags_Borders | ImGuiChildFlags_AutoResizeY);
    ImGui::TextWrapped("Nothing emits light in this scene, so its picture is black.");
    if (ImGui::Button("Light it with a neutral studio", {-FLT_MIN, 0})) light_with_studio(e);
    tip("Soft grey light from all directions; in a closed room also a lamp at the camera");
    e.mark("viewport.studio");
    ImGui::EndChild();
}

float picture_label(PanelContext& e, ImVec2 place, const std::string& text, const std::string& mark) {
    const float scale = ImGui::GetStyle().FontScaleMain;
    const ImVec2 extent = ImGui::CalcTextSize(text.c_str()), lower(place.x - extent.x / 2, place.y);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled({lower.x - 5 * scale, lower.y - 2 * scale},
                        {lower.x + extent.x + 5 * scale, lower.y + extent.y + 2 * scale},
                        ImGui::GetColorU32(colors::over_picture), 3 * scale);
    draw->AddText(lower, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
    e.mark(mark, lower, {lower.x + extent.x, lower.y + extent.y});
    return extent.y + 6 * scale;
}

void Viewport::draw_hint(PanelContext& e) {
    if (e.preferences.hint_seen || !drawn_) return;
    if (navigation_ != Navigation::none || !e.selection.empty()) { // that is how
        e.preferences.hint_seen = true;
        return;
    }
    const bool blender = e.view.keys == KeyPreset::blender;
    const std::string text = fmt::format(
        "Click an object to select it; drag its handles to move it.\n"
        "{} rotates the view, {} shifts it, the wheel zooms.\n"
        "Ctrl+Z undoes anything; ? shows all keys.",
        blender ? "Middle drag" : "Alt + drag", blender ? "Shift + middle drag" : "middle drag");
    const float scale = ImGui::GetStyle().FontScaleMain, pad = 10 * scale;
    const float wrap = std::max(size.x - 6 * pad, 60.f);
    const ImVec2 extent = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
    const ImVec2 a(corner.x + (size.x - extent.x) / 2, corner.y + 3 * pad);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled({a.x - pad, a.y - pad}, {a.x + extent.x + pad, a.y + extent.y + pad},
                        ImGui::GetColorU32(colors::over_picture), 4 * scale);
    draw->AddRectFilled({a.x - pad, a.y - pad}, {a.x - pad + 3 * scale, a.y + extent.y + pad},
                        ImGui::GetColorU32(colors::accent), 2 * scale);
    draw->AddText(ImGui::GetFont(), ImGui::GetFontSize(), a, ImGui::GetColorU32(ImGuiCol_Text), text.c_str(), nullptr,
                  wrap);
    e.mark("hint", a);
}

void Viewport::draw_welcome(PanelContext& e, ImVec2 origin, ImVec2 space) {
    const float scale = ImGui::GetStyle().FontScaleMain, width = std::min(280 * scale, space.x - 20 * scale);
    const float line = ImGui::GetFrameHeightWithSpacing();
    const auto& files = e.files().recent.files();
    const std::size_t recent = std::min<std::size_t>(files.size(), 5);
    const float picture = 40 * scale;
    const float height =
        (recent ? 5.5f : 4.5f) * line + float(recent) * (picture + 2 * ImGui::GetStyle().ItemSpacing.y);
    ImGui::SetCursorScreenPos({origin.x + (space.x - width) / 2, origin.y + std::max(0.f, (space.y - height) / 2)});
    ImGui::BeginChild("welcome", {width, std::min(height, space.y)}, 0, ImGuiWindowFlags_NoBackground);
    ImGui::PushStyleColor(ImGuiCol_Text, colors::dim);
    ImGui::TextWrapped("Drop a scene or a model here, or");
    ImGui::PopStyleColor();
    for (const auto& [id, label] : {std::pair("file.open", "Open..."), {"file.new", "New scene"}}) {
        if (ImGui::Button(label, {-FLT_MIN, 0})) e.run(id);
        tip(find_action(id)->tooltip);
        e.mark(std::string("welcome.") + id);
    }
    if (const auto room = example_room(); !room.empty()) {
        if (ImGui::Button("Open the example room", {-FLT_MIN, 0})) e.open(room);
        tip("A furnished room to experiment with");
        e.mark("welcome.example");
    }
    if (recent) {
        ImGui::Spacing();
        ImGui::TextColored(colors::dim, "Recent");
        for (std::size_t i = 0; i < recent; ++i) {
            const std::filesystem::path path(files[i]);
            const ImVec2 at = ImGui::GetCursorPos();
            if (ImGui::Selectable(fmt::format("##recent {}", i).c_str(), false, 0, {0, picture})) e.open(path);
            tip(files[i].c_str());
            e.mark("welcome.recent." + path.filename().string());
            ImGui::SetCursorPos(at);
            draw_scene_picture(e, path, picture, "welcome.picture." + path.filename().string());
            ImGui::SameLine();
            ImGui::SetCursorPosY(at.y + (picture - ImGui::GetTextLineHeight()) / 2);
            ImGui::TextUnformatted(path.filename().string().c_str());
            ImGui::SetCursorPos({at.x, at.y + picture + ImGui::GetStyle().ItemSpacing.y});
            ImGui::Dummy({0, 0});
        }
    }
    ImGui::EndChild();
}

} // namespace restage::editor
