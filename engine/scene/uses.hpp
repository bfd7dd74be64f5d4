// SPDX-License-Identifier: Apache-2.0
// Who refers to a thing: what must be asked before it is removed. Every reference the scene can hold is walked in one
// place, for_each_reference.
#pragma once

#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace restage::scene {

// Calls visitor(Id<X>) for each reference a thing holds, none (0) excluded.
template <class V>
void visit_references(const ParamSet& params, V&& visitor) {
    for (const auto& entry : params.entries()) {
        if (entry.value.texture) visitor(entry.value.texture);
        if (entry.value.material) visitor(entry.value.material);
    }
}
template <class V>
void visit_references(const Texture& texture, V&& visitor) {
    if (texture.image) visitor(texture.image);
    visit_references(texture.params, visitor);
}
template <class V>
void visit_references(const Material& material, V&& visitor) {
    visit_references(material.params, visitor);
}
template <class V>
void visit_references(const Group& group, V&& visitor) {
    if (group.parent) visitor(group.parent);
}
template <class V>
void visit_references(const Instance& instance, V&& visitor) {
    if (instance.mesh) visitor(instance.mesh);
    if (instance.material) visitor(instance.material);
    if (instance.group) visitor(instance.group);
    if (instance.alpha_texture) visitor(instance.alpha_texture);
    if (instance.media) {
        if (instance.media->interior) visitor(instance.media->interior);
        if (instance.media->exterior) visitor(instance.media->exterior);
    }
}

// visitor(Id<X> target, std::string who) for every reference in the scene; who: 'instance "chair"'.
template <class V>
void for_each_reference(const Scene& scene, V&& visitor) {
    const auto of = [&](const char* kind, const auto& item) {
        visit_references(item, [&](auto target) { visitor(target, std::string(kind) + " \"" + item.name + "\""); });
    };
    scene.textures.each([&](auto, const Texture& t) { of("texture", t); });
    scene.materials.each([&](auto, const Material& m) { of("material", m); });
    scene.groups.each([&](auto, const Group& g) { of("group", g); });
    scene.instances.each([&](auto, const Instance& i) { of("instance", i); });
    if (scene.environment.value && scene.environment.value->image)
        visitor(scene.environment.value->image, std::string("the environment"));
    if (scene.active_camera.value) visitor(scene.active_camera.value, std::string("the active camera"));
    if (scene.settings.value.camera_medium)
        visitor(scene.settings.value.camera_medium, std::string("the medium of the camera"));
}

// Everything that refers to `id`, by name.
template <class T>
std::vector<std::string> users(const Scene& scene, Id<T> id) {
    std::vector<std::string> result;
    for_each_reference(scene, [&]<class X>(Id<X> target, std::string who) {
        if constexpr (std::is_same_v<X, T>)
            if (target == id) result.push_back(std::move(who));
    });
    return result;
}

} // namespace restage::scene
