// SPDX-License-Identifier: Apache-2.0
// Links: objects of another file that are shown in place. A link is a group whose origin names the file; its objects
// are ordinary ones, whose origins keep their place in the file. They are moved, hidden, copied and removed together
// and not edited otherwise, so a project stores only the file and where it stands, and the file can be read again.
#pragma once

#include "base/result.hpp"
#include "scene/edit.hpp"

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace restage::scene {

struct LinkSource {
    std::string file, format; // absolute; of the importer
    std::vector<std::string> options; // of the importer: "up=z", those that were set
    bool operator==(const LinkSource&) const = default;
};
std::optional<LinkSource> link_source(const Group&); // none: not a link
// The link that an object or group is in, or the group itself; none if it is in none.
Id<Group> link_of(const Scene&, Id<Group>);
std::vector<Id<Group>> all_links(const Scene&);
std::vector<Id<Instance>> objects_of(const Scene&, Id<Group> link);
// From the frame of the file to the world.
glm::dmat4 place_of(const Scene&, Id<Group> link);

// The objects of a file as a link, in one new group, to be merged into a scene. Its lights, camera and sky are left
// out.
Scene as_link(const Scene& file, const std::string& name, const LinkSource&);
// Likewise if the file cannot be read: an object that no ray hits, which scene::missing_things lists.
Scene as_missing_link(const std::string& name, const LinkSource&);
// Puts what as_link made, after merging, in this place.
void place_link(Edit& merged, const glm::dmat4& place, bool hidden);

// The items that objects of links are made of.
class LinkedItems {
  public:
    explicit LinkedItems(const Scene&);
    template <class T>
    bool contains(Id<T> id) const {
        return all_.contains({kind_name<T>, id.value});
    }
    bool empty() const { return all_.empty(); }

  private:
    std::set<std::pair<std::string_view, std::uint32_t>> all_;
};

// Refuses an edit of a part of a link, except by replace_link.
Result<> check_links(const Scene&, const Edit&);
// The link becomes ordinary objects.
Result<Edit> make_editable(const Scene&, Id<Group> link);
// Replaces its objects by those of `read` (as_link, as_missing_link), in the same place. Items of the same name keep
// their ids.
Result<Edit> replace_link(const Scene&, Id<Group> link, const Scene& read);
// The scene without its links and what only they use.
Scene without_links(const Scene&);

} // namespace restage::scene
