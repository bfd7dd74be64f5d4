// SPDX-License-Identifier: Apache-2.0
#include "outliner.hpp"

#include "widgets.hpp"

#include <algorithm>

namespace restage::editor {

namespace {

using Row = OutlinerState::Row;

struct Tree { // children of each group, by id; 0 = top level
    std::vector<std::vector<std::uint32_t>> groups, instances;
};

} // namespace

int find_row(const OutlinerState& state, InstanceId id) {
    const auto found = std::find_if(state.rows.begin(), state.rows.end(), [&](const Row& row) {
        return row.kind == Row::Kind::instance && row.id == id.value;
    });
    return id && found != state.rows.end() ? int(found - state.rows.begin()) : -1;
}

void update_rows(const PanelContext& e, OutlinerState& state) {
    const scene::Scene& s = e.scene();
    // Reveal what was picked elsewhere: open the groups around it.
    if (const scene::Instance* active = s.instances.find(e.selection.active());
        active && e.selection.active() != state.last_active && e.selection.instances().size() == 1)
        for (GroupId group = active->group; const scene::Group* item = s.groups.find(group); group = item->parent)
            if (!state.open.insert(group.value).second) break;
    if (state.made_for == s.clock && state.made_search == state.search && state.made_material == state.material &&
        state.made_open == state.open)
        return;
    state.made_for = s.clock;
    state.made_search = state.search;
    state.made_material = state.material;
    state.made_open = state.open;

    const bool filtered = !state.search.empty() || state.material;
    const auto listed = [&](const scene::Instance& i) {
        if (state.material && i.material != state.material) return false;
        if (contains_word(i.name, state.search)) return true;
        const scene::Material* material = s.materials.find(i.material);
        return material && contains_word(material->name, state.search);
    };
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
    s.instances.each([&](InstanceId id, const scene::Instance& i) {
        const GroupId own = s.groups.find(i.group) ? i.group : GroupId{};
        const bool in_list = !filtered || listed(i);
        if (in_list) tree.instances[own.value].push_back(id.value);
        std::size_t depth = 0;
        for (GroupId group = own; group && depth < groups; group = parent_of(group), ++depth) {
            ++state.members[group.value];
            state.hidden[group.value] += i.hidden;
            if (in_list) wanted[group.value] = true;
        }
    });
    s.groups.each([&](GroupId id, const scene::Group& g) { // a group can be found by its own name
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
    if (state.material) return;
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

} // namespace restage::editor
