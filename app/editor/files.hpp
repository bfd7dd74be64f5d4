// SPDX-License-Identifier: Apache-2.0
// Files: what the editor knows of files beyond the document: the recent ones, unsaved work written aside, work that
// goes on in the background.
#pragma once

#include "background.hpp"
#include "document/recovery.hpp"
#include "recent.hpp"

#include <filesystem>
#include <functional>

namespace restage::editor {

struct Files {
    Files(const std::filesystem::path& config, double autosave_seconds, std::function<void()> wake)
        : recent(config.empty() ? config : config / "recent.json"),
          recovery_folder(config.empty() ? config : config / "recovery"),
          autosave(recovery_folder, autosave_seconds),
          jobs(std::move(wake)) {}

    Recent recent;
    std::filesystem::path recovery_folder;
    document::Autosave autosave;
    std::string autosave_problem; // that was said
    BackgroundJobs jobs;
    std::filesystem::path last_picture; // where one was written last
};

} // namespace restage::editor
