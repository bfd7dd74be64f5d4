// SPDX-License-Identifier: Apache-2.0
// PanelContext: the editor as panels see it: the document to read, edits and actions to ask for, what is shown, and
// what panels remember. Their requests are carried out in one place, after all of them are drawn (Editor::frame).
// Everything here is [main] and inside a Dear ImGui frame.
#pragma once

#include "base/result.hpp"
#include "copy_paste.hpp"
#include "marks.hpp"
#include "notices.hpp"
#include "pick_tool.hpp"
#include "render/renderer_options.hpp"
#include "scene/edit.hpp"
#include "selection.hpp"
#include "view_history.hpp"
#include "view_settings.hpp"

#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace restage::plugin {
class Registry;
}
namespace restage::document {
class Session;
struct IsolateOptions;
} // namespace restage::document
namespace restage::view {
class LiveView;
struct Frame;
} // namespace restage::view

namespace restage::editor {

struct Files; // files.hpp
class Opening;
class Viewport;
struct PanelState; // panels/state.hpp

struct EditorOptions {
    render::RendererOptions renderer;
    std::function<void()> wake; // [any] asks for another frame
    std::filesystem::path config_dir; // layout, preferences; "" = nothing is remembered
    double autosave_seconds = 60; // interval between recovery copies of unsaved work
    std::shared_ptr<const document::IsolateOptions> isolate; // scenes are read in a process of their own
};

class PanelContext {
  public:
    PanelContext(const PanelContext&) = delete;
    PanelContext& operator=(const PanelContext&) = delete;

    // --- the document, to read
    // -----------------------------------------------------------------------------------------
    const document::Session& session() const { return *session_; }
    const scene::Scene& scene() const;
    const plugin::Registry& registry() const { return registry_; }
    scene::Id<scene::Camera> camera_id() const { return scene().active_camera.value; }
    // The picture's viewpoint: the scene's camera, or the view that has left it. A default one if the scene has no
    // camera.
    const scene::Camera& camera() const;
    const scene::Camera& scene_camera() const;
    double film_aspect() const;
    const glm::dvec3& up() const { return up_; }
    std::uint64_t document() const { return document_; } // changes when another document is opened; as in Frame
    const std::optional<scene::Scene>& original() const { return original_; } // as opened
    // The camera the file was opened with; null if there is none.
    const scene::Camera* opened_camera() const {
        return original_ ? original_->cameras.find(original_->active_camera.value) : nullptr;
    }

    // --- asking
    // --------------------------------------------------------------------------------------------------------
    // For an edit. The builder sees the scene as it is when it runs; an error becomes a notice. Edits with
    // the same gesture, until the mouse button or the widget is let go, are one step of the history.
    using Builder = std::function<Result<scene::Edit>(const scene::Scene&)>;
    void edit(Builder builder, std::string gesture = {});
    // For something beyond an edit, at the same point. Runs in order with the edits.
    void later(std::function<void()> work);
    void change(std::function<void(document::Session&)> work);
    void run(std::string_view action) { actions_to_run_.emplace_back(action); }
    void end_gesture() { end_gesture_ = true; }
    // Looks from there. If the camera is locked only the view moves, which does not change the document; else the
    // camera moves.
    void look_from(const glm::dmat4& camera_to_world, const std::string& gesture = {},
                   const char* label = "Move camera");
    virtual void open(const std::filesystem::path& path) = 0; // asks about unsaved changes first
    // A file as new objects, on what is seen at this point of the picture.
    virtual void insert(const std::filesystem::path& path, std::optional<glm::dvec2> film_point = {}) = 0;
    // Files dropped at this point of the window: scenes are opened, objects inserted, images applied.
    void drop(const std::vector<std::filesystem::path>& paths, ImVec2 screen);
    // Another device, tracer, number of threads.
    virtual void configure_renderer(const render::RendererOptions& renderer) = 0;
    // A modal that shows until its function returns false.
    void show_modal(std::string title, std::function<bool(PanelContext&)> body);
    bool panel_open(std::string_view title) const;
    void open_panel(std::string_view title, bool open = true);

    // --- what is shown
    // -------------------------------------------------------------------------------------------------
    Selection selection;
    InstanceId hovered; // under the mouse in the viewport or a list, by the panels drawn in this frame
    InstanceId hovered_before; // in the frame before: what is outlined
    InstanceId drop_target; // drop target of what is dragged: outlined alone, in the next frame
    InstanceId drop_target_before;
    ViewSettings view;
    ViewHistory views;
    view::LiveView& live() { return *live_; }
    const view::LiveView& live() const { return *live_; }
    std::shared_ptr<const view::Frame> shown_frame() const;
    void set_picture_size(glm::uvec2 size) { picture_size_ = size; } // by the viewport
    bool show_original = false; // the scene as it was opened, while a key is held
    std::set<std::uint32_t> locked; // Id<Instance>::value: not picked by clicks

  private:
    std::unique_ptr<Viewport> viewport_;

  public:
    Viewport& viewport;
    Notices& notices;
    Preferences preferences;
    std::optional<scene::Id<scene::Material>> material_clipboard;
    Copied copied;
    std::optional<PickTool> pick_tool;

    // --- other things panels use
    // ----------------------------------------------------------------------------------------
    std::unique_ptr<PanelState> panel_state; // what panels remember: searches, open folds
    Files& files() { return *files_; }
    Opening& opening() { return *opening_; }
    const EditorOptions& options() const { return options_; }
    Log& log() { return log_; }
    // Names the last item, or a place, for tests.
    void mark(const std::string& name) { marks_.item(name); }
    void mark(const std::string& name, const ImVec2& point) { marks_.area(name, point, point); }
    void mark(const std::string& name, const ImVec2& lower, const ImVec2& upper) { marks_.area(name, lower, upper); }

  protected:
    PanelContext(plugin::Registry& registry, Log& log, Notices& notices, EditorOptions options);
    ~PanelContext();

    struct Pending {
        Builder builder;
        std::string gesture;
        std::function<void()> work;
    };
    struct Modal {
        std::string title;
        std::function<bool(PanelContext&)> body;
        int frames = 0; // it is shown for, in a window of this size
        float width = 0, height = 0;
    };

    EditorOptions options_;
    Log& log_;
    plugin::Registry& registry_;
    std::unique_ptr<document::Session> session_;
    std::unique_ptr<view::LiveView> live_;
    std::unique_ptr<Opening> opening_;
    std::unique_ptr<Files> files_;
    std::vector<Pending> pending_;
    std::vector<std::string> actions_to_run_;
    bool end_gesture_ = false;
    glm::dvec3 up_{0, 1, 0};
    std::uint64_t document_ = 1; // of ViewOptions
    std::optional<scene::Scene> original_; // as opened
    std::map<std::string, bool, std::less<>> panels_open_;
    std::deque<Modal> modals_;
    glm::uvec2 picture_size_{640, 360};
    Marks marks_; // of the last frame

  private:
    mutable scene::Camera seen_from_; // camera() of a view that has left the scene's
};

} // namespace restage::editor
