// SPDX-License-Identifier: Apache-2.0
#include "scene/texture_map.hpp"

#include "model/texture.hpp"
#include "scene/edits_texture.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace restage::scene {

namespace {

// Its picture is the same after a shift by 2.
bool repeats(const Texture& texture) {
    if (texture.type == "checkerboard") return true;
    const Value* wrap = texture.params.find("wrap");
    return texture.type == "imagemap" && (!wrap || wrap->text == "repeat");
}

Result<> put(Texture& texture, TextureMap map) {
    const auto& lines = model::mapping_params();
    const double most = double(model::find_param(lines, "udelta")->max);
    for (int i = 0; i < 2; ++i)
        if (std::abs(map.shift[i]) > most && repeats(texture)) map.shift[i] -= 2 * std::round(map.shift[i] / 2);
    double largest = 0;
    for (int i = 0; i < 4; ++i)
        largest = std::max(largest, std::abs(map.linear[i / 2][i % 2]));
    for (int i = 0; i < 4; ++i) // the sine of half a turn
        if (std::abs(map.linear[i / 2][i % 2]) < 1e-7 * largest) map.linear[i / 2][i % 2] = 0;
    const std::pair<const char*, double> values[] = {{"uscale", map.linear[0][0]}, {"vshear", map.linear[0][1]},
                                                     {"ushear", map.linear[1][0]}, {"vscale", map.linear[1][1]},
                                                     {"udelta", map.shift[0]},     {"vdelta", map.shift[1]}};
    for (const auto& [id, value] : values) {
        const model::Param& line = *model::find_param(lines, id);
        if (!(value >= double(line.min) && value <= double(line.max)))
            return fail("texture \"" + texture.name + "\": " + line.label + " cannot be " + std::to_string(value));
        forget_edited(texture.origin, id);
        if (float(value) == line.def[0])
            texture.params.remove(id);
        else
            texture.params.set(id, Value::number(float(value)));
    }
    return {};
}

bool reaches(const Scene& scene, Id<Texture> from, std::span<const Id<Texture>> to) {
    return std::ranges::any_of(to, [&](Id<Texture> one) { return contains(scene, from, one); });
}

bool reaches(const Scene& scene, const ParamSet& params, std::span<const Id<Texture>> to) {
    return std::ranges::any_of(params.entries(), [&](const auto& entry) {
        return entry.value.texture && reaches(scene, entry.value.texture, to);
    });
}

} // namespace

TextureMap texture_map(const ParamSet& p) {
    TextureMap map;
    map.linear[0] = {double(p.number("uscale", 1)), double(p.number("vshear", 0))};
    map.linear[1] = {double(p.number("ushear", 0)), double(p.number("vscale", 1))};
    map.shift = {double(p.number("udelta", 0)), double(p.number("vdelta", 0))};
    const Value* set = p.find("uvset");
    map.set = set && set->i == 1 ? 1 : 0;
    return map;
}

TextureMap moved(const TextureMap& map, const glm::dvec2& from, const glm::dvec2& to) {
    TextureMap after = map;
    after.shift += map.linear * (from - to);
    return after;
}

TextureMap transformed(const TextureMap& map, const glm::dmat2& by, const glm::dvec2& about) {
    TextureMap after = map;
    after.linear = map.linear * glm::inverse(by);
    after.shift = map(about) - after.linear * about;
    return after;
}

TextureMap stretched(const TextureMap& map, const glm::dvec2& factor, const glm::dvec2& about) {
    TextureMap after = map;
    for (int column = 0; column < 2; ++column)
        after.linear[column] = map.linear[column] / factor;
    after.shift = map(about) - after.linear * about;
    return after;
}

double turn_of(const TextureMap& map) {
    const double sign =
        glm::determinant(map.linear) < 0 ? -1 : 1; // the first column of the inverse, but for its length
    return glm::degrees(std::atan2(-sign * map.linear[0][1], sign * map.linear[1][1]));
}

Result<Edit> set_texture_maps(const Scene& scene, std::span<const std::pair<Id<Texture>, TextureMap>> maps,
                              std::string label) {
    Edit edit{std::move(label), {}};
    for (const auto& [id, map] : maps) {
        const Texture* before = scene.textures.find(id);
        if (!before) return fail("there is no texture with id " + std::to_string(id.value));
        Texture after = *before;
        RESTAGE_CHECK(put(after, map));
        edit.changes.push_back(Change<Texture>{id, *before, std::move(after)});
    }
    return edit;
}

