// SPDX-License-Identifier: Apache-2.0
// The available tracers: the renderer chooses from them, and the command line, the editor and Python offer them. A new
// one needs its file and a row in tracers.cpp.
#pragma once

#include "render/tracer.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace restage::render {

struct TracerKind {
    std::string_view name; // as Tracer::name()
    const char* label;     // in menus
    const char* says;      // "on the processor"
    Result<std::unique_ptr<Tracer>> (*make)(const TracerContext&);
    int (*suits)(const gpu::DeviceInfo&); // the default is the highest
    bool needs_ray_tracing = false;       // of the device
    bool photons = false, guides = false; // has photon maps; guides paths
};
std::span<const TracerKind> tracer_kinds();
std::vector<std::string> tracer_names();
const TracerKind* find_tracer(std::string_view name); // null if there is none
const TracerKind& best_tracer(const gpu::DeviceInfo&);

} // namespace restage::render
