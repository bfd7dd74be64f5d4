// SPDX-License-Identifier: Apache-2.0
// Sharing equal materials: those that are the same in all that a picture shows and in what their files say beyond that
// (origins), and are called the same but for a number at the end: "oak", "oak 2". Equal materials of other names are
// kept apart, since their names may have a meaning. Materials of linked files (links.hpp) are left alone.
#pragma once

#include "scene/edit.hpp"

#include <cstddef>
#include <unordered_map>

namespace restage::scene {

// Materials of `from` that `into` has already: Id::value in `from` -> the material in `into`; of several the one of
// exactly that name, else the first.
std::unordered_map<std::uint32_t, Id<Material>> shared_materials(const Scene& into, const Scene& from);

struct MergedMaterials {
    Edit edit; // empty: nothing to merge
    std::size_t merged = 0; // materials that are removed, with the textures and images that only they used
    std::size_t other_names = 0; // equal to another one, but kept for their names
};
// The first of equal materials takes the place of the others.
MergedMaterials merge_equal_materials(const Scene&);

} // namespace restage::scene
