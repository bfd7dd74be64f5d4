// SPDX-License-Identifier: Apache-2.0
// Textures are composed like materials: their plugins' GLSL and a switch over the types in the scene. Graphs are data
// for that switch: another graph of the same types needs no new shader.
#pragma once

#include "gpu/compiler.hpp"
#include "render/texture_types.hpp"

#include <filesystem>
#include <span>
#include <string>

namespace restage::render {

// The text that follows a material's code and precedes the engine's; "" if no type has code. Includes lib/texture.glsl.
// Adds the plugins' folders and texts to the source.
std::string compose_textures(std::span<const TextureType>, gpu::ShaderSource&);

// The same for a shader that is a file: after its line `#include "lib/extensions.glsl"`.
void insert_textures(std::span<const TextureType>, gpu::ShaderSource&);

// Checks that a texture's GLSL compiles. Needs no device. For Registry::set_judge. [main]
plugin::Registry::TextureJudge texture_judge(std::filesystem::path shader_dir);

} // namespace restage::render
