// SPDX-License-Identifier: Apache-2.0
// Private to gpu/: compiled shaders on disk, one file a key. What is damaged counts as absent. Any thread, any process.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace restage::gpu {

class SpirvCache {
  public:
    explicit SpirvCache(std::filesystem::path folder); // empty: a cache that holds nothing
    std::optional<std::vector<std::uint32_t>> load(const std::string& key) const;
    void store(const std::string& key, const std::vector<std::uint32_t>& words) const; // failing to is no error
    // Removes the longest unused entries beyond `entries`.
    void trim(std::size_t entries) const;

  private:
    std::filesystem::path file_of(const std::string& key) const;
    std::filesystem::path folder_;
};

} // namespace restage::gpu
