// SPDX-License-Identifier: Apache-2.0
// Whether two materials, perhaps of different scenes, are equal in all that a picture shows: type, values, textures
// and component materials, whatever their names and ids.
#pragma once

#include "scene/scene.hpp"

#include <cstdint>

namespace restage::scene {

// A value that is set to its default differs from one that is not set. False if either does not exist.
bool same_material(const Scene& a, Id<Material> of_a, const Scene& b, Id<Material> of_b);

// Equal in their origins, too, which say more in spectral mode; images of two files are if their pixels are equal.
bool identical_material(const Scene& a, Id<Material> of_a, const Scene& b, Id<Material> of_b);

// Equal for equal materials, on every machine; of images the pixels count. 0 if it does not exist.
std::uint64_t material_hash(const Scene&, Id<Material>);

// The first material of `in` equal to it, those of its name before others; none if there is none.
Id<Material> find_same_material(const Scene& in, const Scene& other, Id<Material> of_other);

} // namespace restage::scene
