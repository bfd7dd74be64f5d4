// SPDX-License-Identifier: Apache-2.0
// Moved things do not enter others (query/collision.hpp), if Preferences::collide is on.
#pragma once

#include "query/collision.hpp"
#include "selection.hpp"

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace restage::editor {

class PanelContext;
struct Drag;

struct Colliding { // of a drag
    query::Collision query;
    std::vector<InstanceId> met; // now
    bool free_shift = false; // Shift was up: it is not the one that asked for a copy
    bool through = false; // Shift is held
};

// At the start of a move; does nothing if that is off, or a light is dragged.
void begin_colliding(PanelContext& editor, Drag& drag);
// The displacement that is possible; `by` itself while Shift is held. `straight`: it does not slide along things, as
// by a handle. `snapped`: where it may go even if something is in the way.
glm::dvec3 collided(Drag& drag, const glm::dvec3& by, bool straight, bool snapped);
void draw_colliding(PanelContext& editor, const Drag& drag);
// How to move what is about to appear, in `from` displaced by `move`, so that it enters nothing; 0 if that is off.
glm::dvec3 room_for(const PanelContext& editor, const scene::Scene& from, std::span<const InstanceId> ids,
                    const glm::dmat4& move);

} // namespace restage::editor
