// SPDX-License-Identifier: Apache-2.0
#include "scene/edits_light.hpp"

namespace restage::scene {

Result<DuplicateLight> duplicate_light(const Scene& scene, Id<Light> id, const glm::dmat4& move) {
    const Light* light = scene.lights.find(id);
    if (!light) return fail("there is no light with id " + std::to_string(id.value));
    std::set<std::string> names;
    scene.lights.each([&](auto, const Light& other) { names.insert(other.name); });
    Light copy = *light;
    copy.name = next_name(copy.name, names);
    copy.light_to_world = move * copy.light_to_world;
    return DuplicateLight{insert(scene, std::move(copy), "Duplicate " + light->name), scene.lights.next()};
}

} // namespace restage::scene
