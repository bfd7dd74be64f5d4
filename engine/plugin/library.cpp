// SPDX-License-Identifier: Apache-2.0
#include "plugin/library.hpp"

#include <system_error>
#include <utility>

#if defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#else
#include "base/file.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>
#include <cerrno>
#include <cstdlib>
#endif
#if defined(__linux__)
#include <elf.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <atomic>
#include <cstdint>
#include <cstring>
#endif

namespace restage::plugin {

Library::Library(Library&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}

Library& Library::operator=(Library&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
}

#if defined(_WIN32)

const char* Library::extension() { return ".dll"; }

Result<Library> Library::open(const std::filesystem::path& path) {
    // Dependencies are searched in the library's folder, not in the current folder.
    if (HMODULE handle =
            LoadLibraryExW(path.c_str(), nullptr, LOAD_LIBRARY_SEARCH_DLL_LOAD_DIR | LOAD_LIBRARY_SEARCH_DEFAULT_DIRS))
        return Library(handle);
    return fail(path.string() + ": " + std::system_category().message(static_cast<int>(GetLastError())));
}

Result<Library> Library::open_copy(const std::filesystem::path& path) { return open(path); } // files in use are locked

Library::~Library() {
    if (handle_) FreeLibrary(static_cast<HMODULE>(handle_));
}

void* Library::symbol(const char* name) const {
    return reinterpret_cast<void*>(GetProcAddress(static_cast<HMODULE>(handle_), name));
}

#else

const char* Library::extension() { return ".so"; }

namespace {

struct Descriptor { // closed with its owner
    int file;
    explicit Descriptor(int f) : file(f) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (file >= 0) ::close(file);
    }
};

bool write_all(int file, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(file, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
}

} // namespace

#if defined(__linux__)

namespace {

// dlopen maps segments without checking whether the file is long enough: a truncated library would kill this
// program with SIGBUS, and one for another processor is reported as "no such file". So the ELF header is checked first.
Result<> check_elf(const std::filesystem::path& path) {
    RESTAGE_TRY(const std::string bytes, read_file(path));
    Elf64_Ehdr header, ours;
    const Descriptor self(::open("/proc/self/exe", O_RDONLY | O_CLOEXEC));
    if (self.file < 0 || ::read(self.file, &ours, sizeof ours) != static_cast<ssize_t>(sizeof ours))
        return fail("/proc/self/exe: cannot be read");
    const auto broken = [&](const std::string& what) -> Result<> { return fail(path.string() + ": " + what); };
    if (bytes.size() < SELFMAG || std::memcmp(bytes.data(), ELFMAG, SELFMAG) != 0)
        return broken("is not a shared library (not an ELF file)");
    if (bytes.size() < sizeof header) return broken("is truncated");
    std::memcpy(&header, bytes.data(), sizeof header);
    if (std::memcmp(header.e_ident, ours.e_ident, EI_VERSION) != 0 || header.e_machine != ours.e_machine)
        return broken("was built for another processor");
    if (header.e_ident[EI_CLASS] != ELFCLASS64) return {};
    // Section headers come last in a complete file.
    const std::uint64_t sections = std::uint64_t{header.e_shnum} * header.e_shentsize;
    if (header.e_shoff > bytes.size() || sections > bytes.size() - header.e_shoff) return broken("is truncated");
    for (std::size_t i = 0; i < header.e_phnum; ++i) {
        Elf64_Phdr segment;
        const std::uint64_t at = header.e_phoff + i * sizeof segment;
        if (at > bytes.size() || bytes.size() - at < sizeof segment) return broken("is truncated");
        std::memcpy(&segment, bytes.data() + at, sizeof segment);
        if (segment.p_offset > bytes.size() || segment.p_filesz > bytes.size() - segment.p_offset)
            return broken("is truncated");
    }
    return {};
}

// A unique path to an open file: dlopen() returns the library already open under a known name,
// and descriptor numbers are recycled. So a counter is encoded as "/." and "//", which are no-ops in a
// path.
std::string new_name_of(int file) {
    static std::atomic<std::uint32_t> counter{0};
    std::string name = "/proc/self/fd";
    const std::uint32_t number = counter++;
    for (int bit = 0; bit < 32; ++bit)
        name += number >> bit & 1 ? "/." : "//";
    return name + "/" + std::to_string(file);
}

} // namespace

#endif

Result<Library> Library::open(const std::filesystem::path& path) {
#if defined(__linux__)
    RESTAGE_CHECK(check_elf(path));
#endif
    if (void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) return Library(handle);
    const char* why = dlerror(); // begins with the path if it is about this file
    const std::string text = why ? why : "unknown reason";
    return fail(text.starts_with(path.string()) ? text : path.string() + ": " + text);
}

Result<Library> Library::open_copy(const std::filesystem::path& path) {
#if defined(__linux__)
    RESTAGE_CHECK(check_elf(path)); // messages name the plugin's own file
#endif
    RESTAGE_TRY(const std::string bytes, read_file(path));
    std::error_code code;
    if (const auto folder = std::filesystem::temp_directory_path(code); !code) {
        std::string copy = (folder / "restage-plugin-XXXXXX").string();
        void* handle = nullptr;
        if (const Descriptor file(::mkostemp(copy.data(), O_CLOEXEC)); file.file >= 0) {
            if (write_all(file.file, bytes)) handle = dlopen(copy.c_str(), RTLD_NOW | RTLD_LOCAL);
            std::filesystem::remove(copy, code); // the mapping stays
        }
        if (handle) return Library(handle);
    }
#if defined(__linux__)
    // The temporary folder is missing, full, not writable, or mounted noexec: use memory.
    if (const Descriptor memory(static_cast<int>(::syscall(SYS_memfd_create, "restage-plugin-copy", MFD_CLOEXEC)));
        memory.file >= 0 && write_all(memory.file, bytes))
        if (void* handle = dlopen(new_name_of(memory.file).c_str(), RTLD_NOW | RTLD_LOCAL)) return Library(handle);
#endif
    // The file itself: it merely cannot be replaced while in use. If the library is at fault, the error says how.
    return open(path);
}

Library::~Library() {
    if (handle_) dlclose(handle_);
}

void* Library::symbol(const char* name) const { return dlsym(handle_, name); }

#endif

} // namespace restage::plugin
