// SPDX-License-Identifier: Apache-2.0
// Theme: fonts, colours and spacing of the editor, for any scale.
#pragma once

#include "fonts.hpp"
#include "preferences.hpp"

#include <imgui.h>
#include <filesystem>
#include <span>

namespace restage::editor {

// Call once after the context is created. Without the font Dear ImGui's own is used. `fallback`: for missing glyphs,
// which are rasterized on first use. The theme is then dark.
void apply_theme(float scale, const std::filesystem::path& fonts, std::span<const FallbackFont> fallback = {});
// Sets all colours, here and of Dear ImGui; between frames or inside one.
void apply_colors(Theme theme);
Theme current_theme();

// WCAG 2.1's contrast ratio of two opaque colours, 1 to 21: 4.5 suffices for text, 3 for what is disabled, large text
// and graphics (https://www.w3.org/TR/WCAG21/#dfn-contrast-ratio).
float contrast(const ImVec4& a, const ImVec4& b);
// The colour that is seen where `top` is drawn on an opaque `below`.
ImVec4 blend(const ImVec4& top, const ImVec4& below);
ImU32 faded(const ImVec4& color, float alpha); // with this opacity instead of its own

// Of the current theme. [main]
struct Colors {
    ImVec4 accent; // selection, active things
    ImVec4 hover; // under the mouse; links
    ImVec4 good, warning, error;
    ImVec4 dim; // less important text
    ImVec4 off; // icons of what is switched off
    ImVec4 axes[3]; // x y z
    ImVec4 over_picture; // ground of text there
};
namespace colors {
extern const ImVec4 &accent, &hover, &good, &warning, &error, &dim, &off, &over_picture;
extern const ImVec4 (&axes)[3];
// In the picture, in both themes: light enough for dark scenes.
inline constexpr ImVec4 selected{0.96f, 0.62f, 0.22f, 1}, pointed{0.55f, 0.78f, 0.98f, 1};
inline constexpr ImVec4 lamp{0.95f, 0.76f, 0.30f, 1}, lamp_off{0.64f, 0.66f, 0.70f, 1};
} // namespace colors

} // namespace restage::editor
