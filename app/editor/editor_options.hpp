// SPDX-License-Identifier: Apache-2.0
// EditorOptions: options of the editor at its start.
#pragma once

#include "render/renderer_options.hpp"

#include <filesystem>
#include <functional>
#include <memory>

namespace restage::document {
struct IsolateOptions;
}

namespace restage::editor {

struct EditorOptions {
    render::RendererOptions renderer;
    std::function<void()> wake; // [any] requests another frame
    std::filesystem::path config_dir; // layout, preferences; "" = nothing is remembered
    double autosave_seconds = 60; // interval between recovery copies of unsaved work
    std::shared_ptr<const document::IsolateOptions> isolate; // scenes are read in a separate process
};

} // namespace restage::editor
