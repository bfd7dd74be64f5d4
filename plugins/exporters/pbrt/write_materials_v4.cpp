// SPDX-License-Identifier: Apache-2.0
// Material plugins as pbrt-v4's materials (https://pbrt.org/fileformat-v4, "Materials"). Those that v4 lacks are
// replaced by the nearest equivalent, with a line in the report.
#include "exporter.hpp"

namespace restage::pbrt_out {

std::string Exporter::material_v4(Params& p, const RestageMaterialDesc& m, const Values& v, const std::string& what) {
    const std::string type = m.type;
    const auto unlike = [&](const char* note) { approximated(what + " (" + type + ")", note); };
    const auto white = [&](const char* id) {
        const auto c = v.color(id, {1, 1, 1});
        return !v.ref(id) && c[0] == 1 && c[1] == 1 && c[2] == 1;
    };
    const auto metal = [&](const char* eta_id, const char* k_id, const char* eta, const char* k) {
        if (v.boolean("use_reflectance", false)) {
            put_color(p, v, "reflectance", "reflectance", {0.9f, 0.9f, 0.9f});
        } else {
            put_color(p, v, eta_id, eta, {0.200438f, 0.924033f, 1.10221f}, false);
            put_color(p, v, k_id, k, {3.91295f, 2.45285f, 2.14219f}, false);
        }
    };
    const auto layer = [&] {
        put_float(p, v, "thickness", "thickness", 0.01f);
        put_float(p, v, "g", "g", 0);
        put_color(p, v, "albedo", "albedo", {0, 0, 0});
        p.add_int("maxdepth", static_cast<long long>(v.number("max_depth", 10)));
        p.add_int("nsamples", static_cast<long long>(v.number("n_samples", 1)));
    };
    if (v.boolean("multiscatter", false)) unlike("pbrt has single scattering between microfacets only");
    if (type == "diffuse") {
        put_color(p, v, "reflectance", "reflectance", {0.5f, 0.5f, 0.5f});
        if (v.ref("sigma") || v.number("sigma", 0) != 0)
            unlike("pbrt-v4 has no Oren-Nayar roughness; Lambert's law is used instead");
        return "diffuse";
    }
    if (type == "conductor") {
        metal("eta", "k", "eta", "k");
        put_roughness(p, v, what, "uroughness", "vroughness", "uroughness", "vroughness", false);
        if (v.choice("distribution", "ggx") != "ggx") unlike("pbrt-v4 has GGX microfacets only");
        return "conductor";
    }
    if (type == "dielectric") {
        put_float(p, v, "eta", "eta", 1.5f);
        if (!white("reflectance") || !white("transmittance"))
            unlike("pbrt-v4's glass has no colour; clear glass is written");
        if (v.choice("distribution", "ggx") != "ggx") unlike("pbrt-v4 has GGX microfacets only");
        if (v.boolean("thin", false)) return "thindielectric";
        put_roughness(p, v, what, "uroughness", "vroughness", "uroughness", "vroughness", true);
        return "dielectric";
    }
    if (type == "coateddiffuse") {
        put_color(p, v, "reflectance", "reflectance", {0.5f, 0.5f, 0.5f});
        put_roughness(p, v, what, "uroughness", "vroughness", "uroughness", "vroughness", true);
        put_float(p, v, "eta", "eta", 1.5f);
        layer();
        return "coateddiffuse";
    }
    if (type == "coatedconductor") {
        put_roughness(p, v, what, "interface_uroughness", "interface_vroughness", "interface.uroughness",
                      "interface.vroughness", true);
        put_float(p, v, "interface_eta", "interface.eta", 1.5f);
        metal("conductor_eta", "conductor_k", "conductor.eta", "conductor.k");
        put_roughness(p, v, what, "conductor_uroughness", "conductor_vroughness", "conductor.uroughness",
                      "conductor.vroughness", false);
        layer();
        return "coatedconductor";
    }
    if (type == "diffusetransmission") {
        put_color(p, v, "reflectance", "reflectance", {0.25f, 0.25f, 0.25f});
        put_color(p, v, "transmittance", "transmittance", {0.25f, 0.25f, 0.25f});
        return "diffusetransmission";
    }
    if (type == "mix") {
        const std::string first = material(v.ref("first")), second = material(v.ref("second"));
        p.add("string", "materials", quote(first) + " " + quote(second));
        put_float(p, v, "amount", "amount", 0.5f);
        return "mix";
    }
    if (type == "interface") return "interface";
    if (type == "principled") { // by the largest component
        const auto mean = [&](const char* id, float otherwise) {
            return v.ref(id) ? average(v.ref(id))[0] : v.number(id, otherwise);
        };
        const bool metallic = mean("metallic", 0) > 0.5f, glass = !metallic && mean("transmission", 0) > 0.5f;
        unlike(metallic ? "pbrt-v4 does not have it; a conductor of its colour is used instead"
               : glass  ? "pbrt-v4 does not have it; clear glass is used instead"
                        : "pbrt-v4 does not have it; a coated diffuse material of its colour is used instead");
        if (!glass) put_color(p, v, "base_color", "reflectance", {0.8f, 0.8f, 0.8f});
        if (!metallic) put_float(p, v, "ior", "eta", 1.5f);
        if (glass && v.boolean("thin", false)) return "thindielectric";
        const float roughness = mean("roughness", 0.5f), strength = mean("anisotropy", 0);
        const float alpha = roughness * roughness;
        if (strength > 0)
            p.add_float("uroughness", alpha + (1 - alpha) * strength * strength).add_float("vroughness", alpha);
        else
            p.add_float("roughness", alpha);
        if (v.ref("sheen_color") || v.color("sheen_color", {0, 0, 0}) != std::array{0.f, 0.f, 0.f})
            dropped(what, "pbrt-v4 has no sheen");
        if (v.ref("emission_color"))
            approximated(what, "pbrt's area lights have one colour; the mean of its emission's texture is written");
        if (mean("iridescence", 0) > 0) dropped(what, "pbrt has no thin films: its iridescence is lost");
        flag(p, "remaproughness", false);
        return metallic ? "conductor" : glass ? "dielectric" : "coateddiffuse";
    }
    if (type == "substrate" || type == "plastic" || type == "uber") {
        unlike("pbrt-v4 does not have it; a coated diffuse material of its colour and roughness is used instead");
        put_color(p, v, "kd", "reflectance",
                  type == "substrate" ? std::array{0.5f, 0.5f, 0.5f} : std::array{0.25f, 0.25f, 0.25f});
        if (type == "plastic")
            put_roughness(p, v, what, "roughness", nullptr, "roughness", nullptr, true, 0.1f);
        else
            put_roughness(p, v, what, "uroughness", "vroughness", "uroughness", "vroughness", true, 0.1f);
        if (type == "uber") put_float(p, v, "eta", "eta", 1.5f);
        return "coateddiffuse";
    }
    if (type == "mirror") {
        unlike("pbrt-v4 does not have it; a smooth conductor of that reflectance is used instead");
        put_color(p, v, "kr", "reflectance", {0.9f, 0.9f, 0.9f});
        p.add_float("roughness", 0.f);
        return "conductor";
    }
    if (type == "translucent") {
        unlike("pbrt-v4 does not have it; its diffuse part is written as diffuse transmission");
        const auto kd = v.ref("kd") ? average(v.ref("kd")) : v.color("kd", {0.25f, 0.25f, 0.25f});
        for (const auto& [id, name] : {std::pair{"reflect", "reflectance"}, {"transmit", "transmittance"}}) {
            const auto side = v.ref(id) ? average(v.ref(id)) : v.color(id, {0.5f, 0.5f, 0.5f});
            p.add_rgb(name, {kd[0] * side[0], kd[1] * side[1], kd[2] * side[2]});
        }
        return "diffusetransmission";
    }
    if (type == "hair") {
        put_color(p, v, "color", "reflectance", {0.35f, 0.2f, 0.1f});
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
        put_color(p, v, "reflectance", "reflectance", {0, 0, 0});
        return "diffuse";
    }
    if (type == "velvet") {
        unlike("pbrt-v4 has no standing fibres; the cloth between them is written");
        put_color(p, v, "reflectance", "reflectance", {0.1f, 0.02f, 0.03f});
        return "diffuse";
    }
    dropped(what + " (" + type + ")", "pbrt-v4 has no such material; a grey diffuse one is used instead");
    p.add_rgb("reflectance", {0.5f, 0.5f, 0.5f});
    return "diffuse";
}

} // namespace restage::pbrt_out
