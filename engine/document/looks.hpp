// SPDX-License-Identifier: Apache-2.0
// Looks: named variations of a document: where things are and which are visible, their materials and the values of
// these, lights, sky, exposure, and the camera. A look records all of that as it was, so going to it shows what was
// seen then; it shares everything with the scene that has not changed since. It holds no objects of its own: those
// removed since are skipped and named, those added since are hidden.
#pragma once

#include "document/session.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace restage::document {

struct Look {
    std::string name; // unique in its document
    std::shared_ptr<const scene::Scene> state; // without geometry; see look_state()
    bool operator==(const Look&) const = default; // the state by identity
};

struct Looks { // in the order shown
    static constexpr std::size_t none = ~std::size_t(0);
    std::vector<Look> list;
    std::size_t current = none; // index of the one recorded or gone to last

    const Look* find(std::string_view name) const; // null if there is none
};

// What a look records of this scene. `seen_from`: replaces the place of the active camera; null = as it is. [any]
std::shared_ptr<const scene::Scene> look_state(const scene::Scene&, const scene::Camera* seen_from = nullptr);

struct LookChange {
    scene::Edit edit; // from the scene to the look; no changes: it looks like that already
    std::vector<std::string> skipped; // 'object "chair"': removed since
};
// Materials, textures, images and media of the look that the scene no longer has are inserted again. [any]
LookChange look_change(const scene::Scene& now, const Look&);
scene::Scene with_look(const scene::Scene& now, const Look&); // the scene after that edit

// The scene, and what only looks need of materials and their textures: so that it is saved. [any]
scene::Scene with_kept(const scene::Scene& now, const Looks&);

// --- on an open document: each is one undo step. Errors: a look that does not exist, a name that another one has. ---

// At the end of the list; it becomes the current one. `name`: "" = "Look 1", "Look 2", ...
Result<> new_look(Session&, std::string name = {}, const scene::Camera* seen_from = nullptr);
Result<std::vector<std::string>> go_to_look(Session&, std::size_t index); // returns what was skipped
Result<> update_look(Session&, std::size_t index, const scene::Camera* seen_from = nullptr); // records it again
Result<> rename_look(Session&, std::size_t index, std::string name);
Result<> duplicate_look(Session&, std::size_t index); // after it
Result<> remove_look(Session&, std::size_t index);
Result<> move_look(Session&, std::size_t from, std::size_t to); // `to`: its index afterwards
// Every look records these objects as they are now.
Result<> use_in_all_looks(Session&, std::span<const scene::Id<scene::Instance>>);

} // namespace restage::document
