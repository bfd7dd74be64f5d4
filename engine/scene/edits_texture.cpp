// SPDX-License-Identifier: Apache-2.0
#include "scene/edits_texture.hpp"

#include <algorithm>
#include <vector>

namespace restage::scene {

namespace {

std::string texture_name(const Scene& scene, const std::string& name) {
    std::set<std::string> taken;
    scene.textures.each([&](auto, const Texture& t) { taken.insert(t.name); });
    return taken.contains(name) ? next_name(name, taken) : name;
}

// Appends the change that puts `value` into the slot.
Result<> fill(const Scene& scene, const TextureSlot& slot, Value value, Edit& edit) {
    return std::visit(
        [&]<class T>(Id<T> id) -> Result<> {
            const T* before = table<T>(scene).find(id);
            if (!before)
                return fail("there is no " + std::string(kind_name<T>) + " with id " + std::to_string(id.value));
            T after = *before;
            after.params.set(slot.param, std::move(value));
            forget_edited(after.origin, slot.param);
            edit.changes.push_back(Change<T>{id, *before, std::move(after)});
            return {};
        },
        slot.of);
}

// An image of the same file and encoding, else this one, which is appended to the edit.
Id<Image> shared_image(const Scene& scene, Image image, Edit& edit) {
    Id<Image> id;
    scene.images.each([&](Id<Image> other, const Image& i) {
        if (!id && !image.path.empty() && i.path == image.path && i.encoding == image.encoding && i.data) id = other;
    });
    if (id) return id;
    id = scene.images.next();
    edit.changes.push_back(Change<Image>{id, std::nullopt, std::move(image)});
    return id;
}

bool is_operand(const model::Param& line) { return line.texturable; }

// Converted to the line's type: a number becomes grey, a colour becomes its first component.
Value fitted(Value value, const model::Param& line) {
    if (line.type == ParamType::color && value.type == ParamType::number) value.v[1] = value.v[2] = value.v[0];
    value.type = line.type;
    for (float& x : value.v)
        x = std::clamp(x, line.min, line.max);
    return value;
}

} // namespace

bool contains(const Scene& scene, Id<Texture> from, Id<Texture> to) {
    std::vector<Id<Texture>> open{from};
    std::set<std::uint32_t> seen;
    while (!open.empty()) {
        const Id<Texture> id = open.back();
        open.pop_back();
        if (id == to) return true;
        const Texture* t = scene.textures.find(id);
        if (!t || !seen.insert(id.value).second) continue;
        for (const auto& entry : t->params.entries())
            if (entry.value.texture) open.push_back(entry.value.texture);
    }
    return false;
}

Result<Edit> new_texture(const Scene& scene, const TextureSlot& slot, const model::Texture& table) {
    Texture made{.name = texture_name(scene, table.label), .type = table.type, .is_float = slot.scalar};
    const Texture* old = scene.textures.find(slot.value.texture);
    if (old && table.image) made.image = old->image;
    const auto first = std::find_if(table.params.begin(), table.params.end(), is_operand);
    if (first != table.params.end() && (old ? old->is_float == slot.scalar : slot.value.type != ParamType::texture))
        made.params.set(first->id, fitted(slot.value, *first));
    Edit edit{"New " + table.label + " for " + slot.param, {}};
    Value value = slot.value;
    value.texture = scene.textures.next();
    edit.changes.push_back(Change<Texture>{value.texture, std::nullopt, std::move(made)});
    RESTAGE_CHECK(fill(scene, slot, std::move(value), edit));
    return edit;
}

Result<Edit> set_image_texture(const Scene& scene, const TextureSlot& slot, Image image) {
    Edit edit{"Image for " + slot.param, {}};
    std::visit(
        [&]<class T>(Id<T> id) {
            if (const T* item = table<T>(scene).find(id)) edit.label = item->name + ": image for " + slot.param;
        },
        slot.of);
    const std::string name = image.name;
    const std::size_t before = edit.changes.size();
    const Id<Image> image_id = shared_image(scene, std::move(image), edit);
    Id<Texture> texture;
    if (edit.changes.size() == before)
        scene.textures.each([&](Id<Texture> other, const Texture& t) {
            if (!texture && t.type == "imagemap" && t.image == image_id && t.is_float == slot.scalar &&
                t.params.entries().empty())
                texture = other;
        });
    if (!texture) {
        texture = scene.textures.next();
        edit.changes.push_back(Change<Texture>{
            texture, std::nullopt,
            Texture{
                .name = texture_name(scene, name), .type = "imagemap", .is_float = slot.scalar, .image = image_id}});
    }
    Value value = slot.value;
    value.texture = texture;
    RESTAGE_CHECK(fill(scene, slot, std::move(value), edit));
    return edit;
}

Result<Edit> set_image_texture(const Scene& scene, Id<Material> id, std::string_view param, model::ParamType type,
                               bool scalar, Image image) {
    const Material* material = scene.materials.find(id);
    const Value* before = material ? material->params.find(param) : nullptr;
    return set_image_texture(scene,
                             {.of = id,
                              .param = std::string(param),
                              .value = before && before->type == type ? *before : Value{.type = type},
                              .scalar = scalar},
                             std::move(image));
}

Result<Edit> set_image(const Scene& scene, Id<Texture> id, Image image) {
    const Texture* texture = scene.textures.find(id);
    if (!texture) return fail("there is no texture with id " + std::to_string(id.value));
    Edit edit{texture->name + ": image", {}};
    Texture after = *texture;
    after.image = shared_image(scene, std::move(image), edit);
    forget_edited(after.origin, "*");
    edit.changes.push_back(Change<Texture>{id, *texture, std::move(after)});
    return edit;
}

Result<Edit> switch_texture_type(const Scene& scene, Id<Texture> id, const model::Texture* before,
                                 const model::Texture& after) {
    const Texture* old = scene.textures.find(id);
    if (!old) return fail("there is no texture with id " + std::to_string(id.value));
    ParamSet params;
    for (const auto& [name, value] : old->params.entries()) {
        const model::Param* line = after.find(name);
        if (!line && after.mapped) line = model::find_param(model::mapping_params(), name);
        if (line && misfit(*line, value).empty()) params.set(name, value);
    }
    std::vector<const model::Param*> operands; // of the old type
    for (const model::Param& line : before ? model::ParamTable(before->params) : model::ParamTable())
        if (line.texturable) operands.push_back(&line);
    std::size_t next = 0;
    for (const model::Param& line : after.params) {
        if (!line.texturable) continue;
        const model::Param* from = next < operands.size() ? operands[next++] : nullptr;
        const Value* set = from ? old->params.find(from->id) : nullptr;
        if (set && set->type == line.type && !params.find(line.id)) params.set(line.id, fitted(*set, line));
    }
    return modify(scene, id, old->name + ": type " + after.type, [&](Texture& t) {
        t.type = after.type;
        if (!after.image) t.image = {};
        t.params = std::move(params);
        forget_edited(t.origin, "*");
    });
}

Result<Edit> reset_param(const Scene& scene, Id<Texture> id, std::string_view param) {
    return modify(scene, id, "Reset " + std::string(param), [&](Texture& t) {
        t.params.remove(param);
        forget_edited(t.origin, param);
    });
}

} // namespace restage::scene
