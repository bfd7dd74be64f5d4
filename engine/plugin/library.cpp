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
#include <unistd.h>
#endif
#if defined(__linux__)
#include <elf.h>
#include <cstring>
#include <fstream>
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
    // The library's own folder is searched for what it depends on; the current folder is not.
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

#if defined(__linux__)

namespace {

// dlopen maps segments without asking whether the file is long enough for them: a truncated library would end this
// program with SIGBUS, and one for another processor is reported as "no such file". So the ELF header is read first.
Result<> check_elf(const std::filesystem::path& path) {
    RESTAGE_TRY(const std::string bytes, read_file(path));
    Elf64_Ehdr header, ours;
    std::ifstream self("/proc/self/exe", std::ios::binary);
    if (!self.read(reinterpret_cast<char*>(&ours), sizeof ours)) return fail("/proc/self/exe: cannot be read");
    const auto broken = [&](const std::string& what) -> Result<> { return fail(path.string() + ": " + what); };
    if (bytes.size() < SELFMAG || std::memcmp(bytes.data(), ELFMAG, SELFMAG) != 0)
        return broken("is no shared library (no ELF file)");
    if (bytes.size() < sizeof header) return broken("is truncated");
    std::memcpy(&header, bytes.data(), sizeof header);
    if (std::memcmp(header.e_ident, ours.e_ident, EI_VERSION) != 0 || header.e_machine != ours.e_machine)
        return broken("was built for another processor");
    if (header.e_ident[EI_CLASS] != ELFCLASS64) return {};
    // The section headers are the end of a file that is whole.
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

} // namespace

#endif

Result<Library> Library::open(const std::filesystem::path& path) {
#if defined(__linux__)
    RESTAGE_CHECK(check_elf(path));
#endif
    if (void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) return Library(handle);
    const char* why = dlerror(); // begins with the path where it is about this file
    const std::string text = why ? why : "unknown reason";
    return fail(text.starts_with(path.string()) ? text : path.string() + ": " + text);
}

Result<Library> Library::open_copy(const std::filesystem::path& path) {
#if defined(__linux__)
    RESTAGE_CHECK(check_elf(path)); // messages name the plugin's own file
#endif
    RESTAGE_TRY(const std::string bytes, read_file(path));
    std::error_code code;
    const auto folder = std::filesystem::temp_directory_path(code);
    if (code) return open(path); // without it, the plugin cannot be replaced while in use, which is all
    std::string copy = (folder / "restage-plugin-XXXXXX").string();
    const int file = mkstemp(copy.data());
    if (file < 0) return open(path);
    ::close(file);
    auto result = [&]() -> Result<Library> {
        RESTAGE_CHECK(write_file_atomic(copy, bytes));
        if (void* handle = dlopen(copy.c_str(), RTLD_NOW | RTLD_LOCAL)) return Library(handle);
        const char* why = dlerror();
        std::string text = why ? why : "unknown reason";
        if (const auto at = text.find(copy); at != std::string::npos) text.replace(at, copy.size(), path.string());
        return fail(text.starts_with(path.string()) ? text : path.string() + ": " + text);
    }();
    std::filesystem::remove(copy, code); // what is mapped stays
    return result;
}

Library::~Library() {
    if (handle_) dlclose(handle_);
}

void* Library::symbol(const char* name) const { return dlsym(handle_, name); }

#endif

} // namespace restage::plugin
