// SPDX-License-Identifier: Apache-2.0
// PanelContext: the complete interface for code below Editor: the levels of contexts.hpp and the picture.
#pragma once

#include "contexts.hpp"
#include "view_settings.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace restage::view {
class LiveView;
struct Frame;
} // namespace restage::view

namespace restage::editor {

class Opening;
class Viewport;

// The live picture, and how it is shown.
class PictureView {
    std::unique_ptr<Viewport> viewport_;

  public:
    PictureView(const PictureView&) = delete;
    PictureView& operator=(const PictureView&) = delete;

    ViewSettings view;
    Viewport& viewport;
    bool show_original = false; // the scene as it was opened, while a key is held
    view::LiveView& live() { return *live_; }
    const view::LiveView& live() const { return *live_; }
    void set_picture_size(glm::uvec2 size) { picture_size_ = size; } // by the viewport
    // Sets another device, tracer, or number of threads.
    virtual void configure_renderer(const render::RendererOptions& renderer) = 0;

  protected:
    PictureView(plugin::Registry& registry, Log& log, const EditorOptions& options);
    ~PictureView();

    std::unique_ptr<view::LiveView> live_;
    glm::uvec2 picture_size_{640, 360};
};

class PanelContext : public SelectContext, public PictureView {
  public:
    InstanceId drop_target; // of the current drag: the only outline in the next frame
    InstanceId drop_target_before;
    std::shared_ptr<const view::Frame> shown_frame() const;
    // Sets the viewpoint. If the camera is locked only the view moves, which does not change the document; else the
    // camera moves.
    void look_from(const glm::dmat4& camera_to_world, const std::string& gesture = {},
                   const char* label = "Move camera");
    // Files dropped at this point of the window: scenes are opened, objects inserted, images applied.
    void drop(const std::vector<std::filesystem::path>& paths, ImVec2 screen);
    Opening& opening() { return *opening_; }
    bool panel_open(std::string_view title) const;
    void open_panel(std::string_view title, bool open = true);

  protected:
    PanelContext(plugin::Registry& registry, Log& log, Notices& notices, EditorOptions options);
    ~PanelContext();

    std::unique_ptr<Opening> opening_;
    std::map<std::string, bool, std::less<>> panels_open_;
};

} // namespace restage::editor
