// SPDX-License-Identifier: Apache-2.0
// Reading, atomic writing and the program's folders.
#include "base/file.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

#if defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#include <io.h>
#include <windows.h>
#else
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace restage {

namespace fs = std::filesystem;

namespace {

std::string reason(int code) { return std::generic_category().message(code); }

std::FILE* open_file(const fs::path& path, const char* mode) {
#if defined(_WIN32)
    const std::wstring wide_mode(mode, mode + std::strlen(mode));
    return _wfopen(path.c_str(), wide_mode.c_str());
#else
    return std::fopen(path.c_str(), (std::string(mode) + "e").c_str()); // closed in children (glibc, musl, BSD)
#endif
}

bool flush_to_disk(std::FILE* file) {
    if (std::fflush(file) != 0) return false;
#if defined(_WIN32)
    return _commit(_fileno(file)) == 0;
#else
    return fsync(fileno(file)) == 0;
#endif
}

// After a rename the folder's entry must be flushed as well. Ignored if the file system does not support it.
void flush_folder(const fs::path& folder) {
#if !defined(_WIN32)
    const int fd = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd >= 0) {
        (void)fsync(fd);
        ::close(fd);
    }
#else
    (void)folder;
#endif
}

Result<fs::path> home_folder(const char* variable, const char* below_home) {
    if (const char* value = std::getenv(variable); value && *value && fs::path(value).is_absolute())
        return fs::path(value) / "restage";
#if defined(_WIN32)
    (void)below_home;
    return fail(std::string("the environment variable ") + variable + " is not set");
#else
    const char* home = std::getenv("HOME");
    if (!home || !*home)
        return fail(std::string("neither ") + variable + " nor HOME is set: set one of them to a folder");
    return fs::path(home) / below_home / "restage";
#endif
}

} // namespace

Result<RegularFile> RegularFile::open(const fs::path& path) {
    const auto is = [&](const char* what) { return fail(path.string() + ": is " + what + ", not a regular file"); };
#if defined(_WIN32)
    std::error_code code;
    const auto kind = fs::status(path, code);
    if (fs::is_directory(kind)) return is("a folder");
    if (fs::exists(kind) && !fs::is_regular_file(kind)) return is("a device");
    std::FILE* file = open_file(path, "rb");
    if (!file) return fail(path.string() + ": cannot be opened: " + reason(errno));
    return RegularFile(path, file, fs::file_size(path, code));
#else
    // O_NONBLOCK: a pipe without a writer, or a device, must not block open; it has no effect on regular files.
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (fd < 0) {
        if (errno == ENXIO) return is("a socket or a device"); // not openable at all
        return fail(path.string() + ": cannot be opened: " + reason(errno));
    }
    struct stat info{};
    std::FILE* file = fstat(fd, &info) == 0 && S_ISREG(info.st_mode) ? fdopen(fd, "rb") : nullptr;
    if (file) return RegularFile(path, file, static_cast<std::uint64_t>(info.st_size));
    ::close(fd);
    if (S_ISDIR(info.st_mode)) return is("a folder");
    return is(S_ISFIFO(info.st_mode) ? "a pipe" : "a device");
#endif
}

RegularFile::RegularFile(fs::path path, std::FILE* file, std::uint64_t size)
    : path_(std::move(path)), file_(file), size_(size) {}

RegularFile::RegularFile(RegularFile&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, nullptr)), size_(other.size_) {}

RegularFile::~RegularFile() {
    if (file_) std::fclose(file_);
}

std::FILE* RegularFile::release() { return std::exchange(file_, nullptr); }

Result<std::string> RegularFile::read(std::uint64_t most) {
    std::string bytes;
    bytes.resize(static_cast<std::size_t>(std::min(most, size_))); // a guess: files grow, and /proc reports size 0
    std::size_t filled = 0;
    while (filled < most) {
        if (filled == bytes.size())
            bytes.resize(static_cast<std::size_t>(std::min<std::uint64_t>(most, bytes.size() + 65536)));
        const std::size_t got = std::fread(bytes.data() + filled, 1, bytes.size() - filled, file_);
        filled += got;
        if (got == 0) break;
    }
    if (std::ferror(file_)) return fail(path_.string() + ": cannot be read: " + reason(errno));
    bytes.resize(filled);
    return bytes;
}

