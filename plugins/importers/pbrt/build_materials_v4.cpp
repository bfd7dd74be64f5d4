// SPDX-License-Identifier: Apache-2.0
// pbrt-v4's materials, parameter by parameter with v4's defaults (https://pbrt.org/fileformat-v4, "Materials").
#include "builder.hpp"

namespace restage::pbrt {

namespace {

const char* remap_v4(const Directive& d) { return d.params.boolean("remaproughness", true) ? "v4" : "none"; }

} // namespace

bool Builder::material_v4(const Directive& d, const std::string& type, Values& values, std::string& plugin) {
    const Rgb half{0.5, 0.5, 0.5}, quarter{0.25, 0.25, 0.25}, zero{};
    plugin = type;
    if (type == "diffuse") {
        put_color(values, "reflectance", d, "reflectance", Role::albedo, half);
        values.number("sigma", 0);
    } else if (type == "conductor") {
        const bool colored = d.params.has("reflectance");
        values.boolean("use_reflectance", colored);
        if (colored)
            put_color(values, "reflectance", d, "reflectance", Role::albedo, half);
        else
            put_metal(values, d, "eta", "k", "eta", "k");
        put_roughness(values, d, "", 0);
        values.choice("remap", remap_v4(d));
        values.choice("distribution", "ggx");
    } else if (type == "dielectric" || type == "thindielectric") {
        plugin = "dielectric";
        put_index(values, "eta", d, "eta", 1.5);
        values.boolean("thin", type == "thindielectric");
        if (type == "thindielectric") {
            values.number("uroughness", 0);
            values.number("vroughness", 0);
            values.choice("remap", "none");
        } else {
            put_roughness(values, d, "", 0);
            values.choice("remap", remap_v4(d));
        }
        values.choice("distribution", "ggx");
        values.color("reflectance", {1, 1, 1});
        values.color("transmittance", {1, 1, 1});
    } else if (type == "coateddiffuse") {
        put_color(values, "reflectance", d, "reflectance", Role::albedo, half);
        put_roughness(values, d, "", 0);
        values.choice("remap", remap_v4(d));
        put_float(values, "thickness", d, "thickness", 0.01);
        put_index(values, "eta", d, "eta", 1.5);
        put_float(values, "g", d, "g", 0);
        put_color(values, "albedo", d, "albedo", Role::albedo, zero);
        values.integer("max_depth", d.params.integer("maxdepth", 10));
        values.integer("n_samples", d.params.integer("nsamples", 1));
    } else if (type == "coatedconductor") {
        put_roughness(values, d, "interface.", 0, "interface_uroughness", "interface_vroughness");
        put_float(values, "thickness", d, "thickness", 0.01);
        put_index(values, "interface_eta", d, "interface.eta", 1.5);
        put_float(values, "g", d, "g", 0);
        put_color(values, "albedo", d, "albedo", Role::albedo, zero);
        values.integer("max_depth", d.params.integer("maxdepth", 10));
        values.integer("n_samples", d.params.integer("nsamples", 1));
        const bool colored = d.params.has("reflectance");
        values.boolean("use_reflectance", colored);
        if (colored)
            put_color(values, "reflectance", d, "reflectance", Role::albedo, half);
        else
            put_metal(values, d, "conductor.eta", "conductor.k", "conductor_eta", "conductor_k");
        put_roughness(values, d, "conductor.", 0, "conductor_uroughness", "conductor_vroughness");
        values.choice("remap", remap_v4(d));
    } else if (type == "diffusetransmission") {
        // "scale" multiplies both; a texture gets a scale texture in front.
        const double scale = d.params.number("scale", 1);
        for (const char* name : {"reflectance", "transmittance"}) {
            const Argument a = color_argument(d, name, Role::albedo, quarter);
            if (a.texture)
                values.texture(name, RESTAGE_COLOR, scale == 1 ? a.texture : scaled_texture(a.texture, scale, false));
            else
                values.color(name, a.value * scale);
        }
    } else if (type == "mix" && (!import_.v3() || d.params.has("materials"))) {
        const Param* names = d.params.find("materials");
        if (!names || names->strings.size() != 2)
            throw ImportError{d.at, "material \"mix\" needs \"string materials\" with two names"};
        values.material("first", named_material(d, names->strings[0]));
        values.material("second", named_material(d, names->strings[1]));
        put_float(values, "amount", d, "amount", 0.5); // the weight of the second (MixMaterial::ChooseMaterial)
    } else {
        return false;
    }
    return true;
}

} // namespace restage::pbrt
