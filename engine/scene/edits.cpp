// SPDX-License-Identifier: Apache-2.0
#include "scene/edits.hpp"

#include "scene/arrange.hpp"
#include "scene/edits_texture.hpp"
#include "scene/uses.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <unordered_map>
#include <unordered_set>

namespace restage::scene {

namespace {

template <class T>
tl::unexpected<Error> missing(Id<T> id) {
    return fail("there is no " + std::string(kind_name<T>) + " with id " + std::to_string(id.value));
}

bool usable(const glm::dmat4& m) { // finite, affine, invertible
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite(m[c][r])) return false;
    return m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1 && glm::determinant(glm::dmat3(m)) != 0;
}

std::string label_for(const Scene& scene, const char* verb, std::span<const Id<Instance>> ids) {
    if (ids.size() == 1 && scene.instances.find(ids[0])) return std::string(verb) + " " + scene.instances[ids[0]].name;
    return std::string(verb) + " " + std::to_string(ids.size()) + " objects";
}

// The same change to several instances, as one edit.
template <class F>
Result<Edit> modify_each(const Scene& scene, std::span<const Id<Instance>> ids, std::string label, F&& f) {
    Edit edit{std::move(label), {}};
    std::unordered_set<std::uint32_t> seen;
    for (const Id<Instance> id : ids) {
        const Instance* before = scene.instances.find(id);
        if (!before) return missing(id);
        if (!seen.insert(id.value).second) continue;
        Instance after = *before;
        f(after);
        edit.changes.push_back(Change<Instance>{id, *before, std::move(after)});
    }
    return edit;
}

} // namespace

std::string next_name(std::string name, std::set<std::string>& taken, TriedNumbers* tried) {
    std::size_t digits = name.size();
    while (digits > 0 && std::isdigit(static_cast<unsigned char>(name[digits - 1])))
        --digits;
    unsigned long number = 1;
    if (digits > 0 && digits < name.size() && name[digits - 1] == ' ' && name.size() - digits < 9) {
        number = std::stoul(name.substr(digits));
        name.resize(digits - 1);
    }
    // Otherwise copying "oak 1" to "oak 20000" would take 20000 lookups each.
    auto* known = tried ? &(*tried)[name] : nullptr;
    const unsigned long first = number;
    const bool inside = known && first >= known->first && first <= known->second;
    if (inside) number = known->second;
    std::string result;
    do
        result = name + " " + std::to_string(++number);
    while (!taken.insert(result).second);
    if (known) *known = {inside ? known->first : first, number};
    return result;
}

template <class T>
Result<Edit> remove(const Scene& scene, Id<T> id) {
    const T* item = table<T>(scene).find(id);
    if (!item) return missing(id);
    if (const auto by = users(scene, id); !by.empty()) {
        std::string names = by[0];
        for (std::size_t i = 1; i < by.size() && i < 3; ++i)
            names += ", " + by[i];
        if (by.size() > 3) names += " and " + std::to_string(by.size() - 3) + " more";
        return fail(std::string(kind_name<T>) + " \"" + item->name + "\" is used by " + names + ": change these first");
    }
    Edit edit{"Remove " + item->name, {}};
    edit.changes.push_back(Change<T>{id, *item, std::nullopt});
    return edit;
}
template Result<Edit> remove(const Scene&, Id<Mesh>);
template Result<Edit> remove(const Scene&, Id<Image>);
template Result<Edit> remove(const Scene&, Id<Texture>);
template Result<Edit> remove(const Scene&, Id<Material>);
template Result<Edit> remove(const Scene&, Id<Medium>);
template Result<Edit> remove(const Scene&, Id<Group>);
template Result<Edit> remove(const Scene&, Id<Light>);
template Result<Edit> remove(const Scene&, Id<Camera>);

