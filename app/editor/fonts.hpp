// SPDX-License-Identifier: Apache-2.0
// System fonts for names that the UI's own font cannot show: Chinese, Japanese, Korean and others.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace restage::editor {

struct Script {
    const char* name; // "Japanese"
    char32_t sample; // a character that every font for it has
    char32_t first, last; // its code point ranges
};
std::span<const Script> known_scripts();
// The script of a character that the UI's font does not cover; null = not listed.
const Script* script_of(char32_t c);

// Where this system keeps fonts.
std::vector<std::filesystem::path> system_font_folders();

struct FallbackFont {
    std::filesystem::path file;
    int face = 0; // within a collection (.ttc)
};
struct FallbackFonts {
    std::vector<FallbackFont> fonts; // in lookup order
    std::vector<std::string> missing; // scripts without a font
};
// A minimal set of fonts that covers every script that any font covers. Reads only the character maps.
FallbackFonts find_fallback_fonts(std::span<const std::filesystem::path> folders);

// Whether that face of the file has a glyph for the character (its table "cmap", formats 4 and 12).
bool font_has(const std::filesystem::path& file, int face, char32_t c);

} // namespace restage::editor
