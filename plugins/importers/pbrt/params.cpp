// SPDX-License-Identifier: Apache-2.0
#include "params.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace restage::pbrt {

namespace {

[[noreturn]] void wrong(const Param& param, const std::string& expected) {
    throw ImportError{param.at, "parameter \"" + param.type + " " + param.name + "\" should be " + expected, true};
}

std::string expected_number(const Param& param) {
    return param.numbers.empty() ? "a number" : "one number; " + std::to_string(param.numbers.size()) + " are given";
}

} // namespace

void ParamList::keep_last() {
    for (std::size_t i = 0; i < params.size();) {
        const auto again = [&](const Param& later) {
            return later.name == params[i].name && later.type == params[i].type;
        };
        const auto at = params.begin() + static_cast<std::ptrdiff_t>(i);
        if (std::any_of(at + 1, params.end(), again))
            params.erase(at);
        else
            ++i;
    }
}

const Param* ParamList::find(std::string_view name) const {
    for (auto it = params.rbegin(); it != params.rend(); ++it)
        if (it->name == name) {
            it->used = true;
            return &*it;
        }
    return nullptr;
}

const Param* ParamList::find(std::string_view name, std::string_view type) const {
    for (auto it = params.rbegin(); it != params.rend(); ++it)
        if (it->name == name && it->type == type) {
            it->used = true;
            return &*it;
        }
    return nullptr;
}

bool ParamList::taken(const Param& param, bool fits, const std::string& expected) const {
    if (fits) return true;
    if (!lenient) wrong(param, expected);
    param.used = false;
    param.misfit = true;
    return false;
}

bool ParamList::typed(const Param& param, std::string_view type) const {
    if (param.type == type) return true;
    if (lenient) return taken(param, false, "");
    param.should_be = type;
    return true;
}

bool ParamList::has(std::string_view name) const {
    for (const Param& param : params)
        if (param.name == name) return true;
    return false;
}

double ParamList::number(std::string_view name, double otherwise) const {
    const Param* param = find(name);
    if (!param || !typed(*param, "float")) return otherwise;
    return taken(*param, param->numbers.size() == 1, expected_number(*param)) ? param->numbers[0] : otherwise;
}

int ParamList::integer(std::string_view name, int otherwise) const {
    const Param* param = find(name);
    if (!param || !typed(*param, "integer") || !taken(*param, param->numbers.size() == 1, expected_number(*param)))
        return otherwise;
    const double value = param->numbers[0];
    if (!taken(*param, value == std::floor(value) && std::abs(value) <= 2147483647.0, "a whole number of 32 bits"))
        return otherwise;
    return static_cast<int>(value);
}

bool ParamList::boolean(std::string_view name, bool otherwise) const {
    const Param* param = find(name);
    if (!param || !typed(*param, "bool") || !taken(*param, param->bools.size() == 1, "true or false")) return otherwise;
    return param->bools[0] != 0;
}

std::string ParamList::string(std::string_view name, std::string otherwise) const {
    const Param* param = find(name);
    if (!param || !typed(*param, "string") || !taken(*param, param->strings.size() == 1, "one \"string\""))
        return otherwise;
    return param->strings[0];
}

std::string ParamList::texture(std::string_view name) const {
    for (auto it = params.rbegin(); it != params.rend(); ++it)
        if (it->name == name) {
            if (it->type != "texture") return {};
            it->used = true;
            if (!taken(*it, it->strings.size() == 1, "the \"name\" of one texture")) return {};
            return it->strings[0];
        }
    return {};
}

std::array<double, 3> ParamList::triple(std::string_view name, std::array<double, 3> otherwise) const {
    const Param* param = find(name);
    if (!param || !taken(*param, param->numbers.size() == 3, "three numbers")) return otherwise;
    return {param->numbers[0], param->numbers[1], param->numbers[2]};
}

const std::vector<double>* ParamList::numbers(std::string_view name) const {
    const Param* param = find(name);
    if (!param) return nullptr;
    if (!taken(*param, !param->numbers.empty() || (param->strings.empty() && param->bools.empty()), "numbers"))
        return nullptr;
    return &param->numbers;
}

