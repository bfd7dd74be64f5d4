// SPDX-License-Identifier: Apache-2.0
// TextureSource: the host's copy of one texture type, like MaterialSource for a material. Its native evaluation is
// code in the plugin's library, which stays open while the source of a TextureEntry has holders.
#pragma once

#include "model/texture.hpp"
#include "plugin/material_source.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

struct RestageTextureAt1;

namespace restage::plugin {

using TextureEval = void (*)(const RestageTextureAt1* at, float rgb[3]);

// Input of a native evaluation; see RestageTextureAt1.
struct TextureCall {
    float uv[2]{};
    const float* values = nullptr;
    const std::int32_t* whole = nullptr;
    const void* image = nullptr; // argument of look_up()
    void (*look_up)(const void* image, float s, float t, int wrap, float rgba[4]) = nullptr;
};

class TextureSource {
  public:
    // `texture` must have passed check_texture. `native`: null if it has none.
    TextureSource(model::Texture texture, std::filesystem::path folder, std::shared_ptr<const FileTexts> glsl,
                  TextureEval native = nullptr);
    TextureSource(const TextureSource&) = delete;

    const model::Texture& texture() const { return texture_; } // valid as long as this
    const std::filesystem::path& folder() const { return folder_; }
    const std::shared_ptr<const FileTexts>& glsl() const { return glsl_; }
    TextureEval eval() const { return eval_; }
    void evaluate(const TextureCall&, float rgb[3]) const; // [any] only if there is eval()
    // Equal numbers mean equal declarations and equal GLSL.
    std::uint64_t revision() const { return revision_; }

  private:
    model::Texture texture_;
    std::filesystem::path folder_;
    std::shared_ptr<const FileTexts> glsl_;
    TextureEval eval_ = nullptr;
    std::uint64_t revision_ = 0;
};

// The "textures" of a manifest's text; empty if it has none. Errors: 'plugin.json: "textures"[0]."params"[1]: ...'
Result<std::vector<model::Texture>> parse_textures(const std::string& text, const std::string& file);

} // namespace restage::plugin