Result<Edit> remove_instances(const Scene& scene, std::span<const Id<Instance>> ids) {
    Edit edit{label_for(scene, "Remove", ids), {}};
    std::unordered_map<std::uint32_t, std::uint32_t> members; // group -> instances and groups in it
    scene.instances.each([&](auto, const Instance& i) { members[i.group.value] += i.group ? 1 : 0; });
    scene.groups.each([&](auto, const Group& g) { members[g.parent.value] += g.parent ? 1 : 0; });
    std::unordered_set<std::uint32_t> seen;
    std::vector<Id<Group>> emptied;
    for (const Id<Instance> id : ids) {
        const Instance* before = scene.instances.find(id);
        if (!before) return missing(id);
        if (!seen.insert(id.value).second) continue;
        edit.changes.push_back(Change<Instance>{id, *before, std::nullopt});
        if (before->group && --members[before->group.value] == 0) emptied.push_back(before->group);
    }
    for (std::size_t i = 0; i < emptied.size(); ++i) { // grows: a parent may lose its last child
        const Group* group = scene.groups.find(emptied[i]);
        if (!group) continue;
        edit.changes.push_back(Change<Group>{emptied[i], *group, std::nullopt});
        if (group->parent && --members[group->parent.value] == 0) emptied.push_back(group->parent);
    }
    return edit;
}

Edit remove_unused(const Scene& scene) {
    // Marked = reachable from instances, environment and settings. Unmarked things may refer to each other.
    std::set<std::pair<std::string_view, std::uint32_t>> marked; // kind, id
    const auto mark = [&](auto& self, auto id) -> void {
        const auto go = [&]<class X>(Id<X> target) {
            if (const X* item = table<X>(scene).find(target);
                item && marked.insert({kind_name<X>, target.value}).second)
                visit_references(*item, [&](auto next) { self(self, next); });
        };
        go(id);
    };
    scene.instances.each(
        [&](auto, const Instance& i) { visit_references(i, [&](auto target) { mark(mark, target); }); });
    each_single([&](const auto& single) {
        visit_references((scene.*single.one).value, [&](auto target) { mark(mark, target); });
    });

    Edit edit{"Remove unused items", {}};
    each_table(scene, [&]<class T>(const Table<T>& table) {
        // Instances, environment and settings are roots; the rest is alive if referenced.
        if constexpr (!std::is_same_v<T, Instance> && !std::is_same_v<T, Light> && !std::is_same_v<T, Camera>) {
            std::vector<AnyChange> unused;
            table.each([&](Id<T> id, const T& item) {
                if (!marked.contains({kind_name<T>, id.value})) unused.push_back(Change<T>{id, item, std::nullopt});
            });
            // Referrers are removed before their targets.
            edit.changes.insert(edit.changes.begin(), unused.begin(), unused.end());
        }
    });
    return edit;
}

Result<Duplicate> duplicate_instances(const Scene& scene, std::span<const Id<Instance>> ids, const glm::dmat4& move) {
    return duplicate_each(scene, ids, std::span(&move, 1));
}

