// SPDX-License-Identifier: Apache-2.0
// Detects the pbrt version of a scene. Each name or form of only one version is a vote; v4 wins a draw.
#include "directives.hpp"

#include <algorithm>
#include <initializer_list>

namespace restage::pbrt {

namespace {

bool one_of(std::string_view text, std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), text) != names.end();
}

const std::initializer_list<std::string_view>
    samplers_v3 = {"lowdiscrepancy", "02sequence", "maxmindist", "halton", "sobol", "random", "stratified"},
    samplers_v4 = {"zsobol", "paddedsobol", "halton", "sobol", "pmj02bn", "independent", "stratified"},
    integrators_v3 = {"whitted", "directlighting", "path", "volpath", "bdpt", "mlt", "ambientocclusion", "sppm"},
    integrators_v4 = {"path", "function", "simplepath",       "lightpath",  "simplevolpath", "volpath",
                      "bdpt", "mlt",      "ambientocclusion", "randomwalk", "sppm"};

struct Vote {
    int weight = 0; // > 0: v3, < 0: v4
    std::string why;
};

Vote material(const std::string& type) {
    if (one_of(type, {"matte", "plastic", "metal", "glass", "mirror", "substrate", "uber", "translucent", "disney",
                      "fourier", "kdsubsurface", "shinymetal"}))
        return {4, "material \"" + type + "\""};
    if (one_of(type, {"diffuse", "coateddiffuse", "conductor", "dielectric", "thindielectric", "diffusetransmission",
                      "coatedconductor", "interface", "measured"}))
        return {-4, "material \"" + type + "\""};
    return {};
}

std::string type_of(const Directive& directive) {
    if (directive.verb == Verb::material) return directive.name;
    for (const Param& param : directive.params.params)
        if (param.name == "type" && param.strings.size() == 1) return param.strings[0];
    return {};
}

Vote by_name(const Directive& d) {
    switch (d.verb) {
        case Verb::world_end:
            return {8, "WorldEnd"};
        case Verb::ignored:
            return {4, d.word};
        case Verb::color_space:
        case Verb::option:
        case Verb::attribute:
        case Verb::import_begin:
            return {-8, d.word};
        case Verb::transform_begin:
            return {1, "TransformBegin"};
        case Verb::material:
        case Verb::make_named_material:
            return material(type_of(d));
        case Verb::film:
            if (d.name == "image") return {8, "Film \"image\""};
            if (one_of(d.name, {"rgb", "gbuffer", "spectral"})) return {-8, "Film \"" + d.name + "\""};
            return {};
        case Verb::sampler:
            if (one_of(d.name, {"02sequence", "lowdiscrepancy", "maxmindist", "random"}))
                return {4, "Sampler \"" + d.name + "\""};
            if (one_of(d.name, {"independent", "zsobol", "paddedsobol", "pmj02bn"}))
                return {-4, "Sampler \"" + d.name + "\""};
            return {};
        case Verb::integrator:
            if (d.word == "SurfaceIntegrator") return {8, d.word};
            if (one_of(d.name, {"directlighting", "whitted"})) return {2, "Integrator \"" + d.name + "\""};
            if (one_of(d.name, {"simplepath", "simplevolpath", "lightpath", "function"}))
                return {-4, "Integrator \"" + d.name + "\""};
            return {};
        case Verb::camera:
            return d.name == "spherical"     ? Vote{-4, "Camera \"spherical\""}
                   : d.name == "environment" ? Vote{4, "Camera \"environment\""}
                                             : Vote{};
        case Verb::shape:
            if (one_of(d.name, {"cone", "paraboloid", "hyperboloid", "heightfield", "nurbs"}))
                return {4, "Shape \"" + d.name + "\""};
            if (d.name == "bilinearmesh") return {-4, "Shape \"bilinearmesh\""};
            return {};
        case Verb::texture:
            if (d.second == "color") return {4, "Texture of type \"color\""};
            if (d.third == "directionmix") return {-4, "Texture \"directionmix\""};
            if (d.third == "uv") return {4, "Texture \"uv\""};
            return {};
        default:
            return {};
    }
}

Vote by_param(const Directive& d, const Param& param) {
    const auto vote = [&](int weight) {
        return Vote{weight, "\"" + param.type + " " + param.name + "\" of " + d.word};
    };
    if (one_of(param.type, {"color", "xyz", "point", "vector"})) return vote(param.type == "color" ? 4 : 1);
    if (one_of(param.type, {"point3", "vector3"})) return vote(-1);
    switch (d.verb) {
        case Verb::light_source:
            if (param.name == "mapname") return vote(4);
            if (one_of(param.name, {"filename", "power", "illuminance", "portal"})) return vote(-4);
            if (param.name == "scale" && param.type != "float") return vote(4);
            if (param.name == "scale") return vote(-1);
            return {};
        case Verb::area_light_source:
            if (one_of(param.name, {"nsamples", "samples"})) return vote(2);
            if (one_of(param.name, {"filename", "power"})) return vote(-4);
            return {};
        case Verb::pixel_filter:
            if (one_of(param.name, {"xwidth", "ywidth", "alpha"})) return vote(4);
            if (one_of(param.name, {"xradius", "yradius", "sigma"})) return vote(-4);
            return {};
        case Verb::material:
        case Verb::make_named_material:
            if (one_of(param.name, {"bumpmap", "Kd", "Ks", "Kr", "Kt", "index"})) return vote(2);
            if (one_of(param.name, {"displacement", "normalmap", "reflectance"})) return vote(-2);
            return {};
        case Verb::texture:
            if (one_of(param.name, {"trilinear", "gamma", "aamode"})) return vote(2);
            if (one_of(param.name, {"encoding", "filter", "invert"})) return vote(-2);
            return {};
        case Verb::shape:
            if (one_of(param.name, {"shadowalpha", "nlevels", "st"})) return vote(2);
            return {};
        default:
            return {};
    }
}

} // namespace

bool pbrt_has(Verb kind, std::string_view name, bool v3) {
    switch (kind) {
        case Verb::sampler:
            return one_of(name, v3 ? samplers_v3 : samplers_v4);
        case Verb::integrator:
            return one_of(name, v3 ? integrators_v3 : integrators_v4);
        default: // Accelerator
            return one_of(name, {"bvh", "kdtree"});
    }
}

Version detect_version(const SceneFile& scene, const Sources& sources, std::string& evidence) {
    int balance = 0;
    Vote best[2]; // the strongest of each side
    Location where[2];
    const auto count = [&](const Vote& vote, Location at) {
        if (vote.weight == 0) return;
        balance += vote.weight;
        const int side = vote.weight > 0 ? 0 : 1;
        if (std::abs(vote.weight) > std::abs(best[side].weight)) {
            best[side] = vote;
            where[side] = at;
        }
    };
    for (const Directive& directive : scene.directives) {
        count(by_name(directive), directive.at);
        for (const Param& param : directive.params.params)
            count(by_param(directive, param), param.at);
    }
    const int side = balance > 0 ? 0 : 1;
    evidence = best[side].weight == 0 ? "nothing in it distinguishes the versions"
                                      : best[side].why + " (" + to_string(sources, where[side]) + ")";
    return side == 0 ? Version::v3 : Version::v4;
}

} // namespace restage::pbrt
