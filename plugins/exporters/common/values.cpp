// SPDX-License-Identifier: Apache-2.0
#include "common/values.hpp"

#include <algorithm>
#include <cmath>

namespace restage::exporters {

const RestageValue* Values::find(std::string_view id) const {
    for (std::uint32_t i = 0; i < count_; ++i)
        if (const RestageValue& v = RESTAGE_AT(RestageValue, values_, i); v.id == id) return &v;
    return nullptr;
}

int Values::integer(std::string_view id, int otherwise) const {
    const RestageValue* v = find(id);
    return v ? v->i : otherwise;
}

float Values::number(std::string_view id, float otherwise) const {
    const RestageValue* v = find(id);
    if (!v) return otherwise;
    return v->type == RESTAGE_INT || v->type == RESTAGE_BOOL ? static_cast<float>(v->i) : v->v[0];
}

std::string Values::choice(std::string_view id, const char* otherwise) const {
    const RestageValue* v = find(id);
    return v && v->text ? v->text : otherwise;
}

std::array<float, 3> Values::color(std::string_view id, std::array<float, 3> otherwise) const {
    const RestageValue* v = find(id);
    if (!v) return otherwise;
    if (v->type == RESTAGE_FLOAT) return {v->v[0], v->v[0], v->v[0]};
    return {v->v[0], v->v[1], v->v[2]};
}

RestageHandle Values::ref(std::string_view id) const {
    const RestageValue* v = find(id);
    return v ? v->ref : 0;
}

std::array<float, 3> average(const RestageSceneReader1& in, RestageHandle handle, int depth) {
    RestageTexture t{};
    std::array<float, 3> grey{0.5f, 0.5f, 0.5f};
    if (depth > 16 || !in.texture(in.ctx, handle, &t)) return grey;
    const Values values(t.values, t.value_count);
    const auto part = [&](const char* id, float otherwise) {
        return values.ref(id) ? average(in, values.ref(id), depth + 1)
                              : values.color(id, {otherwise, otherwise, otherwise});
    };
    const std::string type = t.type;
    if (type == "constant") return part("value", 1);
    if (type == "scale") {
        const auto a = part("tex", 1), b = part("scale", 1);
        return {a[0] * b[0], a[1] * b[1], a[2] * b[2]};
    }
    if (type == "mix" || type == "checkerboard" || type == "checkerboard3d") {
        const bool mix = type == "mix";
        const auto a = part("tex1", mix ? 0.f : 1.f), b = part("tex2", mix ? 1.f : 0.f);
        const float w = mix && !values.ref("amount") ? values.number("amount", 0.5f) : 0.5f;
        return {a[0] + w * (b[0] - a[0]), a[1] + w * (b[1] - a[1]), a[2] + w * (b[2] - a[2])};
    }
    if (type == "bilerp") {
        std::array<float, 3> sum{};
        for (const auto& corner : {part("v00", 0), part("v01", 1), part("v10", 0), part("v11", 1)})
            for (std::size_t k = 0; k < 3; ++k)
                sum[k] += corner[k] / 4;
        return sum;
    }
    if (const RestageValue* known = values.find("average")) return {known->v[0], known->v[1], known->v[2]};
    if (type == "dots") return part("inside", 1);
    if (type == "marble") return {0.52f, 0.52f, 0.56f}; // of its nine colours
    return grey; // an imagemap's mean is unknown here
}

double alpha_of_roughness(double roughness, std::string_view remap) {
    if (remap == "none") return roughness;
    if (remap != "v3") return std::sqrt(roughness);
    const double x = std::log(std::max(roughness, 1e-3));
    return 1.62142 + 0.819955 * x + 0.1734 * x * x + 0.0171201 * x * x * x + 0.000640711 * x * x * x * x;
}

} // namespace restage::exporters
