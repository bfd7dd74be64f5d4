// SPDX-License-Identifier: Apache-2.0
// Options of importers in the editor: rows in the file browser for the chosen file, kept per format while the program
// runs, and a dialog that rereads the document's scene with other options.
#pragma once

#include "scene/params.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace restage::editor {

class DocumentContext;
class EditContext;
class Editor;

// The part of the file browser for a file of this name; empty if its importer has no options. `focus`: the first
// one gets the keyboard.
void import_options_part(EditContext& e, const std::filesystem::path& file, bool focus);
// The current ones for a chosen file.
std::optional<scene::ParamSet> import_options_for(const DocumentContext& e, const std::filesystem::path& file);

// "" or why there are none: the importer of the document's scene has no options.
std::string why_not_import_again(const DocumentContext& e);
// "units=cm, up=z" of the document's scene; "" = none are set.
std::string import_options_text(const DocumentContext& e);
// Opens a dialog for options, and reopens the document with them.
// At once, with the options last chosen for its format (ImportState), or those it was read with.
void read_again(Editor& e);
void import_again(Editor& e);

} // namespace restage::editor
