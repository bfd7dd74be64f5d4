// SPDX-License-Identifier: Apache-2.0
// Navigation by mouse and WASD: of the view, or of the camera if it is not locked. Every gesture is one step of its
// history.
#include "panel_context.hpp"
#include "query/navigation.hpp"
#include "viewport.hpp"

#include <ImGuizmo.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>

namespace restage::editor {

// --------------------------------------------------------------------------------------------------------

glm::dvec3 Viewport::pivot(const PanelContext& e) const {
    if (orbit_center_) return *orbit_center_;
    const scene::Bounds chosen = e.selection.bounds(e.scene());
    if (!chosen.empty()) return chosen.center();
    // The point in the middle of the picture; else a point in the scene.
    const query::ViewRay ray = query::view_ray(e.camera(), {0.5, 0.5}, e.film_aspect());
    if (drawn_ && !drawn_->image.depth.empty()) {
        const auto& image = drawn_->image;
        const float depth = image.depth[std::size_t(image.height / 2) * image.width + image.width / 2];
        if (depth > 0 && std::isfinite(depth)) return ray.origin + glm::normalize(ray.direction) * double(depth);
    }
    const scene::Bounds all = scene::world_bounds(e.scene());
    return ray.origin + glm::normalize(ray.direction) * (all.empty() ? 1.0 : all.radius());
}

void Viewport::set_camera(PanelContext& e, const scene::Camera& camera, const char* gesture) {
    e.look_from(camera.camera_to_world, gesture);
}

void Viewport::navigate(PanelContext& e, bool over) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool alt = io.KeyAlt && !ImGuizmo::IsUsing() && !ImGuizmo::IsOver();
    if (over && navigation_ == Navigation::none) {
        if (ImGui::IsMouseClicked(ImGuiMouseButton_Middle))
            navigation_ = e.view.keys == KeyPreset::blender && !io.KeyShift ? Navigation::orbit : Navigation::pan;
        else if (ImGui::IsMouseClicked(ImGuiMouseButton_Right))
            navigation_ = alt ? Navigation::dolly : Navigation::fly;
        else if (ImGui::IsMouseClicked(ImGuiMouseButton_Left) && alt && !on_knob_)
            navigation_ = Navigation::orbit; // wherever it begins: navigation changes nothing. On handles Alt lifts
    }
    const bool held = ImGui::IsMouseDown(ImGuiMouseButton_Left) || ImGui::IsMouseDown(ImGuiMouseButton_Middle) ||
                      ImGui::IsMouseDown(ImGuiMouseButton_Right);
    if (navigation_ != Navigation::none && !held) {
        navigation_ = Navigation::none;
        e.end_gesture();
    }

    const double aspect = e.film_aspect();
    scene::Camera camera = e.camera();
    const glm::dvec2 delta(io.MouseDelta.x / size.y, io.MouseDelta.y / size.y); // of the picture's height
    const bool moved = delta.x != 0 || delta.y != 0;
    // The world turns with the mouse, so the camera moves the opposite way. Mirrored cameras reverse this.
    const bool mirrored = glm::determinant(glm::dmat3(camera.camera_to_world)) < 0;
    const double turn = mirrored ? -3.0 : 3.0; // [rad] per picture height
    switch (navigation_) {
        case Navigation::none:
            break;
        case Navigation::orbit:
            if (moved) {
                query::orbit(camera, pivot(e), e.up(), {delta.x * turn, -delta.y * 3.0});
                set_camera(e, camera, "navigate");
            }
            break;
        case Navigation::pan:
            if (moved) {
                const double distance = glm::length(pivot(e) - glm::dvec3(camera.camera_to_world[3]));
                query::pan(camera, delta, std::max(distance, 1e-6), aspect);
                set_camera(e, camera, "navigate");
            }
            break;
        case Navigation::dolly:
            if (moved) {
                query::dolly(camera, pivot(e), std::clamp((delta.x + delta.y) * 2.0, -0.9, 0.9));
                set_camera(e, camera, "navigate");
            }
            break;
        case Navigation::fly: {
            if (io.MouseWheel != 0)
                e.view.fly_speed = std::clamp(e.view.fly_speed * std::pow(1.25f, io.MouseWheel), 0.01f, 100.f);
            if (moved) query::look(camera, e.up(), {-delta.x * turn * 0.5, -delta.y * 1.5});
            glm::dvec3 go(0);
            const auto key = [](ImGuiKey k) { return ImGui::IsKeyDown(k) ? 1.0 : 0.0; };
            go.x = key(ImGuiKey_D) - key(ImGuiKey_A);
            go.y = key(ImGuiKey_E) - key(ImGuiKey_Q);
            go.z = key(ImGuiKey_W) - key(ImGuiKey_S);
            const double radius = std::max(scene::world_bounds(e.scene()).radius(), 1e-6);
            const double speed = radius * 0.25 * e.view.fly_speed * (io.KeyShift ? 4 : 1); // a second
            if (go != glm::dvec3(0)) query::translate_local(camera, go * speed * double(std::min(io.DeltaTime, 0.1f)));
            if (moved || go != glm::dvec3(0)) set_camera(e, camera, "navigate");
            break;
        }
    }

    if (over && io.MouseWheel != 0 && navigation_ == Navigation::none) {
        // Towards the point under the mouse.
        const query::ViewRay ray = query::view_ray(camera, film_point(io.MousePos), aspect);
        double distance = glm::length(pivot(e) - ray.origin);
        if (const InstanceId id = instance_at(e, io.MousePos); id && drawn_) {
            const glm::dvec2 p = film_point(io.MousePos);
            const auto& image = drawn_->image;
            const float depth =
                image.depth[std::size_t(p.y * image.height) * image.width + std::size_t(p.x * image.width)];
            if (depth > 0 && std::isfinite(depth)) distance = depth;
        }
        query::dolly(camera, ray.origin + glm::normalize(ray.direction) * distance,
                     1 - std::pow(0.88, double(io.MouseWheel)));
        // Consecutive turns of the wheel are one step.
        if (ImGui::GetTime() - wheel_time_ > 0.7) e.end_gesture();
        wheel_time_ = ImGui::GetTime();
        set_camera(e, camera, "wheel");
    }
}

} // namespace restage::editor
