// SPDX-License-Identifier: Apache-2.0
// Materials: what both versions share. Names decide which version's parameters are meant; where a name is known to both
// (mix, hair, subsurface), the version of the file does. Defaults are written out, since they differ between versions.
#include "builder.hpp"

#include <cmath>

namespace restage::pbrt {

RestageHandle Builder::default_material(const Directive&) {
    if (default_material_) return default_material_;
    Values values; // pbrt-v3: matte; v4: diffuse; both 0.5
    values.color("reflectance", {0.5, 0.5, 0.5});
    values.number("sigma", 0);
    const RestageMaterialDesc desc{
        .text = import_.text("default", ""), .type = "diffuse", .values = values.data(), .value_count = values.size()};
    default_material_ = import_.out.material(import_.out.ctx, &desc);
    return default_material_;
}

// Index of refraction of a dielectric: one number. A dispersive spectrum is reduced to its mean weighted with the eye's
// response; pbrt-v4 would split colours, which RGB cannot.
void Builder::put_index(Values& values, const char* id, const Directive& d, const char* name, double otherwise) {
    if (const auto spectrum = import_.spectrum(d.params, name)) {
        const double low = spectrum->front(), high = spectrum->back();
        if (std::abs(low - high) > 1e-4)
            import_.approximated(
                d.at, d.word,
                "dispersion of \"" + std::string(name) + "\" is left out: its luminance-weighted mean is used");
        values.number(id, luminance_mean(*spectrum));
        keep_exact(id, d, name);
        return;
    }
    put_float(values, id, d, name, otherwise);
}

// "roughness" stands for the missing ones of uroughness and vroughness.
void Builder::put_roughness(Values& values, const Directive& d, const std::string& prefix, double otherwise,
                            const char* u_id, const char* v_id) {
    const std::string both = prefix + "roughness", u = prefix + "uroughness", v = prefix + "vroughness";
    const bool has_u = d.params.has(u), has_v = d.params.has(v);
    put_float(values, u_id, d, has_u ? u.c_str() : both.c_str(), otherwise);
    put_float(values, v_id, d, has_v ? v.c_str() : both.c_str(), otherwise);
}

void Builder::put_common(Values& values, const Directive& d) {
    for (const char* name : {"displacement", "bumpmap"}) // v4, v3
        if (const RestageHandle bump = find_texture(d, name, true)) values.texture("bump", RESTAGE_TEXTURE, bump);
    const std::string file = d.params.string("normalmap", "");
    if (file.empty()) return;
    if (const RestageHandle pixels = image(d, file, RESTAGE_LINEAR, 1, true)) {
        const RestageTexture texture{.text = import_.text("", ""), .type = "imagemap", .is_float = 0, .image = pixels};
        if (const RestageHandle handle = import_.out.texture(import_.out.ctx, &texture))
            values.texture("normalmap", RESTAGE_TEXTURE, handle);
    }
}

// A conductor's index. pbrt-v4: spectra become the RGB index with the metal's own reflectance (rgb_of_metal), since a
// renderer in RGB that averaged eta and k apart would tint gold and copper wrongly. v3 averages them apart itself.
void Builder::put_metal(Values& values, const Directive& d, const char* eta, const char* k, const char* eta_id,
                        const char* k_id) {
    const bool old = import_.v3() || d.word == "v3 metal";
    const auto spectral = [&](const char* name, const char* copper) -> std::optional<Spectrum> {
        if (!d.params.has(name)) return named_spectrum(copper);
        return import_.spectrum(d.params, name);
    };
    if (!old) {
        const auto n = spectral(eta, "metal-Cu-eta"), absorption = spectral(k, "metal-Cu-k");
        if (n && absorption) {
            const ComplexIndex index = rgb_of_metal(*n, *absorption);
            values.color(eta_id, index.eta);
            values.color(k_id, index.k);
            keep_exact(eta_id, d, eta);
            keep_exact(k_id, d, k);
            return;
        }
    }
    put_color(values, eta_id, d, eta, Role::unbounded, rgb_equal_energy(*named_spectrum("metal-Cu-eta")));
    put_color(values, k_id, d, k, Role::unbounded, rgb_equal_energy(*named_spectrum("metal-Cu-k")));
}

RestageHandle Builder::material(const Directive& d, const std::string& name, const std::string& type) {
    // The same anonymous material over and over (Material "diffuse" before each lamp) is one.
    const bool anonymous = name.empty();
    std::string key;
    if (anonymous) {
        key = type + '\n' + to_text(d.params, "\n");
        for (const Param& param : d.params.params)
            key += '\n' + std::to_string(static_cast<int>(param.color_space));
        for (const Param& param : d.params.params)
            if (param.type == "texture" && !param.strings.empty()) { // the same name may mean another texture by now
                const auto& names = *state_.names;
                for (const auto* map : {&names.float_textures, &names.color_textures})
                    if (const auto found = map->find(param.strings[0]); found != map->end())
                        key += '\n' + std::to_string(found->second);
            }
        if (const auto found = materials_by_content_.find(key); found != materials_by_content_.end())
            return found->second;
    }
    const std::string what = anonymous ? "Material " + quote(type) : "material " + quote(name);
    Values values;
    std::string plugin, verbatim;
    exact_.clear();
    d.params.find("type");
    if (type.empty() || type == "none" || type == "interface") {
        plugin = "interface";
        if (!anonymous && type.empty() && !import_.v3() && !d.params.has("type"))
            import_.approximated(d.at, what, "it has no \"string type\"; taken as interface");
    } else if (!material_v4(d, type, values, plugin) && !material_v3(d, type, values, plugin)) {
        approximated_material(d, type, values, plugin);
        // The whole of it goes back out as it came, unless it is edited ("=*": instead of all that would be written).
        exact_ = "=* \"string type\" [ " + quote(type) + " ]\n";
        for (const Param& param : d.params.params)
            if (param.name != "type") exact_ += "=* " + to_text(param) + "\n";
        d.params.mark_all_used();
    }
    if (plugin == "interface")
        exact_.clear();
    else
        put_common(values, d);
    verbatim += exact_ + import_.keep_unused(d.params, what);
    exact_.clear();
    std::string label = name;
    if (label.empty()) label = type + " " + std::to_string(d.at.line);
    const RestageMaterialDesc desc{.text = import_.text(label.c_str(), verbatim.c_str()),
                                   .type = plugin.c_str(),
                                   .values = values.data(),
                                   .value_count = values.size()};
    const RestageHandle handle = import_.out.material(import_.out.ctx, &desc);
    if (plugin == "interface") interfaces_.insert(handle);
    if (anonymous) materials_by_content_[key] = handle;
    return handle;
}

void Builder::approximated_material(const Directive& d, const std::string& type, Values& values, std::string& plugin) {
    const std::string what = d.name == type ? "Material " + quote(type) : "material " + quote(d.name);
    const Rgb half{0.5, 0.5, 0.5};
    std::string note = "there is no such material in pbrt; a diffuse one stands for it";
    plugin = "diffuse";
    Rgb color = half;
    if (type == "subsurface" || type == "kdsubsurface") {
        note = "light under the surface is not simulated; a coated diffuse one of its colour stands for it";
        plugin = "coateddiffuse";
        for (const char* name : {"reflectance", "Kd"})
            if (const auto given = import_.color(d.params, name, Role::albedo)) color = *given;
        const auto a = import_.color(d.params, "sigma_a", Role::unbounded),
                   s = import_.color(d.params, "sigma_s", Role::unbounded);
        if (a && s) { // diffuse reflectance of a half space from the albedo, Hanrahan's fit is finer than this needs
            const auto of = [](double absorbed, double scattered) {
                const double albedo = absorbed + scattered > 0 ? scattered / (absorbed + scattered) : 1;
                const double t = std::sqrt(3 * (1 - albedo));
                return albedo / 2 * (1 + std::exp(-4.0 / 3 * 1.44 * t)) *
                       std::exp(-t); // Jensen et al. 2001, Eq. 15, A of eta 1.3
            };
            color = {of(a->r, s->r), of(a->g, s->g), of(a->b, s->b)};
        }
        values.color("reflectance", color);
        put_index(values, "eta", d, "eta", 1.33);
        put_roughness(values, d, "", 0);
        values.choice("remap", !d.params.boolean("remaproughness", true) ? "none" : import_.v3() ? "v3" : "v4");
    } else if (type == "hair") {
        note = "hair scattering is not simulated; a diffuse one of a brown stands for it";
        color = {0.22, 0.12, 0.06};
        for (const char* name : {"reflectance", "color"})
            if (const auto given = import_.color(d.params, name, Role::albedo)) color = *given;
    } else if (type == "disney") {
        note = "of Disney's model its base colour, metallic and roughness are used";
        const double metallic = float_argument(d, "metallic", 0).value.r;
        if (metallic > 0.5) {
            plugin = "conductor";
            values.boolean("use_reflectance", true);
            put_color(values, "reflectance", d, "color", Role::albedo, half);
        } else {
            plugin = "coateddiffuse";
            put_color(values, "reflectance", d, "color", Role::albedo, half);
            put_index(values, "eta", d, "eta", 1.5);
        }
        const double roughness = float_argument(d, "roughness", 0.5).value.r; // alpha = roughness^2 (Burley 2012)
        values.number("uroughness", roughness * roughness);
        values.number("vroughness", roughness * roughness);
        values.choice("remap", "none");
    } else if (type == "fourier" || type == "measured") {
        note = "measured data is not read; a grey diffuse one stands for it";
    } else if (const RestageHandle texture = find_texture(d, "Kd", false)) {
        values.texture("reflectance", RESTAGE_COLOR, texture);
    }
    if (plugin == "diffuse" && values.size() == 0) values.color("reflectance", color);
    const bool dropped = type == "fourier" || type == "measured";
    import_.report(dropped ? RESTAGE_DROPPED : RESTAGE_APPROXIMATED, d.at, what + " (" + type + ")", note);
}

} // namespace restage::pbrt
