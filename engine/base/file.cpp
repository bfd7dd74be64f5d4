// SPDX-License-Identifier: Apache-2.0
// Reading, atomic writing and the program's folders.
#include "base/file.hpp"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <system_error>

#if defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#include <io.h>
#include <windows.h>
#else
#include <fcntl.h>
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
    return std::fopen(path.c_str(), mode);
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

// After a rename the folder's entry has to reach the disk too. File systems that cannot do it are not worse off.
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

Result<std::string> read_file(const fs::path& path) {
    std::error_code code;
    if (fs::is_directory(path, code)) return fail(path.string() + ": is a folder, a file was expected");
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(open_file(path, "rb"), std::fclose);
    if (!file) return fail(path.string() + ": cannot be opened: " + reason(errno));
    std::string bytes;
    const auto size = fs::file_size(path, code);
    if (!code && size < (std::uintmax_t{1} << 40)) // only a hint: pipes and /proc have none
        bytes.resize(static_cast<std::size_t>(size));
    std::size_t filled = 0;
    for (;;) {
        if (filled == bytes.size()) bytes.resize(bytes.size() + 65536);
        const std::size_t got = std::fread(bytes.data() + filled, 1, bytes.size() - filled, file.get());
        filled += got;
        if (got == 0) break;
    }
    if (std::ferror(file.get())) return fail(path.string() + ": cannot be read: " + reason(errno));
    bytes.resize(filled);
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
    static std::atomic<unsigned> counter{0}; // several writers of one name in one process
#if defined(_WIN32)
    const auto process = static_cast<unsigned long>(GetCurrentProcessId());
#else
    const auto process = static_cast<unsigned long>(getpid());
#endif
    fs::path temporary = path;
    temporary += ".tmp-" + std::to_string(process) + "-" + std::to_string(counter++);
    std::FILE* file = open_file(temporary, "wbx");
    if (!file) return fail(path.string() + ": cannot be written: " + reason(errno));
    return AtomicFile(path, std::move(temporary), file);
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
