// SPDX-License-Identifier: Apache-2.0
#include "render/tracers.hpp"

namespace restage::render {

Result<std::unique_ptr<Tracer>> make_embree_tracer(const TracerContext&); // embree_tracer.cpp
Result<std::unique_ptr<Tracer>> make_vulkan_tracer(const TracerContext&); // vulkan_tracer.cpp

namespace {

constexpr TracerKind kinds[] = {
    {.name = "embree",
     .label = "Embree",
     .says = "on the processor",
     .make = make_embree_tracer,
     .suits = [](const gpu::DeviceInfo&) { return 1; },
     .photons = true,
     .guides = true},
    {.name = "vulkan",
     .label = "Vulkan",
     .says = "on the graphics card, if supported",
     .make = make_vulkan_tracer,
     .suits = [](const gpu::DeviceInfo& d) { return d.ray_tracing && d.type != gpu::DeviceType::cpu ? 2 : 0; },
     .needs_ray_tracing = true},
};

} // namespace

std::span<const TracerKind> tracer_kinds() { return kinds; }

std::vector<std::string> tracer_names() {
    std::vector<std::string> names;
    for (const TracerKind& kind : kinds)
        names.emplace_back(kind.name);
    return names;
}

const TracerKind* find_tracer(std::string_view name) {
    for (const TracerKind& kind : kinds)
        if (kind.name == name) return &kind;
    return nullptr;
}

const TracerKind& best_tracer(const gpu::DeviceInfo& device) {
    const TracerKind* best = &kinds[0];
    for (const TracerKind& kind : kinds)
        if (kind.suits(device) > best->suits(device)) best = &kind;
    return *best;
}

} // namespace restage::render