Result<std::string> read_file(const fs::path& path, std::uint64_t most) {
    RESTAGE_TRY(RegularFile file, RegularFile::open(path));
    const auto too_large = [&](std::uint64_t size) {
        return fail(path.string() + ": has " + std::to_string(size) + " bytes, more than the " + std::to_string(most) +
                    " that are read");
    };
    if (file.size() > most) return too_large(file.size());
    RESTAGE_TRY(std::string bytes, file.read(most + 1));
    if (bytes.size() > most) return too_large(bytes.size()); // it grew, or its size was not reported
    return bytes;
}

Result<> write_file_atomic(const fs::path& path, std::string_view bytes) {
    RESTAGE_TRY(AtomicFile file, AtomicFile::create(path));
    RESTAGE_CHECK(file.write(bytes));
    return file.commit();
}

AtomicFile::AtomicFile(fs::path target, fs::path temporary, std::FILE* file)
    : target_(std::move(target)), temporary_(std::move(temporary)), file_(file) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::move(other.temporary_)),
      file_(std::exchange(other.file_, nullptr)) {}

AtomicFile::~AtomicFile() {
    if (file_) {
        std::fclose(file_);
        std::error_code ignored;
        fs::remove(temporary_, ignored);
    }
}

Result<AtomicFile> AtomicFile::create(const fs::path& path) {
    static std::atomic<unsigned> counter{0}; // one process may have several writers of one name
#if defined(_WIN32)
    const auto process = static_cast<unsigned long>(GetCurrentProcessId());
#else
    const auto process = static_cast<unsigned long>(getpid());
#endif
    std::error_code code;
    const fs::file_status kind = fs::status(path, code); // follows links
    if (fs::exists(kind) && !fs::is_regular_file(kind)) // a rename would replace it
        return fail(path.string() + ": is " +
                    (fs::is_directory(kind) ? "a folder"
                     : fs::is_fifo(kind)    ? "a pipe"
                                            : "a device") +
                    ", not a regular file");
    const fs::path target = fs::is_symlink(path, code) && fs::exists(kind) ? fs::canonical(path, code) : path;
    fs::path temporary = target;
    temporary += ".tmp-" + std::to_string(process) + "-" + std::to_string(counter++);
    std::FILE* file = open_file(temporary, "wbx");
    if (!file) return fail(path.string() + ": cannot be written: " + reason(errno));
    return AtomicFile(target, std::move(temporary), file);
}

Result<> AtomicFile::write(std::string_view bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size())
        return fail(target_.string() + ": cannot be written: " + reason(errno));
    return {};
}

Result<> AtomicFile::commit() {
    const bool flushed = flush_to_disk(file_);
    const int why = errno;
    const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
    std::error_code code;
    if (!flushed || !closed) {
        const std::string text = reason(flushed ? errno : why);
        fs::remove(temporary_, code);
        return fail(target_.string() + ": cannot be written: " + text);
    }
    fs::rename(temporary_, target_, code);
    if (code) {
        std::error_code ignored;
        fs::remove(temporary_, ignored);
        return fail(target_.string() + ": cannot be replaced: " + code.message());
    }
    flush_folder(target_.parent_path());
    return {};
}

Result<fs::path> executable_path() {
#if defined(_WIN32)
    std::wstring buffer(32768, L'\0');
    const DWORD length = GetModuleFileNameW(nullptr, buffer.data(), static_cast<DWORD>(buffer.size()));
    if (length == 0 || length == buffer.size()) return fail("the path of the running program cannot be found");
    buffer.resize(length);
    return fs::path(buffer);
#else
    std::error_code code;
    fs::path path = fs::read_symlink("/proc/self/exe", code);
    if (code) return fail("/proc/self/exe: cannot be read: " + code.message());
    return path;
#endif
}

Result<fs::path> executable_dir() {
    RESTAGE_TRY(const fs::path path, executable_path());
    return path.parent_path();
}

Result<fs::path> cache_dir() {
#if defined(_WIN32)
    RESTAGE_TRY(fs::path folder, home_folder("LOCALAPPDATA", ""));
    folder /= "cache";
#else
    RESTAGE_TRY(const fs::path folder, home_folder("XDG_CACHE_HOME", ".cache"));
#endif
    std::error_code code;
    fs::create_directories(folder, code);
    if (code) return fail(folder.string() + ": cannot be created: " + code.message());
#if !defined(_WIN32)
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        return fail(folder.string() + ": cannot be written: " + reason(errno));
#endif
    return folder;
}

Result<fs::path> user_data_dir() {
#if defined(_WIN32)
    return home_folder("APPDATA", "");
#else
    return home_folder("XDG_DATA_HOME", ".local/share");
#endif
}

} // namespace restage
