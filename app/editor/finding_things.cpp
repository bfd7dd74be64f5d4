// SPDX-License-Identifier: Apache-2.0
#include "finding_things.hpp"

#include "base/thread_priority.hpp"
#include "contexts.hpp"
#include "document/session.hpp"
#include "scene/edit.hpp"

#include <chrono>
#include <utility>

namespace restage::editor {

namespace {

// A scene with only the objects from this id on.
scene::Scene only_new(scene::Scene s, std::uint32_t first) {
    scene::Edit edit;
    s.instances.each([&](InstanceId id, const scene::Instance& instance) {
        if (id.value < first) edit.changes.emplace_back(scene::Change<scene::Instance>{id, instance, std::nullopt});
    });
    scene::apply(s, edit);
    return s;
}

} // namespace

void FindingThings::stop() {
    stop_ = true;
    if (found_.valid()) found_.wait();
    found_ = {};
    stop_ = false;
}

void FindingThings::follow(SelectContext& e) {
    query::Things& things = e.selection.things;
    if (found_.valid()) {
        if (found_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
        const query::Things found = found_.get();
        if (all_)
            things = found; // what was copied meanwhile is looked at next
        else
            things.add(found);
    }
    const auto known = std::uint32_t(things.of.size()); // ids below it
    if (e.scene().instances.size() < std::max(known, 1u)) return;
    all_ = known == 0;
    const std::uint32_t imported = e.session().base().file.empty() ? 0 : e.session().base().scene.groups.size();
    found_ = std::async(std::launch::async, [this, known, imported, s = e.scene(), up = e.up()]() mutable {
        lower_thread_priority(10);
        query::Things found = query::find_things(known ? only_new(std::move(s), known) : s, up, imported,
                                                 [this] { return stop_.load(); });
        wake_();
        return found;
    });
}

} // namespace restage::editor
