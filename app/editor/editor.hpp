// SPDX-License-Identifier: Apache-2.0
// Editor: the desktop program without its window: a Session, the live picture of it, and what the user sees of both.
// Panels are functions of the editor's state that *ask* for changes (edit(), run()); what they asked for is done at one
// place, after all of them are drawn. Everything here is [main] and inside a Dear ImGui frame unless it says otherwise.
#pragma once

#include "actions.hpp"
#include "copy_paste.hpp"
#include "document/session.hpp"
#include "gizmo.hpp"
#include "notices.hpp"
#include "opening.hpp"
#include "preferences.hpp"
#include "selection.hpp"
#include "view/display.hpp"
#include "view/live_view.hpp"
#include "view_history.hpp"
#include "viewport.hpp"

#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace restage::editor {

class Editor;
struct Files; // files.hpp

struct EditorOptions {
    render::RendererOptions renderer;
    std::function<void()> wake; // [any] asks for another frame
    std::filesystem::path config_dir; // layout, preferences; "" = nothing is remembered
    double autosave_seconds = 60; // unsaved work is written aside so often
    std::shared_ptr<const document::IsolateOptions> isolate; // scenes are read in a process of their own
};

enum class GizmoMode { select, move, rotate, scale };

// How things are shown; no part of the document, so none of it is undone or restarts the picture.
struct ViewSettings {
    view::DisplaySettings display;
    bool denoise = true;
    bool show_overlays = true; // outlines, gizmo, names
    bool show_panels = true; // Tab
    bool inspect_pixels = false; // values under the mouse
    float resolution = 1; // picture pixels a screen pixel
    GizmoMode gizmo = GizmoMode::move;
    bool local_axes = false;
    float snap_move = 0.1f, snap_angle = 15, snap_scale = 0.1f; // scene units, deg, factor
    KeyPreset keys = KeyPreset::standard;
    bool camera_locked = true; // looking around moves the view alone
    float fly_speed = 1; // times the scene's size a few seconds
    std::uint32_t samples = 0; // where the live picture stops; 0 = the scene's number
    double seconds = 0, error = 0;
};

struct PanelState; // panels/state.hpp

// What the next click in the picture is for, instead of selecting. Esc gives it up.
struct PickTool {
    std::string hint; // "Click the object whose material to take"
    std::function<void(Editor&, InstanceId, ImVec2 screen)> done;
};

class Editor {
  public:
    // `notices`: where `log` is shown, from before the editor lives.
    Editor(plugin::Registry& registry, Log& log, Notices& notices, EditorOptions options);
    ~Editor();
    Editor(const Editor&) = delete;
    Editor& operator=(const Editor&) = delete;

    // Builds one frame of the UI, then does what it asked for. `keys`: pressed since the last one, by a window that
    // knows better than Dear ImGui (see Window::take_keys); null = Dear ImGui's own.
    void frame(const std::vector<ImGuiKeyChord>* keys = nullptr);
    // The window shows what the last frame() drew; it began so long ago [s]. For the latencies of `make bench`.
    void presented(double frame_seconds);
    bool quit_confirmed() const { return quit_; }
    void request_quit(); // asks about unsaved changes first
    void run_commands(const std::string& lines); // of tests, see probe.cpp
    // What the window's title says.
    std::string title() const;
    // True while frames should follow each other without waiting for events (flying, a fading notice).
    bool animating() const;

    // --- the document
    // -------------------------------------------------------------------------------------------------
    const document::Session& session() const { return session_; }
    const scene::Scene& scene() const { return session_.scene(); }
    const plugin::Registry& registry() const { return session_.registry(); }
    scene::Id<scene::Camera> camera_id() const { return scene().active_camera.value; }
    // What the picture is seen from: the scene's camera, or the view that has left it. A default one where the scene
    // has none.
    const scene::Camera& camera() const;
    const scene::Camera& scene_camera() const;
    // Looks from there. Where the camera is locked only the view goes, which is no change of the document; else the
    // camera does.
    void look_from(const glm::dmat4& camera_to_world, const std::string& gesture = {},
                   const char* label = "Move camera");
    ViewHistory views;
    double film_aspect() const;
    const glm::dvec3& up() const { return up_; }
    std::uint64_t document() const { return document_; } // another number = another one was opened; as in Frame

    // Asks for an edit. The builder sees the scene as it is when its turn comes; an error becomes a notice. Edits with
    // the same gesture, until the mouse button or the widget is let go, are one step of the history.
    using Builder = std::function<Result<scene::Edit>(const scene::Scene&)>;
    void edit(Builder builder, std::string gesture = {});
    // Asks for something that is more than an edit, at the same place. Runs in order with the edits.
    void later(std::function<void()> work) { pending_.push_back({.work = std::move(work)}); }
    void end_gesture() { end_gesture_ = true; }
    document::Session& session_for_changes() { return session_; } // only inside later() and actions

    void open(const std::filesystem::path& path); // asks about unsaved changes first
    void open_now(Opening::Request request) { opening_.start(std::move(request)); } // asks nothing
    // A file as new objects, on what is seen at this point of the picture.
    void insert(const std::filesystem::path& path, std::optional<glm::dvec2> film_point = {});
    // Files that were let go at this point of the window: scenes are opened, objects inserted, images applied.
    void drop(const std::vector<std::filesystem::path>& paths, ImVec2 screen);
    void adopt_scene(scene::Scene scene); // one made in the program becomes the document
    Opening& opening() { return opening_; }
    Files& files() { return *files_; }
    const EditorOptions& options() const { return options_; }
    Preferences preferences;
    Log& log() { return log_; }
    void undo();
    void redo();
    // The camera the file was opened with; null when there is none.
    const scene::Camera* opened_camera() const {
        return original_ ? original_->cameras.find(original_->active_camera.value) : nullptr;
    }

