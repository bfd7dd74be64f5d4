// SPDX-License-Identifier: Apache-2.0
// Picture: the result of a render, in memory that numpy arrays view.
#pragma once

#include "workspace.hpp"

#include "render/film.hpp"

#include <functional>

namespace restage::python {

struct Picture {
    std::shared_ptr<Host> host;
    render::FilmImage film; // the exposure is in color, std_error and luminance_variance
    std::vector<glm::vec3> denoised;
    scene::Development development; // of the scene
    glm::vec4 window{0, 1, 0, 1};   // likewise: Film::crop
    std::uint32_t seed = 0, first_sample = 0;
    double seconds = 0;
    bool finished = false;
    std::map<std::string, std::uint64_t> not_finite;
    std::string scene, device, tracer; // about scene and renderer, for the file
    std::string denoiser = "none";     // the denoiser of `denoised`: "oidn high"
};

// quality: fast, balanced, high. denoiser: see render::choose_denoiser. ask(fraction), with the GIL: false = throws
// Stopped, and the picture is unchanged; empty = only Ctrl-C stops it.
void denoise(Picture&, const std::string& quality, unsigned threads, const std::string& denoiser = "",
             const std::function<bool(double)>& ask = {});
void bind_picture(nb::module_&);

} // namespace restage::python
