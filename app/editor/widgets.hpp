// SPDX-License-Identifier: Apache-2.0
// Widgets that panels share: rows of a form, icons, lists with a search field. Widgets of plugin parameters are in
// param_widget.hpp.
#pragma once

#include <imgui.h>
#include <functional>
#include <string>
#include <string_view>

namespace restage::editor {

// A row of a form: the label in the left column with its tooltip; the next item fills the rest of the line except
// `right` pixels. Labels that do not fit are truncated, and shown in full by the tooltip.
void form_row(const char* label, const char* tooltip = nullptr, float right = 0);
// Call at the start of a dialog: its width, if the window has room [at scale 1].
void dialog_width(float width);
// The header of a collapsible section, in a neutral colour: orange is for selected things.
bool section_header(const char* label, bool open_at_first = false);
// The tooltip of the last item, also of a disabled one.
void tip(const char* text);
// The text of an empty panel: wrapped, dim.
void empty_note(const char* text);
// Wrapped text with the colour of a warning.
void warning_note(const char* text);
void error_note(const char* text);

enum class Icon { eye, eye_closed, lock, lock_open, texture, light, camera, sky, cross, mesh };
// A square button as high as a line; `on` = bright, else dim.
bool icon_button(const char* id, Icon icon, bool on, const char* tooltip);
void draw_icon(ImDrawList* draw, Icon icon, ImVec2 corner, float size, ImU32 color);

// Whether `word` is in `text`, ignoring case. "" is in everything.
bool contains_word(std::string_view text, std::string_view word);
// Puts the next item, this wide, next to the last one, or on the next line at the window's edge.
void flow(float width);
float check_width(const char* label); // of a checkbox or radio button
// Buttons in a row, wrapping at the window's edge.
bool flow_button(const char* label, bool first = false);

// A search field for a long list: draws "search" and calls row(i) for matching names, virtualised. Call between
// BeginCombo/BeginPopup and their end. The caller owns `search`, which is cleared when the list appears.
void searched_list(std::string& search, std::size_t count, const std::function<std::string_view(std::size_t)>& name,
                   const std::function<void(std::size_t)>& row, float row_height = 0); // 0 = a line of text

// An editable name. True once a new one is entered, not while it is typed.
bool name_field(const char* id, std::string& name);

// Display text of a choice of a plugin's table ("ggx", "repeat").
std::string choice_label(std::string_view choice);

// Speed at which a drag changes a value of this magnitude.
float drag_speed(float value, float least = 1e-4f);

} // namespace restage::editor