Result<Duplicate> duplicate_each(const Scene& scene, std::span<const Id<Instance>> ids,
                                 std::span<const glm::dmat4> moves) {
    if (!std::ranges::all_of(moves, usable))
        return fail("the displacement of the copies is not an invertible affine transform");
    if (ids.size() * moves.size() > most_copies)
        return fail("these would be " + std::to_string(ids.size() * moves.size()) + " copies; the most is " +
                    std::to_string(most_copies));
    Duplicate result{{label_for(scene, "Duplicate", ids), {}}, {}};
    std::unordered_set<std::uint32_t> selected;
    for (const Id<Instance> id : ids) {
        if (!scene.instances.find(id)) return missing(id);
        selected.insert(id.value);
    }
    // A group is copied if everything in it, at any depth, is selected.
    std::unordered_set<std::uint32_t> touched, kept;
    const auto each_ancestor = [&](Id<Group> group, auto&& f) {
        for (std::size_t depth = 0; scene.groups.find(group) && depth <= scene.groups.size(); ++depth) {
            f(group);
            group = scene.groups[group].parent;
        }
    };
    scene.instances.each([&](Id<Instance> id, const Instance& i) {
        auto& set = selected.contains(id.value) ? touched : kept;
        each_ancestor(i.group, [&](Id<Group> g) { set.insert(g.value); });
    });
    std::set<std::string> instance_names, group_names;
    scene.instances.each([&](auto, const Instance& i) { instance_names.insert(i.name); });
    scene.groups.each([&](auto, const Group& g) { group_names.insert(g.name); });
    TriedNumbers tried, tried_groups;
    std::vector<Id<Group>> whole; // copied with the selection
    scene.groups.each([&](Id<Group> id, const Group&) {
        if (touched.contains(id.value) && !kept.contains(id.value)) whole.push_back(id);
    });
    std::uint32_t next = scene.instances.next().value, next_group = scene.groups.next().value;
    for (const glm::dmat4& move : moves) {
        std::unordered_map<std::uint32_t, Id<Group>> copy_of;
        for (const Id<Group> id : whole)
            copy_of[id.value] = {next_group++};
        const auto mapped = [&](Id<Group> id) {
            const auto it = copy_of.find(id.value);
            return it == copy_of.end() ? id : it->second;
        };
        for (const Id<Group> id : whole) {
            Group copy = scene.groups[id];
            copy.name = next_name(copy.name, group_names, &tried_groups);
            copy.parent = mapped(copy.parent);
            result.edit.changes.push_back(Change<Group>{copy_of[id.value], std::nullopt, std::move(copy)});
        }
        for (const Id<Instance> id : ids) {
            Instance copy = scene.instances[id];
            copy.name = next_name(copy.name, instance_names, &tried);
            copy.object_to_world = move * copy.object_to_world;
            copy.group = mapped(copy.group);
            result.copies.push_back({next});
            result.edit.changes.push_back(Change<Instance>{{next++}, std::nullopt, std::move(copy)});
        }
    }
    return result;
}

Result<Edit> set_transform(const Scene& scene, Id<Instance> id, const glm::dmat4& object_to_world) {
    if (!usable(object_to_world)) return fail("the transform is not invertible and affine");
    return modify_each(scene, std::span(&id, 1), label_for(scene, "Move", std::span(&id, 1)),
                       [&](Instance& i) { i.object_to_world = object_to_world; });
}

Result<Edit> move_instances(const Scene& scene, std::span<const Id<Instance>> ids, const glm::dmat4& move) {
    if (!usable(move)) return fail("the displacement is not an invertible affine transform");
    return modify_each(scene, ids, label_for(scene, "Move", ids),
                       [&](Instance& i) { i.object_to_world = move * i.object_to_world; });
}

Result<Edit> set_material(const Scene& scene, std::span<const Id<Instance>> ids, Id<Material> material) {
    if (!scene.materials.find(material)) return missing(material);
    return modify_each(scene, ids, label_for(scene, "Material of", ids), [&](Instance& i) { i.material = material; });
}

Result<Edit> set_emission(const Scene& scene, Id<Instance> id, std::optional<Emission> emission) {
    return modify_each(scene, std::span(&id, 1), label_for(scene, "Emission of", std::span(&id, 1)),
                       [&](Instance& i) { i.emission = emission; });
}

Result<Edit> set_hidden(const Scene& scene, std::span<const Id<Instance>> ids, bool hidden) {
    return modify_each(scene, ids, label_for(scene, hidden ? "Hide" : "Show", ids),
                       [&](Instance& i) { i.hidden = hidden; });
}

Result<Edit> set_catcher(const Scene& scene, std::span<const Id<Instance>> ids, bool catcher) {
    return modify_each(scene, ids, label_for(scene, catcher ? "Shadow catcher:" : "No shadow catcher:", ids),
                       [&](Instance& i) { i.catcher = catcher; });
}

Result<Edit> set_hidden(const Scene& scene, Id<Light> id, bool hidden) {
    const Light* light = scene.lights.find(id);
    return modify(scene, id, std::string(hidden ? "Hide " : "Show ") + (light ? light->name : "light"),
                  [&](Light& l) { l.hidden = hidden; });
}

