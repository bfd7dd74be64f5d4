// SPDX-License-Identifier: Apache-2.0
#include "editor.hpp"

#include "actions.hpp"
#include "document/session.hpp"
#include "file_browser.hpp"
#include "files.hpp"
#include "fonts.hpp"
#include "layout.hpp"
#include "opening.hpp"
#include "palette.hpp"
#include "panels/panels.hpp"
#include "panels/plugin_panels.hpp"
#include "panels/state.hpp"
#include "plugin/registry.hpp"
#include "plugin_actions.hpp"
#include "query/navigation.hpp"
#include "saving.hpp"
#include "scene_pictures.hpp"
#include "theme.hpp"
#include "view/live_view.hpp"
#include "viewport.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <algorithm>
#include <set>

namespace restage::editor {

Editor::Editor(plugin::Registry& registry, Log& log, Notices& shown, EditorOptions options)
    : PanelContext(registry, log, shown, std::move(options)) {
    for (const Panel& panel : all_panels())
        panels_open_[panel.title] = panel.open;
    preferences = remembered_ = read_preferences(options_.config_dir);
    view.keys = preferences.keys;
    selection.whole_things = preferences.whole_things;
    view.snap_move = preferences.snap_move;
    view.snap_angle = preferences.snap_angle;
    view.snap_scale = preferences.snap_scale;
    live_->denoise_by(preferences.denoiser);
    session_->set_history_budget(std::size_t(preferences.history_mib) << 20);
}

Editor::~Editor() = default;

void Editor::follow_camera() {
    const glm::dmat4& now = scene_camera().camera_to_world;
    if (camera_place_ && *camera_place_ != now) views.go(std::nullopt, view.camera_locked ? "" : "camera");
    camera_place_ = now;
}

namespace {

std::string title_name(const document::Session& session) {
    return session.path().empty() ? "untitled" : std::filesystem::path(session.path()).filename().string();
}

// Until then everything else leaves the processor to the picture.
bool awaits_fine_picture(const view::ViewStatus& status) {
    return status.state != view::ViewState::failed && (!status.current || status.divider > 1);
}

} // namespace

std::string Editor::title() const {
    return fmt::format("{}{} - Restage", session_->modified() ? "* " : "", title_name(*session_));
}

bool Editor::animating() const {
    return notices.fading() || opening_->running() || files_->jobs.running() || !pending_.empty() || !modals_.empty();
}

// --- asking
// ------------------------------------------------------------------------------------------------------------

void Editor::open(const std::filesystem::path& path) {
    const auto absolute = std::filesystem::absolute(path).lexically_normal();
    ask_unsaved(*this, "opening another scene", [absolute](Editor& e) { e.open_now({.path = absolute}); });
}

void Editor::insert(const std::filesystem::path& path, std::optional<glm::dvec2> film_point) {
    open_now({.path = std::filesystem::absolute(path).lexically_normal(),
              .purpose = Opening::Purpose::insert,
              .link = ImGui::GetIO().KeyAlt,
              .film_point = film_point});
}

void Editor::adopt_scene(scene::Scene scene) {
    session_->adopt(std::move(scene));
    document_changed();
}

void Editor::undo() {
    const std::string label(session_->history().undo_label());
    if (session_->undo()) notices.add(LogLevel::info, "Undone: " + label);
}

void Editor::redo() {
    const std::string label(session_->history().redo_label());
    if (session_->redo()) notices.add(LogLevel::info, "Redone: " + label);
}

void Editor::request_quit() {
    if (!modals_.empty() && modals_.front().title == "Unsaved changes") return; // already asked
    ask_unsaved(*this, "closing Restage", [](Editor& e) {
        keep_scene_picture(e);
        e.quit_ = true;
    });
}

// --- a frame
// -----------------------------------------------------------------------------------------------------------

void Editor::frame(const std::vector<int>* keys) {
    if (current_theme() != preferences.theme) apply_colors(preferences.theme);
    marks_.clear();
    hovered_before = std::exchange(hovered, {});
    drop_target_before = std::exchange(drop_target, {});
    follow_opening();
    follow_plugins();
    panel_state->loads.poll();
    panel_state->balls.poll();
    panel_state->things.follow(*this);
    panel_state->looks.pictures.poll();
    follow_sky(*this);
    follow_convergence(*this, *this);
    run_shortcuts(*this, keys);
    draw_panels();
    draw_palette(*this);
    tour.update(*this);
    links_.follow(*this);
    files_->jobs.update(*this);
    draw_modals();
    // A gesture ends when nothing is held any more and the sky of its last step is complete.
    if (!panel_state->skies.wanted() && !ImGui::IsAnyItemActive() && !ImGui::IsMouseDown(ImGuiMouseButton_Left) &&
        !ImGui::IsMouseDown(ImGuiMouseButton_Right) && !ImGui::IsMouseDown(ImGuiMouseButton_Middle))
        end_gesture_ = true;
    apply_pending();
    if (!options_.config_dir.empty()) {
        files_->autosave.update(*session_, ImGui::GetTime());
        if (std::string problem = files_->autosave.take_problem();
            !problem.empty() && problem != files_->autosave_problem) // once, not each minute
            notices.add(LogLevel::error, files_->autosave_problem = std::move(problem));
    }
    panel_state->mixing.follow(*this, picture_size_, view.denoise);
    refresh_picture();
    panel_state->balls.hold(scene().instances.live() > 0 && awaits_fine_picture(live_->status()));
    remember_preferences();
}

void Editor::remember_preferences() {
    preferences.keys = view.keys;
    preferences.snap_move = view.snap_move;
    preferences.snap_angle = view.snap_angle;
    preferences.snap_scale = view.snap_scale;
    if (preferences == remembered_) return;
    remembered_ = preferences;
    write_preferences(options_.config_dir, preferences);
}

void Editor::follow_opening() {
    auto result = opening_->take();
    if (!result) return;
    const Opening::Request& request = opening_->request();
    if (!*result) {
        if (opening_->problem() != document::BaseProblem::none)
            ask_for_base(result->error().message, opening_->problem() == document::BaseProblem::changed);
        else
            notices.add(LogLevel::error, result->error().message);
        return;
    }
    if ((*result)->inserted) {
        place_inserted(*(*result)->inserted);
        return;
    }
    keep_scene_picture(*this);
    if (request.purpose == Opening::Purpose::recover) {
        session_->adopt_recovered(std::move(*(*result)->document));
        // The old file is removed once a new one exists.
        files_->autosave.write_now(*session_, ImGui::GetTime());
        if (std::filesystem::exists(files_->autosave.file())) document::discard_recoverable({.file = request.path});
    } else {
        session_->adopt(std::move(*(*result)->document));
        files_->recent.add_file(request.path);
    }
    document_changed();
    const auto approximated = session_->report().count(io::Fate::approximated),
               dropped = session_->report().count(io::Fate::dropped);
    notices.add(LogLevel::info, fmt::format("{}: {} objects", title_name(*session_), scene().instances.live()));
    if (approximated + dropped > 0)
        notices.add(LogLevel::warning,
                    fmt::format("Import report: {} approximated, {} dropped", approximated, dropped));
}

void Editor::follow_plugins() {
    constexpr double every = 0.4; // [s]
    if (ImGui::GetTime() < plugins_looked_at_ + every) return;
    plugins_looked_at_ = ImGui::GetTime();
    for (const plugin::Reload& news : registry_.reload_changed()) // failures are logged, and so shown here too
        if (news.error.empty()) notices.add(LogLevel::info, news.plugin->name() + " was reloaded");
}

namespace {

// Explains why names in scripts that no font covers are shown as boxes.
std::string unreadable_scripts(const scene::Scene& s) {
    ImFont* font = ImGui::GetFont();
    std::set<std::string> found;
    const auto look = [&](const std::string& name) {
        for (const char *at = name.data(), *end = at + name.size(); at < end;) {
            unsigned int c = 0;
            at += std::max(ImTextCharFromUtf8(&c, at, end), 1);
            const Script* script = c < 0x80 ? nullptr : script_of(char32_t(c));
            if (script && font && !found.contains(script->name) && !font->IsGlyphInFont(ImWchar(c)))
                found.insert(script->name);
        }
    };
    s.instances.each([&](auto, const scene::Instance& i) { look(i.name); });
    s.groups.each([&](auto, const scene::Group& g) { look(g.name); });
    s.materials.each([&](auto, const scene::Material& m) { look(m.name); });
    s.lights.each([&](auto, const scene::Light& l) { look(l.name); });
    s.cameras.each([&](auto, const scene::Camera& c) { look(c.name); });
    return fmt::format("{}", fmt::join(found, ", "));
}

} // namespace

void Editor::document_changed() {
    ++document_;
    original_ = session_->base().file.empty() ? scene() : session_->base().scene;
    selection = {};
    selection.whole_things = preferences.whole_things;
    views = {};
    camera_place_.reset();
    locked.clear();
    pick_tool.reset();
    panel_state->forget_document();
    up_ = query::guess_up(camera());
    if (const std::string scripts = unreadable_scripts(scene()); !scripts.empty())
        notices.add(LogLevel::warning, "Names here are " + scripts +
                                           ", for which no font was found: they are shown as boxes. Install one (the "
                                           "Noto fonts have them all) and start Restage again");
}

void Editor::ask_for_base(const std::string& message, bool some_fits) {
    show_modal("The scene of this project", [this, message, some_fits, request = opening_->request()](PanelContext&) {
        dialog_width(480);
        ImGui::TextWrapped("%s", message.c_str());
        ImGui::Spacing();
        bool stay = true;
        if (ImGui::Button("Find it...")) {
            stay = false;
            browse(*this, {.title = "Where is the scene?",
                           .start = request.path.parent_path(),
                           .done = [this, request](PanelContext&, const std::filesystem::path& base) {
                               Opening::Request again = request;
                               again.base = base;
                               open_now(std::move(again));
                           }});
        }
        mark("base.find");
        ImGui::SameLine();
        if (some_fits) {
            if (ImGui::Button("Leave these changes out")) {
                stay = false;
                Opening::Request again = request;
                again.drop_lost = true;
                later([this, again] { open_now(again); });
            }
            mark("base.drop");
            ImGui::SameLine();
        }
        if (ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGuiKey_Escape, false)) stay = false;
        mark("base.cancel");
        return stay;
    });
}

