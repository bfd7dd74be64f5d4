// SPDX-License-Identifier: Apache-2.0
// Where tests of images take files from and put them.
#pragma once

#include <filesystem>
#include <random>
#include <string>

namespace restage::test {

inline std::string data_image(const std::string& name) { return RESTAGE_SOURCE_DIR "/tests/data/images/" + name; }

// An empty folder of its own, gone at the end.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::random_device random;
        path_ = std::filesystem::temp_directory_path() /
                ("restage-" + std::to_string(random()) + "-" + std::to_string(random()));
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }

  private:
    std::filesystem::path path_;
};

} // namespace restage::test
