// SPDX-License-Identifier: Apache-2.0
// MTL materials as the nearest of ours: principled where the PBR extension is used, else by what the classic statements
// describe. Bourke's page on MTL and Alias|Wavefront's manual, appendix B, say what they mean.
#include "common/file.hpp"
#include "importer.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace restage::obj {

struct Importer::Slot { // one map_... statement
    std::string material, key;
    const std::string& file;
    const tinyobj::texture_option_t& options;
    std::uint32_t line;
    std::filesystem::path library;
    std::string what() const { return "material " + quote(material) + ": " + key; }
};

namespace {

Rgb rgb(const float* v) { return {v[0], v[1], v[2]}; }
double largest(const Rgb& c) { return std::max({c[0], c[1], c[2]}); }
Rgb clamped(const Rgb& c) {
    return {std::clamp(c[0], 0.0, 1.0), std::clamp(c[1], 0.0, 1.0), std::clamp(c[2], 0.0, 1.0)};
}
// Blinn-Phong's exponent as the alpha of GGX: Walter et al. 2007, sec. 5.2 (alpha_p = 2 / alpha^2 - 2).
double alpha_from_exponent(double exponent) {
    return std::clamp(std::sqrt(2 / (std::max(exponent, 0.0) + 2)), 0.0, 1.0);
}

// Normal maps are blue: x and y around one half, z near one.
bool looks_like_normals(const Picture& picture) {
    if (picture.channels < 3) return false;
    const Rgb mean = average_color(picture, false);
    return std::abs(mean[0] - 0.5) < 0.12 && std::abs(mean[1] - 0.5) < 0.12 && mean[2] > 0.75;
}

} // namespace

Mapping Importer::mapping(const Slot& slot) {
    const auto& o = slot.options;
    if (o.turbulence[0] != 0 || o.turbulence[1] != 0)
        report_.dropped(slot.what() + " -t", "turbulence is not known", slot.line, slot.library.string());
    if (o.brightness != 0 || o.contrast != 1)
        report_.dropped(slot.what() + " -mm", "the picture is used as it is", slot.line, slot.library.string());
    return {.scale_u = o.scale[0],
            .scale_v = o.scale[1],
            .offset_u = o.origin_offset[0],
            .offset_v = o.origin_offset[1],
            .wrap = o.clamp ? "clamp" : "repeat"};
}

RestageHandle Importer::color_texture(const Slot& slot, const Rgb& factor) {
    const std::string path = find_file(slot.library.parent_path(), slot.file).string();
    const bool linear = lower(slot.options.colorspace) == "linear";
    const RestageHandle image = add_image_file(out_, path, linear ? RESTAGE_LINEAR : RESTAGE_SRGB);
    const std::string name = slot.material + " " + slot.key;
    return add_scaled(out_, name + " scaled", add_imagemap(out_, name, image, false, mapping(slot)), false, factor);
}

RestageHandle Importer::scalar_texture(const Slot& slot, double factor, bool invert) {
    const std::string path = find_file(slot.library.parent_path(), slot.file).string();
    const RestageHandle image = add_image_file(out_, path, RESTAGE_LINEAR);
    return add_imagemap(out_, slot.material + " " + slot.key, image, true, mapping(slot), factor, invert);
}

// map_d: the alpha channel where the picture has one that says something, else its brightness.
RestageHandle Importer::alpha_texture(const Slot& slot, double factor) {
    const std::string path = find_file(slot.library.parent_path(), slot.file).string();
    std::string reason;
    const auto picture = read_picture(path, reason);
    if (!picture || !picture->alpha_varies())
        return scalar_texture(slot, factor); // the host says what is wrong with it
    const std::string name = slot.material + " " + slot.key;
    const RestageHandle image = add_pixels(out_, name, picture->width, picture->height, 1,
                                           [&](std::size_t pixel, unsigned) { return picture->value(pixel, 3); });
    return add_imagemap(out_, name, image, true, mapping(slot), factor);
}

