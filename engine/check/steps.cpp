// SPDX-License-Identifier: Apache-2.0
// Names and order of the steps, and what usually makes each fail.
#include "check/steps.hpp"

namespace restage::check {

const std::vector<Step>& plugin_steps() {
    static const std::vector<Step> steps = {
        {"manifest", "plugin.json is complete and its files are there", check_manifest, ""},
        {"load", "the library opens, answers as its manifest says, and its tables are sound", check_load,
         "the plugin was built against another SDK, or a table does not match its headers"},
        {"reload", "a hundred times loaded and unloaded, nothing is left behind", check_reload,
         "memory of init() that shutdown() does not free, or a thread or static object that pins the library"},
    };
    return steps;
}

const std::vector<Step>& material_steps() {
    static const std::vector<Step> steps = {
        {"glsl", "the GLSL compiles", check_glsl, "see the line that the message names"},
        {"names", "every name starts with the prefix; no bindings, no buffers", check_names,
         "two materials share one shader where they are mixed, so names must not meet"},
        {"cost", "first dispatch and time of a call", check_cost, "a loop without a bound"},
        {"params", "values arrive in the GLSL and come back from a project and a pbrt file", check_params,
         "two lines of the table with one id, one that means something to a format (plugin), or choices that are not "
         "those of the GLSL"},
        {"sound", "finite and not negative, whatever the parameters and directions", check_sound,
         "a division by a cosine, by alpha or by 1 - eta, the root or logarithm of something just below 0, or "
         "normalize(0)"},
        {"chi-square", "samples fall as pdf says", check_chi_square,
         "a factor that pdf lacks (the Jacobian of the half vector, the probability of the lobe, the back side)"},
        {"integral", "pdf integrates to 1, less what is delta or absorbed", check_integral,
         "a constant factor in pdf, or pdf is positive where sample never goes"},
        {"weight", "weight = eval / pdf, and the pdf of a sample is pdf", check_weight,
         "sample has formulas of its own that differ from eval's or pdf's"},
        {"expectation", "of a stochastic material: samples carry what eval means, pdf is a density, MIS is unbiased",
         check_expectation,
         "eval and sample walk by different rules (absorption, the last bounce, the choice of lobes)"},
        {"energy", "no more light leaves than arrives", check_energy,
         "lobes that are added without sharing the energy, a missing shadowing term, or 1 / cos at grazing angles"},
        {"furnace", "a white furnace shows nothing, where LOSSLESS is declared", check_furnace,
         "single scattering loses energy at high roughness: then LOSSLESS must not be declared"},
        {"albedo", "albedo() is near what is really reflected", check_albedo, "a Fresnel term or a tint is missing"},
        {"reciprocity", "f(wo, wi) = f(wi, wo), with eta^2 where light is refracted", check_reciprocity,
         "a term that only looks at wo (Fresnel weights, tints); if the model is so, declare NONRECIPROCAL"},
        {"limit", "a vanishing roughness looks like none", check_limit,
         "the smooth and the rough branch differ in a factor (Fresnel, eta^2, the choice of the lobe)"},
    };
    return steps;
}

const std::vector<Step>& denoiser_steps() {
    static const std::vector<Step> steps = {
        {"denoise", "a constant picture stays what it is", check_denoiser, "a scale that is not undone"}};
    return steps;
}

const std::vector<Step>& importer_steps() {
    static const std::vector<Step> steps = {
        {"probe", "noise is answered, not crashed on", check_importer, "reading past the end of the head"}};
    return steps;
}

} // namespace restage::check