std::vector<Id<Texture>> textures_of(const Scene& scene, const Material& material) {
    std::vector<Id<Texture>> found;
    const auto add = [&](const auto& self, const ParamSet& params) -> void {
        for (const auto& entry : params.entries()) {
            const Id<Texture> id = entry.value.texture;
            const Texture* texture = scene.textures.find(id);
            if (!texture || std::ranges::find(found, id) != found.end()) continue;
            found.push_back(id);
            self(self, texture->params);
        }
    };
    add(add, material.params);
    return found;
}

Result<OwnTextures> own_textures(const Scene& scene, std::span<const Id<Instance>> objects, Id<Material> material,
                                 std::span<const Id<Texture>> textures) {
    OwnTextures own{{}, material, {}};
    const std::set<Id<Instance>> mine(objects.begin(), objects.end());
    bool shared = false, has = false;
    scene.instances.each([&](Id<Instance> id, const Instance& instance) {
        if (instance.material == material) (mine.contains(id) ? has : shared) = true;
    });
    if (!has) return fail("none of these objects has the material");
    if (shared) {
        RESTAGE_TRY(MadeUnique unique, make_unique(scene, objects, material));
        own.edit = std::move(unique.edit);
        own.material = unique.material;
    }
    // Copies of what leads to the textures, if another material uses it: then that one, too, has them.
    std::set<Id<Texture>> elsewhere;
    scene.materials.each([&](Id<Material> id, const Material& m) {
        if (id != material || shared)
            for (const Id<Texture> texture : textures_of(scene, m))
                elsewhere.insert(texture);
    });
    std::set<std::string> names;
    scene.textures.each([&](auto, const Texture& t) { names.insert(t.name); });
    std::uint32_t next = scene.textures.next().value;
    const Material& original = scene.materials[material];
    for (const Id<Texture> id : textures_of(scene, original))
        if (elsewhere.contains(id) && reaches(scene, id, textures)) own.copies[id] = {next++};
    const auto with_copies = [&](ParamSet params) {
        params.each_value([&](Value& value) {
            if (const auto copy = own.copies.find(value.texture); copy != own.copies.end())
                value.texture = copy->second;
        });
        return params;
    };
    std::vector<std::pair<Id<Texture>, Id<Texture>>> in_order(own.copies.begin(), own.copies.end());
    std::ranges::sort(in_order, {}, [](const auto& one) { return one.second.value; });
    for (const auto& [id, copy] : in_order) {
        Texture made = scene.textures[id];
        made.name = next_name(made.name, names);
        made.params = with_copies(std::move(made.params));
        own.edit.changes.push_back(Change<Texture>{copy, std::nullopt, std::move(made)});
    }
    if (!own.copies.empty()) {
        const auto change = std::ranges::find_if(
            own.edit.changes, [](const auto& c) { return std::holds_alternative<Change<Material>>(c); });
        if (change != own.edit.changes.end()) { // the copy
            Material& made = *std::get<Change<Material>>(*change).after;
            made.params = with_copies(std::move(made.params));
        } else {
            Material after = original;
            after.params = with_copies(std::move(after.params));
            own.edit.changes.push_back(Change<Material>{material, original, std::move(after)});
        }
        // Textures of the same material that are its own and lead to copies.
        for (const Id<Texture> id : textures_of(scene, original)) {
            if (own.copies.contains(id)) continue;
            Texture after = scene.textures[id];
            after.params = with_copies(std::move(after.params));
            if (!(after == scene.textures[id]))
                own.edit.changes.push_back(Change<Texture>{id, scene.textures[id], std::move(after)});
        }
    }
    own.edit.label = "Own texture for " + scene.instances[objects.back()].name;
    return own;
}

TextureUsers users_of(const Scene& scene, std::span<const Id<Texture>> textures) {
    TextureUsers users;
    std::set<Id<Material>> materials;
    scene.materials.each([&](Id<Material> id, const Material& m) {
        if (reaches(scene, m.params, textures)) materials.insert(id);
    });
    users.materials = materials.size();
    scene.instances.each([&](auto, const Instance& i) { users.objects += materials.contains(i.material); });
    return users;
}

} // namespace restage::scene
