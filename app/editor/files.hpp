// SPDX-License-Identifier: Apache-2.0
// Files: the editor's file state beyond the document: recent files, recovery copies of unsaved work, background
// jobs.
#pragma once

#include "background.hpp"
#include "document/recovery.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace restage::editor {

// The files that were opened or saved last and the folders they are in, remembered in the configuration folder.
class Recent {
  public:
    explicit Recent(std::filesystem::path file); // "" = nothing is remembered
    void add_file(const std::filesystem::path& path); // and its folder
    void add_folder(const std::filesystem::path& path);
    void clear();
    const std::vector<std::string>& files() const { return files_; } // the latest first
    const std::vector<std::string>& folders() const { return folders_; }

  private:
    void save() const;

    std::filesystem::path file_;
    std::vector<std::string> files_, folders_;
};

struct Files {
    Files(const std::filesystem::path& config, double autosave_seconds, std::function<void()> wake)
        : recent(config.empty() ? config : config / "recent.json"),
          recovery_folder(config.empty() ? config : config / "recovery"),
          autosave(recovery_folder, autosave_seconds),
          jobs(std::move(wake)) {}

    Recent recent;
    std::filesystem::path recovery_folder;
    document::Autosave autosave;
    std::string autosave_problem; // that was logged
    BackgroundJobs jobs;
    std::filesystem::path last_picture; // where the last one was written
};

} // namespace restage::editor
