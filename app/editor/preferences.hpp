// SPDX-License-Identifier: Apache-2.0
// Preferences: the user's choices, and hints already seen, stored in the configuration folder; not part of any
// document.
#pragma once

#include <filesystem>
#include <string>

namespace restage::editor {

enum class KeyPreset { standard, blender };
enum class Theme { dark, light };

struct SnapTo { // what a dragged thing snaps to
    bool grid = false, vertex = false, surface = false, wall = false;
    bool any() const { return grid || vertex || surface || wall; }
    bool operator==(const SnapTo&) const = default;
};

struct Preferences {
    bool hint_seen = false; // the first-start hints over the picture
    KeyPreset keys = KeyPreset::standard;
    Theme theme = Theme::dark;
    float snap_move = 0.1f, snap_angle = 15, snap_scale = 0.1f; // steps of drags with Ctrl: scene units, deg, factor
    SnapTo snap_to;
    int history_mib = 512; // memory budget of the history [MiB], 16 to 65536
    bool whole_things = true; // a click takes all parts of what it hits
    bool collide = false; // moved things do not enter others: collide_drag.hpp
    std::string denoiser; // type or id of its plugin; "" = the one shipped with the program
    bool operator==(const Preferences&) const = default;
};

// Defaults if the file is missing or unreadable.
Preferences read_preferences(const std::filesystem::path& config_dir);
// Does nothing without a folder.
void write_preferences(const std::filesystem::path& config_dir, const Preferences& preferences);

} // namespace restage::editor