void Importer::bump(const Slot& slot, Values& values) {
    const std::string path = find_file(slot.library.parent_path(), slot.file).string();
    std::string reason;
    const auto picture = read_picture(path, reason);
    if (picture && looks_like_normals(*picture)) {
        report_.approximated(slot.what(), "the picture holds normals, not heights; it is used as a normal map",
                             slot.line, slot.library.string());
        values.texture("normalmap", RESTAGE_TEXTURE,
                       add_imagemap(out_, slot.material + " normals", add_image_file(out_, path, RESTAGE_LINEAR), false,
                                    mapping(slot)));
        return;
    }
    Bounds all; // heights have no unit in MTL
    for (std::size_t i = 0; i + 2 < attributes_.vertices.size(); i += 3)
        all.add({attributes_.vertices[i], attributes_.vertices[i + 1], attributes_.vertices[i + 2]});
    report_.approximated(slot.what(), "heights have no unit here; white is taken as 1/200 of the model's size high",
                         slot.line, slot.library.string());
    values.texture("bump", RESTAGE_TEXTURE,
                   scalar_texture(slot, slot.options.bump_multiplier * 0.005 * 2 * all.radius()));
}

void Importer::emission(const tinyobj::material_t& m, MadeMaterial& made) {
    const Rgb ke = rgb(m.emission);
    made.emits = largest(ke) > 0;
    made.emission = {std::max(ke[0], 0.0), std::max(ke[1], 0.0), std::max(ke[2], 0.0)};
}

const MadeMaterial& Importer::material(int id) {
    const auto known = made_.find(id);
    if (known != made_.end()) return known->second;
    if (id >= 0) return made_[id] = make_material(materials_[static_cast<std::size_t>(id)]);
    Values values;
    values.color("reflectance", {0.5, 0.5, 0.5});
    const RestageMaterialDesc grey = {
        .text = {"grey", "", ""}, .type = "diffuse", .values = values.data(), .value_count = values.size()};
    MadeMaterial made;
    made.material = out_.material(out_.ctx, &grey);
    return made_[id] = made;
}