    // --- what is shown
    // -------------------------------------------------------------------------------------------------
    Selection selection;
    InstanceId hovered; // under the mouse in the viewport or a list, by the panels drawn in this frame
    InstanceId hovered_before; // in the frame before: what is outlined
    InstanceId drop_target; // what is dragged would go there: outlined alone, in the frame after
    InstanceId drop_target_before;
    ViewSettings view;
    view::LiveView& live() { return *live_; }
    const view::LiveView& live() const { return *live_; }
    std::shared_ptr<const view::Frame> shown_frame() const;
    void set_picture_size(glm::uvec2 size) { picture_size_ = size; } // by the viewport
    bool show_original = false; // the scene as it was opened, while a key is held
    std::set<std::uint32_t> locked; // Id<Instance>::value: not picked by clicks
    Notices& notices;
    Drag gizmo_drag; // of the handles
    Viewport viewport;
    std::optional<scene::Id<scene::Material>> material_clipboard;
    Copied copied;
    std::optional<PickTool> pick_tool;
    std::unique_ptr<PanelState> panel_state; // what panels remember: searches, open folds

    // --- panels
    // --------------------------------------------------------------------------------------------------------
    void run(std::string_view action) { actions_to_run_.emplace_back(action); }
    bool panel_open(std::string_view title) const;
    void open_panel(std::string_view title, bool open = true);
    void reset_layout(); // panels are open, and where they are, as at the first start
    // A modal that shows until its function returns false.
    void show_modal(std::string title, std::function<bool(Editor&)> body);

    void configure_renderer(const render::RendererOptions& renderer); // another device, tracer, number of threads
    const std::optional<scene::Scene>& original() const { return original_; } // as opened

    // Names the last item for tests that drive the program from outside: see probe(). Not while its window has no
    // settled place yet.
    void mark(const std::string& name);
    void mark(const std::string& name, ImVec2 point) { mark(name, point, point); }
    void mark(const std::string& name, ImVec2 lower, ImVec2 upper);
    struct Mark {
        ImVec4 rect; // min.x min.y max.x max.y
        ImGuiID item = 0;
    };
    const Mark* find_mark(std::string_view name) const {
        const auto found = marks_.find(name);
        return found == marks_.end() ? nullptr : &found->second;
    }
    // State and marks as JSON, for tests.
    std::string probe() const;

  private:
    struct Pending {
        Builder builder;
        std::string gesture;
        std::function<void()> work;
    };
    struct Modal {
        std::string title;
        std::function<bool(Editor&)> body;
        int frames = 0; // it is shown for, in a window of this size
        ImVec2 space{0, 0};
    };
    void draw_menu();
    void draw_panels();
    void draw_modals();
    void apply_pending();
    void follow_opening();
    void follow_plugins(); // loads anew what has changed on disk
    void document_changed(); // another one is open now
    void place_inserted(const io::ImportedScene& imported);
    void ask_for_base(const std::string& message, bool some_fits);
    void refresh_picture();
    void follow_camera(); // the view comes back to the scene's camera where that was moved
    void remember_preferences(); // when they changed

    EditorOptions options_;
    Preferences remembered_;
    Log& log_;
    plugin::Registry& registry_;
    document::Session session_;
    std::unique_ptr<view::LiveView> live_;
    Opening opening_;
    std::unique_ptr<Files> files_;
    double plugins_looked_at_ = 0; // [s], as ImGui::GetTime
    std::vector<Pending> pending_;
    std::vector<std::string> actions_to_run_;
    bool end_gesture_ = false;
    glm::dvec3 up_{0, 1, 0};
    std::uint64_t document_ = 1; // of ViewOptions
    mutable scene::Camera seen_from_; // camera() of a view that has left the scene's
    std::optional<glm::dmat4> camera_place_; // of the scene's camera when the view last looked
    std::optional<scene::Scene> original_; // as opened
    std::map<std::string, bool, std::less<>> panels_open_;
    std::deque<Modal> modals_;
    bool quit_ = false, reset_layout_ = false;

    glm::uvec2 picture_size_{640, 360};
    struct Shown { // what the live picture was last asked for
        scene::Version version = 0;
        std::uint64_t plugins = 0; // plugin::Registry::version
        std::uint64_t view = 0; // ViewHistory::version
        glm::uvec2 size{0};
        std::uint64_t document = 0;
        bool original = false;
        std::uint32_t samples = 0;
        double seconds = 0, error = 0;
        bool paused = false;
        bool operator==(const Shown&) const = default;
    } asked_;
    struct Latency { // the latest of each [ms]
        std::map<std::uint64_t, double> asked; // request of the live picture: when it was asked for
        std::uint64_t count = 0; // of `pixels`, with those that were dropped
        std::deque<double> pixels; // from the begin of the frame that asked, to the picture of it on the screen
        std::deque<double> frames; // of the window
        double shown_asked = 0; // when what is shown was asked for [s]
        std::uint64_t clean_request =
            0; // the latest of which a denoised picture, at half resolution or finer, was shown,
        double clean_seconds = 0; // and how long after it was asked for
    } latency_;
    std::map<std::string, Mark, std::less<>> marks_; // of the last frame
};

} // namespace restage::editor
