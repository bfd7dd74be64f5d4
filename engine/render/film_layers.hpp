// SPDX-License-Identifier: Apache-2.0
// FilmImage, a film's contents, and the only list of its layers: reading the film, merging, files, the viewport, the
// command line and Python use it. A new layer is a member and a row here, a field of GuidePixel and GuideSample
// (shared/path_data.h), its sum (shaders/path/film.glsl) and what the path step puts into it (shaders/path/step.glsl).
#pragma once

#include "shared/path_data.h"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <tuple>
#include <vector>

namespace restage::render {

// Normalised; row 0 on top. Layers have width * height values.
struct FilmImage {
    std::uint32_t width = 0, height = 0;
    std::uint32_t samples = 0; // minimum over pixels; adaptive: their mean
    std::vector<glm::vec3> color;        // linear sRGB radiance, exposure not applied
    std::vector<glm::vec3> std_error; // of the mean, per channel; 0 with fewer than 2 samples. See film_error.hpp
    std::vector<float> luminance_variance; // of the mean
    std::vector<glm::vec3> sample_error; // what std_error would be if samples were independent
    std::vector<glm::vec2> twin; // luminance of the pixel's twin and, likewise, its error, above 0 if there is one
    // Of the first hit that is not a mirror or smooth glass, for the denoiser.
    std::vector<glm::vec3> albedo; // [0,1], times the throughput of the mirrors and glasses
    std::vector<glm::vec3> normal; // world space, shading, mean over samples (not unit at edges)
    std::vector<float> depth; // mean distance of the first hit; 0 = none
    std::vector<float> coverage; // the fraction of samples that hit something; less than 1 where the sky is
    std::vector<std::uint32_t> instance_id, material_id; // Id::value seen by the first sample; 0 = none
    // Where shadow catchers are seen (catcher.hpp); elsewhere empty, `alpha` too.
    std::vector<float> caught; // the fraction of samples that met a catcher first
    std::vector<glm::vec3> shade, without, backdrop; // radiance of catchers with objects less that without; behind them
    std::vector<float> alpha; // coverage, but of catchers only what is in shadow. Not a layer: it follows from them
    const std::vector<float>& opacity() const { return alpha.empty() ? coverage : alpha; }

