// SPDX-License-Identifier: Apache-2.0
// Copying between scenes and windows as text: a project without a base that holds the selection and all it needs.
// Large geometry and pixels available from a file are referenced, all others written into the text.
#pragma once

#include "base/result.hpp"
#include "document/session.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace restage::document {

struct Selected { // objects, or a light, or a material
    std::vector<scene::Id<scene::Instance>> instances;
    scene::Id<scene::Light> light;
    scene::Id<scene::Material> material;
};
// The selection with all it needs, and the camera, which defines up and handedness. A material is on a carrier: a small
// object, because merging drops what none uses. An error if it does not exist.
Result<scene::Scene> part_of(const scene::Scene&, const Selected&);
void add_carrier(scene::Scene&, scene::Id<scene::Material>);
// An error if larger than the clipboard's limit.
Result<std::string> copy_text(const Session&, const Selected&);

bool is_copy(std::string_view text); // looks like one
struct Copy {
    scene::Scene scene;
    bool material = false; // it represents the material of its only object
};
Result<Copy> read_copy(const std::string& text, const plugin::Registry&); // [worker]

struct Pasted {
    scene::Edit edit;
    std::vector<scene::Id<scene::Instance>> instances;
    scene::Id<scene::Light> light;
};
// Objects and lights in their old places; `aside`: offset if the same place is already taken.
Pasted paste(const scene::Scene& into, const scene::Scene& copied, const glm::dvec3& aside);
// The material for these objects.
Result<scene::Edit> paste_material(const scene::Scene& into, const Copy&,
                                   std::span<const scene::Id<scene::Instance>> to);

} // namespace restage::document
