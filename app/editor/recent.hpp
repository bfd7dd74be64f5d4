// SPDX-License-Identifier: Apache-2.0
// Recent: the files that were opened or saved last and the folders they are in, remembered in the configuration folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace restage::editor {

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

} // namespace restage::editor
