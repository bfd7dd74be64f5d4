// SPDX-License-Identifier: Apache-2.0
// table<T>(scene): the table that holds T, for code that is the same for every kind of thing; kind_name<T> for
// messages.
#pragma once

#include "scene/scene.hpp"

#include <type_traits>

namespace restage::scene {

template <class T, class S>
auto& table(S& scene) { // S: Scene or const Scene
    if constexpr (std::is_same_v<T, Mesh>)
        return scene.meshes;
    else if constexpr (std::is_same_v<T, Image>)
        return scene.images;
    else if constexpr (std::is_same_v<T, Texture>)
        return scene.textures;
    else if constexpr (std::is_same_v<T, Material>)
        return scene.materials;
    else if constexpr (std::is_same_v<T, Medium>)
        return scene.media;
    else if constexpr (std::is_same_v<T, Group>)
        return scene.groups;
    else if constexpr (std::is_same_v<T, Instance>)
        return scene.instances;
    else if constexpr (std::is_same_v<T, Light>)
        return scene.lights;
    else {
        static_assert(std::is_same_v<T, Camera>);
        return scene.cameras;
    }
}

template <class T>
inline constexpr const char* kind_name = "";
template <>
inline constexpr const char* kind_name<Mesh> = "mesh";
template <>
inline constexpr const char* kind_name<Image> = "image";
template <>
inline constexpr const char* kind_name<Texture> = "texture";
template <>
inline constexpr const char* kind_name<Material> = "material";
template <>
inline constexpr const char* kind_name<Medium> = "medium";
template <>
inline constexpr const char* kind_name<Group> = "group";
template <>
inline constexpr const char* kind_name<Instance> = "instance";
template <>
inline constexpr const char* kind_name<Light> = "light";
template <>
inline constexpr const char* kind_name<Camera> = "camera";

// The first live thing of that name, or none.
template <class T>
Id<T> find_by_name(const Scene& scene, std::string_view name) {
    Id<T> found;
    table<T>(scene).each([&](Id<T> id, const T& item) {
        if (!found && item.name == name) found = id;
    });
    return found;
}

} // namespace restage::scene
