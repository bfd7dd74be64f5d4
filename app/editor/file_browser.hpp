// SPDX-License-Identifier: Apache-2.0
// FileBrowser: choosing a file inside the window. Folders are listed, and paths checked, on threads that are
// abandoned if they hang, as on a lost network drive.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace restage::editor {

class EditContext;
class PanelContext;

struct FileFilter {
    std::string label;                   // "Scenes"
    std::vector<std::string> extensions; // without dots, lower case; none = every file
};

struct BrowseOptions {
    std::string title; // "Open a scene"
    bool save = false; // a new name may be typed, folders created, and replacing a file asks
    bool folder = false; // chooses a folder: files are not listed
    std::vector<FileFilter> filters;
    std::filesystem::path start; // a folder; "" = the last used one
    std::string name;            // initial text of the field
    std::string extension;       // appended to a name without one on saving: ".restage"
    std::function<void(PanelContext&, const std::filesystem::path&)> done;
    // Drawn below the name, for the chosen file ("" = none). `focus`: it should take the keyboard (Alt+O).
    std::function<void(PanelContext&, const std::filesystem::path&, bool focus)> details = {};
};

// Shows it as a modal.
void browse(EditContext& editor, BrowseOptions options);

struct FileEntry {
    std::string name;
    bool folder = false;
    std::uintmax_t size = 0;
    std::filesystem::file_time_type time;
};

// The common continuation of all `names` that begin with `typed`: what Tab adds.
std::string completion(const std::string& typed, const std::vector<FileEntry>& names);

} // namespace restage::editor
