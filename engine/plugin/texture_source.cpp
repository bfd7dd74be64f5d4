// SPDX-License-Identifier: Apache-2.0
#include "plugin/texture_source.hpp"

#include "plugin/table_digest.hpp"

#include <restage/texture.h>

namespace restage::plugin {

namespace {

void look_up(const RestageTextureAt1* at, float s, float t, int32_t wrap, float rgba[4]) {
    const auto& call = *static_cast<const TextureCall*>(at->host);
    call.look_up(call.image, s, t, wrap, rgba);
}

} // namespace

void TextureSource::evaluate(const TextureCall& call, float rgb[3]) const {
    RestageTextureAt1 at{};
    at.uv[0] = call.uv[0], at.uv[1] = call.uv[1];
    at.values = call.values;
    at.whole = call.whole;
    at.host = &call;
    at.image = call.look_up ? look_up : nullptr;
    eval_(&at, rgb);
}

TextureSource::TextureSource(model::Texture texture, std::filesystem::path folder,
                             std::shared_ptr<const FileTexts> glsl, TextureEval native)
    : texture_(std::move(texture)), folder_(std::move(folder)), glsl_(std::move(glsl)), eval_(native) {
    Digest digest;
    for (const std::string& text :
         {texture_.type, texture_.label, texture_.prefix, texture_.glsl_file, texture_.tooltip})
        digest.text(text);
    for (const bool flag : {texture_.image, texture_.mapped, texture_.site})
        digest.number(flag);
    for (const model::Param& p : texture_.params)
        digest.param(p);
    digest.files(*glsl_, folder_);
    revision_ = digest.value();
}

} // namespace restage::plugin
