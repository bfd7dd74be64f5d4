// SPDX-License-Identifier: Apache-2.0
// The tour: six steps on the example room. Each points at a place, says in a sentence what to do there, and is done
// when the user did it. Nothing is locked meanwhile, and it can be left at any time.
#pragma once

#include "scene/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace restage::editor {

class Editor;
class PanelContext;

class Tour {
  public:
    bool running() const { return running_; }
    std::size_t step() const { return step_; } // from 0
    void start(); // when a document is open
    void end() { running_ = false; }
    // Draws the step over everything else, and goes on when it is done. Once a frame, after all panels.
    void update(Editor& editor);

  private:
    void begin_step(PanelContext& editor);

    bool running_ = false, begun_ = false;
    std::size_t step_ = 0;
    // When the step began:
    scene::Scene before_; // shares its contents with the document
    std::uint64_t view_ = 0, document_ = 0;
    bool was_saved_ = false;
};

// Opens the example room, after a question about unsaved changes, and starts; where it is not installed, with the
// document that is open.
void start_tour(Editor& editor);
// The scene of the tour; "" if it is not installed.
std::filesystem::path example_room();

} // namespace restage::editor