MadeMaterial Importer::make_material(const tinyobj::material_t& m) {
    std::filesystem::path file;
    MtlEntry entry;
    for (const auto& library : libraries_)
        for (const auto& [name, found] : library.entries)
            if (name == m.name || name == m.name.substr(0, m.name.find_last_not_of(" \t") + 1)) {
                file = library.path;
                entry = found;
            }
    const auto line = [&](const char* key) {
        const auto it = entry.keys.find(key);
        return it == entry.keys.end() ? entry.line : it->second;
    };
    const std::string what = "material " + quote(m.name);
    const auto slot = [&](const char* key, const std::string& name, const tinyobj::texture_option_t& options) {
        return Slot{m.name, key, name, options, line(key), file};
    };
    const auto dropped = [&](const char* key, const char* note) {
        report_.dropped(what + ": " + key, note, line(key), file.string());
    };

    Values values;
    MadeMaterial made;
    const auto put_color = [&](const char* id, Rgb factor, const char* key, const std::string& name,
                               const tinyobj::texture_option_t& options) {
        if (largest(factor) > 1)
            report_.approximated(what, "a reflectance above 1 is taken as 1", entry.line, file.string());
        factor = clamped(factor);
        if (!name.empty() && largest(factor) <= 0) {
            report_.approximated(what, "a picture times black is taken as the picture", line(key), file.string());
            factor = {1, 1, 1};
        }
        const RestageHandle texture = name.empty() ? 0 : color_texture(slot(key, name, options), factor);
        if (texture)
            values.texture(id, RESTAGE_COLOR, texture);
        else
            values.color(id, factor);
    };
    const auto put_scalar = [&](const char* id, double factor, const char* key, const std::string& name,
                                const tinyobj::texture_option_t& options) {
        const RestageHandle texture = name.empty() ? 0 : scalar_texture(slot(key, name, options));
        if (texture)
            values.texture(id, RESTAGE_FLOAT, texture);
        else
            values.number(id, factor);
    };

    const Rgb kd = rgb(m.diffuse), ks = rgb(m.specular);
    const bool pbr = [&] {
        for (const char* key : {"Pr", "map_Pr", "Pm", "map_Pm", "Ps", "map_Ps", "Pc", "Pcr", "aniso"})
            if (entry.has(key)) return true;
        return false;
    }();
    const int illum = entry.has("illum") ? m.illum : 2;
    const bool filtered = entry.has("Tf") || entry.has("Kt");
    const bool refracts = illum == 6 || illum == 7 || ((illum == 4 || illum == 9) && (m.dissolve < 1 || filtered));
    const bool matte = illum == 0 || illum == 1 || (largest(ks) <= 0 && m.specular_texname.empty());
    const bool metal = !matte && largest(kd) <= 0 && m.diffuse_texname.empty();
    const double alpha = alpha_from_exponent(m.shininess);
    const char* type = "uber";
    if (pbr) {
        type = "principled";
        put_color("base_color", kd, "map_Kd", m.diffuse_texname, m.diffuse_texopt);
        put_scalar("roughness", std::clamp(double(m.roughness), 0.0, 1.0), "map_Pr", m.roughness_texname,
                   m.roughness_texopt);
        put_scalar("metallic", std::clamp(double(m.metallic), 0.0, 1.0), "map_Pm", m.metallic_texname,
                   m.metallic_texopt);
        if (entry.has("Ni") && m.ior > 1) values.number("ior", std::clamp(double(m.ior), 1.0, 3.0));
        if (entry.has("Pc")) values.number("clearcoat", std::clamp(double(m.clearcoat_thickness), 0.0, 1.0));
        if (entry.has("Pcr")) values.number("clearcoat_roughness", std::clamp(double(m.clearcoat_roughness), 0.0, 1.0));
        for (const char* key : {"Ps", "map_Ps", "aniso", "anisor"})
            if (entry.has(key)) dropped(key, "there is no sheen or anisotropy in the principled material");
    } else if (refracts) {
        type = "dielectric";
        values.number("eta", m.ior > 1.0001f ? std::clamp(double(m.ior), 1.0, 3.0) : 1.5);
        if (filtered && largest(rgb(m.transmittance)) > 0) values.color("transmittance", clamped(rgb(m.transmittance)));
        report_.kept(what, "illum " + std::to_string(illum) + " refracts: it is glass", line("illum"), file.string());
    } else if (matte) {
        type = "diffuse";
        put_color("reflectance", kd, "map_Kd", m.diffuse_texname, m.diffuse_texopt);
    } else if (metal) {
        type = "conductor";
        values.boolean("use_reflectance", true);
        put_color("reflectance", ks, "map_Ks", m.specular_texname, m.specular_texopt);
        values.choice("remap", "none");
        for (const char* id : {"uroughness", "vroughness"})
            values.number(id, illum == 3 || illum == 5 ? 0 : alpha); // 3, 5: mirrors
    } else {
        put_color("kd", kd, "map_Kd", m.diffuse_texname, m.diffuse_texopt);
        put_color("ks", ks, "map_Ks", m.specular_texname, m.specular_texopt);
        if (entry.has("Ni") && m.ior > 1.0001f) values.number("eta", std::clamp(double(m.ior), 1.0, 3.0));
        values.choice("remap", "none");
        for (const char* id : {"uroughness", "vroughness"})
            values.number(id, alpha);
        report_.approximated("material " + quote(m.name),
                             "Phong's highlight (Ks, Ns) becomes GGX with Fresnel reflection", entry.line,
                             file.string());
    }

    if (!m.normal_texname.empty()) {
        const Slot s = slot("norm", m.normal_texname, m.normal_texopt);
        const std::string path = find_file(file.parent_path(), s.file).string();
        values.texture(
            "normalmap", RESTAGE_TEXTURE,
            add_imagemap(out_, m.name + " norm", add_image_file(out_, path, RESTAGE_LINEAR), false, mapping(s)));
    } else if (!m.bump_texname.empty()) {
        const char* key = entry.has("bump") ? "bump" : entry.has("map_Bump") ? "map_Bump" : "map_bump";
        bump(slot(key, m.bump_texname, m.bump_texopt), values);
    }
    if (!refracts) {
        made.alpha = std::clamp(m.dissolve, 0.f, 1.f);
        if (!m.alpha_texname.empty())
            made.alpha_texture = alpha_texture(slot("map_d", m.alpha_texname, m.alpha_texopt), made.alpha);
    }
    emission(m, made);
    if (!m.emissive_texname.empty()) dropped("map_Ke", "a surface emits evenly; its Ke alone is used");
    if (!m.specular_highlight_texname.empty()) dropped("map_Ns", "the highlight's size is taken from Ns alone");
    if (!m.displacement_texname.empty()) dropped("disp", "surfaces are not displaced");
    if (!m.reflection_texname.empty()) dropped("refl", "the scene itself is reflected");
    if (!m.ambient_texname.empty() && m.ambient_texname != m.diffuse_texname)
        dropped("map_Ka", "ambient light is computed, not painted");
    for (const auto& [key, value] : m.unknown_parameter)
        dropped(key.c_str(), "it is not understood");

    const std::string name = m.name.empty() ? "material" : m.name;
    const RestageMaterialDesc desc = {
        .text = {name.c_str(), "", ""}, .type = type, .values = values.data(), .value_count = values.size()};
    made.material = out_.material(out_.ctx, &desc);
    return made;
}

} // namespace restage::obj
