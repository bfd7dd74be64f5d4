// SPDX-License-Identifier: Apache-2.0
// The editor's interfaces for panels, in levels. Each level adds to the previous one, and a panel, or a part of it,
// takes the lowest level that suffices (tests/scripts/test_layers.py):
//   PanelUi          notices, preferences, background jobs, and the panels' own state
//   DocumentContext  + the document, to read
//   EditContext      + requests: edits, actions, dialogs
//   SelectContext    + the selection and the viewpoint
//   PanelContext     + the picture (panel_context.hpp). PictureView, only the picture, is separate.
// Requests are carried out in one place, after all panels are drawn (Editor::frame).
// Everything here is [main] and inside a Dear ImGui frame.
#pragma once

#include "base/result.hpp"
#include "copy_paste.hpp"
#include "duplicating.hpp"
#include "editor_options.hpp"
#include "marks.hpp"
#include "notices.hpp"
#include "pick_tool.hpp"
#include "preferences.hpp"
#include "scene/edit.hpp"
#include "selection.hpp"
#include "view_history.hpp"

#include <deque>
#include <filesystem>
#include <functional>
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
}

namespace restage::editor {

struct Files; // files.hpp
class PanelContext;
struct PanelState; // panels/state.hpp

class PanelUi {
  public:
    PanelUi(const PanelUi&) = delete;
    PanelUi& operator=(const PanelUi&) = delete;

    Notices& notices;
    Preferences preferences;
    std::unique_ptr<PanelState> panel_state; // the panels' own state: searches, open folds
    Files& files() { return *files_; }
    const EditorOptions& options() const { return options_; }
    Log& log() { return log_; }
    // Names the last item, or a position, for tests.
    void mark(const std::string& name) { marks_.item(name); }
    void mark(const std::string& name, const ImVec2& point) { marks_.area(name, point, point); }
    void mark(const std::string& name, const ImVec2& lower, const ImVec2& upper) { marks_.area(name, lower, upper); }

  protected:
    PanelUi(Log& log, Notices& notices, EditorOptions options);
    ~PanelUi();

    EditorOptions options_;
    Log& log_;
    std::unique_ptr<Files> files_;
    Marks marks_; // of the last frame
};

class DocumentContext : public PanelUi {
  public:
    const document::Session& session() const { return *session_; }
    const scene::Scene& scene() const;
    const plugin::Registry& registry() const { return registry_; }
    scene::Id<scene::Camera> camera_id() const;
    const scene::Camera& scene_camera() const; // a default one if the scene has no camera
    double film_aspect() const;
    const glm::dvec3& up() const { return up_; }
    std::uint64_t document() const { return document_; } // changes when another document is opened; as in Frame
    const std::optional<scene::Scene>& original() const { return original_; } // as opened
    // The camera the file was opened with; null if there is none.
    const scene::Camera* opened_camera() const;

  protected:
    DocumentContext(plugin::Registry& registry, Log& log, Notices& notices, EditorOptions options);
    ~DocumentContext();

    plugin::Registry& registry_;
    std::unique_ptr<document::Session> session_;
    glm::dvec3 up_{0, 1, 0};
    std::uint64_t document_ = 1; // of ViewOptions
    std::optional<scene::Scene> original_; // as opened
};

class EditContext : public DocumentContext {
  public:
    // Requests an edit. The builder gets the scene as it is when it runs; an error becomes a notice. Edits with
    // the same gesture, until the mouse button or the widget is released, are one undo step.
    using Builder = std::function<Result<scene::Edit>(const scene::Scene&)>;
    void edit(Builder builder, std::string gesture = {});
    // Requests something other than an edit, at the same point. Runs in order with the edits.
    void later(std::function<void()> work);
    void change(std::function<void(document::Session&)> work);
    void end_gesture() { end_gesture_ = true; }
    // Runs an action of actions.hpp; the state of its menu entry.
    void run(std::string_view action) { actions_to_run_.emplace_back(action); }
    struct ActionState {
        bool enabled = false, checked = false;
        std::string label, key; // including the edit it would undo: "Undo Move chair"; "Ctrl+Z" or ""
    };
    virtual ActionState action_state(std::string_view action) const = 0;
    virtual void open(const std::filesystem::path& path) = 0; // asks about unsaved changes first
    // Inserts a file as new objects, on the surface at this point of the picture.
    virtual void insert(const std::filesystem::path& path, std::optional<glm::dvec2> film_point = {}) = 0;
    // A modal that shows until its function returns false.
    void show_modal(std::string title, std::function<bool(PanelContext&)> body);

  protected:
    using DocumentContext::DocumentContext;
    ~EditContext() = default;

    struct Pending {
        Builder builder;
        std::string gesture;
        std::function<void()> work;
    };
    struct Modal {
        std::string title;
        std::function<bool(PanelContext&)> body;
        int frames = 0; // how long it is shown, in a window of this size
        float width = 0, height = 0;
    };
    std::vector<Pending> pending_;
    std::vector<std::string> actions_to_run_;
    bool end_gesture_ = false;
    std::deque<Modal> modals_;
};

class SelectContext : public EditContext {
  public:
    Selection selection;
    InstanceId hovered; // under the mouse in the viewport or a list, by the panels drawn in this frame
    InstanceId hovered_before; // in the previous frame: drawn outlined
    std::set<std::uint32_t> locked; // Id<Instance>::value: not picked by clicks
    std::optional<PickTool> pick_tool;
    std::optional<scene::Id<scene::Material>> material_clipboard;
    Copied copied;
    LatestCopies latest_copies;
    ViewHistory views;
    // The picture's viewpoint: the scene's camera, or the view if it differs.
    const scene::Camera& camera() const;

  protected:
    using EditContext::EditContext;
    ~SelectContext() = default;

  private:
    mutable scene::Camera seen_from_; // camera() of a view that differs from the scene's camera
};

} // namespace restage::editor
