// SPDX-License-Identifier: Apache-2.0
#include "scene/left_over.hpp"

#include "scene/edits.hpp"

#include <set>
#include <string_view>
#include <utility>

namespace restage::scene {

Edit remove_left_over(const Scene& before, const Scene& after) {
    std::set<std::pair<std::size_t, std::uint32_t>> had; // kind, id
    const auto id_of = [](const auto& change) {
        std::uint32_t id = 0; // 0: a group, or no item
        std::visit(
            [&]<class C>(const C& c) {
                if constexpr (!std::is_same_v<C, Change<Group>> && requires { c.id; }) id = c.id.value;
            },
            change);
        return id;
    };
    for (const AnyChange& change : remove_unused(before).changes)
        had.insert({change.index(), id_of(change)});
    Edit edit = remove_unused(after);
    std::erase_if(edit.changes, [&](const AnyChange& change) {
        const std::uint32_t id = id_of(change);
        return id == 0 || had.contains({change.index(), id});
    });
    return edit;
}

} // namespace restage::scene
