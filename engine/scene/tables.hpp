// SPDX-License-Identifier: Apache-2.0
// The kinds of items and the single items of a scene, listed once: edits, validation, merging, references and
// projects walk these lists. Referenced kinds come first.
#pragma once

#include "scene/scene.hpp"

#include <string_view>
#include <tuple>

namespace restage::scene {

template <class T>
struct Kind {
    using type = T;
    const char* name;   // singular, in messages
    const char* plural; // in project files
    Table<T> Scene::* table;
};
inline constexpr std::tuple kinds{
    Kind<Mesh>{"mesh", "meshes", &Scene::meshes},
    Kind<Image>{"image", "images", &Scene::images},
    Kind<Texture>{"texture", "textures", &Scene::textures},
    Kind<Material>{"material", "materials", &Scene::materials},
    Kind<Medium>{"medium", "media", &Scene::media},
    Kind<Group>{"group", "groups", &Scene::groups},
    Kind<Instance>{"instance", "instances", &Scene::instances},
    Kind<Light>{"light", "lights", &Scene::lights},
    Kind<Camera>{"camera", "cameras", &Scene::cameras},
};

template <class T>
struct Single {
    using type = T;
    const char* name; // in project files
    const char* who;  // in messages
    Scene::One<T> Scene::* one;
};
inline constexpr std::tuple singles{
    Single<std::optional<Environment>>{"environment", "the environment", &Scene::environment},
    Single<Id<Camera>>{"active_camera", "the active camera", &Scene::active_camera},
    Single<Film>{"film", "the film", &Scene::film},
    Single<Settings>{"settings", "the medium of the camera", &Scene::settings}, // its only reference
};

// f(Kind<T>) for each; likewise f(const Single<T>&).
template <class F>
void each_kind(F&& f) {
    std::apply([&](const auto&... kind) { (f(kind), ...); }, kinds);
}
template <class F>
void each_single(F&& f) {
    std::apply([&](const auto&... single) { (f(single), ...); }, singles);
}

// The holder of Ts, for code generic over kinds. S: Scene or const Scene.
template <class T, class S>
auto& table(S& scene) {
    return scene.*std::get<Kind<T>>(kinds).table;
}
template <class T, class S>
auto& single(S& scene) {
    return scene.*std::get<Single<T>>(singles).one;
}
template <class T>
inline constexpr const char* kind_name = std::get<Kind<T>>(kinds).name;

// f(Table<T>&) for each.
template <class S, class F>
void each_table(S& scene, F&& f) {
    each_kind([&](const auto& kind) { f(scene.*kind.table); });
}

// The first live item of that name, or none.
template <class T>
Id<T> find_by_name(const Scene& scene, std::string_view name) {
    Id<T> found;
    table<T>(scene).each([&](Id<T> id, const T& item) {
        if (!found && item.name == name) found = id;
    });
    return found;
}

} // namespace restage::scene
