// SPDX-License-Identifier: Apache-2.0
#include "common/file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <system_error>

#if !defined(_WIN32)
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace restage::importing {

namespace fs = std::filesystem;

namespace {
constexpr std::uint64_t most_bytes = std::uint64_t{16} << 30;
}

#if !defined(_WIN32)
int open_regular_file(const fs::path& path, std::uint64_t& size, std::string& reason) {
    // O_NONBLOCK: a pipe without a writer, or a device, must not block open; no effect on regular files.
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    struct stat info{};
    if (fd < 0) {
        reason = errno == ENOENT  ? "there is no such file"
                 : errno == ENXIO ? "it is not a regular file"
                                  : std::generic_category().message(errno);
        return -1;
    }
    if (fstat(fd, &info) != 0)
        reason = std::generic_category().message(errno);
    else if (S_ISDIR(info.st_mode))
        reason = "it is a folder, not a regular file";
    else if (!S_ISREG(info.st_mode))
        reason = S_ISFIFO(info.st_mode) ? "it is a pipe, not a regular file" : "it is a device, not a regular file";
    else if (static_cast<std::uint64_t>(info.st_size) > most_bytes)
        reason = "it has " + std::to_string(info.st_size) + " bytes, more than the limit";
    else {
        size = static_cast<std::uint64_t>(info.st_size);
        return fd;
    }
    ::close(fd);
    return -1;
}
#endif

std::optional<std::string> read_file(const fs::path& path, std::string& reason) {
    std::uint64_t size = 0;
#if defined(_WIN32)
    std::error_code code;
    if (!fs::is_regular_file(path, code)) {
        reason = fs::exists(path, code) ? "it is not a regular file" : "there is no such file";
        return std::nullopt;
    }
    std::FILE* file = _wfopen(path.c_str(), L"rb");
    size = fs::file_size(path, code);
#else
    const int fd = open_regular_file(path, size, reason);
    if (fd < 0) return std::nullopt;
    std::FILE* file = fdopen(fd, "rb");
    if (!file) ::close(fd);
#endif
    if (!file) {
        reason = std::generic_category().message(errno);
        return std::nullopt;
    }
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> closer(file, std::fclose);
    std::string bytes;
    bytes.reserve(static_cast<std::size_t>(size) + 1);
    char block[1 << 16];
    for (std::size_t n; (n = std::fread(block, 1, sizeof block, file)) > 0;) {
        bytes.append(block, n);
        if (bytes.size() > most_bytes) break;
    }
    if (std::ferror(file) || bytes.size() > most_bytes) {
        reason = std::ferror(file) ? "it cannot be read" : "it has more bytes than the limit";
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
    const fs::path as_written = folder / fs::path(name); // an absolute name is unchanged
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
