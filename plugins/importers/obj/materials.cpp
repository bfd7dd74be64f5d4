// SPDX-License-Identifier: Apache-2.0
// MTL materials as our nearest ones: principled if the PBR extension is used, else according to the classic statements.
// Their meaning is from Bourke's page on MTL and Alias|Wavefront's manual, appendix B.
#include "common/file.hpp"
#include "importer.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace restage::obj {

struct Importer::Slot { // one map_... statement
    std::string material, key;
    const MtlTexture& options;
    std::uint32_t line;
    std::filesystem::path library;
    std::string what() const { return "material " + quote(material) + ": " + key; }
};

namespace {

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
    if (o.turbulence != std::array<double, 3>{})
        report_.dropped(slot.what() + " -t", "turbulence is not known", slot.line, slot.library.string());
    if (o.base != 0 || o.gain != 1)
        report_.dropped(slot.what() + " -mm", "the picture is used as it is", slot.line, slot.library.string());
    if (!o.channel.empty() && o.channel != "m" && o.channel != "l")
        report_.dropped(slot.what() + " -imfchan", "the picture's brightness is used", slot.line,
                        slot.library.string());
    return {.scale_u = o.scale[0],
            .scale_v = o.scale[1],
            .offset_u = o.offset[0],
            .offset_v = o.offset[1],
            .wrap = o.clamp ? "clamp" : "repeat"};
}

RestageHandle Importer::color_texture(const Slot& slot, const Rgb& factor) {
    const std::string path = find_file(slot.library.parent_path(), slot.options.file).string();
    const bool linear = slot.options.colorspace == "linear";
    const RestageHandle image = add_image_file(out_, path, linear ? RESTAGE_LINEAR : RESTAGE_SRGB);
    const std::string name = slot.material + " " + slot.key;
    return add_scaled(out_, name + " scaled", add_imagemap(out_, name, image, false, mapping(slot)), false, factor);
}

RestageHandle Importer::scalar_texture(const Slot& slot, double factor, bool invert) {
    const std::string path = find_file(slot.library.parent_path(), slot.options.file).string();
    const RestageHandle image = add_image_file(out_, path, RESTAGE_LINEAR);
    return add_imagemap(out_, slot.material + " " + slot.key, image, true, mapping(slot), factor, invert);
}

// map_d: the alpha channel if the picture has a meaningful one, else its brightness.
RestageHandle Importer::alpha_texture(const Slot& slot, double factor) {
    const std::string path = find_file(slot.library.parent_path(), slot.options.file).string();
    std::string reason;
    const auto picture = read_picture(path, reason);
    if (!picture || !picture->alpha_varies()) return scalar_texture(slot, factor); // the host reports its errors
    const std::string name = slot.material + " " + slot.key;
    const RestageHandle image = add_pixels(out_, name, picture->width, picture->height, 1,
                                           [&](std::size_t pixel, unsigned) { return picture->value(pixel, 3); });
    return add_imagemap(out_, name, image, true, mapping(slot), factor);
}

void Importer::bump(const Slot& slot, Values& values) {
    const std::string path = find_file(slot.library.parent_path(), slot.options.file).string();
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
    for (std::size_t i = 0; i + 2 < model_.vertices.size(); i += 3)
        all.add({model_.vertices[i], model_.vertices[i + 1], model_.vertices[i + 2]});
    report_.approximated(slot.what(), "heights have no unit here; white is taken as 1/200 of the model's size high",
                         slot.line, slot.library.string());
    values.texture("bump", RESTAGE_TEXTURE, scalar_texture(slot, slot.options.bump * 0.005 * 2 * all.radius()));
}

void Importer::emission(const Mtl& m, MadeMaterial& made) {
    const Rgb ke = m.color("Ke");
    made.emits = largest(ke) > 0;
    made.emission = {std::max(ke[0], 0.0), std::max(ke[1], 0.0), std::max(ke[2], 0.0)};
}

const MadeMaterial& Importer::material(int id) {
    const auto known = made_.find(id);
    if (known != made_.end()) return known->second;
    if (id >= 0)
        if (const Mtl* mtl = find(model_.materials[static_cast<std::size_t>(id)].first))
            return made_[id] = make_material(*mtl);
    Values values;
    values.color("reflectance", {0.5, 0.5, 0.5});
    const RestageMaterialDesc grey = {
        .name = "grey", .type = "diffuse", .values = values.data(), .value_count = values.size()};
    MadeMaterial made;
    made.material = out_.material(out_.ctx, &grey);
    return made_[id] = made;
}

