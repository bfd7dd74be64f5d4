// SPDX-License-Identifier: Apache-2.0
// Material plugins as Mitsuba's BSDFs, which see one side only: all that transmit nothing are wrapped in `twosided`.
#include "exporter.hpp"

#include "common/text.hpp"

#include <algorithm>
#include <cmath>

namespace restage::mitsuba_out {

namespace {

constexpr double smooth_alpha = 1e-3; // pbrt's and ours: less is a perfect mirror

float alpha_v4(float x) { return static_cast<float>(alpha_of_roughness(static_cast<double>(x), "v4")); }
float alpha_v3(float x) { return static_cast<float>(alpha_of_roughness(static_cast<double>(x), "v3")); }
Function alpha_function(const Values& v) {
    const std::string remap = v.choice("remap", "v4");
    return remap == "none" ? nullptr : remap == "v3" ? alpha_v3 : alpha_v4;
}

// Of a metal of index 1 with that reflectance at normal incidence: pbrt 4ed, 9.3.
float absorption(float r) {
    return 2 * std::sqrt(std::clamp(r, 0.f, 0.9999f)) / std::sqrt(1 - std::clamp(r, 0.f, 0.9999f));
}

bool transmits(const std::string& type, const Values& v) {
    if (type == "principled") return v.ref("transmission") || v.number("transmission", 0) > 0;
    return type == "dielectric" || type == "diffusetransmission" || type == "translucent" || type == "interface" ||
           type == "mix";
}

} // namespace

float Exporter::mean(const Values& v, const char* id, float otherwise) {
    return v.ref(id) ? average(in_, v.ref(id))[0] : v.number(id, otherwise);
}

double Exporter::least_alpha(const Values& v, const char* u_id, const char* v_id, float otherwise) {
    double least = 1;
    for (const char* id : {u_id, v_id})
        if (!v.ref(id))
            least = std::min(least, alpha_of_roughness(double(v.number(id, otherwise)), v.choice("remap", "v4")));
    return least;
}

void Exporter::put_alpha(Xml& xml, const Values& v, const char* u_id, const char* v_id, float otherwise) {
    const Function alpha = alpha_function(v);
    for (const auto& [id, name] : {std::pair{u_id, "alpha_u"}, {v_id, "alpha_v"}})
        if (v.ref(id))
            put_texture(xml, name, v.ref(id), true, alpha);
        else
            xml.put(name, std::max(alpha ? alpha(v.number(id, otherwise)) : v.number(id, otherwise), 1e-4f));
}

void Exporter::put_metal(Xml& xml, const Values& v, const char* eta_id, const char* k_id) {
    if (v.boolean("use_reflectance", false)) {
        xml.put("eta", 1.f);
        if (v.ref("reflectance")) return put_texture(xml, "k", v.ref("reflectance"), false, absorption);
        Color k = v.color("reflectance", {0.9f, 0.9f, 0.9f});
        std::transform(k.begin(), k.end(), k.begin(), absorption);
        return xml.rgb("k", k);
    }
    for (const auto& [id, name, copper] : {std::tuple{eta_id, "eta", Color{0.200438f, 0.924033f, 1.102212f}},
                                           {k_id, "k", Color{3.912949f, 2.452848f, 2.142188f}}})
        if (v.ref(id))
            put_texture(xml, name, v.ref(id), false);
        else
            xml.rgb(name, v.color(id, copper));
}

// Mitsuba's rough plastic has one alpha, a number.
void Exporter::plastic(Xml& xml, const Values& v, const char* color_id, Color otherwise, const char* u_id,
                       const char* v_id, float roughness, float eta, const std::string& what) {
    const std::string remap = v.choice("remap", std::string_view(color_id) == "kd" ? "v3" : "v4");
    const auto alpha_of = [&](const char* id) { return alpha_of_roughness(double(mean(v, id, roughness)), remap); };
    const double a = alpha_of(u_id), b = alpha_of(v_id), alpha = std::sqrt(a * b);
    if (v.ref(u_id) || v.ref(v_id))
        approximated(what, "Mitsuba's plastic has one roughness: the mean of its texture is written");
    if (a != b)
        approximated(what, "Mitsuba's plastic is equally rough in all directions: the geometric mean is written");
    const bool smooth = std::min(a, b) < smooth_alpha;
    xml.open("bsdf", smooth ? "plastic" : "roughplastic");
    put_color(xml, "diffuse_reflectance", v, color_id, otherwise);
    xml.put("int_ior", eta);
    xml.put("ext_ior", 1.f);
    xml.flag("nonlinear", true);
    if (!smooth) {
        xml.put("distribution", std::string_view("ggx"));
        xml.put("alpha", alpha);
    }
    xml.close();
}

// A leaf: Disney's thin model without a mirror part. diff_trans is 2 where all is transmitted.
void Exporter::thin_diffuse(Xml& xml, const Color& reflected, const Color& transmitted) {
    Color sum{};
    float share = 0, all = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        sum[c] = std::min(reflected[c] + transmitted[c], 1.f);
        share += transmitted[c];
        all += reflected[c] + transmitted[c];
    }
    xml.open("bsdf", "principledthin");
    xml.rgb("base_color", sum);
    xml.put("diff_trans", all > 0 ? 2 * share / all : 0.f);
    xml.put("eta", 1.f);
    xml.put("roughness", 0.5f);
    xml.close();
}

