// SPDX-License-Identifier: Apache-2.0
#include "outliner.hpp"

#include "widgets.hpp"

#include <algorithm>
#include <utility>

namespace restage::editor {

namespace {

using Row = OutlinerState::Row;
using Seen = OutlinerState::Seen;

struct Tree { // children of each group, by id; 0 = top level
    std::vector<std::vector<std::uint32_t>> groups, instances;
};

void list_objects(const scene::Scene& s, OutlinerState& state, bool filtered) {
    ++state.lists;
    Tree tree;
    const std::size_t groups = s.groups.size() + 1;
    tree.groups.resize(groups);
    tree.instances.resize(groups);
    state.members.assign(groups, 0);
    state.hidden.assign(groups, 0);
    std::vector<bool> wanted(groups, !filtered); // something in it is listed
    const auto parent_of = [&](GroupId group) {
        const scene::Group* item = s.groups.find(group);
        return item && s.groups.find(item->parent) ? item->parent : GroupId{};
    };
    s.groups.each([&](GroupId id, const scene::Group&) { tree.groups[parent_of(id).value].push_back(id.value); });
    for (std::uint32_t id = 1; id <= state.seen.size(); ++id) {
        const Seen& i = state.seen[id - 1];
        if (!i.live) continue;
        if (i.listed) tree.instances[i.group].push_back(id);
        std::size_t depth = 0;
        for (GroupId group{i.group}; group && depth < groups; group = parent_of(group), ++depth) {
            ++state.members[group.value];
            state.hidden[group.value] += i.hidden;
            if (i.listed) wanted[group.value] = true;
        }
    }
    s.groups.each([&](GroupId id, const scene::Group& g) { // the filter also applies to a group's own name
        if (!state.search.empty() && !state.material && contains_word(g.name, state.search)) wanted[id.value] = true;
    });

    state.rows.clear();
    const auto add = [&](auto& self, std::uint32_t group, int depth) -> void {
        for (const std::uint32_t child : tree.groups[group]) {
            if (!wanted[child]) continue;
            state.rows.push_back({Row::Kind::group, child, depth});
            if (filtered || state.open.contains(child)) self(self, child, depth + 1);
        }
        for (const std::uint32_t id : tree.instances[group])
            state.rows.push_back({Row::Kind::instance, id, depth});
    };
    add(add, 0, 0);
    state.object_rows = state.rows.size();
}

// Lights and cameras, after the objects.
void list_others(const scene::Scene& s, OutlinerState& state) {
    bool first = true;
    s.lights.each([&](scene::Id<scene::Light> id, const scene::Light& light) {
        if (!contains_word(light.name, state.search)) return;
        if (std::exchange(first, false)) state.rows.push_back({Row::Kind::header, 1, 0});
        state.rows.push_back({Row::Kind::light, id.value, 1});
    });
    first = true;
    s.cameras.each([&](scene::Id<scene::Camera> id, const scene::Camera& camera) {
        if (!contains_word(camera.name, state.search)) return;
        if (std::exchange(first, false)) state.rows.push_back({Row::Kind::header, 2, 0});
        state.rows.push_back({Row::Kind::camera, id.value, 1});
    });
}

} // namespace

int find_row(const OutlinerState& state, InstanceId id) {
    const auto found = std::find_if(state.rows.begin(), state.rows.end(), [&](const Row& row) {
        return row.kind == Row::Kind::instance && row.id == id.value;
    });
    return id && found != state.rows.end() ? int(found - state.rows.begin()) : -1;
}

void update_rows(const SelectContext& e, OutlinerState& state) {
    const scene::Scene& s = e.scene();
    // Reveal a selection made elsewhere: open its groups.
    if (const scene::Instance* active = s.instances.find(e.selection.active());
        active && e.selection.active() != state.last_active && e.selection.instances().size() == 1)
        for (GroupId group = active->group; const scene::Group* item = s.groups.find(group); group = item->parent)
            if (!state.open.insert(group.value).second) break;
    update_rows(s, state);
}

void update_rows(const scene::Scene& s, OutlinerState& state) {
    const bool same_filter = state.made_search == state.search && state.made_material == state.material;
    if (state.made_for == s.clock && same_filter && state.made_open == state.open) return;
    const scene::Version since = std::exchange(state.made_for, s.clock);
    const bool filtered = !state.search.empty() || state.material;
    const auto seen = [&](const scene::Instance* i) -> Seen {
        if (!i) return {};
        const auto listed = [&] {
            if (state.material && i->material != state.material) return false;
            if (contains_word(i->name, state.search)) return true;
            const scene::Material* material = s.materials.find(i->material);
            return material && contains_word(material->name, state.search);
        };
        return {.group = s.groups.find(i->group) ? i->group.value : 0,
                .live = true,
                .hidden = i->hidden,
                .listed = !filtered || listed()};
    };
    bool rows_change = since == ~scene::Version(0) || s.clock < since || !same_filter ||
                       state.made_open != state.open || s.groups.version() > since ||
                       (filtered && s.materials.version() > since);
    if (!rows_change) { // most edits do not affect the list
        bool same = state.seen.size() == s.instances.size();
        s.instances.each_changed(since, [&](InstanceId id, const scene::Instance* i) {
            same = same && state.seen[id.value - 1] == seen(i);
        });
        if (same && s.lights.version() <= since && s.cameras.version() <= since) return;
        rows_change = !same;
    }
    if (rows_change) {
        state.made_search = state.search;
        state.made_material = state.material;
        state.made_open = state.open;
        state.seen.assign(s.instances.size(), {});
        s.instances.each([&](InstanceId id, const scene::Instance& i) { state.seen[id.value - 1] = seen(&i); });
        list_objects(s, state, filtered);
    }
    state.rows.resize(state.object_rows);
    if (!state.material) list_others(s, state);
}

} // namespace restage::editor
