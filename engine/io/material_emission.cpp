// SPDX-License-Identifier: Apache-2.0
#include "io/material_emission.hpp"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>

namespace restage::io {

using namespace scene;

MaterialEmissions::MaterialEmissions(const plugin::Registry& registry, const Scene& scene)
    : scene_(scene), types_(registry.materials()) {
    std::erase_if(types_, [](const plugin::MaterialEntry& e) { return !e.table->emission; });
}

std::optional<MaterialEmission> MaterialEmissions::of(Id<Material> id) const {
    const Material* material = scene_.materials.find(id);
    if (!material) return std::nullopt;
    for (const auto& type : types_)
        if (material->type == type.table->type) return emission_of(*type.table, material->params);
    return std::nullopt;
}

namespace {

glm::vec3 mean_of(const PixelData& pixels) {
    glm::dvec3 sum(0);
    const std::size_t blue = pixels.channels < 3 ? 0 : 2;
    for (std::size_t at = 0; at + pixels.channels <= pixels.values.size(); at += pixels.channels)
        for (std::size_t c = 0; c < 3; ++c)
            if (const float v = pixels.values[at + std::min(c, blue)]; std::isfinite(v))
                sum[int(c)] += std::max(v, 0.f);
    return glm::vec3(sum * double(pixels.channels) / double(std::max<std::size_t>(pixels.values.size(), 1)));
}

glm::vec3 mean_of(const Scene& scene, Id<Texture> id, int depth) {
    const Texture* t = scene.textures.find(id);
    if (!t || depth > 16) return glm::vec3(1);
    const auto operand = [&](const char* param, float otherwise) {
        const Value* v = t->params.find(param);
        if (v && v->texture) return mean_of(scene, v->texture, depth + 1);
        if (v && v->type == model::ParamType::color) return glm::vec3(v->v[0], v->v[1], v->v[2]);
        return glm::vec3(v ? v->scalar() : otherwise);
    };
    if (t->type == "constant") return operand("value", 1);
    if (t->type == "scale") return operand("tex", 1) * operand("scale", 1);
    if (t->type == "mix") return glm::mix(operand("tex1", 0), operand("tex2", 1), operand("amount", 0.5f));
    if (t->type == "checkerboard") return 0.5f * (operand("tex1", 1) + operand("tex2", 0));
    const Image* image = scene.images.find(t->image);
    return image && image->data ? mean_of(*image->data) * operand("scale", 1) : operand("average", 0.5f);
}

} // namespace

glm::vec3 mean_of(const Scene& scene, Id<Texture> id) { return mean_of(scene, id, 0); }

} // namespace restage::io
