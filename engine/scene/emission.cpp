// SPDX-License-Identifier: Apache-2.0
#include "scene/emission.hpp"

#include <glm/glm.hpp>

#include <cmath>

namespace restage::scene {

std::optional<MaterialEmission> emission_of(const model::Material& declared, const ParamSet& params) {
    if (!declared.emission) return std::nullopt;
    const model::Emission& names = *declared.emission;
    const auto value = [&](const std::string& id) { // the set value, else the table's default
        if (const Value* set = params.find(id)) return *set;
        const model::Param* line = declared.find(id);
        return line ? default_value(*line) : Value{};
    };
    const Value color = value(names.radiance);
    MaterialEmission out{.radiance = glm::vec3(1), .texture = color.texture};
    for (int i = 0; i < 3 && !color.texture; ++i) // a number used as a colour is grey
        out.radiance[i] = color.type == ParamType::color ? color.v[std::size_t(i)] : color.scalar();
    if (!names.scale.empty()) out.radiance *= value(names.scale).scalar();
    if (!names.two_sided.empty()) out.two_sided = value(names.two_sided).whole() != 0;
    for (int i = 0; i < 3; ++i)
        if (!std::isfinite(out.radiance[i]) || out.radiance[i] < 0) return std::nullopt;
    if (out.radiance == glm::vec3(0)) return std::nullopt;
    return out;
}

} // namespace restage::scene
