// SPDX-License-Identifier: Apache-2.0
#include "panel_context.hpp"

#include "document/session.hpp"
#include "files.hpp"
#include "opening.hpp"
#include "panels/state.hpp"
#include "plugin/registry.hpp"
#include "scene/edits.hpp"
#include "view/live_view.hpp"
#include "viewport.hpp"

#include <algorithm>
#include <utility>

namespace restage::editor {

PanelUi::PanelUi(Log& log, Notices& shown, EditorOptions options)
    : notices(shown),
      panel_state(std::make_unique<PanelState>(options.wake)),
      options_(std::move(options)),
      log_(log),
      files_(std::make_unique<Files>(options_.config_dir, options_.autosave_seconds, options_.wake)) {}

PanelUi::~PanelUi() = default;

DocumentContext::DocumentContext(plugin::Registry& registry, Log& log, Notices& shown, EditorOptions options)
    : PanelUi(log, shown, std::move(options)),
      registry_(registry),
      session_(std::make_unique<document::Session>(registry)) {}

DocumentContext::~DocumentContext() = default;

PictureView::PictureView(plugin::Registry& registry, Log& log, const EditorOptions& options)
    : viewport_(std::make_unique<Viewport>()),
      viewport(*viewport_),
      live_(std::make_unique<view::LiveView>(registry, log, options.renderer, options.wake)) {}

PictureView::~PictureView() = default;

PanelContext::PanelContext(plugin::Registry& registry, Log& log, Notices& shown, EditorOptions options)
    : SelectContext(registry, log, shown, std::move(options)),
      PictureView(registry, log, options_),
      opening_(std::make_unique<Opening>(registry, options_.wake, options_.isolate)) {}

PanelContext::~PanelContext() { files_.reset(); } // ends its jobs before anything they use

const scene::Scene& DocumentContext::scene() const { return session_->scene(); }

scene::Id<scene::Camera> DocumentContext::camera_id() const { return scene().active_camera.value; }

const scene::Camera* DocumentContext::opened_camera() const {
    return original_ ? original_->cameras.find(original_->active_camera.value) : nullptr;
}

const scene::Camera& SelectContext::camera() const {
    if (!views.now()) return scene_camera();
    seen_from_ = scene_camera();
    seen_from_.camera_to_world = *views.now();
    return seen_from_;
}

const scene::Camera& DocumentContext::scene_camera() const {
    static const scene::Camera none;
    const scene::Camera* found = scene().cameras.find(camera_id());
    return found ? *found : none;
}

double DocumentContext::film_aspect() const {
    const scene::Film& film = scene().film.value;
    return double(std::max(film.width, 1u)) / std::max(film.height, 1u);
}

std::shared_ptr<const view::Frame> PanelContext::shown_frame() const {
    const std::string_view layer = view.display.layer;
    if (const auto& mix = panel_state->mixing.frame();
        mix && mix->document == document_ && (layer == view::picture_layer || layer == view::exposure_layer))
        return mix;
    const bool clean = layer == view::picture_layer || layer == view::exposure_layer || view::look_of(layer);
    auto frame = live_->best(view.denoise && clean);
    return frame && frame->document == document_ ? frame : nullptr; // another scene was opened in this frame
}

void EditContext::edit(Builder builder, std::string gesture) {
    pending_.push_back({.builder = std::move(builder), .gesture = std::move(gesture)});
}

void EditContext::later(std::function<void()> work) { pending_.push_back({.work = std::move(work)}); }

void EditContext::change(std::function<void(document::Session&)> work) {
    later([this, work = std::move(work)] { work(*session_); });
}

void PanelContext::look_from(const glm::dmat4& camera_to_world, const std::string& gesture, const char* label) {
    if (view.camera_locked) {
        later([this, camera_to_world, gesture] { views.go(camera_to_world, gesture); });
        return;
    }
    edit(
        [camera_to_world, label](const scene::Scene& s) {
            const scene::Camera* camera = s.cameras.find(s.active_camera.value);
            if (!camera) return Result<scene::Edit>(fail("the scene has no camera"));
            scene::Camera moved = *camera;
            moved.camera_to_world = camera_to_world;
            return scene::set_camera(s, s.active_camera.value, moved, label);
        },
        gesture);
}

void EditContext::show_modal(std::string title, std::function<bool(PanelContext&)> body) {
    modals_.push_back({std::move(title), std::move(body)});
}

bool PanelContext::panel_open(std::string_view title) const {
    const auto found = panels_open_.find(title);
    return found != panels_open_.end() && found->second;
}

void PanelContext::open_panel(std::string_view title, bool open) { panels_open_[std::string(title)] = open; }

} // namespace restage::editor
