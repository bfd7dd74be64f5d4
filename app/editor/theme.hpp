// SPDX-License-Identifier: Apache-2.0
// Theme: fonts, colours and spacing of the editor, for any scale.
#pragma once

#include "fonts.hpp"

#include <imgui.h>
#include <filesystem>
#include <span>

namespace restage::editor {

// Call once after the context is created. Without the font Dear ImGui's own is used. `fallback`: for missing glyphs,
// which are rasterized on first use.
void apply_theme(float scale, const std::filesystem::path& fonts, std::span<const FallbackFont> fallback = {});

namespace colors {
inline constexpr ImVec4 accent{0.96f, 0.62f, 0.22f, 1}; // selection, active things
inline constexpr ImVec4 hover{0.55f, 0.78f, 0.98f, 1};
inline constexpr ImVec4 good{0.45f, 0.78f, 0.47f, 1};
inline constexpr ImVec4 warning{0.95f, 0.76f, 0.30f, 1};
inline constexpr ImVec4 error{0.95f, 0.42f, 0.38f, 1};
inline constexpr ImVec4 dim{0.60f, 0.62f, 0.66f, 1};
inline constexpr ImVec4 axes[3] = {
    {0.93f, 0.40f, 0.40f, 1}, {0.55f, 0.80f, 0.38f, 1}, {0.42f, 0.64f, 0.98f, 1}}; // x y z
inline constexpr ImVec4 over_picture{0.063f, 0.063f, 0.071f, 0.8f}; // ground of text there
} // namespace colors

} // namespace restage::editor
