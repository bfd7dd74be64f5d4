// SPDX-License-Identifier: Apache-2.0
// Searches for libOpenImageDenoise (README.md) and opens it.

#include "library.hpp"

#include <restage/plugin.h>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <vector>

#if defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#define NOMINMAX
#include <windows.h>
#else
#include <dlfcn.h>
#endif

extern "C" RESTAGE_EXPORT const RestagePlugin restage_plugin;

namespace oidn {

namespace {

namespace fs = std::filesystem;

#if defined(_WIN32)

constexpr const char* names[] = {"OpenImageDenoise.dll"};

void* open(const fs::path& path, std::string& why) {
    const DWORD flags = path.is_absolute() ? LOAD_WITH_ALTERED_SEARCH_PATH : 0; // its parts are in the same folder
    HMODULE handle = LoadLibraryExW(path.c_str(), nullptr, flags);
    if (!handle) why = std::system_category().message(static_cast<int>(GetLastError()));
    return handle;
}
void* symbol(void* handle, const char* name) {
    return reinterpret_cast<void*>(GetProcAddress(static_cast<HMODULE>(handle), name));
}
fs::path module_folder(HMODULE module) {
    wchar_t path[32768];
    const DWORD size = GetModuleFileNameW(module, path, 32768);
    return fs::path(path, path + size).parent_path();
}
fs::path plugin_folder() {
    HMODULE module = nullptr;
    GetModuleHandleExW(GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT,
                       reinterpret_cast<LPCWSTR>(&restage_plugin), &module);
    return module_folder(module);
}
fs::path program_folder() { return module_folder(nullptr); }

#else

#if defined(__APPLE__)
constexpr const char* names[] = {"libOpenImageDenoise.2.dylib", "libOpenImageDenoise.dylib"};
#else
constexpr const char* names[] = {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so"};
#endif

void* open(const fs::path& path, std::string& why) {
    void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!handle) why = dlerror();
    return handle;
}
void* symbol(void* handle, const char* name) { return dlsym(handle, name); }
fs::path plugin_folder() {
    Dl_info info{};
    if (!dladdr(&restage_plugin, &info) || !info.dli_fname) return {};
    std::error_code ignored;
    return fs::absolute(info.dli_fname, ignored).parent_path();
}
fs::path program_folder() {
    std::error_code ignored;
    return fs::read_symlink("/proc/self/exe", ignored).parent_path();
}

#endif

// Files to try; without a folder the system searches.
std::vector<fs::path> candidates() {
    std::vector<fs::path> folders, files;
    if (const char* chosen = std::getenv("RESTAGE_OIDN_PATH"); chosen && *chosen) {
        std::error_code ignored;
        if (!fs::is_directory(chosen, ignored)) return {chosen};
        folders = {chosen};
    } else {
        if (const fs::path plugin = plugin_folder(); !plugin.empty()) folders = {plugin / "lib", plugin};
        if (const fs::path program = program_folder(); !program.empty())
            folders.push_back(program.parent_path() / "lib");
        folders.emplace_back();
    }
    for (const auto& folder : folders)
        for (const char* name : names)
            files.push_back(folder / name);
    return files;
}

template <class Function>
bool take(void* handle, const char* name, Function& function, std::string& missing) {
    function = reinterpret_cast<Function>(symbol(handle, name));
    if (!function && missing.empty()) missing = name;
    return function;
}

bool take_all(void* handle, Api& api, std::string& missing) {
    return take(handle, "oidnNewDevice", api.new_device, missing) &&
           take(handle, "oidnReleaseDevice", api.release_device, missing) &&
           take(handle, "oidnSetDeviceBool", api.set_device_bool, missing) &&
           take(handle, "oidnSetDeviceInt", api.set_device_int, missing) &&
           take(handle, "oidnGetDeviceInt", api.get_device_int, missing) &&
           take(handle, "oidnGetDeviceError", api.get_device_error, missing) &&
           take(handle, "oidnCommitDevice", api.commit_device, missing) &&
           take(handle, "oidnNewFilter", api.new_filter, missing) &&
           take(handle, "oidnReleaseFilter", api.release_filter, missing) &&
           take(handle, "oidnSetSharedFilterImage", api.set_shared_filter_image, missing) &&
           take(handle, "oidnSetFilterBool", api.set_filter_bool, missing) &&
           take(handle, "oidnSetFilterInt", api.set_filter_int, missing) &&
           take(handle, "oidnSetFilterProgressMonitorFunction", api.set_filter_progress_monitor, missing) &&
           take(handle, "oidnCommitFilter", api.commit_filter, missing) &&
           take(handle, "oidnExecuteFilter", api.execute_filter, missing);
}

} // namespace

bool load(Api& api, std::string& reason) {
    std::string broken; // a file that fails to load is a better report than a missing one
    std::error_code ignored;
    for (const fs::path& file : candidates()) {
        std::string why, missing;
        void* handle = open(file, why);
        if (handle && take_all(handle, api, missing)) return true;
        if (handle) why = file.string() + ": lacks the function " + missing + "; version 2 is needed";
        if ((handle || fs::exists(file, ignored)) && broken.empty()) broken = why;
    }
    const char* chosen = std::getenv("RESTAGE_OIDN_PATH");
    if (!broken.empty())
        reason = "Open Image Denoise could not be loaded: " + broken;
    else if (chosen && *chosen)
        reason = "Open Image Denoise was not found: RESTAGE_OIDN_PATH names " + std::string(chosen);
    else
        reason = "Open Image Denoise was not found; run tools/setup, or set RESTAGE_OIDN_PATH to the folder of " +
                 std::string(names[0]);
    return false;
}

} // namespace oidn
