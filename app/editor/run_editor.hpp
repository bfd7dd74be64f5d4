// SPDX-License-Identifier: Apache-2.0
// The editor as a program: opens the window, runs frames until it is closed.
#pragma once

#include "base/result.hpp"
#include "document/isolate.hpp"
#include "render/renderer.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace restage::editor {

struct RunOptions {
    std::string scene; // "" = start empty
    render::RendererOptions renderer;
    float scale = 0; // of the UI; 0 = the monitor's
    glm::ivec2 size{1440, 860};
    std::filesystem::path config_dir; // "" = the user's
    double autosave_seconds = 60;     // interval between copies of unsaved work in its `recovery`
    struct {
        bool safe_mode = false; // only the program's own
        std::vector<plugin::SearchPath> paths;
    } plugins;
    std::shared_ptr<const document::IsolateOptions> isolate; // scenes are read in a separate process
    std::filesystem::path probe;      // for tests: state is written here when it changes; PROBE.in holds commands
};

// [main] Returns the exit code.
Result<int> run_editor(const RunOptions& options);

} // namespace restage::editor
