// SPDX-License-Identifier: Apache-2.0
// Private to gpu/: compiled shaders on disk, one file per key. Damaged files count as absent. Any thread, any process.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace restage::gpu {

class SpirvCache {
  public:
    explicit SpirvCache(std::filesystem::path folder); // empty: the cache is disabled
    std::optional<std::vector<std::uint32_t>> load(const std::string& key) const;
    void store(const std::string& key, const std::vector<std::uint32_t>& words) const; // failure is not an error
    // Removes the longest unused entries beyond `entries`.
    void trim(std::size_t entries) const;

  private:
    std::filesystem::path file_of(const std::string& key) const;
    std::filesystem::path folder_;
};

} // namespace restage::gpu
