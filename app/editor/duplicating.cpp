// SPDX-License-Identifier: Apache-2.0
#include "duplicating.hpp"

#include "copy_paste.hpp"
#include "document/session.hpp"
#include "editor.hpp"
#include "scene/edits_light.hpp"

#include <algorithm>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

namespace restage::editor {

void LatestCopies::made(std::vector<InstanceId> copies, const glm::dmat4& original, const glm::dmat4& move) {
    *this = {};
    copies_ = std::move(copies);
    original_ = original;
    move_ = move;
}

void LatestCopies::made(scene::Id<scene::Light> copy, const glm::dmat4& original, const glm::dmat4& move) {
    *this = {};
    light_ = copy;
    original_ = original;
    move_ = move;
}

void LatestCopies::follow(const Selection& selection) {
    const auto selected = [&](InstanceId id) { return selection.contains(id); };
    if (selection.light() != light_ || selection.instances().size() != copies_.size() ||
        !std::ranges::all_of(copies_, selected))
        *this = {};
}

std::optional<glm::dmat4> LatestCopies::next(const scene::Scene& scene) const {
    const scene::Light* light = scene.lights.find(light_);
    const scene::Instance* copy = copies_.empty() ? nullptr : scene.instances.find(copies_.back());
    if (!light && !copy) return std::nullopt;
    const glm::dmat4& now = light ? light->light_to_world : copy->object_to_world;
    if (now == original_) return std::nullopt;
    if (now == move_ * original_) return move_; // exactly, so that a long row stays even
    return now * glm::affineInverse(original_);
}

void duplicate_selected(Editor& e) {
    const scene::Scene& s = e.scene();
    const glm::dmat4 move =
        e.latest_copies.next(s).value_or(glm::translate(glm::dmat4(1), aside(e, e.selection.bounds(s))));
    document::Session& session = e.session_for_changes();
    if (const scene::Light* light = s.lights.find(e.selection.light())) {
        const glm::dmat4 original = light->light_to_world;
        auto made = scene::duplicate_light(s, e.selection.light(), move);
        if (!made) return e.notices.add(LogLevel::error, made.error().message);
        if (const auto done = session.edit(std::move(made->edit)); !done)
            return e.notices.add(LogLevel::error, done.error().message);
        e.selection.set_light(made->copy);
        return e.latest_copies.made(made->copy, original, move);
    }
    const glm::dmat4 original = s.instances[e.selection.active()].object_to_world;
    auto made = session.duplicate(e.selection.instances(), move);
    if (!made) return e.notices.add(LogLevel::error, made.error().message);
    e.selection.things.copied(e.selection.instances(), *made);
    e.selection.set(*made);
    e.latest_copies.made(std::move(*made), original, move);
}

} // namespace restage::editor
