// SPDX-License-Identifier: Apache-2.0
// A tree over emitters, up to eight children a node, by which shaders choose one for a point
// (shaders/lib/light_tree.glsl). Conty Estevez and Kulla 2018; pbrt 4ed, 12.6.3.
#pragma once

#include "shared/scene_data.h"

#include <vector>

namespace restage::render {

inline constexpr std::uint32_t light_node_children = 8;

struct LightTree {
    std::vector<shared::LightNode>
        nodes; // the root's children first, at least 8, black ones after them; siblings are neighbours
    std::uint32_t roots = 0;              // number of the root's children
};

// emitters: leaves in any order (`lights` > 0); at most light_node_children of them are the root's children as they
// are.
LightTree make_light_tree(std::vector<shared::LightNode> emitters);

// Of an inner node's children: the node around them. `children`, `parent` and the like stay those of `node`.
void refit(shared::LightNode& node, const shared::LightNode* children);

} // namespace restage::render
