// SPDX-License-Identifier: Apache-2.0
// The part of Open Image Denoise's C API that this plugin calls, declared here so that neither headers nor linking are
// needed, and the search for the library. Version 2.0 and later.
#pragma once

#include <cstddef>
#include <string>

namespace oidn {

struct DeviceImpl;
struct FilterImpl;
using Device = DeviceImpl*;
using Filter = FilterImpl*;
using ProgressMonitor = bool (*)(void* user, double done); // false = stop

inline constexpr int device_type_cpu = 1;
inline constexpr int error_none = 0, error_cancelled = 6;
inline constexpr int format_float3 = 3;
inline constexpr int quality_fast = 4, quality_balanced = 5, quality_high = 6;
inline constexpr int first_version_with_fast = 20300; // major * 10000 + minor * 100 + patch

struct Api {
    Device (*new_device)(int type);
    void (*release_device)(Device);
    void (*set_device_bool)(Device, const char* name, bool);
    void (*set_device_int)(Device, const char* name, int);
    int (*get_device_int)(Device, const char* name);
    int (*get_device_error)(Device, const char** message);
    void (*commit_device)(Device);
    Filter (*new_filter)(Device, const char* type);
    void (*release_filter)(Filter);
    void (*set_shared_filter_image)(Filter, const char* name, void* data, int format, std::size_t width,
                                    std::size_t height, std::size_t byte_offset, std::size_t pixel_stride,
                                    std::size_t row_stride);
    void (*set_filter_bool)(Filter, const char* name, bool);
    void (*set_filter_int)(Filter, const char* name, int);
    void (*set_filter_progress_monitor)(Filter, ProgressMonitor, void* user);
    void (*commit_filter)(Filter);
    void (*execute_filter)(Filter);
};

// Opens the library, which then stays in memory until the process ends: its threads would not survive unloading.
// False = missing or unusable; then `reason` is a sentence.
bool load(Api& api, std::string& reason);

} // namespace oidn
