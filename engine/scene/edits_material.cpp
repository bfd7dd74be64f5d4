// SPDX-License-Identifier: Apache-2.0
// Edit builders for materials: change type, make unique. Images for parameters: edits_texture.cpp.
#include "scene/edits.hpp"

#include <algorithm>

namespace restage::scene {

namespace {

const model::Param* main_color(ParamTable table) {
    const auto found = std::find_if(table.begin(), table.end(), [](const model::Param& p) {
        return p.type == model::ParamType::color && p.max == 1;
    });
    return found == table.end() ? nullptr : &*found;
}

bool is_roughness(const model::Param& p) {
    return p.type == model::ParamType::number && p.max == 1 && p.id.ends_with("roughness");
}

// The value converted to fit the table line; nullopt if impossible.
std::optional<Value> fitted(Value value, const model::Param& line) {
    const auto type = line.type;
    if (value.texture && !line.texturable && type != model::ParamType::texture) return {};
    if (value.type != type) return {};
    if (type == model::ParamType::choice && !line.choice_index(value.text)) return {};
    if (type == model::ParamType::integer) value.i = std::clamp(value.i, line.int_min, line.int_max);
    if (type == model::ParamType::number || type == model::ParamType::color)
        for (float& x : value.v)
            x = std::clamp(x, line.min, line.max);
    return value;
}

} // namespace

Result<Edit> switch_material_type(const Scene& scene, Id<Material> id, std::string type, ParamTable before,
                                  ParamTable after) {
    const Material* old = scene.materials.find(id);
    if (!old) return fail("there is no material with id " + std::to_string(id.value));
    const auto held = [&](const model::Param& line) { // the old type's effective value
        const Value* set = old->params.find(line.id);
        return set ? *set : default_value(line);
    };
    ParamSet params = old->params; // ids in neither table are kept
    for (const model::Param& line : after) {
        const Value* set = params.find(line.id);
        if (!set) continue;
        if (const auto value = fitted(*set, line))
            params.set(line.id, *value);
        else
            params.remove(line.id);
    }
    const auto carry = [&](const model::Param* from, const model::Param& to) {
        if (!from || params.find(to.id) || find_param(before, to.id)) return;
        if (const auto value = fitted(held(*from), to)) params.set(to.id, *value);
    };
    if (const model::Param* color = main_color(after)) carry(main_color(before), *color);
    const auto rough = std::find_if(before.begin(), before.end(), is_roughness);
    for (const model::Param& line : after)
        if (is_roughness(line)) carry(rough == before.end() ? nullptr : &*rough, line);
    return modify(scene, id, old->name + ": type " + type, [&](Material& m) {
        m.type = std::move(type);
        m.params = std::move(params);
        forget_edited(m.origin, "*");
    });
}

Result<MadeUnique> make_unique(const Scene& scene, std::span<const Id<Instance>> ids, Id<Material> material) {
    const Material* shared = scene.materials.find(material);
    if (!shared) return fail("there is no material with id " + std::to_string(material.value));
    std::vector<Id<Instance>> users;
    for (const Id<Instance> id : ids)
        if (const Instance* instance = scene.instances.find(id); instance && instance->material == material)
            users.push_back(id);
    if (users.empty()) return fail("none of these objects has the material \"" + shared->name + "\"");
    std::set<std::string> taken;
    scene.materials.each([&](auto, const Material& m) { taken.insert(m.name); });
    Material copy = *shared;
    copy.name = next_name(copy.name, taken);
    MadeUnique made{insert(scene, std::move(copy), "Make " + shared->name + " unique"), scene.materials.next()};
    for (const Id<Instance> id : users) {
        Instance after = scene.instances[id];
        after.material = made.material;
        made.edit.changes.push_back(Change<Instance>{id, scene.instances[id], std::move(after)});
    }
    return made;
}

} // namespace restage::scene
