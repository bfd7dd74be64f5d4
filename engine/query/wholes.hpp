// SPDX-License-Identifier: Apache-2.0
// Wholes: the groups and things around an object, from the outside in; what a click takes, and a double click enters.
#pragma once

#include "query/things.hpp"

#include <compare>

namespace restage::query {

// What holds objects together: a group or a thing.
struct Whole {
    scene::Id<scene::Group> group; // of a thing: the outermost of the user's groups around this part of it
    std::uint32_t thing = 0;
    explicit operator bool() const { return group || thing; }
    auto operator<=>(const Whole&) const = default;
};
// Around an object, from the outside in: groups but for collections, and its thing inside the user's groups.
std::vector<Whole> wholes_around(const scene::Scene& scene, const Things& things, scene::Id<scene::Instance> id);
std::vector<scene::Id<scene::Instance>> members_of(const scene::Scene& scene, const Things& things, const Whole& whole);

// All objects in a group and the groups within it.
std::vector<scene::Id<scene::Instance>> instances_in(const scene::Scene& scene, scene::Id<scene::Group> group);

} // namespace restage::query
