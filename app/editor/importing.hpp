// SPDX-License-Identifier: Apache-2.0
// Options of importers in the editor: rows in the file browser for the file that is chosen there, remembered per format
// while the program runs, and a dialog that reads the document's scene again with others.
#pragma once

#include "scene/params.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace restage::editor {

class DocumentContext;
class EditContext;
class Editor;

// The part of the file browser for a file of this name; nothing where its importer has no options. `focus`: the first
// one gets the keyboard.
void import_options_part(EditContext& e, const std::filesystem::path& file, bool focus);
// As they stand there for a file that has been chosen.
std::optional<scene::ParamSet> import_options_for(const DocumentContext& e, const std::filesystem::path& file);

// "" or why there is nothing to choose: the importer of the document's scene has no options.
std::string why_not_import_again(const DocumentContext& e);
// "units=cm, up=z" of the document's scene; "" = none are set.
std::string import_options_text(const DocumentContext& e);
// Asks for options, and opens the document anew with them.
void import_again(Editor& e);

} // namespace restage::editor
