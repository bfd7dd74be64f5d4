// SPDX-License-Identifier: Apache-2.0
#include "scene/edit.hpp"

#include <algorithm>

namespace restage::scene {

namespace {

template <class T>
void apply_change(Scene& scene, const Change<T>& change) {
    auto& slots = table<T>(scene);
    [[maybe_unused]] const T* held = slots.find(change.id);
    assert(held ? change.before && *held == *change.before : !change.before);
    slots.set(change.id, change.after, scene.clock);
}

template <class T>
void apply_change(Scene& scene, const ChangeOne<T>& change) {
    auto& slot = single<T>(scene);
    assert(slot.value == change.before);
    slot.value = change.after;
    slot.version = scene.clock;
}

} // namespace

void apply(Scene& scene, const Edit& edit) {
    if (edit.changes.empty()) return;
    ++scene.clock;
    for (const AnyChange& change : edit.changes)
        std::visit([&](const auto& c) { apply_change(scene, c); }, change);
}

Edit inverse(const Edit& edit) {
    Edit result = edit;
    std::reverse(result.changes.begin(), result.changes.end());
    for (AnyChange& change : result.changes)
        std::visit([](auto& c) { std::swap(c.before, c.after); }, change);
    return result;
}

} // namespace restage::scene
