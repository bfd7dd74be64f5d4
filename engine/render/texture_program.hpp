// SPDX-License-Identifier: Apache-2.0
// Textures of the scene as postfix programs: in words for shaders (shaders/lib/texture.glsl), and for the CPU, which
// resolves cut-outs and mixes while Embree visits a hit, by the native code of the textures' plugins if they
// have any.
#pragma once

#include "render/texture_types.hpp"
#include "scene/scene.hpp"
#include "shared/scene_data.h"

#include <vector>

namespace restage::render {

// An operation on the CPU.
struct NativeOp {
    const plugin::TextureSource* source = nullptr; // null: a literal
    glm::vec3 literal{0};
    glm::vec4 map{1, 1, 0, 0}; // scale, delta
    glm::vec2 shear{0};
    bool second_uv = false;
    std::uint32_t image = 0;
    std::uint32_t operands = 0; // bit k: the k-th texturable line is on the stack
    std::uint32_t values = 0, whole = 0; // first of them
};

// Programs are indexed by Id<Texture>::value; 0 is empty. Images are indexed by Id<Image>::value.
struct TexturePrograms {
    std::vector<shared::TextureProgram> programs; // of words
    std::vector<std::uint32_t> words;
    struct Native {
        std::uint32_t first = 0, count = 0; // of ops
        bool there = false;     // else a type has no native code, and
        glm::vec3 average{0.5f}; // this average is used if nothing better is available
    };
    std::vector<Native> native;
    std::vector<NativeOp> ops;
    std::vector<float> values; // 4 per table line
    std::vector<std::int32_t> whole; // 1 per table line
};

// Types without a plugin shade as their `average`; so do images without pixels, and graphs that exceed the
// stack. New types are added.
TexturePrograms compile_textures(const scene::Scene&, TextureTypes&, const TextureLookup&);

// Pixels for reading on the CPU.
struct CpuImage {
    const scene::PixelData* pixels = nullptr;
};

// uv, of the first and of the second set -> value. Same filter and wrap modes as the GLSL.
glm::vec3 evaluate_texture(const TexturePrograms&, const std::vector<CpuImage>& images, std::uint32_t texture,
                           glm::vec4 uv);
inline glm::vec3 evaluate_texture(const TexturePrograms& textures, const std::vector<CpuImage>& images,
                                  std::uint32_t texture, glm::vec2 uv) {
    return evaluate_texture(textures, images, texture, glm::vec4(uv, uv));
}

} // namespace restage::render