void Editor::apply_pending() {
    for (const std::string& id : std::exchange(actions_to_run_, {}))
        if (const Action* action = find_action(id); action && (!action->enabled || action->enabled(*this)))
            action->run(*this);
    for (Pending& pending : std::exchange(pending_, {})) {
        if (pending.work) {
            pending.work();
            continue;
        }
        if (auto changed = session_->edit(pending.builder(scene()), pending.gesture); !changed)
            notices.add(LogLevel::error, changed.error().message);
    }
    if (std::exchange(end_gesture_, false)) {
        session_->end_gesture();
        views.end_gesture();
    }
    follow_camera();
    selection.prune(scene());
    latest_copies.follow(selection);
}

void Editor::refresh_picture() {
    const scene::Settings& settings = scene().settings.value;
    const Trial trial = current_trial(panel_state->library);
    const Shown wanted{.version = session_->version(),
                       .plugins = registry_.version(),
                       .view = views.version(),
                       .size = picture_size_,
                       .document = document_,
                       .original = show_original && original_,
                       .lights = panel_state->lights.version(),
                       .samples = view.samples ? view.samples : settings.samples,
                       .seconds = view.seconds,
                       .error = view.error,
                       .paused = files_->jobs.picture_paused() || panel_state->mixing.shown(),
                       .look = view::look_of(view.display.layer),
                       .trial = trial.number,
                       .region = viewport.region.area};
    if (wanted == asked_ || scene().instances.live() == 0) return;
    asked_ = wanted;
    scene::Scene shown = panel_state->lights.follow(shown_scene_.follow(scene(), document_, trial), registry_);
    if (wanted.original) {
        // The camera stays where it is, so that the two can be compared.
        shown = *original_;
        shown.cameras = scene().cameras;
        shown.active_camera = scene().active_camera;
        shown.film = scene().film;
    }
    if (const auto id = shown.active_camera.value;
        views.now() && shown.cameras.find(id)) // versions that no edit can have
        shown.cameras.set(id, camera(), (std::uint64_t(1) << 48) + views.version());
    const std::uint64_t request = live_->show(std::move(shown), {.size = wanted.size,
                                                                 .document = document_,
                                                                 .variant = wanted.original ? 1u : 0u,
                                                                 .paused = wanted.paused,
                                                                 .look = wanted.look,
                                                                 .region = wanted.region,
                                                                 .samples = wanted.samples,
                                                                 .seconds = wanted.seconds,
                                                                 .error = wanted.error});
    latency_.asked[request] = ImGui::GetTime();
}

