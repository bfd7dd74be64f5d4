// SPDX-License-Identifier: Apache-2.0
// Names and order of the steps, and the usual cause of failure of each.
#include "check/steps.hpp"

namespace restage::check {

static constexpr const char* load_calls = "init(), query() or shutdown()";

const std::vector<Step>& plugin_steps() {
    static const std::vector<Step> steps = {
        {"manifest", "plugin.json is complete and its files exist", check_manifest, "", load_calls},
        {"load", "the library opens, matches its manifest, and its tables are valid", check_load,
         "the plugin was built against another SDK, or a table does not match its headers", load_calls},
        {"reload", "loaded and unloaded a hundred times, it leaks nothing", check_reload,
         "memory of init() that shutdown() does not free, or a thread or static object that keeps the library loaded",
         load_calls},
    };
    return steps;
}

const std::vector<Step>& material_steps() {
    static const std::vector<Step> steps = {
        {"glsl", "the GLSL compiles", check_glsl,
         "see the line that the message names; the GLSL may use <restage/v1/...> and its own files, nothing of the "
         "scene"},
        {"names", "every name starts with the prefix; no bindings, no buffers", check_names,
         "mixed materials share one shader, so names must not clash"},
        {"cost", "first dispatch and time of a call", check_cost, "a loop without a bound"},
        {"params", "values reach the GLSL and survive a project and a pbrt file", check_params,
         "two table lines with one id, one that has a meaning in a format (plugin), or choices that differ from "
         "those in the GLSL"},
        {"sound", "finite and not negative, for any parameters and directions", check_sound,
         "a division by a cosine, by alpha or by 1 - eta, the root or logarithm of something just below 0, or "
         "normalize(0)"},
        {"chi-square", "samples follow pdf", check_chi_square,
         "a factor that pdf lacks (the Jacobian of the half vector, the probability of the lobe, the back side)"},
        {"integral", "pdf integrates to 1, minus the delta and absorbed fraction", check_integral,
         "a constant factor in pdf, or pdf is positive where sample never goes"},
        {"reach", "samples carry as much light as eval has over the whole sphere", check_reach,
         "eval is positive where sample never goes (a side, a lobe), or a lobe's weight lacks a factor"},
        {"weight", "weight = eval / pdf, and the pdf of a sample is pdf", check_weight,
         "sample uses formulas that differ from eval's or pdf's"},
        {"expectation", "for a stochastic material: samples match the mean of eval, pdf is a density, MIS is unbiased",
         check_expectation,
         "eval and sample use different random walks (absorption, the last bounce, the choice of lobes)"},
        {"energy", "no more light leaves than arrives", check_energy,
         "lobes added without sharing the energy, a missing shadowing term, or 1 / cos at grazing angles"},
        {"furnace", "a white furnace shows nothing, if LOSSLESS is declared", check_furnace,
         "single scattering loses energy at high roughness: then LOSSLESS must not be declared"},
        {"albedo", "albedo() is close to the actual reflectance", check_albedo, "a Fresnel term or a tint is missing"},
        {"reciprocity", "f(wo, wi) = f(wi, wo), with eta^2 for refraction", check_reciprocity,
         "a term that depends only on wo (Fresnel weights, tints); if the model is so, declare NONRECIPROCAL"},
        {"isotropy", "without TANGENT, rotating both directions about the normal changes nothing", check_isotropy,
         "eval treats x and y differently: declare TANGENT"},
        {"limit", "a vanishing roughness looks like zero roughness", check_limit,
         "the smooth and the rough branch differ in a factor (Fresnel, eta^2, the choice of the lobe)"},
        {"inspector", "its inspector draws, for any user input", check_inspector,
         "an id no longer in the table, an array shorter than its count, or a value out of range", "draw()"},
        {"tables", "any file for its table parameters is read, or refused with a message", check_tables,
         "counts and offsets of a file used unchecked", "read()"},
    };
    return steps;
}

const std::vector<Step>& texture_steps() {
    static const std::vector<Step> steps = {
        {"texture-glsl", "the GLSL of a texture compiles, in both colour modes", check_texture_glsl,
         "see the line that the message names; the GLSL may use <restage/v1/...> and its own files. Build colours with "
         "texture_color()"},
        {"texture-names", "every name of a texture starts with its prefix", check_texture_names,
         "all textures share one shader with a material, so names must not clash"},
        {"texture-values", "a texture is finite and deterministic for any parameters and places", check_texture_values,
         "a division by something that may be 0, the root or logarithm of a negative number, normalize(0)"},
        {"texture-params", "each parameter of a texture has an effect", check_texture_params,
         "a table line that the GLSL does not read, or a range in which it has no effect"},
        {"texture-native", "the native evaluation of a texture agrees with the GLSL", check_texture_native,
         "the index of a value (4 per table line), rounding of an integer, or a formula changed in one of the two only",
         "eval()"},
    };
    return steps;
}

const std::vector<Step>& denoiser_steps() {
    static const std::vector<Step> steps = {
        {"denoise", "a constant picture is unchanged", check_denoise, "a scale that is not undone", "run()"},
        {"sizes", "one pixel, odd sizes, each guide alone, in place", check_denoise_sizes,
         "tiles or vectors that do not fit the size, or guides assumed to exist (they may be NULL)", "run()"},
        {"robust", "NaN and infinity, determinism, cancelled at each call of progress", check_denoise_robust,
         "values used unchecked, threads that write to one place, or a result of "
         "progress() that is ignored",
         "run()"},
        {"denoise-leaks", "a hundred runs, some cancelled, leak nothing", check_denoise_leaks,
         "a buffer that is not freed if run() returns early", "run()"},
    };
    return steps;
}

const std::vector<Step>& importer_steps() {
    static const std::vector<Step> steps = {
        {"probe", "noise and truncated files get an answer, its own files are recognized", check_probe,
         "reading past the end of the head", "probe()"},
        {"read", "its files read identically twice; corrupted and noise files get an answer", check_read,
         "counts, offsets and indices of a file used unchecked", "load()"},
        {"options", "its files are read with each option at its limits, identically twice", check_read_options,
         "a choice that is not handled, or a division by an option's value", "load()"},
        {"cut", "truncated files get an answer", check_read_cut, "a length in the file used unchecked", "load()"},
        {"stop", "it stops at any call of progress that returns 0", check_read_stop,
         "an answer of progress() that is ignored", "load()"},
        {"read-leaks", "a hundred loads, some refused or cancelled, leak nothing", check_read_leaks,
         "memory not freed, or files not closed, if load() returns early", "load()"},
    };
    return steps;
}

const std::vector<Step>& exporter_steps() {
    static const std::vector<Step> steps = {
        {"write", "every kind of thing, each option, identical bytes twice", check_write,
         "getters that return 0 (removed things, no environment) and optional pointers used "
         "unchecked; or hash tables whose order determines the file's",
         "save()"},
        {"write-stop", "it stops at any call of progress that returns 0, and keeps the old file", check_write_stop,
         "an answer of progress() that is ignored, or a file that is written in place", "save()"},
        {"place", "an unwritable path and a full disk are reported, and the old file is kept", check_write_place,
         "write errors that are ignored, or a file that is written in place", "save()"},
        {"roundtrip", "an importer reads back what was written", check_roundtrip,
         "matrices that are transposed, indices off by one, or numbers with too few digits", "save() or load()"},
        {"write-leaks", "a hundred saves, some cancelled, leak nothing", check_write_leaks,
         "memory not freed, or files not closed, if save() returns early", "save()"},
    };
    return steps;
}

const std::vector<Step>& action_steps() {
    static const std::vector<Step> steps = {
        {"act",
         "any scene, selection and parameters: identical, valid edits twice, different ones with another seed; undo "
         "reverts "
         "all of them",
         check_act,
         "handles of the selection used unchecked, meshes without triangles, a failure without error(), or "
         "random numbers without a seed",
         "run()"},
        {"act-stop", "it stops at any call of progress that returns 0, and nothing changes", check_act_stop,
         "an answer of progress() that is ignored", "run()"},
        {"act-leaks", "a hundred runs leak nothing", check_act_leaks, "memory that run() does not free", "run()"},
    };
    return steps;
}

const std::vector<Step>& panel_steps() {
    static const std::vector<Step> steps = {
        {"panel", "it draws, for any user input, and runs actions of its plugin", check_panel,
         "an id that is no longer in the table, an unknown action, a group that stays open, or a value out of "
         "range",
         "draw()"},
    };
    return steps;
}

const std::vector<Step>& sky_steps() {
    static const std::vector<Step> steps = {
        {"sky", "finite, not negative and deterministic, at any size and with any values", check_sky,
         "a division by a cosine at or below the horizon, a direction not of unit length, or rows of another length "
         "than "
         "the width",
         "make()"},
        {"sky-params", "each parameter has an effect", check_sky_params, "a value that is looked up by the wrong id",
         "make()"},
        {"sky-stop", "it stops when progress returns 0", check_sky_stop, "an answer of progress() that is ignored",
         "make()"},
        {"sky-runs", "a hundred skies leak nothing", check_sky_runs, "memory of make() that is not freed", "make()"},
    };
    return steps;
}

std::span<const std::vector<Step>* const> all_steps() {
    static const std::vector<Step>* const lists[] = {
        &plugin_steps(),   &material_steps(), &texture_steps(), &sky_steps(),   &importer_steps(),
        &exporter_steps(), &denoiser_steps(), &action_steps(),  &panel_steps(),
    };
    return lists;
}

const Step* find_step(const std::string& name) {
    for (const auto* list : all_steps())
        for (const Step& step : *list)
            if (name == step.name) return &step;
    return nullptr;
}

} // namespace restage::check
