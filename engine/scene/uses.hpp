// SPDX-License-Identifier: Apache-2.0
// Referrers of an item, checked before it is removed. Every reference in a scene is walked in one
// place, for_each_reference.
#pragma once

#include "scene/tables.hpp"

#include <concepts>
#include <string>
#include <vector>

namespace restage::scene {

template <class T, class U>
concept Of = std::same_as<std::remove_const_t<T>, U>; // U or const U

// Calls visitor(Id<X>&) for each non-null reference an item holds; const if the item is.
template <class T, class V>
void visit_references(T&, V&&) {} // meshes, images, media, lights, cameras, the film: none
template <Of<Id<Camera>> T, class V>
void visit_references(T& camera, V&& visitor) {
    if (camera) visitor(camera);
}
template <Of<ParamSet> T, class V>
void visit_references(T& params, V&& visitor) {
    params.each_value([&](auto& value) {
        if (value.texture) visitor(value.texture);
        if (value.material) visitor(value.material);
    });
}
template <Of<Texture> T, class V>
void visit_references(T& texture, V&& visitor) {
    if (texture.image) visitor(texture.image);
    visit_references(texture.params, visitor);
}
template <Of<Material> T, class V>
void visit_references(T& material, V&& visitor) {
    visit_references(material.params, visitor);
}
template <Of<Group> T, class V>
void visit_references(T& group, V&& visitor) {
    if (group.parent) visitor(group.parent);
}
template <Of<Instance> T, class V>
void visit_references(T& instance, V&& visitor) {
    if (instance.mesh) visitor(instance.mesh);
    if (instance.material) visitor(instance.material);
    if (instance.group) visitor(instance.group);
    if (instance.alpha_texture) visitor(instance.alpha_texture);
    if (instance.media) {
        if (instance.media->interior) visitor(instance.media->interior);
        if (instance.media->exterior) visitor(instance.media->exterior);
    }
}
template <Of<std::optional<Environment>> T, class V>
void visit_references(T& environment, V&& visitor) {
    if (!environment) return;
    if (environment->image) visitor(environment->image);
    visit_references(environment->sky_params, visitor);
}
template <Of<Settings> T, class V>
void visit_references(T& settings, V&& visitor) {
    if (settings.camera_medium) visitor(settings.camera_medium);
}

// visitor(Id<X> target, std::string who) for every reference in the scene; who: 'instance "chair"'.
template <class V>
void for_each_reference(const Scene& scene, V&& visitor) {
    each_table(scene, [&]<class T>(const Table<T>& table) {
        table.each([&](Id<T>, const T& item) {
            visit_references(
                item, [&](auto target) { visitor(target, std::string(kind_name<T>) + " \"" + item.name + "\""); });
        });
    });
    each_single([&](const auto& single) {
        visit_references((scene.*single.one).value, [&](auto target) { visitor(target, std::string(single.who)); });
    });
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
