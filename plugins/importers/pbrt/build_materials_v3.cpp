// SPDX-License-Identifier: Apache-2.0
// pbrt-v3's materials with v3's defaults (https://pbrt.org/fileformat-v3, "Materials"; defaults as in its sources).
#include "builder.hpp"

#include <algorithm>
#include <cmath>

namespace restage::pbrt {

bool Builder::material_v3(const Directive& d, const std::string& type, Values& values, std::string& plugin) {
    const auto grey = [](double value) { return Rgb{value, value, value}; };
    const auto color = [&](const char* id, const char* name, double otherwise) {
        put_color(values, id, d, name, Role::unbounded, grey(otherwise)); // v3 clamps where it evaluates, not here
    };
    const auto remap = [&] { values.choice("remap", d.params.boolean("remaproughness", true) ? "v3" : "none"); };
    const auto index = [&] { put_index(values, "eta", d, d.params.has("eta") ? "eta" : "index", 1.5); };
    plugin = type;
    if (type == "matte") {
        plugin = "diffuse";
        color("reflectance", "Kd", 0.5);
        put_float(values, "sigma", d, "sigma", 0);
    } else if (type == "metal") {
        plugin = "conductor";
        Directive old; // a v3 name in a v4 file still means v3's averages
        old.word = "v3 metal";
        old.at = d.at;
        old.params.params = d.params.params;
        put_metal(values, old, "eta", "k", "eta", "k");
        d.params.find("eta");
        d.params.find("k");
        values.boolean("use_reflectance", false);
        put_roughness(values, d, "", 0.01);
        remap();
        values.choice("distribution", "ggx");
    } else if (type == "glass") {
        plugin = "dielectric";
        color("reflectance", "Kr", 1);
        color("transmittance", "Kt", 1);
        index();
        put_float(values, "uroughness", d, "uroughness", 0);
        put_float(values, "vroughness", d, "vroughness", 0);
        remap();
        values.boolean("thin", false);
        values.choice("distribution", "ggx");
    } else if (type == "substrate") {
        color("kd", "Kd", 0.5);
        color("ks", "Ks", 0.5);
        put_float(values, "uroughness", d, "uroughness", 0.1);
        put_float(values, "vroughness", d, "vroughness", 0.1);
        remap();
    } else if (type == "plastic") {
        color("kd", "Kd", 0.25);
        color("ks", "Ks", 0.25);
        put_float(values, "roughness", d, "roughness", 0.1);
        remap();
    } else if (type == "mirror") {
        color("kr", "Kr", 0.9);
    } else if (type == "uber") {
        color("kd", "Kd", 0.25);
        color("ks", "Ks", 0.25);
        color("kr", "Kr", 0);
        color("kt", "Kt", 0);
        color("opacity", "opacity", 1);
        put_roughness(values, d, "", 0.1);
        index();
        remap();
    } else if (type == "translucent") {
        color("kd", "Kd", 0.25);
        color("ks", "Ks", 0.25);
        color("reflect", "reflect", 0.5);
        color("transmit", "transmit", 0.5);
        put_float(values, "roughness", d, "roughness", 0.1);
        remap();
    } else if (type == "mix") {
        // v3's amount is the weight of the first material, the host's that of its second: the two are swapped.
        values.material("first", named_material(d, d.params.string("namedmaterial2", "")));
        values.material("second", named_material(d, d.params.string("namedmaterial1", "")));
        const Argument amount = color_argument(d, "amount", Role::unbounded, grey(0.5));
        if (amount.texture) {
            values.texture("amount", RESTAGE_FLOAT, amount.texture);
            import_.approximated(d.at, "material " + quote(d.name) + " (mix)",
                                 "its colour texture \"amount\" is used as a scalar");
        } else {
            const Rgb a = amount.value;
            values.number("amount", luminance(a));
            if (std::abs(a.r - a.g) + std::abs(a.g - a.b) > 1e-3)
                import_.approximated(d.at, "material " + quote(d.name) + " (mix)",
                                     "its coloured \"amount\" becomes its luminance");
        }
    } else {
        return false;
    }
    return true;
}

// Burley 2012 and 2015, as in pbrt-v3's disney.cpp, by the principled material's parameters.
void Builder::disney(const Directive& d, Values& values) {
    const auto number = [&](const char* name, double otherwise) { return float_argument(d, name, otherwise).value.r; };
    put_color(values, "base_color", d, "color", Role::albedo, {0.5, 0.5, 0.5});
    put_float(values, "metallic", d, "metallic", 0);
    put_index(values, "ior", d, "eta", 1.5);
    put_float(values, "transmission", d, "spectrans", 0);
    values.boolean("thin", d.params.boolean("thin", false));

    const Argument color = color_argument(d, "color", Role::albedo, {0.5, 0.5, 0.5});
    const double light = luminance(color.value);
    const Rgb tint = !color.texture && light > 0 ? color.value * (1 / light) : Rgb{1, 1, 1};
    const auto towards_tint = [&](double amount) {
        const auto mixed = [&](double t) { return std::clamp(1 + (t - 1) * amount, 0.0, 1.0); };
        return Rgb{mixed(tint.r), mixed(tint.g), mixed(tint.b)};
    };
    values.color("specular_color", towards_tint(number("speculartint", 0)));
    const double sheen = std::clamp(number("sheen", 0), 0.0, 1.0);
    values.color("sheen_color", towards_tint(number("sheentint", 0.5)) * sheen);
    values.number("sheen_roughness", 0.5);

    // Both widths are Disney's own: along u roughness^2 / aspect, along v roughness^2 * aspect.
    const Argument roughness = float_argument(d, "roughness", 0.5);
    const double aspect = std::sqrt(1 - 0.9 * std::clamp(number("anisotropic", 0), 0.0, 1.0));
    if (roughness.texture || aspect == 1) {
        put_float(values, "roughness", d, "roughness", 0.5);
    } else {
        const double square = roughness.value.r * roughness.value.r;
        const double along = std::min(square / aspect, 1.0), across = std::min(square * aspect, 0.999);
        values.number("roughness", std::sqrt(across));
        values.number("anisotropy", std::sqrt(std::max(along - across, 0.0) / (1 - across)));
    }
    values.number("clearcoat", 0.25 * std::clamp(number("clearcoat", 0), 0.0, 1.0));
    const double coat_alpha = 0.1 + (0.001 - 0.1) * std::clamp(number("clearcoatgloss", 1), 0.0, 1.0);
    values.number("clearcoat_roughness", std::sqrt(coat_alpha));
}

} // namespace restage::pbrt
