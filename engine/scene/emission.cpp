// SPDX-License-Identifier: Apache-2.0
#include "scene/emission.hpp"

#include <glm/glm.hpp>

#include <cmath>

namespace restage::scene {

std::optional<MaterialEmission> emission_of(const RestageMaterial1& table, const RestageEmission1& names,
                                            const ParamSet& params) {
    const auto value = [&](const char* id) { // what is set, else the table's default
        if (const Value* set = params.find(id)) return *set;
        for (std::uint32_t i = 0; i < table.param_count; ++i)
            if (std::string_view(table.params[i].id) == id) return default_value(table.params[i]);
        return Value{};
    };
    const Value color = value(names.radiance);
    MaterialEmission out{.radiance = glm::vec3(1), .texture = color.texture};
    for (int i = 0; i < 3 && !color.texture; ++i) // a number where a colour is asked for is a grey
        out.radiance[i] = color.v[color.type == RESTAGE_FLOAT ? 0 : std::size_t(i)];
    if (names.scale) out.radiance *= value(names.scale).v[0];
    if (names.two_sided) out.two_sided = value(names.two_sided).v[0] != 0;
    for (int i = 0; i < 3; ++i)
        if (!std::isfinite(out.radiance[i]) || out.radiance[i] < 0) return std::nullopt;
    if (out.radiance == glm::vec3(0)) return std::nullopt;
    return out;
}

} // namespace restage::scene