std::vector<std::uint32_t> ParamList::indices(std::string_view name, std::size_t bound) const {
    std::vector<std::uint32_t> out;
    const Param* param = find(name);
    if (!param) return out;
    if (!param->strings.empty() || !param->bools.empty()) wrong(*param, "whole numbers");
    out.reserve(param->numbers.size());
    for (std::size_t i = 0; i < param->numbers.size(); ++i) {
        const double value = param->numbers[i];
        const bool whole = value == std::floor(value);
        if (!(value >= 0 && value < static_cast<double>(bound)) || !whole)
            throw ImportError{param->at,
                              "\"" + param->name + "\" number " + std::to_string(i) + " is " + shortest(value) +
                                  ", but there are " + std::to_string(bound) + " vertices; indices count from 0",
                              !whole};
        out.push_back(static_cast<std::uint32_t>(value));
    }
    return out;
}

void ParamList::mark_all_used() const {
    for (const Param& param : params)
        param.used = true;
}

void ParamList::each_unused(const std::function<void(const Param&)>& visit) const {
    for (const Param& param : params)
        if ((!param.used && !param.from_attribute) || param.misfit || !param.should_be.empty()) visit(param);
}

bool is_pbrt_parameter(std::string_view name) {
    static constexpr std::string_view names =
        " B C I Kd Kr Ks Kt L Le Lescale N P Pw Pz S aamode albedo alpha amount anisotropic aperture "
        "aperturediameter basis beta_m beta_n bootstrapsamples bsdffile bumpmap chains clearcoat clearcoatgloss "
        "color conductor.eta conductor.k conductor.roughness conductor.uroughness conductor.vroughness coneangle "
        "conedeltaangle coordinatesystem cossample cropwindow degree density diagonal difftrans dimension "
        "dimensions dir discarddegenerateUVs displacement edgelength emissionfilename emptybonus encoding eta "
        "eumelanin exposuretime faceIndices filename filter flatness focaldistance focusdistance fov "
        "frameaspectratio frequency from g gamma halffov height illuminance imagewritefrequency imagingratio "
        "index indices innerradius inside interface.eta interface.roughness interface.uroughness "
        "interface.vroughness intersectcost invert iso iterations jitter k lambdamax lambdamin "
        "largestepprobability lensfile lensradius levels lightsampler lightsamplestrategy majorantgridres "
        "mapname mapping materials maxanisotropy maxcomponentvalue maxdepth maxdistance maxnodeprims maxprims "
        "maxsampleluminance metallic mfp mutationsperpixel name namedmaterial1 namedmaterial2 nbuckets nlevels "
        "normalmap nsamples nu numiterations nv nx ny nz octaves opacity outside p0 p1 p2 pheomelanin phimax "
        "photonsperiteration pixelbounds pixelsamples portal power preset radius randomization reflect "
        "reflectance regularize remaproughness roughness rrthreshold samplebsdf samplelights samplepixelcenter "
        "samples savefp16 scale scatterdistance scheme screenwindow seed sensor shadowalpha sheen sheentint "
        "shutterclose shutteropen sigma sigma_a sigma_prime_s sigma_s simpleweighting spectrans speculartint "
        "splitdepth splitmethod st strategy tau temperature temperaturecutoff temperatureoffset temperaturescale "
        "tex tex1 tex2 thickness thin to transmit transmittance traversalcost trilinear twosided type u0 u1 "
        "udelta uknots uorder uroughness uscale uv v0 v00 v01 v1 v10 v11 v2 value variation vdelta "
        "visualizestrategies visualizeweights vknots vorder vroughness vscale whitebalance width width0 width1 "
        "wispiness wrap xradius xresolution xsamples xwidth yradius yresolution ysamples ywidth zmax zmin ";
    return names.find(' ' + std::string(name) + ' ') != names.npos;
}

std::string shortest(double value) {
    char text[32];
    const bool whole = value == std::floor(value) && std::abs(value) < 1e15; // 1000000000, not 1e+09
    const auto end = (whole ? std::to_chars(text, text + sizeof text, value, std::chars_format::fixed)
                            : std::to_chars(text, text + sizeof text, value))
                         .ptr;
    return {text, end};
}

std::optional<double> parse_double(std::string_view text) {
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

std::string quote(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '\n') {
            out += "\\n";
            continue;
        }
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + '"';
}

std::string to_text(const Param& param) {
    std::string out = quote(param.type + " " + param.name) + " [";
    for (const double value : param.numbers)
        (out += ' ') += shortest(value);
    for (const std::string& value : param.strings)
        (out += ' ') += quote(value);
    for (const char value : param.bools)
        out += value ? " true" : " false";
    return out + " ]";
}

std::string to_text(const ParamList& list, std::string_view separator) {
    std::string out;
    for (const Param& param : list.params) {
        if (!out.empty()) out += separator;
        out += to_text(param);
    }
    return out;
}

} // namespace restage::pbrt
