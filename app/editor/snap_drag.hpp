// SPDX-License-Identifier: Apache-2.0
// Snapping of drags (query/snapping.hpp) to what the preferences say, with hints over the picture.
#pragma once

#include "query/snapping.hpp"

#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace restage::editor {

class DocumentContext;
class PanelContext;
class PanelUi;
struct Drag;

struct Snapping { // of a drag
    query::Snapping query;
    std::vector<query::SnapHint> hints; // now
};

// At the start of a move; does nothing if nothing is chosen to snap to, or a light is dragged. `grabbed`: where it is
// held.
void begin_snapping(DocumentContext& editor, Drag& drag, const glm::dvec3& grabbed, const query::ViewRay& mouse);
// The displacement with snapping; `by` itself while Ctrl or Alt is held. `axis`: of a handle, unit.
glm::dvec3 snapped(PanelContext& editor, Drag& drag, const glm::dvec3& by, const query::ViewRay& mouse,
                   const std::optional<glm::dvec3>& axis);
void draw_snapping(PanelContext& editor, const Drag& drag);
// The toolbar's button with its popup.
void snap_button(PanelUi& editor);

} // namespace restage::editor
