// SPDX-License-Identifier: Apache-2.0
// The dialog of final pictures.
#include "document/looks.hpp"
#include "document/session.hpp"
#include "file_browser.hpp"
#include "files.hpp"
#include "final_pictures.hpp"
#include "panel_context.hpp"
#include "plugin/registry.hpp"
#include "saving.hpp"
#include "widgets.hpp"

#include <imgui.h>
#include <algorithm>
#include <memory>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

constexpr int most_frames = 100000;

// Rows for a camera that moves.
void camera_move(PanelUi& e, FinalWish& wish, std::size_t cameras) {
    struct Choice {
        CameraMove move;
        const char *label, *mark, *tooltip;
    };
    constexpr Choice choices[] = {
        {CameraMove::none, "None", "final.move.none", "A picture"},
        {CameraMove::turntable, "Turntable", "final.move.turntable", "One turn around the scene"},
        {CameraMove::path, "Through all cameras", "final.move.path",
         "From camera to camera, bookmarks included, in the Outliner's order; each stretch takes equally long"}};
    form_row("Camera move", "A series of numbered pictures, or a video of them");
    const char* shown = choices[int(wish.move)].label;
    const bool open = ImGui::BeginCombo("##move", shown);
    e.mark("final.move");
    if (open) {
        for (const Choice& choice : choices) {
            const bool possible = choice.move != CameraMove::path || cameras > 1;
            if (ImGui::Selectable(choice.label, wish.move == choice.move, possible ? 0 : ImGuiSelectableFlags_Disabled))
                wish.move = choice.move;
            tip(possible ? choice.tooltip : "It needs two cameras: bookmark a view (B)");
            e.mark(choice.mark);
        }
        ImGui::EndCombo();
    }
    if (wish.move == CameraMove::none) return;
    int frames = int(wish.frames);
    form_row("Pictures", "Of the whole move: a video of 2 seconds has 48 at 24 a second");
    if (ImGui::DragInt("##frames", &frames, 1, 2, most_frames, "%d", ImGuiSliderFlags_AlwaysClamp))
        wish.frames = std::uint32_t(frames);
    e.mark("final.frames");
    form_row("A second", "Of a video: choose a file that ends in .mp4, .webm, .mov or .gif. It needs ffmpeg");
    ImGui::DragFloat("##fps", &wish.fps, 0.1f, 1, 240, "%.4g pictures", ImGuiSliderFlags_AlwaysClamp);
    e.mark("final.fps");
}

std::vector<FileFilter> filters_of(const FinalWish& wish) {
    if (wish.move == CameraMove::none) return {{"Pictures", {"exr", "png", "hdr", "pfm"}}, {"All files", {}}};
    return {{"Pictures and videos", {"png", "exr", "mp4", "webm", "mov", "gif"}}, {"All files", {}}};
}
const char* extension_of(const FinalWish& wish) { return wish.move == CameraMove::none ? ".exr" : ".png"; }

} // namespace

void final_render_dialog(PanelContext& e) {
    auto wish = std::make_shared<FinalWish>();
    wish->samples = std::max(e.scene().settings.value.samples, 1u);
    wish->denoise = !e.registry().denoisers().empty();
    wish->denoiser = e.preferences.denoiser;
    e.show_modal("Final picture", [wish](PanelContext& editor) {
        const scene::Film& film = editor.scene().film.value;
        dialog_width(360);
        form_row("Size", "The picture's size: change it in the Scene panel, under Picture");
        ImGui::Text("%u × %u pixels", film.width, film.height);
        if (editor.views.now()) {
            form_row("From", "The viewpoint: the current view, or the scene's camera");
            if (ImGui::RadioButton("View", wish->from_view)) wish->from_view = true;
            editor.mark("final.view");
            ImGui::SameLine();
            if (ImGui::RadioButton("Camera", !wish->from_view)) wish->from_view = false;
            editor.mark("final.camera");
        }
        const std::size_t looks = editor.session().looks().list.size(), cameras = editor.scene().cameras.live();
        if (looks > 0) {
            form_row("Every look", "One picture of each look, with its name in the file's");
            ImGui::Checkbox("##looks", &wish->all_looks);
            editor.mark("final.looks");
        }
        if (cameras > 1 && wish->move != CameraMove::path) {
            form_row("Every camera", "One picture from each camera and bookmark, with its name in the file's");
            ImGui::Checkbox("##cameras", &wish->all_cameras);
            editor.mark("final.cameras");
        }
        camera_move(editor, *wish, cameras);
        int samples = int(wish->samples);
        form_row("Samples", "Light paths per pixel: twice as many take twice the time and leave 0.7 of the noise");
        if (ImGui::DragInt("##samples", &samples, 1, 1, 1 << 20, "%d a pixel", ImGuiSliderFlags_AlwaysClamp))
            wish->samples = std::uint32_t(samples);
        editor.mark("final.samples");
        float percent = wish->error * 100;
        form_row("Stop at error", "Stop at this noise: the estimated relative error before denoising. 0 = no target");
        if (ImGui::DragFloat("##error", &percent, 0.05f, 0, 100, percent > 0 ? "%.2f %%" : "No target"))
            wish->error = percent / 100;
        editor.mark("final.error");
        form_row("Denoise", "Removes the remaining noise, in high quality; in an EXR the raw picture is kept as well");
        ImGui::BeginDisabled(editor.registry().denoisers().empty());
        ImGui::Checkbox("##denoise", &wish->denoise);
        editor.mark("final.denoise");
        ImGui::EndDisabled();
        empty_note("It renders in the background while you continue editing; the live picture is paused meanwhile.");
        ImGui::Spacing();
        bool stay = true;
        if (ImGui::Button("Choose where...")) {
            stay = false;
            const fs::path path(editor.session().path());
            const fs::path& last = editor.files().last_picture;
            browse(editor, {.title = "Final picture as",
                            .save = true,
                            .filters = filters_of(*wish),
                            .start = !last.empty()  ? last.parent_path()
                                     : path.empty() ? fs::path()
                                                    : path.parent_path(),
                            .name = (path.empty() ? "untitled" : path.stem().string()) + extension_of(*wish),
                            .extension = extension_of(*wish),
                            .done = [wish](PanelContext& ed, const fs::path& place) {
                                wish->path = place;
                                start_final_pictures(ed, *wish);
                            }});
        }
        editor.mark("final.choose");
        ImGui::SameLine();
        if (ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGuiKey_Escape, false)) stay = false;
        editor.mark("final.cancel");
        return stay;
    });
}

} // namespace restage::editor
