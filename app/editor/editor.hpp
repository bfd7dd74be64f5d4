// SPDX-License-Identifier: Apache-2.0
// Editor: the desktop program without its window: a Session, its live picture, and their user interface. Panels and
// actions access it through PanelContext; their requests are carried out in one place, apply_pending(). Everything here
// is [main] and inside a Dear ImGui frame unless stated otherwise.
#pragma once

#include "linking.hpp"
#include "opening.hpp"
#include "panel_context.hpp"
#include "shown_scene.hpp"
#include "tour.hpp"

namespace restage::io {
struct ImportedScene;
}

namespace restage::editor {

class Editor final : public PanelContext {
  public:
    // `notices`: shows `log`, including lines from before the editor exists.
    Editor(plugin::Registry& registry, Log& log, Notices& notices, EditorOptions options);
    ~Editor();

    // Builds one frame of the UI, then carries out requests. `keys`: ImGuiKeyChords pressed since the last one, by a
    // window that tracks them better than Dear ImGui (see Window::take_keys); null = Dear ImGui's own.
    void frame(const std::vector<int>* keys = nullptr);
    // The window shows what the last frame() drew, begun this long ago [s]. For the latencies of `make bench`.
    void presented(double frame_seconds);
    bool quit_confirmed() const { return quit_; }
    void request_quit(); // asks about unsaved changes first
    void run_commands(const std::string& lines); // of tests, see probe.cpp
    // The window's title.
    std::string title() const;
    // True while frames should follow each other without waiting for events (flying, a fading notice).
    bool animating() const;

    void open(const std::filesystem::path& path) override;
    void insert(const std::filesystem::path& path, std::optional<glm::dvec2> film_point = {}) override;
    void configure_renderer(const render::RendererOptions& renderer) override;
    ActionState action_state(std::string_view action) const override;
    void open_now(Opening::Request request) { opening_->start(std::move(request)); } // without asking
    void adopt_scene(scene::Scene scene); // a scene created in the program becomes the document
    document::Session& session_for_changes() { return *session_; } // only inside later() and actions
    void undo();
    void redo();
    void reset_layout(); // panels are open and placed as at the first start

    Tour tour;
    const Marks::Mark* find_mark(std::string_view name) const { return marks_.find(name); }
    // State and marks as JSON, for tests.
    std::string probe() const;

  private:
    void draw_menu();
    void draw_panels();
    void draw_modals();
    void apply_pending();
    void follow_opening();
    void follow_plugins(); // reloads what has changed on disk
    void document_changed(); // another one is open now
    void place_inserted(const io::ImportedScene& imported);
    void ask_for_base(const std::string& message, bool some_fits);
    void refresh_picture();
    void follow_camera(); // the view returns to the scene's camera if that was moved
    void remember_preferences(); // when they changed

    Preferences remembered_;
    ShownScene shown_scene_;
    LinkWatch links_;
    double plugins_looked_at_ = 0; // [s], as ImGui::GetTime
    std::optional<glm::dmat4> camera_place_; // of the scene's camera as last seen by the view
    bool quit_ = false, reset_layout_ = false;
    struct Shown { // the last request to the live picture
        scene::Version version = 0;
        std::uint64_t plugins = 0; // plugin::Registry::version
        std::uint64_t view = 0; // ViewHistory::version
        glm::uvec2 size{0};
        std::uint64_t document = 0;
        bool original = false;
        std::uint64_t lights = 0; // view::LightBoard::version
        std::uint32_t samples = 0;
        double seconds = 0, error = 0;
        bool paused = false;
        std::optional<render::ClayLook> look;
        std::uint64_t trial = 0; // Trial::number
        std::optional<glm::vec4> region; // RenderRegion::area
        bool operator==(const Shown&) const = default;
    } asked_;
    struct Latency { // the latest of each [ms]
        std::map<std::uint64_t, double> asked; // live picture request -> its time
        std::uint64_t count = 0; // of `pixels`, including dropped ones
        std::deque<double> pixels; // from the start of the requesting frame until its picture is on the screen
        std::deque<double> frames; // of the window
        double shown_asked = 0; // when the shown picture was requested [s]
        std::uint64_t clean_request =
            0; // the latest request with a denoised picture shown, at half resolution or finer,
        double clean_seconds = 0; // and how long after the request
    } latency_;
};

} // namespace restage::editor
