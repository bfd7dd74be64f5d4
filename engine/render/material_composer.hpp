// SPDX-License-Identifier: Apache-2.0
// Materials are composed, not linked: for each type in the scene a shader from its parameter struct, its fetch code,
// the plugin's GLSL and the tracer's own main.
#pragma once

#include "gpu/compiler.hpp"
#include "gpu/pipeline.hpp"
#include "render/material_types.hpp"
#include "render/renderer_options.hpp"

#include <span>
#include <vector>

namespace restage::render {

// Features the scene uses; see the constants in shaders/lib/scene.glsl.
struct SceneFeatures {
    bool environment = false;
    bool lens = false;
    bool media = false;
    bool filter_table = false;
    bool borders = false; // of media, at surfaces that rays pass
    bool emission_textures = false;
    bool light_alpha = false; // some lamp has alpha below 1
    bool glow = false;        // some lamp has no surface
    bool quadrics = false;    // spheres, disks, cylinders
    bool spectral = false;    // requested, and some colour is not grey
    bool curves = false;      // of it: some light or medium has a measured spectrum
    bool caustics = false;    // requested, and some light may meet something specular
    bool guiding = false;     // the tracer's: paths are guided
    bool catchers = false;    // shadow catchers
    std::uint32_t camera = 0; // CAMERA_*
    std::uint32_t lights = 0; // LIGHTS_*
    std::uint32_t light_roots = 0;
    bool operator==(const SceneFeatures&) const = default;
};

// The definition of Spectrum in a shader: see shaders/restage/v1/spectrum.glsl.
enum class ColorMode { rgb, spectral };
inline ColorMode color_mode(const SceneFeatures& f) { return f.spectral ? ColorMode::spectral : ColorMode::rgb; }
// For a kernel that is not composed.
void set_color_mode(ColorMode, gpu::ShaderSource&);

// `main_file`: "wave_shade.glsl" or another tracer's wrapper around path_step.
gpu::ShaderSource compose_material(const MaterialType&, const std::string& main_file, gpu::ShaderStage,
                                   ColorMode = ColorMode::rgb, std::span<const TextureType> textures = {});
// Whether its shader samples textures: then it is composed with the scene's texture types.
bool evaluates_textures(const SceneFeatures&, const MaterialType&);

// The stand-in for a material that is still compiling: `type` (diffuse) with its defaults, in the material's
// own colour; see MaterialData::params.
gpu::ShaderSource compose_stand_in(const MaterialType& type, const std::string& main_file, gpu::ShaderStage,
                                   ColorMode = ColorMode::rgb);

// Checks that a material's GLSL compiles within the kernel that renders it. Needs no device. For Registry::set_judge.
// [main]
plugin::Registry::Judge material_judge(std::filesystem::path shader_dir);

// For a material's shader: the features this type uses; or for a kernel without material.
std::vector<gpu::SpecConstant> spec_constants(const SceneFeatures&, bool guides, Strategy,
                                              const MaterialType* = nullptr);

} // namespace restage::render
