// SPDX-License-Identifier: Apache-2.0
// Statistics: what the scene holds, where the time of the live picture goes, and memory.
#include "panels.hpp"

#include "document/session.hpp"
#include "panel_context.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "view/live_view.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <fstream>
#include <string>

namespace restage::editor {

namespace {

std::string count_text(std::size_t n) { // with separators: 1,234,567
    std::string text = std::to_string(n);
    for (std::size_t i = text.size(); i > 3;)
        text.insert(i -= 3, ",");
    return text;
}

std::string bytes_text(std::size_t bytes) { return fmt::format("{:.1f} MiB", double(bytes) / (1024 * 1024)); }

std::string time_text(double seconds) {
    return seconds <= 0  ? "-"
           : seconds < 1 ? fmt::format("{:.1f} ms", seconds * 1e3)
                         : fmt::format("{:.2f} s", seconds);
}

// Of this process, as Linux reports it [byte]; 0 where it does not.
std::size_t resident_bytes() {
    std::ifstream file("/proc/self/status");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("VmRSS:")) return std::stoull(line.substr(6)) * 1024;
    return 0;
}

void heading(const char* text) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextColored(colors::accent, "%s", text);
    ImGui::TableNextColumn();
}

void line(PanelUi& e, const char* what, const std::string& value) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextColored(colors::dim, "%s", what);
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", value.c_str());
    e.mark(std::string("statistics.") + what);
}

bool begin_part(const char* id) {
    ImGui::TableNextColumn();
    if (!ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingFixedFit)) return false;
    ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthFixed);
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
    return true;
}

void scene_part(DocumentContext& e) {
    StatisticsState& state = e.panel_state->statistics;
    const scene::Scene& s = e.scene();
    if (state.made_for != s.clock) {
        state.made_for = s.clock;
        state.scene = scene::statistics_of(s);
    }
    const scene::Statistics& n = state.scene;
    heading("Scene");
    line(e, "Objects", count_text(n.objects) + (n.hidden ? ", " + count_text(n.hidden) + " hidden" : ""));
    line(e, "Groups", count_text(s.groups.live()));
    line(e, "Triangles", count_text(n.triangles));
    line(e, "With copies", count_text(n.instanced));
    line(e, "Meshes", count_text(s.meshes.live()));
    line(e, "Materials", count_text(s.materials.live()));
    line(e, "Textures", count_text(s.textures.live()));
    line(e, "Lights", count_text(s.lights.live()));
}

void picture_part(PanelUi& e, const PictureView& picture) {
    const view::ViewStatus status = picture.live().status();
    const auto frame = picture.live().frame(), clean = picture.live().denoised();
    heading("Picture");
    line(e, "Tracer", status.tracer.empty() ? "-" : status.tracer + " on " + status.device);
    if (frame)
        line(e, "Size",
             fmt::format("{} × {}, {} samples", frame->image.width, frame->image.height, frame->image.samples));
    line(e, "Speed", fmt::format("{:.2f} million samples/s", status.samples_per_second * 1e-6));
    line(e, "Since the change", time_text(frame ? frame->seconds : 0));
    line(e, "Scene update", time_text(status.update_seconds));
    line(e, "One sample", time_text(status.sample_seconds));
    line(e, "Denoising", time_text(clean ? clean->denoise_seconds : 0));
}

void memory_part(DocumentContext& e, const PictureView& picture) {
    const scene::Statistics& n = e.panel_state->statistics.scene;
    heading("Memory");
    line(e, "Geometry", bytes_text(n.geometry_bytes));
    line(e, "Images", bytes_text(n.pixel_bytes));
    line(e, "On the device", bytes_text(picture.live().status().gpu_bytes));
    line(e, "History", bytes_text(e.session().history().bytes()));
    if (const std::size_t all = resident_bytes()) line(e, "This program", bytes_text(all));
}

} // namespace

void draw_statistics(DocumentContext& e, const PictureView& picture) {
    const float scale = ImGui::GetStyle().FontScaleMain, width = ImGui::GetContentRegionAvail().x;
    const int columns = width > 690 * scale ? 3 : width > 460 * scale ? 2 : 1;
    if (!ImGui::BeginTable("parts", columns, ImGuiTableFlags_SizingStretchSame | ImGuiTableFlags_ScrollY)) return;
    if (begin_part("scene")) {
        scene_part(e);
        ImGui::EndTable();
    }
    if (begin_part("picture")) {
        picture_part(e, picture);
        ImGui::EndTable();
    }
    if (begin_part("memory")) {
        memory_part(e, picture);
        ImGui::EndTable();
    }
    ImGui::EndTable();
}

} // namespace restage::editor
