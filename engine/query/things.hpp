// SPDX-License-Identifier: Apache-2.0
// Things: what a user takes for one object, though a file stores it as several (a chair of 20 meshes). Files that name
// no such things have only geometry to tell: parts that touch belong together, unless one just rests on the other (a
// vase on a table, a chair on a rug), or both stand on their own and only lean together (cabinets in a row), or one is
// a floor, a wall or a ceiling.
#pragma once

#include "scene/scene.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace restage::query {

struct Things {
    std::vector<std::vector<scene::Id<scene::Instance>>> members{1}; // of thing number i; [0]: none
    std::vector<std::uint32_t> of; // by Id<Instance>::value: number of its thing, 0 = it is alone
    std::uint32_t imported_groups = 0; // groups of a higher id were made by the user
    std::vector<bool> collections; // by Id<Group>::value: groups that only gather separate things (a whole room)

    std::uint32_t number(scene::Id<scene::Instance> id) const { return id.value < of.size() ? of[id.value] : 0; }
    bool is_collection(scene::Id<scene::Group> id) const {
        return id.value < collections.size() && collections[id.value];
    }
    // Adds those of objects that were not known.
    void add(const Things& more);
    // Copies of whole things are things; of a part, parts of nothing. `copies`: once or more in the order of
    // `originals`.
    void copied(std::span<const scene::Id<scene::Instance>> originals,
                std::span<const scene::Id<scene::Instance>> copies);
};

// `up`: unit. `imported_groups`: as in the result; the user's own groups are whole as they are. Of larger
// scenes than that, only groups are looked at. `stop`: asked now and then; when it returns true, the result
// is useless. [any]
inline constexpr std::size_t most_objects = 20'000, most_triangles = 10'000'000; // of their meshes, each once
Things find_things(const scene::Scene& scene, const glm::dvec3& up, std::uint32_t imported_groups,
                   const std::function<bool()>& stop = {});

} // namespace restage::query