namespace {

template <class T>
Result<Edit> set_param_of(const Scene& scene, Id<T> id, std::string_view param, Value value) {
    if (value.texture && !scene.textures.find(value.texture)) return missing(value.texture);
    if (value.material && !scene.materials.find(value.material)) return missing(value.material);
    for (const float x : value.v)
        if (!std::isfinite(x))
            return fail("parameter \"" + std::string(param) + "\": the value is not a finite number");
    const T* item = table<T>(scene).find(id);
    return modify(scene, id, (item ? item->name + ": " : std::string()) + std::string(param), [&](T& t) {
        t.params.set(param, std::move(value));
        forget_edited(t.origin, param);
    });
}

} // namespace

void forget_edited(Origin& origin, std::string_view param) {
    std::erase_if(origin.values, [&](const OriginValue& v) { return param == "*" || v.id == "*" || v.id == param; });
}

Result<Edit> set_param(const Scene& scene, Id<Material> id, std::string_view param, Value value) {
    return set_param_of(scene, id, param, std::move(value));
}

Result<Edit> set_param(const Scene& scene, Id<Texture> id, std::string_view param, Value value) {
    const Texture* operand = scene.textures.find(value.texture);
    if (operand && contains(scene, value.texture, id))
        return fail("texture \"" + operand->name + "\" would contain itself");
    return set_param_of(scene, id, param, std::move(value));
}

Result<Edit> set_params(const Scene& scene, Id<Material> id, std::span<const std::pair<std::string, Value>> values,
                        std::string label) {
    return modify(scene, id, std::move(label), [&](Material& m) {
        for (const auto& [param, value] : values) {
            m.params.set(param, value);
            forget_edited(m.origin, param);
        }
    });
}

Result<Edit> reset_param(const Scene& scene, Id<Material> id, std::string_view param) {
    return modify(scene, id, "Reset " + std::string(param), [&](Material& m) {
        m.params.remove(param);
        forget_edited(m.origin, param);
    });
}

Result<Edit> set_material_type(const Scene& scene, Id<Material> id, std::string type) {
    return modify(scene, id, "Material type " + type, [&](Material& m) {
        m.type = std::move(type);
        forget_edited(m.origin, "*");
    });
}

Result<Edit> set_light(const Scene& scene, Id<Light> id, Light light, std::string label) {
    return modify(scene, id, std::move(label), [&](Light& l) { l = std::move(light); });
}

Result<Edit> set_camera(const Scene& scene, Id<Camera> id, Camera camera, std::string label) {
    return modify(scene, id, std::move(label), [&](Camera& c) { c = std::move(camera); });
}

Result<Edit> set_active_camera(const Scene& scene, Id<Camera> id) {
    if (!scene.cameras.find(id)) return missing(id);
    Edit edit{"Look through " + scene.cameras[id].name, {}};
    edit.changes.push_back(ChangeOne<Id<Camera>>{scene.active_camera.value, id});
    return edit;
}

Edit set_environment(const Scene& scene, std::optional<Environment> environment, std::string label) {
    Edit edit{std::move(label), {}};
    const auto& now = scene.environment.value;
    if (now && !now->sky.empty() && (!environment || environment->image != now->image)) {
        // With another image it is no longer the plugin's; the old image becomes unused.
        if (environment && environment->sky == now->sky) environment->sky.clear(), environment->sky_params = {};
        if (const Image* image = scene.images.find(now->image); image && users(scene, now->image).size() == 1)
            edit.changes.push_back(Change<Image>{now->image, *image, std::nullopt});
    }
    edit.changes.push_back(ChangeOne<std::optional<Environment>>{now, std::move(environment)});
    return edit;
}

Edit set_film(const Scene& scene, Film film, std::string label) {
    Edit edit{std::move(label), {}};
    edit.changes.push_back(ChangeOne<Film>{scene.film.value, std::move(film)});
    return edit;
}

Edit set_settings(const Scene& scene, Settings settings, std::string label) {
    Edit edit{std::move(label), {}};
    edit.changes.push_back(ChangeOne<Settings>{scene.settings.value, std::move(settings)});
    return edit;
}

} // namespace restage::scene
