// SPDX-License-Identifier: Apache-2.0
// Material plugins as pbrt-v3's materials (https://pbrt.org/fileformat-v3, "Materials"). Those that v3 lacks are
// replaced by the nearest equivalent, with a line in the report.
#include "exporter.hpp"

#include <algorithm>
#include <cmath>

namespace restage::pbrt_out {

std::string Exporter::material_v3(Params& p, const RestageMaterialDesc& m, const Values& v, const std::string& what) {
    const std::string type = m.type;
    const auto unlike = [&](const char* note) { approximated(what + " (" + type + ")", note); };
    const auto color = [&](const char* id, const char* name, float otherwise) {
        put_color(p, v, id, name, {otherwise, otherwise, otherwise}, false); // v3 clamps where it evaluates
    };
    const auto rough = [&](const char* u, const char* w, bool zero_is_smooth, float otherwise = 0) {
        put_roughness(p, v, what, u, w, "uroughness", "vroughness", zero_is_smooth, otherwise);
    };
    if (v.boolean("multiscatter", false)) unlike("pbrt has single scattering between microfacets only");
    if (type == "diffuse") {
        color("reflectance", "Kd", 0.5f);
        put_float(p, v, "sigma", "sigma", 0);
        return "matte";
    }
    if (type == "conductor" && !v.boolean("use_reflectance", false)) {
        put_color(p, v, "eta", "eta", {0.200438f, 0.924033f, 1.10221f}, false);
        put_color(p, v, "k", "k", {3.91295f, 2.45285f, 2.14219f}, false);
        rough("uroughness", "vroughness", false);
        if (v.choice("distribution", "ggx") != "ggx") unlike("pbrt-v3's metal has GGX microfacets");
        return "metal";
    }
    if (type == "conductor" || type == "coatedconductor") {
        const bool coated = type == "coatedconductor", colored = v.boolean("use_reflectance", false);
        unlike(coated ? "pbrt-v3 has no coats on metal; the metal alone is written"
                      : "pbrt-v3 defines metal by its optical constants; others with that reflectance are written");
        if (colored) { // eta = 1: R = k^2 / (k^2 + 4), as pbrt-v4 does it (ConductorMaterial::GetBxDF)
            const auto r =
                v.ref("reflectance") ? average(v.ref("reflectance")) : v.color("reflectance", {0.9f, 0.9f, 0.9f});
            std::array<float, 3> k{};
            for (std::size_t i = 0; i < 3; ++i) {
                const double x = std::clamp(static_cast<double>(r[i]), 0.0, 0.9999);
                k[i] = static_cast<float>(2 * std::sqrt(x) / std::sqrt(1 - x));
            }
            p.add_rgb("eta", {1, 1, 1}).add_rgb("k", k);
        } else {
            put_color(p, v, "conductor_eta", "eta", {0.200438f, 0.924033f, 1.10221f}, false);
            put_color(p, v, "conductor_k", "k", {3.91295f, 2.45285f, 2.14219f}, false);
        }
        rough(coated ? "conductor_uroughness" : "uroughness", coated ? "conductor_vroughness" : "vroughness", false);
        return "metal";
    }
    if (type == "dielectric") {
        color("reflectance", "Kr", 1);
        color("transmittance", "Kt", 1);
        put_float(p, v, "eta", "eta", 1.5f);
        if (v.boolean("thin", false)) unlike("pbrt-v3 has no thin glass; solid glass is written");
        if (v.choice("distribution", "ggx") != "ggx") unlike("pbrt-v3's glass has GGX microfacets");
        rough("uroughness", "vroughness", true);
        return "glass";
    }
    if (type == "coateddiffuse") {
        unlike("pbrt-v3 has no layered materials; an Ashikhmin-Shirley substrate is used instead");
        color("reflectance", "Kd", 0.5f);
        const double eta = std::max(static_cast<double>(v.ref("eta") ? 1.5f : v.number("eta", 1.5f)), 1.0);
        const auto f0 =
            static_cast<float>((eta - 1) * (eta - 1) / ((eta + 1) * (eta + 1))); // Fresnel at normal incidence
        p.add_rgb("Ks", {f0, f0, f0});
        rough("uroughness", "vroughness", false);
        return "substrate";
    }
    if (type == "substrate") {
        color("kd", "Kd", 0.5f);
        color("ks", "Ks", 0.5f);
        rough("uroughness", "vroughness", false, 0.1f);
        return "substrate";
    }
    if (type == "plastic") {
        color("kd", "Kd", 0.25f);
        color("ks", "Ks", 0.25f);
        put_roughness(p, v, what, "roughness", nullptr, "roughness", nullptr, false, 0.1f);
        return "plastic";
    }
    if (type == "mirror") {
        color("kr", "Kr", 0.9f);
        return "mirror";
    }
    if (type == "uber") {
        color("kd", "Kd", 0.25f);
        color("ks", "Ks", 0.25f);
        color("kr", "Kr", 0);
        color("kt", "Kt", 0);
        color("opacity", "opacity", 1);
        put_float(p, v, "eta", "eta", 1.5f);
        rough("uroughness", "vroughness", false, 0.1f);
        return "uber";
    }
    if (type == "translucent") {
        color("kd", "Kd", 0.25f);
        color("ks", "Ks", 0.25f);
        color("reflect", "reflect", 0.5f);
        color("transmit", "transmit", 0.5f);
        put_roughness(p, v, what, "roughness", nullptr, "roughness", nullptr, false, 0.1f);
        return "translucent";
    }
    if (type == "diffusetransmission") { // exactly translucent's diffuse part
        lossy_ = true; // a different material here, but the same picture
        color("reflectance", "reflect", 0.25f);
        color("transmittance", "transmit", 0.25f);
        p.add_rgb("Kd", {1, 1, 1}).add_rgb("Ks", {0, 0, 0});
        return "translucent";
    }
    if (type == "mix") { // v3's amount is the weight of the first: the two are swapped
        p.add_string("namedmaterial1", material(v.ref("second")))
            .add_string("namedmaterial2", material(v.ref("first")));
        if (v.ref("amount")) {
            unlike("pbrt-v3 mixes by a colour texture; the mean of its scalar texture is written");
            const float mean = average(v.ref("amount"))[0];
            p.add_rgb("amount", {mean, mean, mean});
        } else {
            const float amount = v.number("amount", 0.5f);
            p.add_rgb("amount", {amount, amount, amount});
        }
        return "mix";
    }
    if (type == "interface") return "none";
    if (type == "principled") {
        unlike("pbrt-v3's disney material is written, which has the same parameters but different formulas");
        color("base_color", "color", 0.8f);
        put_float(p, v, "metallic", "metallic", 0);
        put_float(p, v, "roughness", "roughness", 0.5f); // both square it
        put_float(p, v, "ior", "eta", 1.5f);
        put_float(p, v, "transmission", "spectrans", 0);
        put_float(p, v, "clearcoat", "clearcoat", 0);
        put_float(p, v, "anisotropy", "anisotropic", 0);
        const auto sheen =
            v.ref("sheen_color") ? average(v.ref("sheen_color")) : v.color("sheen_color", {0.f, 0.f, 0.f});
        if (const float most = std::max({sheen[0], sheen[1], sheen[2]}); most > 0)
            p.add_float("sheen", most).add_float("sheentint", 0.f);
        if (v.ref("emission_color"))
            approximated(what, "pbrt's area lights have one colour; the mean of its emission's texture is written");
        if (v.ref("iridescence") || v.number("iridescence", 0) > 0)
            dropped(what, "pbrt has no thin films: its iridescence is lost");
        flag(p, "thin", v.boolean("thin", false));
        return "disney";
    }
    if (type == "hair") {
        put_color(p, v, "color", "color", {0.35f, 0.2f, 0.1f});
        put_float(p, v, "eta", "eta", 1.55f);
        put_float(p, v, "beta_m", "beta_m", 0.3f);
        put_float(p, v, "beta_n", "beta_n", 0.3f);
        put_float(p, v, "alpha", "alpha", 2);
        return "hair";
    }
    if (type == "emissive") { // the light is the shape's
        if (v.ref("radiance"))
            unlike("pbrt's area lights have one colour; the mean of its texture is written");
        else
            lossy_ = true;
        put_color(p, v, "reflectance", "Kd", {0, 0, 0});
        return "matte";
    }
    if (type == "velvet") {
        unlike("pbrt-v3 has no standing fibres; the cloth between them is written");
        put_color(p, v, "reflectance", "Kd", {0.1f, 0.02f, 0.03f});
        return "matte";
    }
    dropped(what + " (" + type + ")", "pbrt-v3 has no such material; a grey matte one is used instead");
    p.add_rgb("Kd", {0.5f, 0.5f, 0.5f});
    return "matte";
}

} // namespace restage::pbrt_out
