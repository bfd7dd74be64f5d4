// SPDX-License-Identifier: Apache-2.0
// Converts kept lines of one version of pbrt to the other's syntax. https://pbrt.org/fileformat-v3 and -v4.
#include "exporter.hpp"

#include <algorithm>

namespace restage::pbrt_out {

namespace {

bool one_of(std::string_view text, std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), text) != names.end();
}

Params only(const Params& given, std::initializer_list<const char*> names) {
    Params out = given;
    Params others = given;
    for (const char* name : names)
        others.remove(name);
    out.remove_all_of(others);
    return out;
}

// Sample placement only: they converge to the same picture.
std::string sampler(const KeptLine& line, bool to_v3) {
    Params given;
    given.add_raw(line.rest);
    const std::string name = one_of(line.name, {"halton", "sobol", "stratified"}) ? line.name
                             : line.name == "random"                              ? "independent"
                             : line.name == "independent"                         ? "random"
                             : to_v3                                              ? "sobol"
                                                                                  : "paddedsobol";
    return "Sampler " + quote(name) + " " + only(given, {"pixelsamples", "xsamples", "ysamples", "jitter"}).text();
}

// Those that the other version lacks, but that converge to the same picture, become path tracers.
std::optional<std::string> integrator(const KeptLine& line) {
    Params given;
    given.add_raw(line.rest);
    if (given.value("regularize") == "true") return std::nullopt; // biased
    std::string name = line.name;
    if (one_of(name, {"simplepath", "lightpath", "randomwalk"})) name = "path";
    if (name == "simplevolpath") name = "volpath";
    if (!one_of(name, {"path", "volpath", "bdpt", "mlt", "sppm", "ambientocclusion"})) return std::nullopt;
    const Params same =
        only(given, {"maxdepth", "bootstrapsamples", "chains", "mutationsperpixel", "largestepprobability", "sigma",
                     "photonsperiteration", "radius", "cossample", "maxdistance"});
    return "Integrator " + quote(name) + " " + same.text();
}

} // namespace

std::optional<std::string> in_other_words(const std::string& text, bool to_v3) {
    const auto parameter = [&](std::string_view raw) -> std::optional<std::string> {
        Params one;
        one.add_raw(raw);
        for (const char* how : {"filter", "maxanisotropy", "trilinear", "aamode", "nsamples", "samples", "savefp16"})
            if (one.has(how)) return "";
        for (const char* same : {"shutteropen", "shutterclose", "diagonal"})
            if (one.has(same)) return std::string(raw);
        return std::nullopt;
    };
    if (text[0] == '"') return parameter(text);
    const KeptLine line = split_directive(text);
    if (line.word == "Accelerator" || line.word == "TransformTimes") return text;
    if (line.word == "Sampler") return sampler(line, to_v3);
    if (line.word == "Integrator" || line.word == "SurfaceIntegrator") return integrator(line);
    if (line.word == "Camera" && line.name == "realistic") {
        Params given;
        given.add_raw(line.rest);
        for (const char* own : {"simpleweighting", "aperture"}) // the picture is a placeholder anyway
            given.remove(own);
        return "Camera \"realistic\" " + given.text();
    }
    if (line.word == "Film" && line.name.empty())
        if (const auto same = parameter(line.rest)) return same->empty() ? "" : text;
    return std::nullopt;
}

} // namespace restage::pbrt_out
