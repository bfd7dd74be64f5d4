// SPDX-License-Identifier: Apache-2.0
// Scene panel, camera and film: the viewpoint and the picture's size.
#include "scene_panel.hpp"

#include "actions.hpp"
#include "pick_tool.hpp"
#include "query/navigation.hpp"
#include "query/raycast.hpp"
#include "scene/edits.hpp"
#include "scene/projection.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "view/live_view.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>

namespace restage::editor {

namespace {

// A lens has a focal length only with a film of known size: 24 mm for the shorter side, as in 35 mm photography, and a
// scene unit of one metre.
double focal_length(const scene::Camera& camera) {
    return 0.012 / std::tan(glm::radians(double(camera.fov)) / 2);
} // [m]

struct Size {
    const char* label;
    std::uint32_t width, height;
};
constexpr Size sizes[] = {{"640 × 360", 640, 360},
                          {"960 × 540", 960, 540},
                          {"1280 × 720 (HD)", 1280, 720},
                          {"1920 × 1080 (Full HD)", 1920, 1080},
                          {"2560 × 1440", 2560, 1440},
                          {"3840 × 2160 (4K)", 3840, 2160},
                          {"1024 × 1024 (square)", 1024, 1024},
                          {"1080 × 1920 (upright)", 1080, 1920},
                          {"2480 × 3508 (A4, 300 dpi)", 2480, 3508}};

void ask_film(EditContext& e, const scene::Film& film, const char* label, const char* gesture) {
    e.edit(
        [film, label](const scene::Scene& s) {
            scene::Edit edit = scene::set_film(s, film, label);
            const scene::Film& before = s.film.value;
            const bool other_shape =
                std::uint64_t(before.width) * film.height != std::uint64_t(film.width) * before.height;
            // A screen window or aspect from the file, meant for its own shape, would stretch the picture.
            if (const scene::Camera* camera = s.cameras.find(s.active_camera.value);
                other_shape && camera && (camera->screen_window || camera->frame_aspect != 0)) {
                scene::Camera fitted = *camera;
                fitted.frame_aspect = 0;
                fitted.screen_window.reset();
                if (camera->projection == scene::Projection::orthographic &&
                    camera->screen_window) { // it also determines the scale
                    const glm::vec4 w = *camera->screen_window;
                    const float middle = (w.x + w.y) / 2,
                                half = (w.w - w.z) / 2 * float(film.width) / float(film.height);
                    fitted.screen_window = glm::vec4(middle - half, middle + half, w.z, w.w);
                }
                edit.changes.push_back(scene::Change<scene::Camera>{s.active_camera.value, *camera, fitted});
            }
            return Result<scene::Edit>(std::move(edit));
        },
        gesture);
}

void filter_rows(EditContext& e, scene::Film film) {
    static constexpr const char* kinds[] = {"Box", "Triangle", "Gaussian", "Mitchell", "Sinc"};
    int kind = int(film.filter.kind);
    form_row("Pixel filter",
             "How samples are combined into pixels: wide filters are softer, Mitchell and Sinc sharper");
    if (ImGui::Combo("##filter", &kind, kinds, IM_ARRAYSIZE(kinds))) {
        // pbrt-v4's defaults.
        static constexpr scene::Filter defaults[] = {{scene::FilterKind::box, {0.5f, 0.5f}, {0, 0}},
                                                     {scene::FilterKind::triangle, {2, 2}, {0, 0}},
                                                     {scene::FilterKind::gaussian, {1.5f, 1.5f}, {0.5f, 0}},
                                                     {scene::FilterKind::mitchell, {2, 2}, {1.f / 3, 1.f / 3}},
                                                     {scene::FilterKind::sinc, {4, 4}, {3, 0}}};
        film.filter = defaults[kind];
        ask_film(e, film, "Pixel filter", "");
    }
    e.mark("film.filter");
    form_row("Filter radius", "Horizontal and vertical");
    bool changed =
        ImGui::SliderFloat2("##radius", &film.filter.radius.x, 0.5f, 5, "%.2f px", ImGuiSliderFlags_AlwaysClamp);
    e.mark("film.filter_radius");
    if (film.filter.kind == scene::FilterKind::gaussian) {
        form_row("Filter width", "Standard deviation of the Gaussian (sigma)");
        changed |=
            ImGui::SliderFloat("##sigma", &film.filter.params.x, 0.1f, 3, "%.2f px", ImGuiSliderFlags_AlwaysClamp);
        e.mark("film.sigma");
    } else if (film.filter.kind == scene::FilterKind::mitchell) {
        form_row("Blur, ringing", "Mitchell and Netravali's B and C");
        changed |= ImGui::SliderFloat2("##bc", &film.filter.params.x, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    } else if (film.filter.kind == scene::FilterKind::sinc) {
        form_row("Cycles", "Of the window around the sinc (tau)");
        changed |= ImGui::SliderFloat("##tau", &film.filter.params.x, 1, 8, "%.1f", ImGuiSliderFlags_AlwaysClamp);
    }
    if (changed) ask_film(e, film, "Pixel filter", "film.filter");
}

void ask_camera(EditContext& e, const scene::Camera& camera) {
    e.edit([camera](
               const scene::Scene& s) { return scene::set_camera(s, s.active_camera.value, camera, "Change camera"); },
           "scene.camera");
}

// Its projection and field of view. Returns true if changed.
bool projection_rows(DocumentContext& e, scene::Camera& camera) {
    static constexpr const char* kinds[] = {"Perspective", "Orthographic", "Panorama", "Panorama, equal areas"};
    form_row("Projection", "The projection: perspective, parallel, or a full panorama");
    int kind = int(camera.projection);
    bool changed = ImGui::Combo("##projection", &kind, kinds, IM_ARRAYSIZE(kinds));
    if (changed) {
        const bool was_parallel = camera.projection == scene::Projection::orthographic;
        // Keeps the size of things in the middle of the picture.
        const query::ViewRay ray = query::view_ray(camera, {0.5, 0.5}, e.film_aspect());
        const auto hits = query::raycast_all(e.scene(), ray.origin, ray.direction);
        const double distance = hits.empty() ? 1 : hits[0].t;
        camera.projection = scene::Projection(kind);
        if (was_parallel) camera.screen_window.reset();
        if (camera.projection == scene::Projection::orthographic) {
            scene::Camera perspective = camera;
            perspective.projection = scene::Projection::perspective;
            camera.screen_window = glm::vec4(scene::film_window(perspective, e.film_aspect()) * distance);
        }
    }
    e.mark("camera.projection");
    if (scene::is_spherical(camera)) {
        empty_note("Shows all directions. Handles are off, as they would be curved.");
    } else if (camera.projection == scene::Projection::orthographic) {
        glm::vec4 window(scene::film_window(camera, e.film_aspect()));
        form_row("Height", "Visible height of the world, from the picture's lower to its upper edge");
        float height = window.w - window.z;
        if (ImGui::DragFloat("##height", &height, drag_speed(height, 1e-3f), 1e-6f, 1e9f, "%.3f units",
                             ImGuiSliderFlags_AlwaysClamp)) {
            camera.screen_window = window * (height / (window.w - window.z));
            changed = true;
        }
        e.mark("camera.height");
    } else {
        form_row("Field of view", "Along the picture's shorter side: small = telephoto, large = wide angle");
        changed |= ImGui::SliderFloat("##fov", &camera.fov, 1, 150, "%.1f°", ImGuiSliderFlags_AlwaysClamp);
        tip(fmt::format("Equivalent to a {:.0f} mm lens on a 35 mm camera", focal_length(camera) * 1000).c_str());
        e.mark("camera.fov");
    }
    return changed;
}

} // namespace

void camera_section(SelectContext& e) {
    const bool open = section_header("Camera", true);
    e.mark("scene.camera");
    if (!open) return;
    if (!e.camera_id()) {
        empty_note("The scene has no camera.");
        return;
    }
    ImGui::PushID("camera");
    if (e.scene().cameras.live() > 1) {
        form_row("Look through", "One of the scene's cameras");
        if (ImGui::BeginCombo("##active", e.scene_camera().name.c_str())) {
            e.scene().cameras.each([&](scene::Id<scene::Camera> id, const scene::Camera& c) {
                if (ImGui::Selectable(fmt::format("{}##{}", c.name, id.value).c_str(), id == e.camera_id()))
                    e.edit([id](const scene::Scene& s) { return scene::set_active_camera(s, id); });
            });
            ImGui::EndCombo();
        }
        e.mark("camera.active");
    }
    if (e.views.now()) {
        action_button(e, "view.set_camera");
        ImGui::SameLine();
        action_button(e, "view.camera", "Look through it");
    }
    scene::Camera camera = e.scene_camera();
    bool changed = projection_rows(e, camera);
    if (scene::is_spherical(camera)) {
        if (changed) ask_camera(e, camera);
        ImGui::PopID();
        return; // it has no lens
    }
    form_row("Depth of field", "Blurs objects nearer or farther than the focus distance, as a real lens does");
    if (bool blur = camera.lens_radius > 0; ImGui::Checkbox("##dof", &blur)) {
        camera.lens_radius = blur ? float(focal_length(camera) / (2 * 2.8)) : 0;
        // Pinhole cameras come with a focus somewhere: the middle of the picture is a better start.
        const query::ViewRay ray = query::view_ray(camera, {0.5, 0.5}, e.film_aspect());
        if (const auto hits = query::raycast_all(e.scene(), ray.origin, ray.direction);
            blur && !hits.empty() && double(camera.focal_distance) > 10 * hits[0].t)
            camera.focal_distance = float(hits[0].t);
        changed = true;
    }
    e.mark("camera.dof");
    if (camera.lens_radius > 0) {
        form_row("Aperture", "Of the lens (f-number): small = more blur. Assumes 1 scene unit = 1 m and 35 mm film");
        auto f_number = float(focal_length(camera) / (2 * double(camera.lens_radius)));
        if (ImGui::DragFloat("##fnumber", &f_number, drag_speed(f_number, 0.01f), 0.01f, 1000, "f/%.2f",
                             ImGuiSliderFlags_AlwaysClamp)) {
            camera.lens_radius = float(focal_length(camera) / (2 * double(f_number)));
            changed = true;
        }
        e.mark("camera.fnumber");
        form_row("Lens radius", "The aperture in scene units, as stored in the file");
        changed |= ImGui::DragFloat("##lens", &camera.lens_radius, drag_speed(camera.lens_radius, 1e-5f), 1e-6f, 1e6f,
                                    "%.5f units", ImGuiSliderFlags_AlwaysClamp);
        e.mark("camera.lens");
    }
    form_row("Focus distance", "Objects at this distance along the view are sharp",
             ImGui::CalcTextSize("Pick").x + 2 * ImGui::GetStyle().FramePadding.x);
    changed |=
        ImGui::DragFloat("##focus", &camera.focal_distance, drag_speed(camera.focal_distance, 1e-3f), 1e-4f, 1e9f,
                         camera.focal_distance < 1e4f ? "%.3f units" : "%.0f units", ImGuiSliderFlags_AlwaysClamp);
    e.mark("camera.focus");
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    if (ImGui::Button("Pick")) e.pick_tool = focus_picker();
    tip("Then click the object in the picture that should be sharp");
    e.mark("camera.pick_focus");
    if (changed) ask_camera(e, camera);
    ImGui::PopID();
}

void film_section(EditContext& e) {
    const bool open = section_header("Picture");
    e.mark("scene.film");
    if (!open) return;
    ImGui::PushID("film");
    scene::Film film = e.scene().film.value;
    const std::string now = fmt::format("{} × {}", film.width, film.height);
    form_row("Size", "Size of the final picture, in pixels; the live one has its shape");
    if (ImGui::BeginCombo("##preset", now.c_str())) {
        for (const Size& size : sizes) {
            if (ImGui::Selectable(size.label, size.width == film.width && size.height == film.height)) {
                film.width = size.width;
                film.height = size.height;
                ask_film(e, film, "Picture size", "");
            }
            e.mark(fmt::format("film.size.{}x{}", size.width, size.height));
        }
        ImGui::EndCombo();
    }
    e.mark("film.size");
    int wh[2] = {int(film.width), int(film.height)};
    bool& keep = e.panel_state->scene.keep_aspect;
    form_row("Width, height", "Of the final picture", ImGui::GetFrameHeight());
    ImGui::DragInt2("##wh", wh, 2, 16, 16384, "%d px", ImGuiSliderFlags_AlwaysClamp);
    e.mark("film.wh");
    if (!ImGui::IsItemActive())
        e.panel_state->scene.aspect = e.film_aspect(); // from the start of a drag, as rounding would add up
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    if (icon_button(
            "##aspect", keep ? Icon::lock : Icon::lock_open, keep,
            keep ? "The shape is kept. Click to change width and height separately" : "Click to keep the shape"))
        keep = !keep;
    e.mark("film.keep_aspect");
    const double aspect = e.panel_state->scene.aspect;
    const bool by_width = wh[0] != int(film.width), by_height = wh[1] != int(film.height);
    if (keep && by_width)
        wh[1] = std::max(16, int(std::lround(wh[0] / aspect)));
    else if (keep && by_height)
        wh[0] = std::max(16, int(std::lround(wh[1] * aspect)));
    if (by_width || by_height) {
        film.width = std::uint32_t(wh[0]);
        film.height = std::uint32_t(wh[1]);
        ask_film(e, film, "Picture size", "film.size");
    }
    form_row("Exposure",
             "Brightness of written pictures and of the live one, which also has its own exposure above it");
    if (ImGui::DragFloat("##exposure", &film.exposure, drag_speed(film.exposure, 1e-3f), 1e-6f, 1e6f, "%.4g×",
                         ImGuiSliderFlags_AlwaysClamp))
        ask_film(e, film, "Exposure", "film.exposure");
    e.mark("film.exposure");
    filter_rows(e, film);
    ImGui::PopID();
}

} // namespace restage::editor
