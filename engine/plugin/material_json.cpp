// SPDX-License-Identifier: Apache-2.0
// Material tables written as JSON: the lines of RestageMaterial1 and RestageParam, by name. check_material validates
// them, like tables from a library.
#include "plugin/material_source.hpp"
#include "plugin/param_json.hpp"

#include <utility>

namespace restage::plugin {

using nlohmann::json;

namespace {

constexpr Word<bool model::Material::*> flag_words[] = {{"stochastic", &model::Material::stochastic},
                                                        {"lossless", &model::Material::lossless},
                                                        {"transmissive", &model::Material::transmissive},
                                                        {"nonreciprocal", &model::Material::nonreciprocal},
                                                        {"tangent", &model::Material::tangent},
                                                        {"additive", &model::Material::additive},
                                                        {"site", &model::Material::site}};

Result<model::Emission> emission(const json& object, const std::string& where) {
    RESTAGE_CHECK(know(object, {"radiance", "scale", "two_sided"}, where));
    model::Emission e;
    RESTAGE_TRY(e.radiance, json_text(object, "radiance", nullptr, where));
    RESTAGE_TRY(e.scale, json_text(object, "scale", "", where));
    RESTAGE_TRY(e.two_sided, json_text(object, "two_sided", "", where));
    return e;
}

Result<model::Material> material(const json& object, const std::string& where) {
    RESTAGE_CHECK(know(object, {"type", "label", "prefix", "glsl", "flags", "tooltip", "params", "emission"}, where));
    model::Material m;
    RESTAGE_CHECK(json_shader(object, flag_words, where, m));
    if (const auto it = object.find("emission"); it != object.end()) {
        RESTAGE_TRY(m.emission, emission(*it, where + ".\"emission\""));
    }
    return m;
}

} // namespace

Result<std::vector<model::Material>> parse_materials(const std::string& text, const std::string& file) {
    return json_tables<model::Material>(text, file, "materials", material);
}

} // namespace restage::plugin