void Editor::presented(double frame_seconds) {
    const auto keep = [](std::deque<double>& values, double ms) {
        values.push_back(ms);
        if (values.size() > 512) values.pop_front();
    };
    keep(latency_.frames, frame_seconds * 1000);
    const std::uint64_t shown = viewport.shown_request();
    for (auto it = latency_.asked.begin(); it != latency_.asked.end() && it->first <= shown;) {
        // ImGui::GetTime() is the frame's start.
        if (it->first == shown) {
            latency_.shown_asked = it->second;
            ++latency_.count;
            keep(latency_.pixels, (ImGui::GetTime() + frame_seconds - it->second) * 1000);
        }
        it = latency_.asked.erase(it);
    }
    if (shown > latency_.clean_request && viewport.shows_clean()) {
        latency_.clean_request = shown;
        latency_.clean_seconds = ImGui::GetTime() + frame_seconds - latency_.shown_asked;
    }
}

// --- panels
// ------------------------------------------------------------------------------------------------------------

void Editor::draw_menu() {
    if (!ImGui::BeginMainMenuBar()) return;
    std::string_view last;
    bool shown = false;
    for (const Action& action : all_actions()) {
        const std::string_view id = action.id;
        const std::string_view menu = id.substr(0, id.find('.'));
        if (menu != last) {
            if (shown) ImGui::EndMenu();
            std::string label(menu);
            label[0] = char(std::toupper(static_cast<unsigned char>(label[0])));
            shown = ImGui::BeginMenu(label.c_str());
            mark("menu." + std::string(menu));
            last = menu;
        }
        if (shown) menu_item(*this, id);
        if (shown && id == "file.open") recent_menu(*this);
    }
    if (shown) ImGui::EndMenu();
    tools_menu(*this);
    const bool panels = ImGui::BeginMenu("Panels");
    mark("menu.panels");
    if (panels) {
        for (const Panel& panel : all_panels()) {
            ImGui::MenuItem(panel.title, nullptr, &panels_open_[panel.title]);
            ImGui::SetItemTooltip("%s", panel.tooltip);
            mark(std::string("panels.") + panel.title);
        }
        const auto catalogue = registry_.catalogue();
        for (const plugin::PanelEntry& panel : catalogue->panels) {
            const std::string title = panel_title(*panel.table);
            ImGui::MenuItem(title.c_str(), nullptr, &panels_open_[title]);
            tip(("Of " + panel.plugin->name()).c_str());
            mark("panels." + panel.table->id);
        }
        ImGui::Separator();
        menu_item(*this, "view.reset_layout");
        ImGui::EndMenu();
    }
    // Activity, at the right end.
    const view::ViewStatus status = live_->status();
    const bool waits = scene().instances.live() > 0; // waiting for a picture
    const std::string state = status.state == view::ViewState::starting    ? waits ? "starting the renderer" : ""
                              : status.state == view::ViewState::preparing ? waits ? "preparing" : ""
                              : status.state == view::ViewState::failed    ? "cannot render"
                              : status.compiling.empty()                   ? ""
                                                                           : "compiling " + status.compiling;
    if (!state.empty()) {
        ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::CalcTextSize(state.c_str()).x -
                        24 * ImGui::GetStyle().FontScaleMain);
        ImGui::TextColored(status.state == view::ViewState::failed ? colors::error : colors::dim, "%s", state.c_str());
        if (!status.text.empty()) ImGui::SetItemTooltip("%s", status.text.c_str());
    }
    ImGui::EndMainMenuBar();
}

