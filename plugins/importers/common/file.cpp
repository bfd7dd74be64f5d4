// SPDX-License-Identifier: Apache-2.0
#include "common/file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>

namespace restage::importing {

namespace fs = std::filesystem;

std::optional<std::string> read_file(const fs::path& path, std::string& reason) {
    std::error_code code;
    if (fs::is_directory(path, code)) {
        reason = "it is a folder";
        return std::nullopt;
    }
    std::FILE* file = std::fopen(path.string().c_str(), "rb");
    if (!file) {
        reason = std::generic_category().message(errno);
        return std::nullopt;
    }
    std::string bytes;
    const auto size = fs::file_size(path, code); // of a pipe there is none
    if (!code) bytes.reserve(static_cast<std::size_t>(size) + 1);
    char block[1 << 16];
    for (std::size_t n; (n = std::fread(block, 1, sizeof block, file)) > 0;)
        bytes.append(block, n);
    const bool failed = std::ferror(file) != 0;
    std::fclose(file);
    if (failed) {
        reason = "it cannot be read";
        return std::nullopt;
    }
    return bytes;
}

std::string lower(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
    return result;
}

bool has_extension(const char* path, std::string_view extension) {
    const std::string name = lower(path ? path : "");
    return name.size() > extension.size() && name.ends_with(extension) &&
           name[name.size() - extension.size() - 1] == '.';
}

fs::path find_file(const fs::path& folder, const std::string& name) {
    std::error_code code;
    const auto absolute = [&](const fs::path& path) {
        const fs::path full = fs::weakly_canonical(path, code);
        return code ? path : full;
    };
    const fs::path as_written = folder / fs::path(name); // an absolute name stays itself
    if (fs::exists(as_written, code)) return absolute(as_written);
    std::string slashes = name;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    if (const fs::path path = folder / slashes; fs::exists(path, code)) return absolute(path);
    const fs::path last = fs::path(slashes).filename();
    for (const fs::path& beside : {(folder / slashes).parent_path(), folder}) {
        if (!fs::is_directory(beside, code)) continue;
        if (fs::exists(beside / last, code)) return absolute(beside / last);
        for (fs::directory_iterator entry(beside, code), end; !code && entry != end; entry.increment(code))
            if (lower(entry->path().filename().string()) == lower(last.string())) return absolute(entry->path());
    }
    return absolute(folder / slashes);
}

} // namespace restage::importing
