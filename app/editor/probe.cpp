// SPDX-License-Identifier: Apache-2.0
// Editor::probe(): state for tests that control the program with real mouse and key events; and commands for things
// that mouse and keys cannot do.
#include "document/session.hpp"
#include "editor.hpp"
#include "files.hpp"
#include "opening.hpp"
#include "view/live_view.hpp"

#include <imgui_internal.h>
#include <charconv>
#include <nlohmann/json.hpp>
#include <sstream>

namespace restage::editor {

std::string Editor::probe() const {
    using nlohmann::json;
    json j;
    const auto& history = session_->history();
    j["path"] = session_->path();
    j["base"] = session_->base().file;
    j["modified"] = session_->modified();
    j["recovery"] = files_->autosave.file().string();
    j["jobs"] = files_->jobs.running();
    j["job"] = files_->jobs.progress();
    j["modal"] = modals_.empty() ? "" : modals_.front().title;
    j["version"] = session_->version();
    j["opening"] = opening_->running();
    j["history"] = {{"size", history.size()}, {"position", history.position()}, {"undo", history.undo_label()}};
    for (std::size_t i = 0; i < history.size(); ++i)
        j["history"]["labels"].push_back(history.label(i));
    std::size_t hidden = 0;
    scene().instances.each([&](InstanceId, const scene::Instance& instance) { hidden += instance.hidden; });
    j["counts"] = {{"hidden", hidden},
                   {"groups", scene().groups.live()},
                   {"images", scene().images.live()},
                   {"instances", scene().instances.live()},
                   {"materials", scene().materials.live()},
                   {"textures", scene().textures.live()},
                   {"lights", scene().lights.live()}};
    j["selection"] = json::array();
    j["selected"] = selection.instances().size();
    for (const InstanceId id : selection.instances()) {
        const scene::Instance* instance = scene().instances.find(id);
        if (!instance) continue;
        if (j["selection"].size() >= 100) break; // enough for any test, and fast to write
        const scene::Bounds box = scene::world_bounds(scene(), id);
        const glm::dvec3 p(instance->object_to_world[3]);
        const scene::Material* material = scene().materials.find(instance->material);
        j["selection"].push_back({{"id", id.value},
                                  {"name", instance->name},
                                  {"position", {p.x, p.y, p.z}},
                                  {"lower", {box.lower.x, box.lower.y, box.lower.z}},
                                  {"upper", {box.upper.x, box.upper.y, box.upper.z}},
                                  {"material", material ? material->name : ""},
                                  {"type", material ? material->type : ""}});
    }
    if (const scene::Instance* active = scene().instances.find(selection.active()))
        if (const scene::Material* material = scene().materials.find(active->material))
            for (const auto& [name, value] : material->params.entries()) {
                const scene::Texture* texture = scene().textures.find(value.texture);
                j["material"][name] = {
                    {"value", value.is_whole() ? std::array{value.scalar(), 0.f, 0.f, 0.f} : value.v},
                    {"text", value.text},
                    {"texture", texture ? texture->name : ""}};
            }
    const auto& sky = scene().environment.value;
    j["sky"] = sky ? sky->name : "";
    if (sky) {
        const glm::dvec3 x(sky->light_to_world[0]);
        j["sky_x"] = {x.x, x.y, x.z}; // direction of its x axis
        for (const auto& [name, value] : sky->sky_params.entries())
            j["sky_values"][name] = value.scalar();
    }
    const glm::dvec3 eye(camera().camera_to_world[3]);
    j["camera"] = {eye.x, eye.y, eye.z};
    const glm::dvec3 camera_eye(scene_camera().camera_to_world[3]);
    j["scene_camera"] = {camera_eye.x, camera_eye.y, camera_eye.z};
    j["views"] = {{"apart", views.now().has_value()}, {"back", views.can_back()}, {"forward", views.can_forward()}};
    const view::ViewStatus status = live_->status();
    const auto frame = live_->frame(), clean = live_->denoised();
    j["view"] = {{"state", int(status.state)},
                 {"text", status.text},
                 {"current", status.current},
                 {"compiling", status.compiling},
                 {"samples", status.samples},
                 {"divider", status.divider},
                 {"asked", asked_.version},
                 {"request", frame ? frame->request : 0},
                 {"seconds", frame ? frame->seconds : 0.0},
                 {"denoised_request", clean ? clean->request : 0},
                 {"denoised_samples",
                  clean && frame && clean->request == frame->request && clean->divider == 1 ? clean->image.samples : 0},
                 {"first_clean_request", latency_.clean_request},
                 {"first_clean_seconds", latency_.clean_seconds},
                 {"denoiser", clean ? clean->denoiser : ""},
                 {"denoiser_missing", live_->denoiser_missing()},
                 {"denoised_seconds", clean ? clean->seconds : 0.0},
                 {"hovered", hovered.value}};
    if (const ImGuiInputTextState* input = ImGui::GetInputTextState(ImGui::GetActiveID()))
        j["typing"] = std::string(input->TextSrc, std::size_t(input->TextLen)); // the text field that has the keyboard
    j["latency"] = {{"count", latency_.count},
                    {"nframes", ImGui::GetFrameCount()},
                    {"pixels", latency_.pixels},
                    {"frames", latency_.frames}};
    for (const auto& [name, mark] : marks_.all())
        j["marks"][name] = {mark.x0, mark.y0, mark.x1, mark.y1};
    for (const auto& line : notices.lines())
        j["log"].push_back(line.text);
    return j.dump(-1, ' ', false, json::error_handler_t::replace);
}

// One per line: "drop PATH X Y", as if dropped there by a file manager.
void Editor::run_commands(const std::string& lines) {
    std::istringstream in(lines);
    for (std::string line; std::getline(in, line);) {
        const std::size_t y = line.rfind(' '), x = y == 0 || y == std::string::npos ? y : line.rfind(' ', y - 1);
        if (!line.starts_with("drop ") || x == std::string::npos || x < 5) {
            log_.warning("probe: \"" + line + "\" is not a command");
            continue;
        }
        const auto number = [&](std::size_t at) {
            float value = 0;
            std::from_chars(line.data() + at + 1, line.data() + line.size(), value);
            return value;
        };
        drop({line.substr(5, x - 5)}, {number(x), number(y)});
    }
}

} // namespace restage::editor
