// SPDX-License-Identifier: Apache-2.0
// Viewport: the picture, what lies over it (outlines, handles, notes), and what the mouse does in it: navigate, pick,
// drop.
#pragma once

#include "drag.hpp"
#include "gizmo.hpp"
#include "selection.hpp"
#include "texture.hpp"
#include "view/display.hpp"
#include "view/live_view.hpp"

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>

namespace restage::editor {

class Editor;

class Viewport {
  public:
    void draw(Editor& editor);

    // The picture's rectangle on screen, of the last frame.
    ImVec2 corner{0, 0}, size{1, 1};
    // Where a screen point lies in the picture: (0,0) top left, (1,1) bottom right.
    glm::dvec2 film_point(ImVec2 screen) const;
    // The object seen there in the shown picture; none outside.
    InstanceId instance_at(const Editor& editor, ImVec2 screen) const;
    std::uint64_t shown_request() const { return drawn_ ? drawn_->request : 0; } // of LiveView::show
    bool shows_clay() const { return drawn_ && drawn_->clay; }
    bool shows_clean() const { return drawn_ && drawn_->denoised && drawn_->divider <= 2; }
    bool navigating() const { return navigation_ != Navigation::none; }
    bool dragging(const Editor& editor) const; // what is selected, or a box
    void cancel(Editor& editor); // the drag that runs; until all is let go, the mouse and T do nothing more

  private:
    enum class Navigation { none, orbit, pan, dolly, fly };
    void draw_toolbar(Editor& editor);
    void update_textures(Editor& editor);
    void draw_overlays(Editor& editor);
    void draw_lights(Editor& editor); // without a surface: their marks, and the selected spot's cone with its handle
    void draw_cone(Editor& editor, scene::Id<scene::Light> id);
    scene::Id<scene::Light> light_at(const Editor& editor, ImVec2 screen) const; // whose mark is there
    void draw_status(Editor& editor);
    void draw_progress(Editor& editor); // over the picture, while a scene is opened and prepared
    void draw_darkness(Editor& editor); // over a scene without light
    void draw_hint(Editor& editor); // until the first gesture of somebody's first start
    void draw_welcome(Editor& editor, ImVec2 origin, ImVec2 space); // where there is no scene
    void navigate(Editor& editor, bool over);
    void pick(Editor& editor, bool over, const GizmoState& gizmo);
    bool can_drag(const Editor& editor, ImVec2 screen) const; // something selected is there
    void start_sliding(Editor& editor, ImVec2 screen);
    void slide(Editor& editor);
    std::vector<InstanceId> in_box(const Editor& editor, ImVec2 from, ImVec2 to) const;
    void stick(Editor& editor, bool over); // T held: the selection follows the surface under the mouse
    void inspect_pixel(Editor& editor, bool over);
    void set_camera(Editor& editor, const scene::Camera& camera, const char* gesture);
    glm::dvec3 pivot(const Editor& editor) const;

    Texture picture_, outline_;
    std::shared_ptr<const view::Frame> drawn_; // what picture_ holds
    view::DisplaySettings drawn_settings_;
    std::size_t most_compiling_ = 0; // shaders, since the scene was opened
    struct OutlineKey {
        const view::Frame* frame = nullptr;
        std::vector<InstanceId> selected;
        std::vector<InstanceId> hovered;
        bool operator==(const OutlineKey&) const = default;
    } outlined_;
    std::vector<std::uint32_t> pixels_;

    Navigation navigation_ = Navigation::none;
    std::optional<glm::dvec3> orbit_center_; // set by a double click
    double wheel_time_ = 0;                  // of the last turn
    Drag slide_; // of the object itself, or the knob
    ImVec2 press_{0, 0};
    bool pressed_ = false, boxing_ = false, sticking_ = false;
    bool on_knob_ = false; // the knob was pressed
    bool cone_held_ = false; // the handle of a spot's cone
    bool cancelled_ = false; // until all buttons, and T, are up
    ImVec2 last_click_{-1, -1};
    std::size_t behind_ = 0; // how often the same point was clicked
};

} // namespace restage::editor
