// SPDX-License-Identifier: Apache-2.0
// Builders of edits: each reads a scene and returns the changes as data. They never write the scene; impossible
// requests (an unknown id, a material still in use) return an error message.
#pragma once

#include "base/result.hpp"
#include "scene/edit.hpp"
#include "scene/tables.hpp"

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace restage::scene {

// The item's id will be table<T>(scene).next().
template <class T>
Edit insert(const Scene& scene, T item, std::string label) {
    Edit edit{std::move(label), {}};
    edit.changes.push_back(Change<T>{table<T>(scene).next(), std::nullopt, std::move(item)});
    return edit;
}

// f(T&) changes a copy of the item.
template <class T, class F>
Result<Edit> modify(const Scene& scene, Id<T> id, std::string label, F&& f) {
    const T* before = table<T>(scene).find(id);
    if (!before) return fail("there is no " + std::string(kind_name<T>) + " with id " + std::to_string(id.value));
    T after = *before;
    f(after);
    Edit edit{std::move(label), {}};
    edit.changes.push_back(Change<T>{id, *before, std::move(after)});
    return edit;
}

// "chair" -> "chair 2", "chair 2" -> "chair 3", skipping names in use; marks the result used. `tried` speeds up long
// series of names: per stem, the range (first, last] known to be in use.
using TriedNumbers = std::unordered_map<std::string, std::pair<unsigned long, unsigned long>>;
std::string next_name(std::string name, std::set<std::string>& taken, TriedNumbers* tried = nullptr);

template <class T>
Result<Edit> rename(const Scene& scene, Id<T> id, std::string name) {
    return modify(scene, id, "Rename " + std::string(kind_name<T>), [&](T& item) { item.name = std::move(name); });
}

// Refused while something refers to it; the error names the referrers.
template <class T>
Result<Edit> remove(const Scene& scene, Id<T> id);
extern template Result<Edit> remove(const Scene&, Id<Mesh>);
extern template Result<Edit> remove(const Scene&, Id<Image>);
extern template Result<Edit> remove(const Scene&, Id<Texture>);
extern template Result<Edit> remove(const Scene&, Id<Material>);
extern template Result<Edit> remove(const Scene&, Id<Medium>);
extern template Result<Edit> remove(const Scene&, Id<Group>);
extern template Result<Edit> remove(const Scene&, Id<Light>);
extern template Result<Edit> remove(const Scene&, Id<Camera>);

// Instances are what a user deletes. Groups left empty go too; meshes and materials stay.
Result<Edit> remove_instances(const Scene&, std::span<const Id<Instance>>);
// Every mesh, image, texture, material, medium and group that is not referenced, directly or through others.
Edit remove_unused(const Scene&);

struct Duplicate {
    Edit edit;
    std::vector<Id<Instance>> copies; // in the order requested
};
// Copies share mesh and material; `move` is applied in world space. Groups wholly contained in the selection are
// copied with it; other copies stay in the group of their original. Names get a number: "chair" -> "chair 2".
Result<Duplicate> duplicate_instances(const Scene&, std::span<const Id<Instance>>, const glm::dmat4& move);

Result<Edit> set_transform(const Scene&, Id<Instance>, const glm::dmat4& object_to_world);
Result<Edit> move_instances(const Scene&, std::span<const Id<Instance>>, const glm::dmat4& move); // world space
Result<Edit> set_material(const Scene&, std::span<const Id<Instance>>, Id<Material>);
Result<Edit> set_emission(const Scene&, Id<Instance>, std::optional<Emission>);
Result<Edit> set_hidden(const Scene&, std::span<const Id<Instance>>, bool hidden);
Result<Edit> set_hidden(const Scene&, Id<Light>, bool hidden);
Result<Edit> set_catcher(const Scene&, std::span<const Id<Instance>>, bool catcher);

// Drops the lines valid only while `param` ("*": everything) is as imported. The builders below call it.
void forget_edited(Origin&, std::string_view param);
Result<Edit> set_param(const Scene&, Id<Material>, std::string_view param, Value);
Result<Edit> set_param(const Scene&, Id<Texture>, std::string_view param, Value);
Result<Edit> set_params(const Scene&, Id<Material>, std::span<const std::pair<std::string, Value>>, std::string label);
Result<Edit> reset_param(const Scene&, Id<Material>, std::string_view param); // back to the table's default
Result<Edit> set_material_type(const Scene&, Id<Material>, std::string type); // values of other ids are kept

// --- edits_material.cpp ---------------------------------------------------------------------------------------------

using model::ParamTable;
// Changes the type and keeps common values: a value with the same id is kept if the new table can hold it
// (clamped to its range), else the default holds. The main colour (first COLOR of range 0..1) and roughness are kept
// under the new type's names.
Result<Edit> switch_material_type(const Scene&, Id<Material>, std::string type, ParamTable before, ParamTable after);

struct MadeUnique {
    Edit edit;
    Id<Material> material; // the copy
};
// A copy of the material for these instances only; others keep theirs. An error if none of them has it.
Result<MadeUnique> make_unique(const Scene&, std::span<const Id<Instance>>, Id<Material>);

// An `imagemap` of this image replaces the parameter. An existing image of the same file and encoding is
// shared, as is a texture that shows it unmodified. `scalar`: single-channel.
Result<Edit> set_image_texture(const Scene&, Id<Material>, std::string_view param, model::ParamType type, bool scalar,
                               Image);

Result<Edit> set_light(const Scene&, Id<Light>, Light, std::string label = "Change light");
Result<Edit> set_camera(const Scene&, Id<Camera>, Camera, std::string label = "Move camera");
Result<Edit> set_active_camera(const Scene&, Id<Camera>);
Edit set_environment(const Scene&, std::optional<Environment>, std::string label = "Change environment");
Edit set_film(const Scene&, Film, std::string label = "Change film");
Edit set_settings(const Scene&, Settings, std::string label = "Change settings");

} // namespace restage::scene
