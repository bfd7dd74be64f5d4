// SPDX-License-Identifier: Apache-2.0
#include "drag.hpp"

#include "document/session.hpp"
#include "panel_context.hpp"
#include "scene/edits_light.hpp"

#include <cmath>

namespace restage::editor {

namespace {

constexpr double farthest = 8; // times the distance at the start of the drag: keeps it away from the horizon

// Where the ray hits the plane through `at`.
std::optional<glm::dvec3> on_plane(const query::ViewRay& ray, const glm::dvec3& at, const glm::dvec3& normal) {
    const double slope = glm::dot(ray.direction, normal);
    const double t = glm::dot(at - ray.origin, normal) / slope;
    if (!std::isfinite(t) || t <= 0) return std::nullopt;
    const double taken = glm::length(at - ray.origin), now = t * glm::length(ray.direction);
    if (now > farthest * taken) return std::nullopt;
    return ray.origin + t * ray.direction;
}

Result<scene::Edit> place(const scene::Scene& s, const Drag& d, const glm::dmat4& by, const char* verb) {
    if (d.light) {
        const scene::Light* light = s.lights.find(d.light);
        if (!light) return fail("the light no longer exists");
        scene::Light changed = *light;
        changed.light_to_world = by * d.light_start;
        return scene::set_light(s, d.light, changed, std::string(verb) + " " + light->name);
    }
    scene::Edit edit;
    for (const auto& [id, start] : d.start) {
        auto one = scene::set_transform(s, id, by * start);
        if (!one) return one;
        edit.changes.insert(edit.changes.end(), one->changes.begin(), one->changes.end());
    }
    const scene::Instance* first = d.start.empty() ? nullptr : s.instances.find(d.start[0].first);
    edit.label = std::string(verb) + " " +
                 (d.start.size() == 1 && first ? first->name : std::to_string(d.start.size()) + " objects");
    return edit;
}

} // namespace

void DragPath::begin(const glm::dvec3& at, const glm::dvec3& up, const Mouse& mouse, bool handle) {
    *this = {};
    up_ = up;
    at_ = at;
    if (!handle) from_ = on_plane(mouse.ray, at, up).value_or(at);
}

double DragPath::height(const Mouse& mouse) const {
    const glm::dvec3 d = glm::normalize(mouse.ray.direction), w = mouse.ray.origin - at_;
    if (steep_) { // seen from above: up in the picture moves up
        const glm::dvec3 ahead = glm::normalize(glm::cross(mouse.view_up, glm::cross(d, mouse.view_up)));
        const double t = -glm::dot(w, ahead) / glm::dot(d, ahead);
        return glm::dot(w + t * d, mouse.view_up);
    }
    const double along = glm::dot(up_, d);
    return (glm::dot(up_, w) - along * glm::dot(d, w)) / (1 - along * along);
}

glm::dvec3 DragPath::update(bool lift, const Mouse& mouse, std::optional<glm::dvec3> handle, double step) {
    if (lift != lifting_) {
        at_ += now_ - kept_;
        kept_ = now_;
        lifting_ = lift;
        const double along = glm::dot(up_, glm::normalize(mouse.ray.direction));
        steep_ = 1 - along * along < 0.06; // within 14 degrees
        if (lift)
            height_ = height(mouse);
        else
            from_ = handle ? *handle : on_plane(mouse.ray, at_, up_).value_or(at_);
    }
    const auto stepped = [&](const glm::dvec3& v) { return step > 0 ? glm::round(v / step) * step : v; };
    if (lift)
        now_ = kept_ + up_ * stepped(glm::dvec3(height(mouse) - height_)).x;
    else if (handle)
        now_ = kept_ + *handle - from_; // already in steps
    else if (const auto to = on_plane(mouse.ray, at_, up_))
        now_ = kept_ + stepped(*to - from_);
    return now_;
}

std::vector<std::pair<InstanceId, glm::dmat4>> Drag::thing() const {
    std::vector<std::pair<InstanceId, glm::dmat4>> thing;
    for (std::size_t i = 0; i < start.size(); ++i)
        thing.emplace_back(originals[i], start[i].second);
    return thing;
}

std::unordered_set<InstanceId> Drag::dragged() const {
    std::unordered_set<InstanceId> ids;
    for (const auto& [id, place] : start)
        ids.insert(id);
    return ids;
}

void begin_drag(PanelContext& e, Drag& drag, bool copy) {
    const scene::Scene& s = e.scene();
    drag.active = true;
    drag.copied = false;
    drag.start.clear();
    drag.originals = e.selection.instances();
    drag.light = drag.original_light = e.selection.light();
    if (const scene::Light* light = s.lights.find(drag.light)) {
        drag.light_start = light->light_to_world;
        if (!copy) return;
        if (auto made = scene::duplicate_light(s, drag.light, glm::dmat4(1))) {
            drag.light = made->copy;
            drag.copied = true;
            e.edit([edit = made->edit](const scene::Scene&) { return Result<scene::Edit>(edit); }, "drag");
            e.later([&e, id = made->copy, at = drag.light_start] {
                e.selection.set_light(id);
                e.latest_copies.made(id, at, glm::dmat4(1));
            });
        }
        return;
    }
    for (const InstanceId id : drag.originals)
        drag.start.emplace_back(id, s.instances[id].object_to_world);
    if (!copy) return;
    // Copies are created at the originals' places, and are dragged instead.
    if (auto made = scene::duplicate_instances(s, drag.originals, glm::dmat4(1))) {
        for (std::size_t i = 0; i < drag.start.size(); ++i)
            drag.start[i].first = made->copies[i];
        drag.copied = true;
        e.edit([edit = made->edit](const scene::Scene&) { return Result<scene::Edit>(edit); }, "drag");
        e.later([&e, originals = drag.originals, copies = made->copies, at = drag.start.back().second] {
            e.selection.things.copied(originals, copies);
            e.selection.set(copies);
            e.latest_copies.made(copies, at, glm::dmat4(1));
        });
    }
}

void ask_drag(PanelContext& e, const Drag& drag, const glm::dmat4& by, const char* verb) {
    e.edit(
        [d = drag, by, verb = drag.copied ? "Copy" : verb](const scene::Scene& now) { return place(now, d, by, verb); },
        "drag");
}

void cancel_drag(PanelContext& e, Drag& drag) {
    if (!drag.active) return;
    e.change([&e, originals = drag.originals, light = drag.original_light,
              copied = drag.copied](document::Session& session) {
        session.cancel_gesture();
        if (!copied) return;
        if (light)
            e.selection.set_light(light);
        else
            e.selection.set(originals);
    });
    drag = {};
}

} // namespace restage::editor
