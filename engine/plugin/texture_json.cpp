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
    RESTAGE_CHECK(json_shader(object, flag_words, where, t));
    return t;
}

} // namespace

Result<std::vector<model::Texture>> parse_textures(const std::string& text, const std::string& file) {
    return json_tables<model::Texture>(text, file, "textures", texture);
}

} // namespace restage::plugin
