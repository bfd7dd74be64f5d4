// SPDX-License-Identifier: Apache-2.0
// Viewport: the picture, its overlays (outlines, handles, notes), and mouse input: navigation, picking,
// dropping.
#pragma once

#include "drag.hpp"
#include "gizmo.hpp"
#include "measure_tool.hpp"
#include "place_texture.hpp"
#include "region_tool.hpp"
#include "selection.hpp"
#include "texture.hpp"
#include "view/display.hpp"
#include "view/live_view.hpp"

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>

namespace restage::editor {

class PanelContext;
class SelectContext;

class Viewport {
  public:
    void draw(PanelContext& editor);

    // The picture's rectangle on screen, of the last frame.
    ImVec2 corner{0, 0}, size{1, 1};
    Drag gizmo_drag; // of the handles
    Measurement measurement;
    RenderRegion region;
    TexturePlacing placing;
    // A screen point in picture coordinates: (0,0) top left, (1,1) bottom right.
    glm::dvec2 film_point(ImVec2 screen) const;
    // Where it is seen: on screen, beside the picture, too; nullopt behind the camera.
    std::optional<ImVec2> on_screen(const SelectContext& editor, const glm::dvec3& world) const;
    // The object visible there in the shown picture; none outside.
    InstanceId instance_at(const PanelContext& editor, ImVec2 screen) const;
    std::uint64_t shown_request() const { return drawn_ ? drawn_->request : 0; } // of LiveView::show
    bool shows_clay() const { return drawn_ && drawn_->clay; }
    bool shows_clean() const { return drawn_ && drawn_->denoised && drawn_->divider <= 2; }
    bool navigating() const { return navigation_ != Navigation::none; }
    bool dragging() const; // the selection, or a box
    void cancel(
        PanelContext& editor); // the running drag; until everything is released, the mouse and T have no other effect

  private:
    enum class Navigation { none, orbit, pan, dolly, fly };
    void draw_toolbar(PanelContext& editor);
    void update_textures(PanelContext& editor);
    void draw_overlays(PanelContext& editor);
    void draw_lights(
        PanelContext& editor); // without a surface: their marks, and the selected spot's cone with its handle
    void draw_cone(PanelContext& editor, scene::Id<scene::Light> id);
    scene::Id<scene::Light> light_at(const PanelContext& editor, ImVec2 screen) const; // whose mark is there
    void draw_grid(PanelContext& editor); // on the floor
    void draw_axes(PanelContext& editor); // in the corner: a click looks along one
    void draw_layer_note(PanelContext& editor); // what is displayed if it is not the picture, and the way back
    bool run_measuring(PanelContext& editor, bool over); // true while the tool takes clicks
    bool run_region(PanelContext& editor, bool over); // true while the tool takes clicks
    void draw_status(PanelContext& editor);
    void draw_progress(PanelContext& editor); // over the picture, while a scene is opened and prepared
    void draw_darkness(PanelContext& editor); // over a scene without light
    void draw_hint(PanelContext& editor); // at a user's first start, until the first gesture
    void draw_welcome(PanelContext& editor, ImVec2 origin, ImVec2 space); // without a scene
    void navigate(PanelContext& editor, bool over);
    bool go_in(PanelContext& editor, InstanceId id);
    void pick(PanelContext& editor, bool over, const GizmoState& gizmo);
    bool can_drag(const PanelContext& editor, ImVec2 screen) const; // over something selected
    void start_sliding(PanelContext& editor, ImVec2 screen);
    void slide(PanelContext& editor);
    std::vector<InstanceId> in_box(const PanelContext& editor, ImVec2 from, ImVec2 to) const;
    void stick(PanelContext& editor, bool over); // T held: the selection follows the surface under the mouse
    void inspect_pixel(PanelContext& editor, bool over);
    void set_camera(PanelContext& editor, const scene::Camera& camera, const char* gesture);
    glm::dvec3 pivot(const PanelContext& editor) const;

    Texture picture_, outline_;
    std::shared_ptr<const view::Frame> drawn_; // contents of picture_
    view::DisplaySettings drawn_settings_;
    view::Scale scale_; // of its colours
    scene::Bounds world_; // of the scene, for the grid
    scene::Version world_of_ = ~scene::Version(0);
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
    Drag slide_; // of a drag of the object itself, or the knob
    ImVec2 press_{0, 0};
    bool pressed_ = false, pressed_twice_ = false, boxing_ = false, sticking_ = false;
    bool on_knob_ = false; // the knob was pressed
    bool cone_held_ = false; // the handle of a spot's cone
    bool cancelled_ = false; // until all buttons and T are released
    ImVec2 last_click_{-1, -1};
    std::size_t behind_ = 0; // number of clicks on the same point
};

// Draws a line of text on a ground over the picture, centred below that place, with that mark. Returns the height to
// the next one.
float picture_label(PanelContext& editor, ImVec2 place, const std::string& text, const std::string& mark);

// The text in the picture's corner. `compiling`: a material whose code is not ready; "" = none.
std::string picture_note(const view::Frame& shown, const std::string& compiling, bool beside_camera);

// What is selected, and how to get at its parts; "" = nothing.
std::string selection_note(const SelectContext& editor);

} // namespace restage::editor
