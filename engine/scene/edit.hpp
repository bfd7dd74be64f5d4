// SPDX-License-Identifier: Apache-2.0
// Edits: undo is data. An edit is one or more changes, each with the whole thing before and after (heavy data is
// shared, so this is small). Insert has no before, remove no after. apply() is the only writer of a Scene.
#pragma once

#include "scene/scene.hpp"

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

using AnyChange =
    std::variant<Change<Mesh>, Change<Image>, Change<Texture>, Change<Material>, Change<Medium>, Change<Group>,
                 Change<Instance>, Change<Light>, Change<Camera>, ChangeOne<std::optional<Environment>>,
                 ChangeOne<Id<Camera>>, ChangeOne<Film>, ChangeOne<Settings>>;

struct Edit {
    std::string label; // "Move chair": what the history shows
    std::vector<AnyChange> changes;
};

void apply(Scene&, const Edit&); // before must be what the scene holds (asserted)
Edit inverse(const Edit&);

} // namespace restage::scene
