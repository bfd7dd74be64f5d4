// SPDX-License-Identifier: Apache-2.0
#include "check/workplace.hpp"

#include "base/file.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <random>

namespace restage::check {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
    std::error_code ignored;
    path = fs::temp_directory_path(ignored) / fmt::format("restage-check-{}", std::random_device{}());
    fs::create_directories(path, ignored);
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
}

std::string noise(Engine& e, std::size_t kind, std::string_view head) {
    std::string bytes(head);
    const std::size_t length = kind == 0 ? 0 : kind < 4 ? kind : e() % 4096;
    for (std::size_t i = 0; i < length; ++i)
        switch (kind % 3) {
            case 0:
                bytes += static_cast<char>(e() % 256);
                break;
            case 1:
                bytes += i % 40 == 39 ? '\n' : static_cast<char>(' ' + e() % 95);
                break;
            default: // numbers, with what numbers may go wrong by
                constexpr std::string_view words[] = {"0",          "1",           "-1",    "1e38",
                                                      "4294967295", "-2147483648", "nan",   "inf",
                                                      "0.5",        "\n",          "1e-45", "99999999999999999999"};
                bytes += std::string(words[e() % std::size(words)]) + " ";
                break;
        }
    return bytes;
}

std::string broken_version(Engine& e, const std::string& good, std::size_t kind) {
    if (good.empty()) return good;
    const std::size_t at = e() % good.size(), length = 1 + e() % std::max<std::size_t>(good.size() / 4, 1);
    std::string bad = good;
    switch (kind % 4) {
        case 0:
            bad.resize(at);
            break;
        case 1:
            for (std::size_t i = 0; i < 1 + good.size() / 64; ++i)
                bad[e() % bad.size()] = static_cast<char>(e() % 256);
            break;
        case 2:
            bad.erase(at, length);
            break;
        default:
            bad.insert(at, good, at, length);
            break;
    }
    return bad;
}

std::size_t open_files() {
    std::size_t count = 0;
    std::error_code code;
    for (fs::directory_iterator it("/proc/self/fd", code), end; !code && it != end; it.increment(code))
        ++count;
    return count;
}

std::vector<std::pair<std::string, std::string>> contents_of(const fs::path& folder) {
    std::vector<std::pair<std::string, std::string>> all;
    std::error_code code;
    for (fs::recursive_directory_iterator it(folder, code), end; !code && it != end; it.increment(code)) {
        std::error_code ignored;
        if (!it->is_regular_file(ignored)) continue;
        auto text = read_file(it->path());
        all.emplace_back(it->path().lexically_relative(folder).generic_string(), text ? std::move(*text) : "");
    }
    std::sort(all.begin(), all.end());
    return all;
}

} // namespace restage::check
