// SPDX-License-Identifier: Apache-2.0
// Raw bytes of files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace restage::importing {

// Bytes of a regular file: mapped where possible, inflated when it starts with the gzip magic number.
class FileBytes {
  public:
    // nullopt and a reason if the file cannot be read.
    static std::optional<FileBytes> open(const std::filesystem::path& path, std::string& reason);
    static FileBytes from_memory(std::string text);
    FileBytes(FileBytes&& other) noexcept;
    FileBytes& operator=(FileBytes&&) = delete;
    ~FileBytes();

    std::string_view view() const { return {data_, size_}; }

  private:
    FileBytes() = default;
    const char* data_ = nullptr;
    std::size_t size_ = 0;
    bool mapped_ = false;
    std::unique_ptr<std::vector<char>> owned_;
};

} // namespace restage::importing
