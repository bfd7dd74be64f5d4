// SPDX-License-Identifier: Apache-2.0
#include "run_editor.hpp"

#include "base/file.hpp"
#include "document/session.hpp"
#include "editor.hpp"
#include "farewell.hpp"
#include "files.hpp"
#include "io/services.hpp"
#include "plugin/registry.hpp"
#include "render/material_composer.hpp"
#include "render/texture_composer.hpp"
#include "saving.hpp"
#include "viewport.hpp"
#include "window.hpp"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <mutex>

namespace restage::editor {

namespace {

// Readers see the old text or the new one. Not flushed to the disk: that would hold up each frame that is measured.
Result<void> write_probe(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::path temporary = path;
    temporary += ".new";
    std::ofstream file(temporary, std::ios::binary);
    file << text;
    file.close();
    std::error_code code;
    if (file) std::filesystem::rename(temporary, path, code);
    if (!file || code) return fail(path.string() + ": cannot be written");
    return {};
}

// Runs until the window is closed (0), or a signal arrives (its exit code).
Result<int> run_frames(Editor& editor, Window& window, Farewell& farewell, const RunOptions& options,
                       const std::filesystem::path& commands, const std::function<void()>& write_aside) {
    std::error_code ignored;
    std::string title, probe;
    while (!editor.quit_confirmed()) {
        const bool goes_on = editor.animating() || editor.viewport.navigating() || window.unsettled();
        farewell.busy().unlock();
        window.wait(window.input_waits() ? 0 : goes_on ? 0.016 : 0.5);
        farewell.busy().lock();
        if (const int signal = farewell.signal()) return 128 + signal;
        if (window.close_requested()) {
            window.refuse_close();
            write_aside(); // the desktop session may be ending, and will not wait for an answer
            if (window.display_gone()) return fail("the display is gone");
            editor.request_quit();
        }
        const auto begin = std::chrono::steady_clock::now();
        RESTAGE_TRY(const bool visible, window.begin_frame());
        if (!visible) continue;
        glm::vec2 where(0);
        if (const auto dropped = window.take_dropped(where); !dropped.empty()) editor.drop(dropped, {where.x, where.y});
        if (!options.probe.empty() && std::filesystem::exists(commands, ignored))
            if (const auto lines = read_file(commands)) {
                std::filesystem::remove(commands, ignored);
                editor.run_commands(*lines);
            }
        const auto keys = window.take_keys();
        editor.frame(&keys);
        RESTAGE_CHECK(window.end_frame());
        editor.presented(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
        if (editor.title() != title) window.set_title(title = editor.title());
        if (!options.probe.empty())
            if (std::string now = editor.probe(); now != probe) {
                RESTAGE_CHECK(write_probe(options.probe, now));
                probe = std::move(now);
            }
    }
    return 0;
}

// The configuration folder; "", or why nothing will be stored. A read-only one is still read.
std::string prepare(std::filesystem::path& config) {
    if (config.empty()) {
        auto user = user_data_dir();
        if (!user) return user.error().message;
        config = std::move(*user);
    }
    std::error_code code;
    std::filesystem::create_directories(config, code);
    if (code) return config.string() + ": cannot be created: " + code.message();
    const auto probe = AtomicFile::create(config / "write-test"); // gone with its owner
    return probe ? "" : probe.error().message;
}

// Once: it leaves a file of preferences.
bool is_first_start(const std::filesystem::path& config) {
    std::error_code code;
    if (std::filesystem::exists(config / "preferences.json", code)) return false;
    write_preferences(config, {});
    return std::filesystem::exists(config / "preferences.json", code);
}

} // namespace

Result<int> run_editor(const RunOptions& options) {
    // The order matters: later objects are destroyed first. The editor outlives the window, see texture.hpp.
    Notices notices;
    Log log([&](LogLevel level, std::string_view line) {
        if (level != LogLevel::debug) std::fprintf(stderr, "restage: %.*s\n", int(line.size()), line.data());
        notices.add(level, std::string(line));
    });
    plugin::Registry registry(log, io::with_services({.safe_mode = options.plugins.safe_mode,
                                                      .quarantine = plugin::Registry::default_quarantine()}));
    registry.scan(options.plugins.paths);

    std::filesystem::path config = options.config_dir;
    std::error_code ignored;
    if (const std::string problem = prepare(config); !problem.empty())
        log.warning("layout, preferences and recovery files will not be kept: " + problem);
    RESTAGE_TRY(const auto bin, executable_dir());
    registry.set_judge(render::material_judge(bin.parent_path() / "share/restage/shaders"),
                       render::texture_judge(bin.parent_path() / "share/restage/shaders"));

    // Threads may request frames before and after the window exists: GLFW ignores that.
    Editor editor(registry, log, notices,
                  {.renderer = options.renderer,
                   .wake = Window::wake,
                   .config_dir = config,
                   .autosave_seconds = options.autosave_seconds,
                   .isolate = options.isolate});
    RESTAGE_TRY(const auto window, Window::create({.size = options.size,
                                                   .device = options.renderer.device,
                                                   .validation = options.renderer.validation,
                                                   .scale = options.scale,
                                                   .fonts = bin.parent_path() / "share/restage/fonts",
                                                   .layout = config},
                                                  log));
    if (!options.scene.empty())
        editor.open(options.scene);
    else if (options.probe.empty() && is_first_start(config))
        start_tour(editor);
    offer_recovery(editor);
    std::filesystem::path commands = options.probe;
    commands += ".in";

    // However the program ends, unsaved work is saved for recovery first.
    const auto write_aside = [&editor] {
        if (editor.session().modified()) editor.files().autosave.write_now(editor.session(), 0);
    };
    Farewell farewell(Window::wake, [&] {
        write_aside();
        std::fputs("restage: the display is gone; unsaved work is kept for the next start\n", stderr);
    });
    const std::unique_lock busy(farewell.busy()); // released while it waits for events
    const auto ended = run_frames(editor, *window, farewell, options, commands, write_aside);
    if (!ended || *ended != 0) {
        write_aside();
        if (ended) log.warning("ended by " + signal_name(*ended - 128) + "; unsaved work is kept for the next start");
    }
    // Kept work is offered at the next start; otherwise nothing is left.
    if ((ended && *ended == 0) || !editor.session().modified()) editor.files().autosave.forget();
    return ended;
}

} // namespace restage::editor
