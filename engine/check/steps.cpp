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
        {"reload", "loaded and unloaded a hundred times, nothing is left behind", check_reload,
         "memory of init() that shutdown() does not free, or a thread or static object that pins the library",
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
        {"sound", "finite and not negative, whatever the parameters and directions", check_sound,
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
        {"inspector", "its part of the inspector draws, whatever the user does", check_inspector,
         "an id no longer in the table, an array shorter than its count, or a value out of range", "draw()"},
        {"tables", "any file for its table parameters is read, or refused with a message", check_tables,
         "counts and offsets of a file used unchecked", "read()"},
    };
    return steps;
}

const std::vector<Step>& texture_steps() {
    static const std::vector<Step> steps = {
        {"texture-glsl", "the GLSL of a texture compiles, in both colour modes", check_texture_glsl,
         "see the line that the message names; the GLSL knows <restage/v1/...> and its own files. Colours of its own "
         "are "
         "made by texture_color()"},
        {"texture-names", "every name of a texture starts with its prefix", check_texture_names,
         "the code of all textures and of a material stands in one shader"},
        {"texture-values", "a texture is finite, and the same twice, whatever the parameters and places",
         check_texture_values, "a division by what may be 0, the root or logarithm of something below 0, normalize(0)"},
        {"texture-params", "each parameter of a texture changes something", check_texture_params,
         "a line of the table that the GLSL does not read, or a range in which it does nothing"},
        {"texture-native", "the native evaluation of a texture is the GLSL's", check_texture_native,
         "the index of a value (4 a line of the table), rounding of a whole number, or a formula that was changed once",
         "eval()"},
    };
    return steps;
}

const std::vector<Step>& denoiser_steps() {
    static const std::vector<Step> steps = {
        {"denoise", "a constant picture is unchanged", check_denoise, "a scale that is not undone", "run()"},
        {"sizes", "one pixel, odd sizes, each guide alone, in place", check_denoise_sizes,
         "tiles or vectors that do not fit the size, or guides assumed to exist (they may be NULL)", "run()"},
        {"robust", "NaN and infinity, determinism, a stop at each call of progress", check_denoise_robust,
         "values used unchecked, threads that write to one place, or a result of "
         "progress() that is ignored",
         "run()"},
        {"denoise-leaks", "a hundred runs, of which some are stopped, leave nothing behind", check_denoise_leaks,
         "a buffer that is not freed where run() returns early", "run()"},
    };
    return steps;
}

const std::vector<Step>& importer_steps() {
    static const std::vector<Step> steps = {
        {"probe", "noise and beginnings of its files are answered, its own files recognized", check_probe,
         "reading past the end of the head", "probe()"},
        {"read", "its files twice the same; changed and as noise an answer", check_read,
         "counts, offsets and indices of a file used unchecked", "load()"},
        {"options", "its files are read with each option at its ends, twice the same", check_read_options,
         "a choice that is not told apart, or a value that is divided by", "load()"},
        {"cut", "its files cut short get an answer", check_read_cut, "a length of a file that is believed", "load()"},
        {"stop", "it ends at whichever call of progress says so", check_read_stop,
         "an answer of progress() that is ignored", "load()"},
        {"read-leaks", "a hundred loads, of which some are refused and stopped, leave nothing behind", check_read_leaks,
         "what is not freed, or not closed, where load() returns early", "load()"},
    };
    return steps;
}

const std::vector<Step>& exporter_steps() {
    static const std::vector<Step> steps = {
        {"write", "something of everything, each option, twice the same bytes", check_write,
         "getters that return 0 (removed things, no environment) and optional pointers used "
         "unchecked; or hash tables whose order gets into the file",
         "save()"},
        {"write-stop", "it ends at whichever call of progress says so, and the old file stays", check_write_stop,
         "an answer of progress() that is ignored, or a file that is written in place", "save()"},
        {"place", "a place that cannot be written is refused, a full disk noticed, and the old file stays",
         check_write_place, "writes whose result is not looked at, or a file that is written in place", "save()"},
        {"roundtrip", "what an importer makes of its file is what was written", check_roundtrip,
         "matrices that are transposed, indices off by one, or numbers with too few digits", "save() or load()"},
        {"write-leaks", "a hundred saves, of which some are stopped, leave nothing behind", check_write_leaks,
         "what is not freed, or not closed, where save() returns early", "save()"},
    };
    return steps;
}

const std::vector<Step>& action_steps() {
    static const std::vector<Step> steps = {
        {"act",
         "any scene, selection and parameters: twice the same edits, others with another seed, sound; undo takes all "
         "of them back",
         check_act,
         "handles of the selection that are taken for granted, meshes without triangles, a failure without error(), or "
         "random numbers without a seed",
         "run()"},
        {"act-stop", "stopped at each call of progress it ends, and nothing has changed", check_act_stop,
         "an answer of progress() that is ignored", "run()"},
        {"act-leaks", "a hundred runs leave nothing behind", check_act_leaks, "memory that run() does not free",
         "run()"},
    };
    return steps;
}

const std::vector<Step>& panel_steps() {
    static const std::vector<Step> steps = {
        {"panel", "it draws, whatever the user does, and runs actions of its plugin", check_panel,
         "an id that the table no longer has, an action of another id, a group that stays open, or a value out of "
         "range",
         "draw()"},
    };
    return steps;
}

const std::vector<Step>& sky_steps() {
    static const std::vector<Step> steps = {
        {"sky", "finite and not negative, twice the same, at any size and with any values", check_sky,
         "a cosine at or below the horizon that is divided by, a direction that is not of length 1, or rows that are "
         "counted in another way than width * width",
         "make()"},
        {"sky-params", "each parameter does something", check_sky_params, "a value that is looked up by another id",
         "make()"},
        {"sky-stop", "it ends when progress says so", check_sky_stop, "an answer of progress() that is ignored",
         "make()"},
        {"sky-runs", "a hundred skies leave nothing behind", check_sky_runs, "memory of make() that is not freed",
         "make()"},
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