    static FilmImage blank(std::uint32_t width, std::uint32_t height); // all zeros
    void expose(float exposure); // multiplies what is radiance
    std::size_t pixels() const { return std::size_t{width} * height; }
};

enum class LayerSource {
    samples, // sums and squares of the film: color and its errors; scaled by exposure
    mean, // of all samples' guides
    radiance, // likewise, colours scaled by exposure; empty unless shadow catchers are seen
    first, // of the first sample's guide
};
enum class LayerLook { hidden, light, reflectance, direction, distance, fraction, number }; // in the viewport

template <class V>
struct FilmLayer {
    std::vector<V> FilmImage::* values;
    const char* name; // of its array in Python
    const char* in_file; // the .exr layer of its channels; layers with the same name are merged there
    std::array<const char*, 3> channels; // as many as V has
    LayerSource source;
    V (*guide)(const shared::GuidePixel&); // the value, or for a mean the sum; null for layers from samples
    LayerLook look;
    const char* label; // in menus
    const char* doc; // for Python
};

inline constexpr std::array<const char*, 3> rgb_channels{"R", "G", "B"};

inline constexpr std::tuple film_layers{
    FilmLayer<glm::vec3>{.values = &FilmImage::color,
                         .name = "color",
                         .in_file = "",
                         .channels = rgb_channels,
                         .source = LayerSource::samples,
                         .guide = nullptr,
                         .look = LayerLook::light,
                         .label = "Picture",
                         .doc = "float32 (H, W, 3): the picture, not denoised."},
    FilmLayer<glm::vec3>{.values = &FilmImage::std_error,
                         .name = "std_error",
                         .in_file = "stderr",
                         .channels = rgb_channels,
                         .source = LayerSource::samples,
                         .guide = nullptr,
                         .look = LayerLook::hidden,
                         .label = "",
                         .doc = "float32 (H, W, 3): standard error of `color`; 0 with fewer than two samples."},
    FilmLayer<float>{.values = &FilmImage::luminance_variance,
                     .name = "",
                     .in_file = "stderr",
                     .channels = {"Y"},
                     .source = LayerSource::samples,
                     .guide = nullptr,
                     .look = LayerLook::hidden,
                     .label = "",
                     .doc = ""},
    FilmLayer<glm::vec3>{.values = &FilmImage::sample_error,
                         .name = "",
                         .in_file = "stderr",
                         .channels = {"sampleR", "sampleG", "sampleB"},
                         .source = LayerSource::samples,
                         .guide = nullptr,
                         .look = LayerLook::hidden,
                         .label = "",
                         .doc = ""},
    FilmLayer<glm::vec2>{.values = &FilmImage::twin,
                         .name = "",
                         .in_file = "stderr",
                         .channels = {"twinY", "twinError"},
                         .source = LayerSource::samples,
                         .guide = nullptr,
                         .look = LayerLook::hidden,
                         .label = "",
                         .doc = ""},
    FilmLayer<glm::vec3>{.values = &FilmImage::albedo,
                         .name = "albedo",
                         .in_file = "albedo",
                         .channels = rgb_channels,
                         .source = LayerSource::mean,
                         .guide = [](const shared::GuidePixel& g) { return g.albedo; },
                         .look = LayerLook::reflectance,
                         .label = "Albedo",
                         .doc = "float32 (H, W, 3): reflectance, 0 to 1, of the first surface that is not a mirror or "
                                "smooth glass."},
    FilmLayer<glm::vec3>{.values = &FilmImage::normal,
                         .name = "normal",
                         .in_file = "normal",
                         .channels = {"X", "Y", "Z"},
                         .source = LayerSource::mean,
                         .guide = [](const shared::GuidePixel& g) { return g.normal; },
                         .look = LayerLook::direction,
                         .label = "Normals",
                         .doc = "float32 (H, W, 3): shading normal there, world space; a mean, not unit at edges."},
    FilmLayer<float>{.values = &FilmImage::depth,
                     .name = "depth",
                     .in_file = "depth",
                     .channels = {"Z"},
                     .source = LayerSource::mean,
                     .guide = [](const shared::GuidePixel& g) { return g.depth; },
                     .look = LayerLook::distance,
                     .label = "Distance",
                     .doc = "float32 (H, W): mean distance of the first hit [scene units]; 0 = none."},
    FilmLayer<float>{.values = &FilmImage::coverage,
                     .name = "coverage",
                     .in_file = "coverage",
                     .channels = {"A"},
                     .source = LayerSource::mean,
                     .guide = [](const shared::GuidePixel& g) { return g.coverage; },
                     .look = LayerLook::fraction,
                     .label = "Coverage",
                     .doc = "float32 (H, W): fraction of the samples that hit something, 0 to 1."},
    FilmLayer<std::uint32_t>{.values = &FilmImage::instance_id,
                             .name = "object_id",
                             .in_file = "id",
                             .channels = {"instance"},
                             .source = LayerSource::first,
                             .guide = [](const shared::GuidePixel& g) { return g.instance_id; },
                             .look = LayerLook::number,
                             .label = "Objects",
                             .doc = "uint32 (H, W): Object.id that the first sample hit; 0 = none."},
    FilmLayer<std::uint32_t>{.values = &FilmImage::material_id,
                             .name = "material_id",
                             .in_file = "id",
                             .channels = {"material"},
                             .source = LayerSource::first,
                             .guide = [](const shared::GuidePixel& g) { return g.material_id; },
                             .look = LayerLook::number,
                             .label = "Materials",
                             .doc = "uint32 (H, W): Material.id there; 0 = none."},
    FilmLayer<float>{.values = &FilmImage::caught,
                     .name = "",
                     .in_file = "catcher",
                     .channels = {"A"},
                     .source = LayerSource::radiance,
                     .guide = [](const shared::GuidePixel& g) { return g.caught; },
                     .look = LayerLook::hidden,
                     .label = "",
                     .doc = ""},
    FilmLayer<glm::vec3>{.values = &FilmImage::shade,
                         .name = "",
                         .in_file = "catcher",
                         .channels = {"shadeR", "shadeG", "shadeB"},
                         .source = LayerSource::radiance,
                         .guide = [](const shared::GuidePixel& g) { return g.shade; },
                         .look = LayerLook::hidden,
                         .label = "",
                         .doc = ""},
    FilmLayer<glm::vec3>{.values = &FilmImage::without,
                         .name = "",
                         .in_file = "catcher",
                         .channels = {"withoutR", "withoutG", "withoutB"},
                         .source = LayerSource::radiance,
                         .guide = [](const shared::GuidePixel& g) { return g.without; },
                         .look = LayerLook::hidden,
                         .label = "",
                         .doc = ""},
    FilmLayer<glm::vec3>{.values = &FilmImage::backdrop,
                         .name = "",
                         .in_file = "catcher",
                         .channels = {"behindR", "behindG", "behindB"},
                         .source = LayerSource::radiance,
                         .guide = [](const shared::GuidePixel& g) { return g.backdrop; },
                         .look = LayerLook::hidden,
                         .label = "",
                         .doc = ""},
};

// f(const FilmLayer<V>&) for each.
template <class F>
void each_film_layer(F&& f) {
    std::apply([&](const auto&... layer) { (f(layer), ...); }, film_layers);
}

} // namespace restage::render
