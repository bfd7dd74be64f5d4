// SPDX-License-Identifier: Apache-2.0
// Texture tables written as JSON: the members of RestageTexture1 and RestageParam, by name.
#include "plugin/param_json.hpp"
#include "plugin/texture_source.hpp"

namespace restage::plugin {

using nlohmann::json;

namespace {

constexpr Word<bool model::Texture::*> flag_words[] = {
    {"image", &model::Texture::image}, {"mapped", &model::Texture::mapped}, {"site", &model::Texture::site}};

Result<model::Texture> texture(const json& object, const std::string& where) {
    RESTAGE_CHECK(know(object, {"type", "label", "prefix", "glsl", "flags", "tooltip", "params"}, where));
    model::Texture t;
    RESTAGE_TRY(t.type, json_text(object, "type", nullptr, where));
    RESTAGE_TRY(t.label, json_text(object, "label", t.type.c_str(), where));
    RESTAGE_TRY(t.prefix, json_text(object, "prefix", t.type.c_str(), where));
    RESTAGE_TRY(t.glsl_file, json_text(object, "glsl", nullptr, where));
    RESTAGE_CHECK(json_flags(object, flag_words, where, t));
    RESTAGE_TRY(t.tooltip, json_text(object, "tooltip", "", where));
    RESTAGE_TRY(t.params, json_params(object, where));
    return t;
}

} // namespace

Result<std::vector<model::Texture>> parse_textures(const std::string& text, const std::string& file) {
    return json_tables<model::Texture>(text, file, "textures", texture);
}

} // namespace restage::plugin