MadeMaterial Importer::make_material(const Mtl& m, RestageHandle baked) {
    std::filesystem::path file;
    for (const auto& library : libraries_)
        for (const Mtl& other : library.materials)
            if (&other == &m) file = library.path;
    const auto line = [&](const char* key) {
        const auto it = m.lines.find(key);
        return it == m.lines.end() ? m.line : it->second;
    };
    const std::string what = "material " + quote(m.name);
    const auto slot = [&](const char* key) { return Slot{m.name, key, *m.texture(key), line(key), file}; };
    const auto dropped = [&](const char* key, const char* note) {
        report_.dropped(what + ": " + key, note, line(key), file.string());
    };

    Values values;
    MadeMaterial made;
    // The colour of `color_key` times the picture of `key`. Without a colour the picture is the colour.
    const auto put_color = [&](const char* id, const char* color_key, const char* key) {
        Rgb factor = m.color(color_key);
        const bool textured = m.texture(key) != nullptr;
        if (textured && !m.has(color_key)) factor = {1, 1, 1};
        if (largest(factor) > 1)
            report_.approximated(what, "a reflectance above 1 is taken as 1", m.line, file.string());
        factor = clamped(factor);
        if (textured && largest(factor) <= 0) {
            report_.approximated(what, "a picture times black is taken as the picture", line(key), file.string());
            factor = {1, 1, 1};
        }
        RestageHandle texture = textured ? color_texture(slot(key), factor) : 0;
        if (baked && std::string_view(color_key) == "Kd")
            texture = add_imagemap(out_, m.name + " colours", baked, false, Mapping{});
        if (texture)
            values.texture(id, RESTAGE_COLOR, texture);
        else
            values.color(id, factor);
    };
    const auto put_scalar = [&](const char* id, double factor, const char* key) {
        const RestageHandle texture = m.texture(key) ? scalar_texture(slot(key)) : 0;
        if (texture)
            values.texture(id, RESTAGE_FLOAT, texture);
        else
            values.number(id, factor);
    };
    const auto unit = [&](const char* key, double otherwise) { return std::clamp(m.number(key, otherwise), 0.0, 1.0); };

    const Rgb kd = m.color("Kd"), ks = m.color("Ks"), tf = m.color("Tf");
    const bool pbr = [&] {
        for (const char* key : {"Pr", "map_Pr", "Pm", "map_Pm", "Ps", "map_Ps", "Pc", "Pcr", "aniso"})
            if (m.has(key)) return true;
        return false;
    }();
    const int illum = static_cast<int>(std::clamp(m.number("illum", 2), -1.0, 100.0));
    const double ior = m.number("Ni", 1), dissolve = unit("d", 1);
    const bool filtered = m.has("Tf");
    const bool refracts = illum == 6 || illum == 7 || ((illum == 4 || illum == 9) && (dissolve < 1 || filtered));
    const bool matte = illum == 0 || illum == 1 || (largest(ks) <= 0 && !m.texture("map_Ks"));
    const bool metal = !matte && !baked && largest(kd) <= 0 && !m.texture("map_Kd");
    const double alpha = alpha_from_exponent(m.number("Ns", 1));
    const char* type = "uber";
    if (pbr) {
        type = "principled";
        put_color("base_color", "Kd", "map_Kd");
        put_scalar("roughness", unit("Pr", 0), "map_Pr");
        put_scalar("metallic", unit("Pm", 0), "map_Pm");
        if (ior > 1) values.number("ior", std::clamp(ior, 1.0, 3.0));
        if (m.has("Pc")) values.number("clearcoat", unit("Pc", 0));
        if (m.has("Pcr")) values.number("clearcoat_roughness", unit("Pcr", 0));
        for (const char* key : {"Ps", "map_Ps", "aniso", "anisor"})
            if (m.has(key)) dropped(key, "there is no sheen or anisotropy in the principled material");
    } else if (refracts && !baked) {
        type = "dielectric";
        values.number("eta", ior > 1.0001 ? std::clamp(ior, 1.0, 3.0) : 1.5);
        if (filtered && largest(tf) > 0) values.color("transmittance", clamped(tf));
        report_.kept(what, "illum " + std::to_string(illum) + " refracts: it is glass", line("illum"), file.string());
    } else if (matte) {
        type = "diffuse";
        put_color("reflectance", "Kd", "map_Kd");
    } else if (metal) {
        type = "conductor";
        values.boolean("use_reflectance", true);
        put_color("reflectance", "Ks", "map_Ks");
        values.choice("remap", "none");
        for (const char* id : {"uroughness", "vroughness"})
            values.number(id, illum == 3 || illum == 5 ? 0 : alpha); // 3, 5: mirrors
    } else {
        put_color("kd", "Kd", "map_Kd");
        put_color("ks", "Ks", "map_Ks");
        if (ior > 1.0001) values.number("eta", std::clamp(ior, 1.0, 3.0));
        values.choice("remap", "none");
        for (const char* id : {"uroughness", "vroughness"})
            values.number(id, alpha);
        report_.approximated(what, "Phong's highlight (Ks, Ns) becomes GGX with Fresnel reflection", m.line,
                             file.string());
    }

    if (m.texture("norm")) {
        const Slot s = slot("norm");
        const std::string path = find_file(file.parent_path(), s.options.file).string();
        values.texture(
            "normalmap", RESTAGE_TEXTURE,
            add_imagemap(out_, m.name + " norm", add_image_file(out_, path, RESTAGE_LINEAR), false, mapping(s)));
    } else if (m.texture("bump")) {
        bump(slot("bump"), values);
    }
    if (!refracts) {
        made.alpha = static_cast<float>(dissolve);
        if (m.texture("map_d")) made.alpha_texture = alpha_texture(slot("map_d"), dissolve);
    }
    emission(m, made);
    if (m.texture("map_Ke")) dropped("map_Ke", "a surface emits evenly; its Ke alone is used");
    if (m.texture("map_Ns")) dropped("map_Ns", "the highlight's size is taken from Ns alone");
    if (m.texture("disp")) dropped("disp", "surfaces are not displaced");
    if (m.texture("refl")) dropped("refl", "the scene itself is reflected");
    if (m.texture("map_Ka") && (!m.texture("map_Kd") || m.texture("map_Ka")->file != m.texture("map_Kd")->file))
        dropped("map_Ka", "ambient light is computed, not painted");
    for (const auto& [statement, at] : m.not_understood)
        report_.dropped(what + ": " + statement, "it is not understood", at, file.string());

    const std::string name = m.name.empty() ? "material" : m.name;
    const RestageMaterialDesc desc = {
        .name = name.c_str(), .type = type, .values = values.data(), .value_count = values.size()};
    made.material = out_.material(out_.ctx, &desc);
    return made;
}

} // namespace restage::obj
