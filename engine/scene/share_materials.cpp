// SPDX-License-Identifier: Apache-2.0
#include "scene/share_materials.hpp"

#include "scene/left_over.hpp"
#include "scene/links.hpp"
#include "scene/same_material.hpp"
#include "scene/uses.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <map>
#include <string>
#include <vector>

namespace restage::scene {

namespace {

std::string without_number(const std::string& name) { // "oak 2" -> "oak"
    std::size_t end = name.size();
    while (end > 0 && std::isdigit(static_cast<unsigned char>(name[end - 1])))
        --end;
    const bool numbered = end < name.size() && end > 1 && name[end - 1] == ' ';
    return numbered ? name.substr(0, end - 1) : name;
}

using ByStem = std::map<std::string, std::vector<Id<Material>>>;

ByStem by_stem(const Scene& scene) {
    const LinkedItems linked(scene);
    ByStem stems;
    scene.materials.each([&](Id<Material> id, const Material& m) {
        if (!linked.contains(id)) stems[without_number(m.name)].push_back(id);
    });
    return stems;
}

} // namespace

std::unordered_map<std::uint32_t, Id<Material>> shared_materials(const Scene& into, const Scene& from) {
    std::unordered_map<std::uint32_t, Id<Material>> shared;
    const ByStem ours = by_stem(into);
    for (const auto& [stem, theirs] : by_stem(from)) {
        const auto found = ours.find(stem);
        if (found == ours.end()) continue;
        for (const Id<Material> id : theirs) {
            Id<Material> same;
            for (const Id<Material> one : found->second) {
                const bool of_its_name = into.materials[one].name == from.materials[id].name;
                if ((same && !of_its_name) || !identical_material(into, one, from, id)) continue;
                same = one;
                if (of_its_name) break;
            }
            if (same) shared.emplace(id.value, same);
        }
    }
    return shared;
}

MergedMaterials merge_equal_materials(const Scene& scene) {
    MergedMaterials result;
    std::map<Id<Material>, Id<Material>> kept; // dropped -> kept
    std::vector<Id<Material>> distinct; // one of each name
    for (const auto& [stem, ids] : by_stem(scene)) {
        std::vector<Id<Material>> mine;
        for (const Id<Material> id : ids) {
            const auto equal = std::ranges::find_if(
                mine, [&](Id<Material> other) { return identical_material(scene, other, scene, id); });
            if (equal != mine.end())
                kept.emplace(id, *equal);
            else
                mine.push_back(id);
        }
        for (const Id<Material> id : mine)
            result.other_names += std::ranges::any_of(
                distinct, [&](Id<Material> other) { return identical_material(scene, other, scene, id); });
        distinct.insert(distinct.end(), mine.begin(), mine.end());
    }
    result.merged = kept.size();
    if (kept.empty()) return result;
    Edit& edit = result.edit;
    edit.label = kept.size() == 1 ? "Merge a material" : fmt::format("Merge {} materials", kept.size());
    const auto change_users = [&]<class T>(const Table<T>& items) {
        items.each([&](Id<T> id, const T& item) {
            if constexpr (std::is_same_v<T, Material>)
                if (kept.contains(id)) return;
            T copy = item;
            visit_references(copy, [&]<class X>(Id<X>& target) {
                if constexpr (std::is_same_v<X, Material>)
                    if (const auto found = kept.find(target); found != kept.end()) target = found->second;
            });
            if (!(copy == item)) edit.changes.push_back(Change<T>{id, item, std::move(copy)});
        });
    };
    change_users(scene.instances);
    change_users(scene.materials);
    for (const auto& [id, replaced_by] : kept)
        edit.changes.push_back(Change<Material>{id, scene.materials[id], std::nullopt});
    Scene after = scene;
    apply(after, edit);
    const Edit left = remove_left_over(scene, after);
    edit.changes.insert(edit.changes.end(), left.changes.begin(), left.changes.end());
    return result;
}

} // namespace restage::scene
