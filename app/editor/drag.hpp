// SPDX-License-Identifier: Apache-2.0
// Dragging the selection by its handles, by the knob between them or directly. Common rules: moved things stay on the
// plane they stand on, Shift drags a copy, Ctrl moves in steps, Alt lifts; Esc or a right click cancels. A drag is one
// undo step, or none if it ends where it began.
#pragma once

#include "query/navigation.hpp"
#include "selection.hpp"

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <unordered_set>
#include <utility>
#include <vector>

namespace restage::editor {

class PanelContext;
struct Colliding; // collide_drag.hpp
struct Snapping; // snap_drag.hpp

// Displacement of a moved thing as the mouse moves: over the plane of `up` or along an axis handle, and
// along `up` while Alt is held. Switching between the two continues from the current place.
class DragPath {
  public:
    struct Mouse {
        query::ViewRay ray; // through it
        glm::dvec3 view_up; // the camera's if the ray is along `up`
    };
    // `at`: a point of the dragged things, in world space, near the ray. `handle`: by an axis handle.
    void begin(const glm::dvec3& at, const glm::dvec3& up, const Mouse& mouse, bool handle);
    // `handle`: an axis handle's displacement; none = over the plane. `step`: of movement from now on; 0 = any.
    glm::dvec3 update(bool lift, const Mouse& mouse, std::optional<glm::dvec3> handle, double step);
    // It was displaced by this instead: where the next change between the two continues.
    void stop_at(const glm::dvec3& by) { now_ = by; }

  private:
    double height(const Mouse& mouse) const; // along up_, of the point nearest to the ray

    glm::dvec3 up_{0, 1, 0};
    glm::dvec3 at_{0}, kept_{0}, now_{0}; // place and displacement at the last change; current displacement
    glm::dvec3 from_{0}; // the mouse then: on the plane, or along the handle
    double height_ = 0;
    bool lifting_ = false, steep_ = false;
};

// A running drag: the selection, its places, and the handles' frame, at the start.
struct Drag {
    bool active = false;
    bool copied = false;
    std::vector<InstanceId> originals; // the selection before the copies were selected
    std::vector<std::pair<InstanceId, glm::dmat4>> start;
    scene::Id<scene::Light> light, original_light;
    glm::dmat4 light_start{1};
    DragPath path; // of moves
    glm::dvec3 pivot{0};
    // Of the handles, about the pivot: at the start, and now, in ImGuizmo's form.
    glm::dmat4 frame{1};
    glm::mat4 current{1};
    std::shared_ptr<Snapping> snapping; // of moves; null until it is used
    std::shared_ptr<Colliding> colliding; // likewise

    // Without copies, which are not in the scene yet when the drag begins: originals at the places of what is dragged.
    std::vector<std::pair<InstanceId, glm::dmat4>> thing() const;
    // What is dragged.
    std::unordered_set<InstanceId> dragged() const;
};

// Records the dragged things, or copies of them, and their places.
void begin_drag(PanelContext& editor, Drag& drag, bool copy);
// Requests the initial places transformed by `by`. PanelContext::end_gesture() ends it.
void ask_drag(PanelContext& editor, const Drag& drag, const glm::dmat4& by, const char* verb);
// Reverts its changes, leaving no undo step.
void cancel_drag(PanelContext& editor, Drag& drag);

} // namespace restage::editor
