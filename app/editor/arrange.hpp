// SPDX-License-Identifier: Apache-2.0
// Arranging the selection (scene/arrange.hpp): the settings of the panel, and what it and the menu do with them. An
// array is live: it is the newest step of the history, and replaced whenever its settings change, until it is kept or
// cancelled, or anything else happens.
#pragma once

#include "scene/arrange.hpp"
#include "scene/path_array.hpp"
#include "selection.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace restage::editor {

class SelectContext;

enum class ArrayKind { line, circle, grid, path };

struct ArrangeState {
    bool align_to_all = false; // else to the last selected thing
    bool gap_centers = false; // distribute: distances of centres, else gaps
    enum class About { center, lower, upper, last, zero } mirror_about = About::center;
    bool mirror_copy = false;
    bool replace_keeps_size = false, replace_turns = true;

    struct Array {
        ArrayKind kind = ArrayKind::line;
        int count = 5; // with the original: of a line, a circle
        glm::dvec3 step{1, 0, 0}; // of a line: to the next one, or to the last one
        bool step_to_last = false;
        glm::dvec3 center{0}; // of a circle
        bool around_last = false; // its centre is that of the last selected thing, which is not repeated
        int axis = 1;
        double angle = 360; // [deg]
        bool turn = true;
        glm::ivec3 grid{3, 1, 3};
        glm::dvec3 spacing{1};
        std::vector<glm::dvec3> path; // points after the selection's own place, drawn in the picture
        bool smooth = true, by_spacing = false;
        double path_spacing = 1;
    } array;
    bool drawing = false; // a path: clicks in the picture are its points
    struct Live {
        scene::Scene start; // before it
        std::vector<InstanceId> selected, copied,
            copies; // `selected`: then, in order; `copied`: what the copies are of
        scene::Version version = 0; // of the scene with it
        bool changed = false; // it is a step of the history
    };
    std::optional<Live> live;
    std::string problem; // why the array cannot be made
    bool asked = false; // the menu asked for an array: the panel begins one when it is shown
    int drawn = -1; // the last frame in which the panel was shown

    struct { // what things_of() found last
        std::vector<InstanceId> selected;
        scene::Version version = ~scene::Version(0);
        std::vector<scene::Thing> things;
    } found;
};

// The selection as whole things: what one click selects stays together. The last one contains the active object.
const std::vector<scene::Thing>& things_of(SelectContext& editor);

void align_selection(SelectContext& editor, int axis, scene::Side side);
void distribute_selection(SelectContext& editor, int axis, scene::Spacing spacing);
void mirror_selection(SelectContext& editor, int axis); // as the panel says; without copies a light, too
void mirror_in_place(SelectContext& editor, int axis); // about the centre
// Each other selected thing by a copy of the last one; each by a copy of what was copied in this window.
void replace_by_last(SelectContext& editor);
void replace_by_copied(SelectContext& editor);

// Whether the array of the panel can still change, is kept by Enter and removed by Esc.
bool array_is_live(const SelectContext& editor);
glm::dvec3 path_start(const SelectContext& editor); // of an array along a path: the middle of the selection's underside
void suit_array(SelectContext& editor); // settings that suit the selection
void change_array(SelectContext& editor); // makes it, or again after its settings changed
void keep_array(SelectContext& editor); // and select all of it
bool cancel_array(SelectContext& editor); // false if none is live

} // namespace restage::editor
