// SPDX-License-Identifier: Apache-2.0
// Textures of the scene as postfix programs (shaders/lib/texture.glsl), and the same evaluation in C++ for what the CPU
// resolves while Embree visits a hit: cut-outs and mixes.
#pragma once

#include "scene/scene.hpp"
#include "shared/scene_data.h"

#include <vector>

namespace restage::render {

// Programs are indexed by Id<Texture>::value; 0 is empty. Images are indexed by Id<Image>::value.
struct TexturePrograms {
    std::vector<shared::TextureProgram> programs;
    std::vector<shared::TextureOp> ops;
};

// Texture types that the engine does not evaluate shade as their `average`; graphs deeper than the stack of three, too.
TexturePrograms compile_textures(const scene::Scene&);

// Pixels as the CPU reads them.
struct CpuImage {
    const scene::PixelData* pixels = nullptr;
};

// uv, of the first and of the second set -> value. Same operations, filter and wrap modes as the GLSL.
glm::vec3 evaluate_texture(const TexturePrograms&, const std::vector<CpuImage>& images, std::uint32_t texture,
                           glm::vec4 uv);
inline glm::vec3 evaluate_texture(const TexturePrograms& textures, const std::vector<CpuImage>& images,
                                  std::uint32_t texture, glm::vec2 uv) {
    return evaluate_texture(textures, images, texture, glm::vec4(uv, uv));
}

} // namespace restage::render