void Exporter::principled(Xml& xml, const Values& v, const std::string& what) {
    const bool thin = v.boolean("thin", false);
    approximated(what, "Mitsuba's principled model is Disney's, ours glTF's: values are the same, the lobes similar");
    xml.open("bsdf", thin ? "principledthin" : "principled");
    put_color(xml, "base_color", v, "base_color", {0.8f, 0.8f, 0.8f});
    put_number(xml, "roughness", v, "roughness", 0.5f);
    if (v.ref("transmission") || v.number("transmission", 0) > 0) put_number(xml, "spec_trans", v, "transmission", 0);
    if (v.ref("anisotropy") || v.number("anisotropy", 0) > 0) put_number(xml, "anisotropic", v, "anisotropy", 0);
    xml.put("eta", std::max(v.number("ior", 1.5f), 1.001f));
    if (!thin) {
        put_number(xml, "metallic", v, "metallic", 0);
        if (v.ref("clearcoat") || v.number("clearcoat", 0) > 0) {
            put_number(xml, "clearcoat", v, "clearcoat", 0);
            const float rough = mean(v, "clearcoat_roughness", 0); // Disney: alpha from 0.1 (gloss 0) to 0.001 (1)
            xml.put("clearcoat_gloss", std::clamp((0.1f - rough * rough) / 0.099f, 0.f, 1.f));
        }
    } else if (mean(v, "metallic", 0) > 0 || mean(v, "clearcoat", 0) > 0) {
        dropped(what, "Mitsuba's thin model is never metal or varnished");
    }
    const auto sheen = v.ref("sheen_color") ? average(in_, v.ref("sheen_color")) : v.color("sheen_color", {0, 0, 0});
    if (const float most = *std::max_element(sheen.begin(), sheen.end()); most > 0) {
        xml.put("sheen", most);
        approximated(what, "Disney's sheen is another, and takes its colour from the base");
    }
    if (mean(v, "iridescence", 0) > 0) dropped(what, "Mitsuba's principled model has no thin films");
    if (mean(v, "specular", 1) != 1 || v.ref("specular_color") ||
        v.color("specular_color", {1, 1, 1}) != Color{1, 1, 1})
        dropped(what, "Mitsuba gives its reflection by the index of refraction alone, without strength and tint");
    if (v.number("anisotropy_rotation", 0) != 0) dropped(what, "Mitsuba cannot turn the direction of anisotropy");
    xml.close();
}

