// SPDX-License-Identifier: Apache-2.0
// Edits: undo is data. An edit is one or more changes, each with the complete item before and after (heavy data is
// shared, so this is small). Insert has no before, remove no after. apply() is the only writer of a Scene.
#pragma once

#include "scene/tables.hpp"

#include <string>
#include <variant>
#include <vector>

namespace restage::scene {

template <class T>
struct Change {
    Id<T> id;
    std::optional<T> before, after;
};
template <class T>
struct ChangeOne {
    T before, after;
};

template <class... T, class... U>
std::variant<Change<T>..., ChangeOne<U>...> any_change(const std::tuple<Kind<T>...>&, const std::tuple<Single<U>...>&);
using AnyChange = decltype(any_change(kinds, singles)); // a Change<T> per kind, a ChangeOne<T> per single item

struct Edit {
    std::string label; // "Move chair": shown in the history
    std::vector<AnyChange> changes;
};

void apply(Scene&, const Edit&); // before must equal the scene's state (asserted)
Edit inverse(const Edit&);

} // namespace restage::scene
