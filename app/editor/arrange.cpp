// SPDX-License-Identifier: Apache-2.0
#include "arrange.hpp"

#include "contexts.hpp"
#include "copy_paste.hpp"
#include "document/session.hpp"
#include "panels/state.hpp"

#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_set>
#include <utility>

namespace restage::editor {

namespace {

int axis_of(const glm::dvec3& up) { return std::abs(up.x) > 0.5 ? 0 : std::abs(up.y) > 0.5 ? 1 : 2; }

// All things but the last one.
std::vector<InstanceId> all_but_last(const std::vector<scene::Thing>& things) {
    std::vector<InstanceId> ids;
    for (std::size_t i = 0; i + 1 < things.size(); ++i)
        ids.insert(ids.end(), things[i].begin(), things[i].end());
    return ids;
}

bool around_last(const ArrangeState& a, const std::vector<scene::Thing>& things) {
    return a.array.kind == ArrayKind::circle && a.array.around_last && things.size() > 1;
}

glm::dvec3 underside(const scene::Bounds& box, const glm::dvec3& up) {
    return box.center() - up * (0.5 * std::abs(glm::dot(box.size(), up)));
}

std::vector<glm::dmat4> path_moves(const ArrangeState::Array& a, const glm::dvec3& start, const glm::dvec3& up) {
    std::vector<glm::dvec3> points{start};
    points.insert(points.end(), a.path.begin(), a.path.end());
    return scene::path_array(
        scene::path_through(points, a.smooth),
        {.count = a.count, .spacing = a.by_spacing ? a.path_spacing : 0, .up = up, .turn = a.turn});
}

std::vector<glm::dmat4> moves_of(const ArrangeState::Array& a, const glm::dvec3& middle) {
    if (a.kind == ArrayKind::grid) return scene::grid_array(a.grid, a.spacing);
    if (a.kind == ArrayKind::line)
        return scene::line_array(a.count, a.step_to_last ? a.step / double(std::max(a.count - 1, 1)) : a.step);
    glm::dvec3 axis(0);
    axis[a.axis] = 1;
    return scene::circle_array({.count = a.count, .center = a.center, .axis = axis, .angle = a.angle, .turn = a.turn},
                               middle);
}

void replace(SelectContext& e, std::vector<scene::Thing> things, std::vector<InstanceId> by) {
    const ArrangeState& a = e.panel_state->arrange;
    e.change(
        [&e, things = std::move(things), by = std::move(by),
         options = scene::ReplaceOptions{.up = e.up(), .keep_size = a.replace_keeps_size, .turn = a.replace_turns}](
            document::Session& session) {
            auto made = scene::replace(session.scene(), things, by, options);
            if (!made) return e.notices.add(LogLevel::error, made.error().message);
            if (const auto done = session.edit(std::move(made->edit)); !done)
                return e.notices.add(LogLevel::error, done.error().message);
            e.selection.things.copied(by, made->copies);
            e.selection.set(made->copies);
        });
}

} // namespace

const std::vector<scene::Thing>& things_of(SelectContext& e) {
    auto& found = e.panel_state->arrange.found;
    const std::vector<InstanceId>& selected = e.selection.instances();
    if (found.version == e.session().version() && found.selected == selected) return found.things;
    found = {selected, e.session().version(), {}};
    std::unordered_set<InstanceId> taken;
    for (const InstanceId id : selected) {
        if (taken.contains(id)) continue;
        scene::Thing thing = e.selection.click_target(e.scene(), id);
        std::erase_if(thing,
                      [&](InstanceId part) { return !e.selection.contains(part) || !taken.insert(part).second; });
        if (!thing.empty()) found.things.push_back(std::move(thing));
    }
    for (std::size_t i = 0; i < found.things.size(); ++i)
        if (std::ranges::find(found.things[i], e.selection.active()) != found.things[i].end()) {
            std::rotate(found.things.begin() + std::ptrdiff_t(i), found.things.begin() + std::ptrdiff_t(i) + 1,
                        found.things.end());
            break;
        }
    return found.things;
}

void align_selection(SelectContext& e, int axis, scene::Side side) {
    e.edit([things = things_of(e), axis, side, all = e.panel_state->arrange.align_to_all](const scene::Scene& s) {
        scene::Bounds target;
        for (const scene::Thing& thing : things)
            if (all || &thing == &things.back()) target.add(scene::world_bounds(s, thing));
        return scene::align(s, things, axis, side, target);
    });
}

void distribute_selection(SelectContext& e, int axis, scene::Spacing spacing) {
    e.edit([things = things_of(e), axis, spacing](const scene::Scene& s) {
        return scene::distribute(s, things, axis, spacing);
    });
}

void mirror_in_place(SelectContext& e, int axis) {
    const double at = e.selection.bounds(e.scene()).center()[axis];
    e.edit([ids = e.selection.instances(), light = e.selection.light(), axis, at](const scene::Scene& s) {
        return light ? scene::mirror(s, light, axis, at) : scene::mirror(s, ids, axis, at);
    });
}

void mirror_selection(SelectContext& e, int axis) {
    using About = ArrangeState::About;
    const ArrangeState& a = e.panel_state->arrange;
    if (e.selection.light()) return mirror_in_place(e, axis);
    const std::vector<scene::Thing>& things = things_of(e);
    const bool last = a.mirror_about == About::last && things.size() > 1;
    std::vector<InstanceId> ids = last ? all_but_last(things) : e.selection.instances();
    const scene::Bounds box = last ? scene::world_bounds(e.scene(), things.back()) : e.selection.bounds(e.scene());
    if (box.empty()) return e.notices.add(LogLevel::info, "There is no geometry to mirror");
    const double at = a.mirror_about == About::lower   ? box.lower[axis]
                      : a.mirror_about == About::upper ? box.upper[axis]
                      : a.mirror_about == About::zero  ? 0
                                                       : box.center()[axis];
    if (!a.mirror_copy)
        return e.edit(
            [ids = std::move(ids), axis, at](const scene::Scene& s) { return scene::mirror(s, ids, axis, at); });
    e.change([&e, ids = std::move(ids), by = scene::reflection(axis, at)](document::Session& session) {
        auto made = scene::duplicate_each(session.scene(), ids, std::span(&by, 1));
        if (!made) return e.notices.add(LogLevel::error, made.error().message);
        made->edit.label.replace(0, std::string_view("Duplicate").size(), "Mirrored copy of");
        if (const auto done = session.edit(std::move(made->edit)); !done)
            return e.notices.add(LogLevel::error, done.error().message);
        e.selection.things.copied(ids, made->copies);
        e.selection.set(made->copies);
    });
}

void replace_by_last(SelectContext& e) {
    std::vector<scene::Thing> things = things_of(e);
    if (things.size() < 2)
        return e.notices.add(LogLevel::info,
                             "Select what to replace, and then, with Shift, the thing to replace it by");
    std::vector<InstanceId> by = std::move(things.back());
    things.pop_back();
    replace(e, std::move(things), std::move(by));
}

void replace_by_copied(SelectContext& e) {
    std::vector<InstanceId> by;
    for (const auto& [id, instance] : e.copied.instances)
        if (e.scene().instances.find(id)) by.push_back(id);
    if (by.empty() || by.size() < e.copied.instances.size())
        return e.notices.add(LogLevel::info,
                             "What was copied is no longer in this scene: paste it, and replace by that");
    replace(e, things_of(e), std::move(by));
}

bool array_is_live(const SelectContext& e) {
    const ArrangeState& a = e.panel_state->arrange;
    return a.live && a.live->version == e.session().version() && a.live->selected == e.selection.instances() &&
           ImGui::GetFrameCount() - a.drawn <= 1;
}

glm::dvec3 path_start(const SelectContext& e) { return underside(e.selection.bounds(e.scene()), e.up()); }

void suit_array(SelectContext& e) {
    ArrangeState::Array& a = e.panel_state->arrange.array;
    const std::vector<scene::Thing>& things = things_of(e);
    const scene::Bounds box = e.selection.bounds(e.scene());
    if (box.empty()) return;
    const glm::dvec3 step = aside(e, box);
    a.step = a.step_to_last ? step * double(std::max(a.count - 1, 1)) : step;
    a.axis = axis_of(e.up());
    a.around_last = things.size() > 1;
    a.center = box.center() + step * 2.0;
    a.path_spacing = std::max(glm::length(step), 1e-6);
    for (int i = 0; i < 3; ++i) {
        a.grid[i] = i == a.axis ? 1 : 3;
        a.spacing[i] = box.size()[i] > 0 ? box.size()[i] * 1.05 : std::max(box.radius(), 1e-3);
        if (step[i] < 0) a.spacing[i] = -a.spacing[i];
    }
}

void change_array(SelectContext& e) {
    e.change([&e](document::Session& session) {
        ArrangeState& a = e.panel_state->arrange;
        const std::vector<scene::Thing> things = things_of(e);
        if (array_is_live(e)) {
            if (a.live->changed) session.undo();

        } else {
            a.live = ArrangeState::Live{.start = session.scene(), .selected = e.selection.instances(), .copies = {}};
        }
        // Made for the scene before it, so that equal settings give equal ids.
        const scene::Scene& start = a.live->start;
        std::vector<InstanceId> ids = a.live->selected;
        if (around_last(a, things)) {
            ids = all_but_last(things);
            a.array.center = scene::world_bounds(start, things.back()).center();
        }
        const scene::Bounds box = scene::world_bounds(start, ids);
        auto made = scene::duplicate_each(start, ids,
                                          a.array.kind == ArrayKind::path
                                              ? path_moves(a.array, underside(box, e.up()), e.up())
                                              : moves_of(a.array, box.empty() ? a.array.center : box.center()));
        Result<bool> done = false;
        if (made) {
            made->edit.label.replace(0, std::string_view("Duplicate").size(), "Array of");
            done = session.edit(std::move(made->edit));
        }
        a.problem = !made ? made.error().message : !done ? done.error().message : "";
        a.live->changed = done && *done;
        a.live->copies = a.live->changed ? std::move(made->copies) : std::vector<InstanceId>();
        a.live->copied = std::move(ids);
        a.live->version = session.version();
    });
}

void keep_array(SelectContext& e) {
    e.later([&e] {
        ArrangeState& a = e.panel_state->arrange;
        if (!array_is_live(e)) return;
        const ArrangeState::Live live = *std::exchange(a.live, std::nullopt);
        e.selection.things.copied(live.copied, live.copies);
        e.selection.set(live.copies, Selection::Mode::add);
    });
}

bool cancel_array(SelectContext& e) {
    ArrangeState& array = e.panel_state->arrange;
    const bool drawing = std::exchange(array.drawing, false);
    if (drawing) array.array.path.clear();
    if (!array_is_live(e)) return drawing;
    e.change([&e](document::Session& session) {
        ArrangeState& a = e.panel_state->arrange;
        if (array_is_live(e) && a.live->changed) session.undo();
        a.live.reset();
        a.problem.clear();
    });
    return true;
}

} // namespace restage::editor