void Exporter::surface(Xml& xml, const RestageMaterialDesc& m, const Values& v, const std::string& what) {
    const std::string type = m.type;
    const std::string named = what + " (" + type + ")";
    const auto unlike = [&](const char* note) { approximated(named, note); };
    const auto diffuse = [&](const char* id, Color otherwise) {
        xml.open("bsdf", "diffuse");
        put_color(xml, "reflectance", v, id, otherwise);
        xml.close();
    };
    const auto of_both = [&](const char* id, float otherwise) {
        return v.ref(id) ? average(in_, v.ref(id)) : v.color(id, {otherwise, otherwise, otherwise});
    };
    if (v.boolean("multiscatter", false)) unlike("Mitsuba has single scattering between microfacets only");
    if (type == "diffuse") {
        if (v.ref("sigma") || v.number("sigma", 0) != 0)
            unlike("Mitsuba has no Oren-Nayar roughness; Lambert's law is used");
        return diffuse("reflectance", {0.5f, 0.5f, 0.5f});
    }
    if (type == "conductor" || type == "coatedconductor") {
        const bool coated = type == "coatedconductor";
        if (coated) unlike("Mitsuba has no varnished metal; the metal is written without its coat");
        const char *u = coated ? "conductor_uroughness" : "uroughness",
                   *w = coated ? "conductor_vroughness" : "vroughness";
        const bool smooth = least_alpha(v, u, w, 0) < smooth_alpha;
        xml.open("bsdf", smooth ? "conductor" : "roughconductor");
        put_metal(xml, v, coated ? "conductor_eta" : "eta", coated ? "conductor_k" : "k");
        if (!smooth) {
            xml.put("distribution", std::string_view(v.choice("distribution", "ggx")));
            put_alpha(xml, v, u, w, 0);
        }
        return xml.close();
    }
    if (type == "dielectric") {
        const bool thin = v.boolean("thin", false),
                   smooth = least_alpha(v, "uroughness", "vroughness", 0) < smooth_alpha;
        xml.open("bsdf", thin ? "thindielectric" : smooth ? "dielectric" : "roughdielectric");
        xml.put("int_ior", v.number("eta", 1.5f));
        xml.put("ext_ior", 1.f);
        for (const auto& [id, name] :
             {std::pair{"reflectance", "specular_reflectance"}, {"transmittance", "specular_transmittance"}})
            if (v.ref(id) || v.color(id, {1, 1, 1}) != Color{1, 1, 1}) put_color(xml, name, v, id, {1, 1, 1});
        if (!thin && !smooth) {
            xml.put("distribution", std::string_view(v.choice("distribution", "ggx")));
            put_alpha(xml, v, "uroughness", "vroughness", 0);
        }
        return xml.close();
    }
    if (type == "coateddiffuse") {
        unlike(
            "Mitsuba's plastic is the nearest: light scattered inside by a diffuse base, without a medium in the coat");
        return plastic(xml, v, "reflectance", {0.5f, 0.5f, 0.5f}, "uroughness", "vroughness", 0, mean(v, "eta", 1.5f),
                       what);
    }
    if (type == "substrate" || type == "plastic" || type == "uber") {
        unlike("Mitsuba's plastic of its colour and roughness is written");
        if (type == "uber" && (of_both("kt", 0) != Color{} || of_both("opacity", 1) != Color{1, 1, 1}))
            dropped(named, "the light that it lets pass");
        const bool one = type == "plastic";
        const Color grey = type == "substrate" ? Color{0.5f, 0.5f, 0.5f} : Color{0.25f, 0.25f, 0.25f};
        return plastic(xml, v, "kd", grey, one ? "roughness" : "uroughness", one ? "roughness" : "vroughness", 0.1f,
                       v.number("eta", 1.5f), what);
    }
    if (type == "mirror") {
        xml.open("bsdf", "conductor");
        xml.put("material", std::string_view("none"));
        put_color(xml, "specular_reflectance", v, "kr", {0.9f, 0.9f, 0.9f});
        return xml.close();
    }
    if (type == "diffusetransmission" || type == "translucent") {
        Color reflected, transmitted;
        if (type == "translucent") {
            unlike("the diffuse part of it is written as Mitsuba's thin principled model");
            const auto kd = of_both("kd", 0.25f), r = of_both("reflect", 0.5f), t = of_both("transmit", 0.5f);
            for (std::size_t c = 0; c < 3; ++c) {
                reflected[c] = kd[c] * r[c];
                transmitted[c] = kd[c] * t[c];
            }
        } else {
            unlike(
                "Mitsuba's thin principled model is written: the share of light that passes is one number, textures "
                "are "
                "their mean");
            reflected = of_both("reflectance", 0.25f);
            transmitted = of_both("transmittance", 0.25f);
        }
        return thin_diffuse(xml, reflected, transmitted);
    }
    if (type == "mix") {
        const std::string first = material(v.ref("first")), second = material(v.ref("second"));
        xml.open("bsdf", "blendbsdf");
        put_number(xml, "weight", v, "amount", 0.5f);
        xml.ref(first);
        xml.ref(second);
        return xml.close();
    }
    if (type == "interface") {
        xml.open("bsdf", "null");
        return xml.close();
    }
    if (type == "principled") return principled(xml, v, named);
    if (type == "emissive") return diffuse("reflectance", {0, 0, 0}); // the light is the shape's
    if (type == "velvet") {
        unlike("Mitsuba has no standing fibres; the cloth between them is written");
        return diffuse("reflectance", {0.1f, 0.02f, 0.03f});
    }
    if (type == "hair") {
        unlike("Mitsuba has hair on curves only; a diffuse surface of its colour is written");
        return diffuse("color", {0.35f, 0.2f, 0.1f});
    }
    dropped(named, "Mitsuba has no such material; a grey diffuse one is written");
    diffuse("reflectance", {0.5f, 0.5f, 0.5f});
}

