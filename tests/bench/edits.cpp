// SPDX-License-Identifier: Apache-2.0
// The time from an edit of one of a thousand instances until the next sample can start.
#include "bench.hpp"
#include "embree_counts.hpp"
#include "scene/edit.hpp"
#include "scenes.hpp"

#include <functional>

namespace restage::bench {
namespace {

std::uint64_t pipelines = 0;
PFN_vkCreateComputePipelines create_pipelines = nullptr;
VKAPI_ATTR VkResult VKAPI_CALL count_pipelines(VkDevice device, VkPipelineCache cache, std::uint32_t n,
                                               const VkComputePipelineCreateInfo* info, const VkAllocationCallbacks* a,
                                               VkPipeline* out) {
    pipelines += n;
    return create_pipelines(device, cache, n, info, a, out);
}

} // namespace

Json measure_edits(const Options& o) {
    using namespace scene;
    Plugins plugins;
    const auto renderer = plugins.renderer({.threads = o.threads});
    auto& functions = const_cast<VolkDeviceTable&>(renderer->device().vk()); // to count: these do not change it
    create_pipelines = std::exchange(functions.vkCreateComputePipelines, count_pipelines);

    std::vector<Id<Instance>> spheres;
    Scene scene = crowd(1000, 41, spheres);
    check(renderer->sync(scene));
    check(renderer->trace(1));

    struct Kind {
        const char* name;
        std::function<Edit(int)> make; // the i-th
    };
    const auto change = [&](Id<Instance> id, std::optional<Instance> after) {
        const Instance* before = scene.instances.find(id);
        return Edit{"edit", {Change<Instance>{id, before ? std::optional(*before) : std::nullopt, std::move(after)}}};
    };
    const auto sphere = [&](int i) { return spheres[std::size_t(i * 37 + 11) % 1000]; };
    const Kind kinds[] = {
        {"move",
         [&](int i) {
             Instance moved = scene.instances[sphere(i)];
             moved.object_to_world[3].y += 0.5;
             return change(sphere(i), moved);
         }},
        {"add",
         [&](int i) {
             Instance copy = scene.instances[sphere(i)];
             copy.object_to_world[3].y += 1;
             return change(scene.instances.next(), copy);
         }},
        {"remove", [&](int i) { return change(sphere(500 + i), std::nullopt); }},
        {"other material",
         [&](int i) {
             Instance other = scene.instances[sphere(i)];
             other.material = scene.instances[sphere(i + 1)].material;
             return change(sphere(i), other);
         }},
    };
    Json rows = Json::array();
    for (const Kind& kind : kinds) {
        Json runs = Json::array();
        for (int i = 0; i < std::max(o.runs, 3) * 3; ++i) {
            const auto uploaded = renderer->gpu_scene().uploaded_bytes();
            const auto made = pipelines, built = embree_scenes_made();
            const Seconds sync = time([&] {
                apply(scene, kind.make(i));
                check(renderer->sync(scene));
            });
            runs.push_back({{"wall", sync.wall},
                            {"cpu", sync.cpu},
                            {"uploaded_bytes", renderer->gpu_scene().uploaded_bytes() - uploaded},
                            {"pipelines", pipelines - made},
                            {"mesh_structures_built", embree_scenes_made() - built}});
            const auto before = pipelines;
            check(renderer->trace(1)); // pipelines are built here on demand
            runs.back()["pipelines"] = runs.back()["pipelines"].get<std::uint64_t>() + pipelines - before;
        }
        rows.push_back({{"edit", kind.name}, {"runs", runs}});
    }
    return {{"instances", 1000}, {"edits", rows}, {"target_seconds", 0.02}};
}

} // namespace restage::bench
