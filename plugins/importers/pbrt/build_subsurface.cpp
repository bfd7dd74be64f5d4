// SPDX-License-Identifier: Apache-2.0
// Light under the surface is not simulated: an opaque material that reflects as much, of the same colour, replaces
// pbrt's subsurface and kdsubsurface.
#include "builder.hpp"
#include "medium_data.hpp"

#include <algorithm>
#include <cmath>

namespace restage::pbrt {

namespace {

// Diffuse reflectance of the inside of a smooth dielectric: W. G. Egan, T. Hilgeman, "Optical Properties of
// Inhomogeneous Materials", 1979, as in Jensen et al. 2001 (after Eq. 6).
double internal_reflectance(double eta) { return -1.440 / (eta * eta) + 0.710 / eta + 0.668 + 0.0636 * eta; }

// Fraction of diffuse light that a half space of this albedo reflects: Jensen et al. 2001, Eq. 15.
double diffuse_reflectance(double absorption, double reduced_scattering, double eta) {
    const double extinction = absorption + reduced_scattering;
    const double albedo = extinction > 0 ? reduced_scattering / extinction : 1;
    const double inside = internal_reflectance(eta);
    const double a = (1 + inside) / (1 - inside), t = std::sqrt(3 * std::max(0.0, 1 - albedo));
    return albedo / 2 * (1 + std::exp(-4.0 / 3 * a * t)) * std::exp(-t);
}

// The albedo of a diffuse base that reflects `all` through a smooth coat, including interreflection under the coat.
double base_under_coat(double all, double eta) {
    const double inside = internal_reflectance(eta);
    return all / (1 - inside + inside * all);
}

} // namespace

// The fraction of entering light that leaves again, as a colour or a texture.
Argument Builder::subsurface_reflectance(const Directive& d, const std::string& type, double eta) {
    const Rgb half{0.5, 0.5, 0.5};
    if (type == "kdsubsurface") return color_argument(d, "Kd", Role::albedo, half);
    const std::string name = d.params.string("name", "");
    const MediumPreset* preset = medium_preset(name.empty() ? default_medium : name);
    if (!preset) {
        import_.warned(d.at, "Material " + quote(type),
                       "no medium is called " + quote(name) + "; whole milk is used instead");
        preset = medium_preset(default_medium);
    }
    const bool measured = import_.v3() || d.params.has("sigma_a") || d.params.has("sigma_s");
    if (name.empty() && !measured && d.params.has("reflectance"))
        return color_argument(d, "reflectance", Role::albedo, half);
    // v4: a name excludes the coefficients; v3: they default to the name's.
    const bool given = name.empty() || import_.v3();
    const auto coefficient = [&](const char* of, Rgb otherwise) {
        Argument out{0, otherwise};
        if (given) out = color_argument(d, of, Role::unbounded, otherwise);
        if (out.texture == 0) return out.value;
        const auto value = constant_of(out.texture);
        if (!value)
            import_.approximated(d.at, "Material " + quote(type),
                                 std::string("its textured \"") + of + "\" is taken as the default's");
        return value.value_or(otherwise);
    };
    const Rgb absorption = coefficient("sigma_a", preset->absorption),
              scattering = coefficient("sigma_s", preset->scattering);
    const double g = name.empty() ? d.params.number("g", 0) : 0; // a name's are already reduced
    const auto of = [&](double absorbed, double scattered) {
        return diffuse_reflectance(absorbed, scattered * (1 - g), eta);
    };
    return {0, {of(absorption.r, scattering.r), of(absorption.g, scattering.g), of(absorption.b, scattering.b)}};
}

// Returns the note of the report.
std::string Builder::subsurface(const Directive& d, const std::string& type, Values& values, std::string& plugin) {
    const double index = float_argument(d, "eta", 1.33).value.r, eta = index > 1 && index < 4 ? index : 1.33;
    Argument all = subsurface_reflectance(d, type, eta);
    if (const auto value = constant_of(all.texture)) all = {0, *value};
    put_index(values, "eta", d, "eta", 1.33);
    put_roughness(values, d, "", 0);
    values.choice("remap", !d.params.boolean("remaproughness", true) ? "none" : import_.v3() ? "v3" : "v4");
    if (all.texture) { // transmission through a coat is not linear in the texture: use a gloss over it, which only adds
        plugin = "uber";
        const bool rough = d.params.has("roughness") || d.params.has("uroughness") || d.params.has("vroughness");
        const double facing = (eta - 1) / (eta + 1) * ((eta - 1) / (eta + 1));
        values.texture("kd", RESTAGE_COLOR, scaled_texture(all.texture, 1 - facing, false));
        for (const char* lobe : {"ks", "kr", "kt"}) {
            const double share = std::string_view(lobe) == (rough ? "ks" : "kr") ? 1 : 0;
            values.color(lobe, {share, share, share});
        }
        values.color("opacity", {1, 1, 1});
        return "light under the surface is not simulated; an opaque one with its texture under a gloss is used instead";
    }
    plugin = "coateddiffuse";
    const Rgb c = all.value;
    values.color("reflectance", {base_under_coat(c.r, eta), base_under_coat(c.g, eta), base_under_coat(c.b, eta)});
    return "light under the surface is not simulated; a coated diffuse one that reflects as much is used instead";
}

} // namespace restage::pbrt
