// SPDX-License-Identifier: Apache-2.0
// Textures are composed like materials: their plugins' GLSL and a switch over the types that a scene has. Graphs are
// data for that switch: another graph of the same types needs no other shader.
#pragma once

#include "gpu/compiler.hpp"
#include "render/texture_types.hpp"

#include <filesystem>
#include <span>
#include <string>

namespace restage::render {

// What stands after a material's own code and before everything of the engine's; "" where no type has code. Adds the
// plugins' folders and texts to the source. It includes lib/texture.glsl.
std::string compose_textures(std::span<const TextureType>, gpu::ShaderSource&);

// The same for a shader that is a file: after its line `#include "lib/extensions.glsl"`.
void insert_textures(std::span<const TextureType>, gpu::ShaderSource&);

// Does a texture's GLSL compile? No device is needed. For Registry::set_judge. [main]
plugin::Registry::TextureJudge texture_judge(std::filesystem::path shader_dir);

} // namespace restage::render
