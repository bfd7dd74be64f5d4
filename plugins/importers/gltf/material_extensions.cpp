// SPDX-License-Identifier: Apache-2.0
// KHR_materials_*: mapped to the principled material if it has an equivalent, else to the nearest with a line in the
// report.
#include "importer.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

namespace restage::gltf {

void Importer::volume(const tinygltf::Value& v, const std::string& name, MadeMaterial& made, Values& values) {
    if (number_of(v, "thicknessFactor", 0) <= 0) return; // a pane
    values.boolean("thin", false);
    if (v.Has("thicknessTexture"))
        report_.kept("material " + quote(name) + ": thickness texture", "not needed: rays measure the thickness");
    const double distance = number_of(v, "attenuationDistance", 0) * placement_.metres;
    const Rgb color = color_of(v, "attenuationColor", {1, 1, 1});
    if (distance <= 0 || color == Rgb{1, 1, 1}) return;
    RestageMedium medium{.name = name.c_str(), .sigma_a = {}, .sigma_s = {}, .g = 0};
    for (std::size_t i = 0; i < 3; ++i) // transmittance after `distance` is the colour (Beer and Lambert)
        medium.sigma_a[i] = static_cast<float>(-std::log(std::clamp(color[i], 1e-4, 1.0)) / distance);
    made.interior = out_.medium(out_.ctx, &medium);
    made.has_interior = made.interior != 0;
}

void Importer::anisotropy(const tinygltf::Value& v, const std::string& what, MadeMaterial& made, Values& values) {
    const TextureUse use = use_of(v, "anisotropyTexture", "anisotropy");
    if (use)
        report_.approximated(what + ": anisotropy texture",
                             "its strength is rendered; the directions in it are not, only the rotation is");
    const double strength = number_of(v, "anisotropyStrength", 0);
    made.needs_tangents |= strength > 0;
    put_scalar(values, "anisotropy", strength, use, 2, made);
    values.number("anisotropy_rotation",
                  std::remainder(number_of(v, "anisotropyRotation", 0) * 180 / std::numbers::pi, 360));
}

void Importer::iridescence(const tinygltf::Value& v, MadeMaterial& made, Values& values) {
    put_scalar(values, "iridescence", number_of(v, "iridescenceFactor", 0),
               use_of(v, "iridescenceTexture", "iridescence"), 0, made);
    values.number("iridescence_ior", std::clamp(number_of(v, "iridescenceIor", 1.3), 1.0, 3.0));
    const double least = number_of(v, "iridescenceThicknessMinimum", 100),
                 most = number_of(v, "iridescenceThicknessMaximum", 400);
    const TextureUse use = use_of(v, "iridescenceThicknessTexture", "iridescence thickness");
    const RestageHandle amount = use ? texture(use, Purpose::green, made.uv, made.name) : 0;
    if (!amount) {
        values.number("iridescence_thickness", std::clamp(most, 0.0, 2000.0));
        return;
    }
    Values mix;
    mix.number("tex1", least);
    mix.number("tex2", most);
    mix.texture("amount", RESTAGE_FLOAT, amount);
    const std::string film = made.name + " film";
    const RestageTexture between = {.name = film.c_str(),
                                    .type = "mix",
                                    .is_float = 1,
                                    .image = 0,
                                    .values = mix.data(),
                                    .value_count = mix.size()};
    values.texture("iridescence_thickness", RESTAGE_FLOAT, out_.texture(out_.ctx, &between));
}

// KHR_materials_pbrSpecularGlossiness: F0 is the specular colour, so that of ior 1.5 (0.04) times 25 of it.
void Importer::glossiness(const tinygltf::Value& v, bool metal, MadeMaterial& made, Values& values) {
    const TextureUse packed = use_of(v, "specularGlossinessTexture", "specular-glossiness");
    Rgb specular = color_of(v, "specularFactor", {1, 1, 1});
    const double gloss = std::clamp(number_of(v, "glossinessFactor", 1), 0.0, 1.0);
    for (double& x : specular)
        x = std::clamp(x, 0.0, 1.0);
    values.number("metallic", metal ? 1 : 0);
    Rgb f0 = specular;
    for (double& x : f0)
        x *= 25;
    if (!metal) put_color(values, "specular_color", f0, packed, made, 25);
    const RestageHandle rough = packed ? texture(packed, Purpose::gloss, made.uv, made.name, gloss) : 0;
    if (rough)
        values.texture("roughness", RESTAGE_FLOAT, rough);
    else
        values.number("roughness", 1 - gloss);
    if (packed)
        report_.approximated("material " + quote(made.name) + ": specular-glossiness",
                             "its diffuse colour is not dimmed by the specular picture, but by what that reflects");
}

// A coat over a surface with a normal map: here both share one normal.
void Importer::clear_coat(const tinygltf::Material& m, const tinygltf::Value& v, MadeMaterial& made, Values& values) {
    const double factor = number_of(v, "clearcoatFactor", 0);
    put_scalar(values, "clearcoat", factor, use_of(v, "clearcoatTexture", "clear coat"), 0, made);
    put_scalar(values, "clearcoat_roughness", number_of(v, "clearcoatRoughnessFactor", 0),
               use_of(v, "clearcoatRoughnessTexture", "clear coat roughness"), 1, made);
    if (factor <= 0) return;
    const int own = use_of(v, "clearcoatNormalTexture", "clear coat normal").index, below = m.normalTexture.index;
    if (own == below) return;
    report_.approximated("material " + quote(made.name) + ": clear coat normals",
                         own < 0 ? "the coat is smooth in the file; here it follows the normal map below it"
                         : below < 0
                             ? "texture " + std::to_string(own) + " of the coat is left out; it is smooth"
                             : "texture " + std::to_string(own) + " of the coat is left out; it follows texture " +
                                   std::to_string(below) + ", the normal map below it");
}

// KHR_materials_dispersion: Cauchy's formula n = a + b / l^2 through the index at the d line, and an Abbe number of
// 20 / dispersion. For spectral rendering: the spectrum of the parameter `ior`; see docs/plugins.md.
std::string dispersed_index(double ior, double dispersion) {
    constexpr double d = 587.6, f = 486.1, c = 656.3; // lines [nm]
    const double b = (ior - 1) * dispersion / 20 / (1 / (f * f) - 1 / (c * c));
    std::string text;
    const auto add = [&](auto x) { // all digits, in any locale
        char digits[32];
        text.append(digits, std::to_chars(digits, digits + sizeof(digits), x).ptr) += ' ';
    };
    for (int i = 0; i < 3; ++i)
        add(static_cast<float>(ior));
    for (int nm = 360; nm <= 830; nm += 10) {
        add(nm);
        add(static_cast<float>(ior + b * (1.0 / (nm * nm) - 1 / (d * d))));
    }
    return text;
}

void Importer::extensions(const tinygltf::Material& m, const BaseColor& base, MadeMaterial& made, Values& values) {
    const std::string what = "material " + quote(m.name);
    bool transmits = false;
    for (const auto& [name, v] : m.extensions) {
        if (name == "KHR_materials_ior") {
            const double ior = number_of(v, "ior", 1.5);
            if (ior < 1 || ior > 3)
                report_.approximated(what + ": ior " + std::to_string(ior), "indices from 1 to 3 are rendered");
            made.ior = std::clamp(ior, 1.0, 3.0);
            values.number("ior", made.ior);
        } else if (name == "KHR_materials_specular") {
            const Rgb color = color_of(v, "specularColorFactor", {1, 1, 1});
            if (const double most = std::max({color[0], color[1], color[2]}); most > 25)
                report_.approximated(what + ": specular colour " + std::to_string(most),
                                     "values above 25 are taken as 25");
            put_scalar(values, "specular", number_of(v, "specularFactor", 1), use_of(v, "specularTexture", "specular"),
                       3, made);
            put_color(values, "specular_color", color, use_of(v, "specularColorTexture", "specular colour"), made, 25);
        } else if (name == "KHR_materials_transmission") {
            const double factor = number_of(v, "transmissionFactor", 0);
            transmits = factor > 0;
            put_scalar(values, "transmission", factor, use_of(v, "transmissionTexture", "transmission"), 0, made);
        } else if (name == "KHR_materials_clearcoat") {
            clear_coat(m, v, made, values);
        } else if (name == "KHR_materials_pbrSpecularGlossiness") {
            glossiness(v, base.metal, made, values);
        } else if (name == "KHR_materials_sheen") {
            put_color(values, "sheen_color", color_of(v, "sheenColorFactor", {0, 0, 0}),
                      use_of(v, "sheenColorTexture", "sheen colour"), made);
            put_scalar(values, "sheen_roughness", number_of(v, "sheenRoughnessFactor", 0),
                       use_of(v, "sheenRoughnessTexture", "sheen roughness"), 3, made);
        } else if (name == "KHR_materials_anisotropy") {
            anisotropy(v, what, made, values);
        } else if (name == "KHR_materials_iridescence") {
            iridescence(v, made, values);
        } else if (name == "KHR_materials_dispersion") {
            made.dispersion = number_of(v, "dispersion", 0);
            if (made.dispersion > 0)
                report_.approximated(what + ": dispersion", "left out in RGB; --spectral renders it");
        } else if (name == "KHR_materials_diffuse_transmission" || name == "KHR_materials_variants") {
            report_.dropped(what + ": " + name, "not rendered");
        } else if (name != "KHR_materials_volume" && name != "KHR_materials_unlit" &&
                   name != "KHR_materials_emissive_strength") {
            report_.dropped(what + ": " + name, "not known");
        }
    }
    if (!transmits) return;
    values.boolean("thin", true);
    if (const auto v = m.extensions.find("KHR_materials_volume"); v != m.extensions.end())
        volume(v->second, m.name, made, values);
}

} // namespace restage::gltf