std::string Exporter::material(RestageHandle handle) {
    if (const auto it = material_ids_.find(handle); it != material_ids_.end()) return it->second;
    RestageMaterialDesc m{};
    const bool known = in_.material(in_.ctx, handle, &m) != 0;
    const std::string id = unique_id("material", known ? m.name : "");
    material_ids_[handle] = id;
    Xml xml(1); // a mix writes its parts first
    if (!known) m = {.name = "", .type = "diffuse", .values = nullptr, .value_count = 0};
    const std::string what = std::string("material \"") + m.name + "\"";
    if (known) report_kept(*m.origin, what);
    const Values v(m.values, m.value_count);
    RestageHandle bump = v.ref("bump"), normals = v.ref("normalmap");
    if ((bump || normals) && std::string_view(m.type) == "mix") {
        dropped(what, "a bump or normal map of a mix");
        bump = normals = 0;
    }
    const bool one_sided = !transmits(m.type, v);
    xml.name_next(id);
    if (one_sided) xml.open("bsdf", "twosided");
    if (bump) {
        xml.open("bsdf", "bumpmap");
        put_texture(xml, "height", bump, true);
    }
    if (normals) {
        xml.open("bsdf", "normalmap");
        put_texture(xml, "normalmap", normals, false);
    }
    surface(xml, m, v, what);
    for (const bool opened : {normals != 0, bump != 0, one_sided})
        if (opened) xml.close();
    materials_.add(xml);
    return id;
}

std::string Exporter::cut_out(RestageHandle handle, const RestageInstance& i) {
    const std::string whole = material(handle);
    if (!i.alpha_texture && i.alpha >= 1) return whole;
    const std::string what = std::string("alpha of \"") + i.name + "\"";
    const bool mask = (i.flags & RESTAGE_INSTANCE_ALPHA_MASK) != 0;
    if (mask && !i.alpha_texture && i.alpha > 0) return whole;
    if (mask && i.alpha_texture)
        approximated(what, "a mask becomes a fraction: Mitsuba lets rays pass where alpha is between 0 and 1");
    std::string& id = cut_outs_[whole + " " + std::to_string(i.alpha_texture) + " " + number(i.alpha)];
    if (!id.empty()) return id;
    id = unique_id("cutout", whole);
    Xml xml(1);
    xml.open("bsdf", "mask", id);
    if (i.alpha_texture)
        put_texture(xml, "opacity", i.alpha_texture, true);
    else
        xml.put("opacity", i.alpha);
    xml.ref(whole);
    xml.close();
    materials_.add(xml);
    return id;
}

} // namespace restage::mitsuba_out
