// SPDX-License-Identifier: Apache-2.0
#include "scene/links.hpp"

#include "scene/left_over.hpp"
#include "scene/merge.hpp"
#include "scene/uses.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <unordered_map>

namespace restage::scene {

namespace {

// Of origins.
constexpr const char *file_id = "link", *format_id = "link.format", *option_id = "link.option";
constexpr const char* reading_id = "link.reading"; // how often its file was read again while the document was open
constexpr const char* place_id = "link.place"; // of an object: where it is in the file

const std::string* find_value(const Origin& origin, std::string_view id) {
    const auto found = std::ranges::find(origin.values, id, &OriginValue::id);
    return found == origin.values.end() ? nullptr : &found->text;
}

bool is_mark(const OriginValue& value) { return value.id == file_id || value.id.starts_with("link."); }

std::string place_text(const glm::dmat4& m) {
    std::string text;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            text += fmt::format("{}{}", text.empty() ? "" : " ", m[c][r]);
    return text;
}

std::optional<glm::dmat4> place_in_file(const Instance& instance) {
    const std::string* text = find_value(instance.origin, place_id);
    if (!text) return std::nullopt;
    glm::dmat4 m;
    const char *at = text->data(), *end = at + text->size();
    for (int i = 0; i < 16; ++i) {
        while (at != end && *at == ' ')
            ++at;
        const auto [next, code] = std::from_chars(at, end, m[i / 4][i % 4]);
        if (code != std::errc()) return std::nullopt;
        at = next;
    }
    return m;
}

void put_source(Group& group, const LinkSource& source) {
    group.origin.values.push_back({file_id, source.file});
    group.origin.values.push_back({format_id, source.format});
    for (const std::string& option : source.options)
        group.origin.values.push_back({option_id, option});
}

// Without `links`, their groups and what only they use.
Edit removal(const Scene& scene, const std::set<Id<Group>>& links) {
    Edit edit;
    scene.instances.each([&](Id<Instance> id, const Instance& i) {
        if (links.contains(link_of(scene, i.group))) edit.changes.push_back(Change<Instance>{id, i, std::nullopt});
    });
    scene.groups.each([&](Id<Group> id, const Group& g) {
        if (links.contains(link_of(scene, id))) edit.changes.push_back(Change<Group>{id, g, std::nullopt});
    });
    Scene after = scene;
    apply(after, edit);
    const Edit left = remove_left_over(scene, after);
    edit.changes.insert(edit.changes.end(), left.changes.begin(), left.changes.end());
    return edit;
}

bool near(const glm::dmat4& a, const glm::dmat4& b) {
    for (int c = 0; c < 4; ++c)
        if (glm::length(a[c] - b[c]) > 1e-5 * (1 + glm::length(b[c]))) return false;
    return true;
}

Result<const Group*> linked_group(const Scene& scene, Id<Group> link) {
    const Group* group = scene.groups.find(link);
    if (!group) return fail("there is no such group");
    if (!find_value(group->origin, file_id)) return fail('"' + group->name + "\" is not linked from a file");
    return group;
}

} // namespace

std::optional<LinkSource> link_source(const Group& group) {
    const std::string* file = find_value(group.origin, file_id);
    if (!file) return std::nullopt;
    LinkSource source{.file = *file, .format = {}, .options = {}};
    if (const std::string* format = find_value(group.origin, format_id)) source.format = *format;
    for (const OriginValue& value : group.origin.values)
        if (value.id == option_id) source.options.push_back(value.text);
    return source;
}

Id<Group> link_of(const Scene& scene, Id<Group> id) {
    std::size_t steps = 0; // a file may have loops
    for (const Group* group = scene.groups.find(id); group && steps <= scene.groups.size(); ++steps) {
        if (find_value(group->origin, file_id)) return id;
        id = group->parent;
        group = scene.groups.find(id);
    }
    return {};
}

std::vector<Id<Group>> all_links(const Scene& scene) {
    std::vector<Id<Group>> links;
    scene.groups.each([&](Id<Group> id, const Group& g) {
        if (find_value(g.origin, file_id)) links.push_back(id);
    });
    return links;
}

std::vector<Id<Instance>> objects_of(const Scene& scene, Id<Group> link) {
    std::vector<Id<Instance>> objects;
    scene.instances.each([&](Id<Instance> id, const Instance& i) {
        if (link_of(scene, i.group) == link) objects.push_back(id);
    });
    return objects;
}

glm::dmat4 place_of(const Scene& scene, Id<Group> link) {
    for (const Id<Instance> id : objects_of(scene, link)) {
        const Instance& instance = scene.instances[id];
        const auto place = place_in_file(instance);
        if (place && glm::determinant(glm::dmat3(*place)) != 0) return instance.object_to_world * glm::inverse(*place);
    }
    return glm::dmat4(1);
}

Scene as_link(const Scene& file, const std::string& name, const LinkSource& source) {
    Scene scene = file;
    ++scene.clock;
    Group root{.name = name, .parent = {}, .origin = {}};
    put_source(root, source);
    const Id<Group> link = scene.groups.next();
    file.groups.each([&](Id<Group> id, const Group& g) {
        if (g.parent) return;
        Group inside = g;
        inside.parent = link;
        scene.groups.set(id, std::move(inside), scene.clock);
    });
    scene.groups.set(link, std::move(root), scene.clock);
    file.instances.each([&](Id<Instance> id, const Instance& i) {
        Instance inside = i;
        if (!inside.group) inside.group = link;
        inside.origin.values.push_back({place_id, place_text(i.object_to_world)});
        scene.instances.set(id, std::move(inside), scene.clock);
    });
    file.lights.each([&](Id<Light> id, const Light&) { scene.lights.set(id, std::nullopt, scene.clock); });
    return scene;
}

Scene as_missing_link(const std::string& name, const LinkSource& source) {
    Scene file;
    auto nothing = std::make_shared<MeshData>(); // as of other missing meshes
    nothing->positions = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    nothing->triangles = {{0, 1, 2}};
    const Id<Mesh> mesh = file.meshes.next();
    const std::string line = fmt::format("missing # the linked file {}", source.file); // a comment in a pbrt file
    file.meshes.set(mesh, Mesh{.name = name, .data = nothing, .source_file = source.file, .primitive = line}, 1);
    const Id<Material> material = file.materials.next();
    file.materials.set(material, Material{.name = name, .type = "diffuse"}, 1);
    file.instances.set(file.instances.next(), Instance{.name = name, .mesh = mesh, .material = material}, 1);
    return as_link(file, name, source);
}

void place_link(Edit& merged, const glm::dmat4& place, bool hidden) {
    for (AnyChange& change : merged.changes)
        if (auto* c = std::get_if<Change<Instance>>(&change); c && c->after)
            if (const auto in_file = place_in_file(*c->after)) {
                c->after->object_to_world = place * *in_file;
                c->after->hidden = c->after->hidden || hidden;
            }
}

LinkedItems::LinkedItems(const Scene& scene) {
    if (all_links(scene).empty()) return;
    const auto add = [&](auto& self, auto id) -> void {
        const auto go = [&]<class X>(Id<X> target) {
            if constexpr (std::is_same_v<X, Group>) return;
            if (const X* item = table<X>(scene).find(target); item && all_.insert({kind_name<X>, target.value}).second)
                visit_references(*item, [&](auto next) { self(self, next); });
        };
        go(id);
    };
    scene.instances.each([&](Id<Instance> id, const Instance& i) {
        if (link_of(scene, i.group)) add(add, id);
    });
}

Result<> check_links(const Scene& scene, const Edit& edit) {
    const std::vector<Id<Group>> links = all_links(scene);
    if (links.empty()) return {};
    std::set<Id<Group>> touched, released;
    std::map<Id<Instance>, const Change<Instance>*> objects;
    for (const AnyChange& change : edit.changes)
        if (const auto* g = std::get_if<Change<Group>>(&change);
            g && g->before && g->after && g->before->origin != g->after->origin && link_source(*g->before))
            released.insert(g->id); // made editable, or read again
    const auto locked = [&](Id<Group> group) {
        const Id<Group> link = link_of(scene, group);
        return released.contains(link) ? Id<Group>{} : link;
    };
    const auto refuse = [&](Id<Group> link) {
        const Group& group = scene.groups[link];
        return fail(
            fmt::format("\"{}\" is linked from {}: only the whole is moved, hidden, copied or deleted. "
                        "\"Make editable\" turns it into objects of this document",
                        group.name, std::filesystem::path(link_source(group)->file).filename().string()));
    };
    const LinkedItems items(scene);
    for (const AnyChange& change : edit.changes) {
        Id<Group> refused;
        std::visit(
            [&]<class C>(const C& c) {
                if constexpr (std::is_same_v<C, Change<Instance>>) {
                    const Id<Group> from = c.before ? locked(c.before->group) : Id<Group>{};
                    const Id<Group> to = c.after ? locked(c.after->group) : from;
                    if (from != to) refused = from ? from : to;
                    if (!from) return;
                    touched.insert(from);
                    objects[c.id] = &c;
                    if (!c.after) return;
                    Instance same = *c.after;
                    same.object_to_world = c.before->object_to_world;
                    same.hidden = c.before->hidden;
                    if (!(same == *c.before)) refused = from;
                } else if constexpr (std::is_same_v<C, Change<Group>>) {
                    const Id<Group> self = c.before ? locked(c.id) : Id<Group>{};
                    if (c.after && self && self != c.id) refused = self;
                    if (c.after && c.after->parent && !self) refused = locked(c.after->parent);
                    if (!c.after && self) touched.insert(self);
                } else if constexpr (requires { c.id; }) {
                    // One that links of this document are made of.
                    if (released.empty() && c.before && c.after && items.contains(c.id)) refused = links.front();
                }
            },
            change);
        if (refused) return refuse(refused);
    }
    for (const Id<Group> link : touched) {
        std::size_t removed = 0, hidden = 0;
        bool hides = false;
        std::optional<glm::dmat4> motion;
        const std::vector<Id<Instance>> all = objects_of(scene, link);
        for (const Id<Instance> id : all) {
            const auto found = objects.find(id);
            const Instance& before = scene.instances[id];
            if (found != objects.end() && !found->second->after) {
                ++removed;
                continue;
            }
            const Instance& after = found == objects.end() ? before : *found->second->after;
            hidden += after.hidden;
            hides = hides || after.hidden != before.hidden;
            if (!motion) motion = after.object_to_world * glm::inverse(before.object_to_world);
            if (!near(*motion * before.object_to_world, after.object_to_world)) return refuse(link);
        }
        if (removed != 0 && removed != all.size()) return refuse(link);
        if (hides && hidden != 0 && hidden != all.size()) return refuse(link);
    }
    return {};
}

Result<Edit> make_editable(const Scene& scene, Id<Group> link) {
    RESTAGE_TRY(const Group* const group, linked_group(scene, link));
    Edit edit{"Make " + group->name + " editable", {}};
    const auto add = [&]<class T>(Id<T> id, const T& before) {
        T after = before;
        std::erase_if(after.origin.values, is_mark);
        edit.changes.push_back(Change<T>{id, before, std::move(after)});
    };
    add(link, *group);
    for (const Id<Instance> id : objects_of(scene, link))
        add(id, scene.instances[id]);
    return edit;
}

Result<Edit> replace_link(const Scene& scene, Id<Group> link, const Scene& read) {
    RESTAGE_TRY(const Group* const group, linked_group(scene, link));
    const std::vector<Id<Instance>> objects = objects_of(scene, link);
    const bool hidden =
        !objects.empty() && std::ranges::all_of(objects, [&](Id<Instance> id) { return scene.instances[id].hidden; });
    const Edit gone = removal(scene, {link});
    Scene apart = scene;
    apply(apart, gone);
    Merged merged = merge(apart, read, "");
    place_link(merged.edit, place_of(scene, link), hidden);

    // By name, items take the ids of those that they replace; the others are numbered anew.
    Edit edit{"Reload " + group->name, {}};
    std::map<std::pair<std::string_view, std::uint32_t>, std::uint32_t> now; // kind and id as merged -> id
    std::set<std::pair<std::string_view, std::uint32_t>> replaced;
    each_kind([&]<class T>(const Kind<T>& kind) {
        std::map<std::string, Id<T>> old;
        for (const AnyChange& change : gone.changes)
            if (const auto* c = std::get_if<Change<T>>(&change)) old.emplace(c->before->name, c->id);
        std::uint32_t next = (scene.*kind.table).next().value;
        for (const AnyChange& change : merged.edit.changes) {
            const auto* c = std::get_if<Change<T>>(&change);
            if (!c) continue;
            Id<T> id;
            if constexpr (std::is_same_v<T, Group>)
                if (link_source(*c->after)) id = link;
            if (const auto found = old.find(c->after->name); !id && found != old.end()) id = found->second;
            if (!id || !replaced.insert({kind.name, id.value}).second) id = {next++};
            now[{kind.name, c->id.value}] = id.value;
        }
    });
    for (AnyChange& change : merged.edit.changes)
        std::visit(
            [&]<class C>(C& c) {
                if constexpr (requires { c.id; }) {
                    using T = std::remove_cvref_t<decltype(*c.after)>;
                    visit_references(*c.after, [&]<class X>(Id<X>& target) {
                        if (const auto found = now.find({kind_name<X>, target.value}); found != now.end())
                            target = {found->second};
                    });
                    c.id = {now.at({kind_name<T>, c.id.value})};
                    if (const T* before = table<T>(scene).find(c.id)) c.before = *before;
                    if constexpr (std::is_same_v<T, Group>)
                        if (c.id == link) {
                            c.after = *group;
                            const std::string* reading = find_value(group->origin, reading_id);
                            const std::size_t times = reading ? reading->size() + 1 : 1;
                            std::erase_if(c.after->origin.values, [](const auto& v) { return v.id == reading_id; });
                            c.after->origin.values.push_back({reading_id, std::string(times, '+')});
                        }
                    if (!(c.before == c.after)) edit.changes.push_back(c);
                }
            },
            change);
    for (const AnyChange& change : gone.changes)
        std::visit(
            [&]<class C>(const C& c) {
                if constexpr (requires { c.id; })
                    if (!replaced.contains({kind_name<std::remove_cvref_t<decltype(*c.before)>>, c.id.value}))
                        edit.changes.push_back(c);
            },
            change);
    return edit;
}

Scene without_links(const Scene& scene) {
    const std::vector<Id<Group>> links = all_links(scene);
    Scene rest = scene;
    if (!links.empty()) apply(rest, removal(scene, {links.begin(), links.end()}));
    return rest;
}

} // namespace restage::scene