void Editor::draw_panels() {
    draw_menu();
    const ImGuiViewport* main = ImGui::GetMainViewport();
    const ImGuiID space = ImGui::GetID("dockspace");
    if (!view.show_panels) { // only the picture
        ImGui::SetNextWindowPos(main->WorkPos);
        ImGui::SetNextWindowSize(main->WorkSize);
        ImGui::DockSpaceOverViewport(space, main, ImGuiDockNodeFlags_KeepAliveOnly);
        ImGui::Begin("##picture alone", nullptr,
                     ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoDocking |
                         ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBringToFrontOnFocus);
        draw_viewport(*this);
        ImGui::End();
        return;
    }
    const float scale = ImGui::GetStyle().FontScaleMain;
    if (std::exchange(reset_layout_, false) || !ImGui::DockBuilderGetNode(space)) first_layout(space, main->WorkSize);
    keep_picture_large(space, main->WorkSize);
    ImGui::DockSpaceOverViewport(space, main, ImGuiDockNodeFlags_PassthruCentralNode);
    for (const Panel& panel : all_panels()) {
        bool& open = panels_open_[panel.title];
        if (!open) continue;
        const bool picture = panel.draw == draw_viewport;
        if (panel.dock == Dock::floating) {
            ImGui::SetNextWindowSize(
                {std::min(900 * scale, main->WorkSize.x * 0.9f), std::min(620 * scale, main->WorkSize.y * 0.9f)},
                ImGuiCond_FirstUseEver);
            ImGui::SetNextWindowPos(main->GetCenter(), ImGuiCond_FirstUseEver, {0.5f, 0.5f});
        }
        if (picture) ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
        const bool visible =
            ImGui::Begin(panel.title, picture ? nullptr : &open,
                         picture ? ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse : 0);
        if (picture) ImGui::PopStyleVar();
        marks_.tab(std::string("tab.") + panel.title);
        if (visible) panel.draw(*this);
        ImGui::End();
    }
    const auto catalogue = registry_.catalogue(); // of plugins that may be reloaded meanwhile
    for (const plugin::PanelEntry& panel : catalogue->panels) {
        const std::string title = panel_title(*panel.table);
        bool& open = panels_open_[title];
        if (!open) continue;
        ImGui::SetNextWindowSize(
            {std::min(340 * scale, main->WorkSize.x * 0.9f), std::min(460 * scale, main->WorkSize.y * 0.9f)},
            ImGuiCond_FirstUseEver);
        ImGui::SetNextWindowPos(main->GetCenter(), ImGuiCond_FirstUseEver, {0.5f, 0.5f});
        const bool visible = ImGui::Begin(title.c_str(), &open);
        marks_.tab("tab." + panel.table->id);
        if (visible) draw_panel(*this, panel);
        ImGui::End();
    }
}

