// SPDX-License-Identifier: Apache-2.0
#include "gpu/spirv_cache.hpp"

#include "base/file.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace restage::gpu {

namespace {

constexpr std::string_view magic = "restage spirv 1\n";
constexpr std::uint32_t spirv_magic = 0x07230203;

} // namespace

SpirvCache::SpirvCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

std::filesystem::path SpirvCache::file_of(const std::string& key) const { return folder_ / (key + ".spv"); }

// A file: magic, key, XXH64 of the words, words.
std::optional<std::vector<std::uint32_t>> SpirvCache::load(const std::string& key) const {
    std::error_code failed;
    if (folder_.empty() || !std::filesystem::is_regular_file(file_of(key), failed)) return {};
    const auto file = read_file(file_of(key));
    const std::size_t head = magic.size() + key.size() + sizeof(std::uint64_t);
    if (!file || file->size() <= head || (file->size() - head) % sizeof(std::uint32_t) != 0) return {};
    const std::string_view bytes = *file;
    if (!bytes.starts_with(magic) || bytes.substr(magic.size(), key.size()) != key) return {};
    std::uint64_t sum = 0;
    std::memcpy(&sum, bytes.data() + head - sizeof sum, sizeof sum);
    if (sum != hash64(bytes.substr(head))) return {};
    std::vector<std::uint32_t> words((bytes.size() - head) / sizeof(std::uint32_t));
    std::memcpy(words.data(), bytes.data() + head, bytes.size() - head);
    if (words.front() != spirv_magic) return {};
    std::filesystem::last_write_time(file_of(key), std::filesystem::file_time_type::clock::now(), failed);
    return words;
}

void SpirvCache::store(const std::string& key, const std::vector<std::uint32_t>& words) const {
    if (folder_.empty()) return;
    std::error_code failed;
    std::filesystem::create_directories(folder_, failed);
    const std::string_view payload(reinterpret_cast<const char*>(words.data()), words.size() * sizeof(std::uint32_t));
    const std::uint64_t sum = hash64(payload);
    std::string bytes(magic);
    bytes += key;
    bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
    bytes += payload;
    (void)write_file_atomic(file_of(key), bytes); // on failure the next start just recompiles
}

void SpirvCache::trim(std::size_t entries) const {
    if (folder_.empty()) return;
    std::error_code failed;
    std::vector<std::pair<std::filesystem::file_time_type, std::filesystem::path>> files;
    for (std::filesystem::directory_iterator it(folder_, failed), end; !failed && it != end; it.increment(failed)) {
        std::error_code gone;
        if (it->path().extension() != ".spv") continue;
        const auto time = it->last_write_time(gone);
        if (!gone) files.emplace_back(time, it->path());
    }
    if (files.size() <= entries) return;
    std::sort(files.begin(), files.end());
    files.resize(files.size() - entries);
    for (const auto& [time, path] : files)
        std::filesystem::remove(path, failed);
}

} // namespace restage::gpu