void Editor::reset_layout() {
    reset_layout_ = true;
    view.show_panels = true;
    panels_open_.clear();
    for (const Panel& panel : all_panels())
        panels_open_[panel.title] = panel.open;
}

void Editor::configure_renderer(const render::RendererOptions& renderer) {
    options_.renderer = renderer;
    live_->configure(renderer);
}

void Editor::draw_modals() {
    if (modals_.empty()) return;
    Modal& modal = modals_.front(); // one at a time
    if (modal.frames == 0) ImGui::OpenPopup(modal.title.c_str());
    // Auto-sized in its first frames; then it can be moved, until the window is resized.
    const ImVec2 center = ImGui::GetMainViewport()->GetCenter(), space = ImGui::GetMainViewport()->Size;
    if (modal.width != space.x || modal.height != space.y) modal.frames = std::min(modal.frames, 1);
    modal.width = space.x, modal.height = space.y;
    if (++modal.frames < 5) ImGui::SetNextWindowPos(center, ImGuiCond_Always, {0.5f, 0.5f});
    bool keep = true;
    if (ImGui::BeginPopupModal(modal.title.c_str(), nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
        keep = modal.body(*this);
        if (!keep) ImGui::CloseCurrentPopup();
        ImGui::EndPopup();
    } else {
        keep = false;
    }
    if (!keep) modals_.pop_front();
}

} // namespace restage::editor
