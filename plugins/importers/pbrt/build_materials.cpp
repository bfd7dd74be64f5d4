// SPDX-License-Identifier: Apache-2.0
// Materials: the common part of both versions. The name determines which version's parameters apply; for names of both
// (mix, hair, subsurface), the version of the file does. Defaults are written out, since they differ between versions.
#include "builder.hpp"

#include <algorithm>
#include <cmath>

namespace restage::pbrt {

RestageHandle Builder::default_material(const Directive&) {
    if (default_material_) return default_material_;
    Values values; // pbrt-v3: matte; v4: diffuse; both 0.5
    values.color("reflectance", {0.5, 0.5, 0.5});
    values.number("sigma", 0);
    const RestageMaterialDesc desc{.name = "default",
                                   .origin = import_.origin(),
                                   .type = "diffuse",
                                   .values = values.data(),
                                   .value_count = values.size()};
    default_material_ = import_.out.material(import_.out.ctx, &desc);
    return default_material_;
}

// Index of refraction of a dielectric: one number. A dispersive spectrum is reduced to its mean weighted with the eye's
// response; pbrt-v4 would split colours, which RGB cannot.
void Builder::put_index(Values& values, const char* id, const Directive& d, const char* name, double otherwise) {
    if (const auto spectrum = import_.v3() ? std::nullopt : import_.spectrum(d.params, name)) { // v3: a float there
        const double low = spectrum->front(), high = spectrum->back();
        if (std::abs(low - high) > 1e-4)
            import_.approximated(
                d.at, d.word,
                "dispersion of \"" + std::string(name) + "\" is left out in RGB: its luminance-weighted mean is used");
        const double mean = luminance_mean(*spectrum);
        values.number(id, mean);
        keep_exact(id, d, name);
        const auto given = import_.given_spectrum(d.params, name);
        if (given && std::abs(given->front() - given->back()) > 1e-4) keep_spectrum(id, {mean, mean, mean}, given);
        return;
    }
    put_float(values, id, d, name, otherwise);
}

// "roughness" replaces missing uroughness and vroughness.
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
    import_.approximated(d.at, "\"normalmap\" of a material",
                         "where it turns a normal away from the viewer it is bent back until it faces them; "
                         "pbrt's surface is black there");
    if (const RestageHandle pixels = image(d, file, RESTAGE_LINEAR, 1, true)) {
        const RestageTexture texture{
            .name = "", .origin = import_.origin(), .type = "imagemap", .is_float = 0, .image = pixels};
        if (const RestageHandle handle = import_.out.texture(import_.out.ctx, &texture))
            values.texture("normalmap", RESTAGE_TEXTURE, handle);
    }
}

// A conductor's index. pbrt-v4: spectra become the RGB index with the metal's own reflectance (rgb_of_metal), since a
// renderer in RGB that averaged eta and k apart would tint gold and copper wrongly. v3 itself averages them apart.
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
            keep_spectrum(eta_id, index.eta, n);
            keep_spectrum(k_id, index.k, absorption);
            return;
        }
    }
    put_color(values, eta_id, d, eta, Role::unbounded, rgb_equal_energy(*named_spectrum("metal-Cu-eta")));
    put_color(values, k_id, d, k, Role::unbounded, rgb_equal_energy(*named_spectrum("metal-Cu-k")));
}

bool is_material_parameter(std::string_view name) { // of pbrt-v3's materials; not "alpha", which is the shape's own
    static const std::set<std::string_view> names = {"Kd",
                                                     "Ks",
                                                     "Kr",
                                                     "Kt",
                                                     "sigma",
                                                     "roughness",
                                                     "uroughness",
                                                     "vroughness",
                                                     "eta",
                                                     "k",
                                                     "index",
                                                     "opacity",
                                                     "remaproughness",
                                                     "bumpmap",
                                                     "reflect",
                                                     "transmit",
                                                     "amount",
                                                     "color",
                                                     "metallic",
                                                     "speculartint",
                                                     "anisotropic",
                                                     "sheen",
                                                     "sheentint",
                                                     "clearcoat",
                                                     "clearcoatgloss",
                                                     "spectrans",
                                                     "flatness",
                                                     "thin",
                                                     "difftrans",
                                                     "scatterdistance",
                                                     "mfp",
                                                     "sigma_a",
                                                     "sigma_s",
                                                     "sigma_prime_s",
                                                     "g",
                                                     "eumelanin",
                                                     "pheomelanin",
                                                     "beta_m",
                                                     "beta_n"};
    return names.count(name) > 0;
}

// pbrt-v3 (GraphicsState::GetMaterialForShape): a material reads its parameters from the shape first.
RestageHandle Builder::material_of_shape(const Directive& shape) {
    const RestageHandle own = state_.material ? state_.material : default_material(shape);
    const auto overrides = [](const Param& param) { return is_material_parameter(param.name); };
    if (!import_.v3() || (state_.material && !state_.material_from) ||
        std::none_of(shape.params.params.begin(), shape.params.params.end(), overrides))
        return own;
    Directive merged;
    merged.word = "Material";
    merged.at = shape.at;
    merged.name = "matte";
    if (const Directive* from = state_.material_from) {
        merged.name = from->verb == Verb::material ? from->name : from->params.string("type", "matte");
        merged.params = from->params;
    }
    for (const Param& param : shape.params.params)
        if (overrides(param)) {
            std::erase_if(merged.params.params, [&](const Param& p) { return p.name == param.name; });
            merged.params.params.push_back(param);
            param.used = true;
        }
    const auto name = material_names_.find(own);
    return material(merged, "", merged.name, name == material_names_.end() ? "" : name->second);
}

RestageHandle Builder::material(const Directive& d, const std::string& name, const std::string& type,
                                const std::string& wanted_label) {
    // A repeated anonymous material (Material "diffuse" before each lamp) is shared.
    const bool anonymous = name.empty();
    std::string key;
    if (anonymous) {
        key = type + '\n' + to_text(d.params, "\n");
        for (const Param& param : d.params.params)
            key += '\n' + std::to_string(static_cast<int>(param.color_space));
        for (const Param& param : d.params.params)
            if (param.type == "texture" && !param.strings.empty()) { // the name may refer to a different texture by now
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
    const auto other_version = [&](const char* note) {
        import_.warned(d.at, what + " (" + type + ")", std::string(note) + "; it is taken as the other version's");
    };
    if (is_for_plugin(d)) {
        material_of_plugin(d, d.params.string("plugin", ""), values, plugin);
    } else if (type.empty() || type == "none" || type == "interface") {
        plugin = "interface";
        if (!anonymous && type.empty() && !import_.v3() && !d.params.has("type"))
            import_.approximated(d.at, what, "it has no \"string type\"; taken as interface");
    } else if (material_v4(d, type, values, plugin)) {
        if (import_.v3() && type != "mix") other_version("pbrt-v3 has no material of that name, and takes matte");
    } else if (material_v3(d, type, values, plugin)) {
        if (!import_.v3()) other_version("pbrt-v4 has no material of that name, and stops");
    } else if (!material_of_plugin(d, type, values, plugin)) {
        approximated_material(d, type, values, plugin);
        // All of it is written back verbatim unless edited ("=*": replaces everything that would be written).
        exact_ = "=* \"string type\" [ " + quote(type) + " ]\n";
        for (const Param& param : d.params.params)
            if (param.name != "type") exact_ += "=* " + to_text(param) + "\n";
        d.params.mark_all_used();
        missing_files_of(d, what);
    }
    if (plugin == "interface")
        exact_.clear();
    else
        put_common(values, d);
    verbatim += exact_ + import_.keep_unused(d.params, what);
    exact_.clear();
    std::string label = name.empty() ? wanted_label : name;
    if (label.empty()) label = type.empty() ? "interface" : type;
    const RestageMaterialDesc desc{.name = label.c_str(),
                                   .origin = import_.origin(verbatim),
                                   .type = plugin.c_str(),
                                   .values = values.data(),
                                   .value_count = values.size()};
    const RestageHandle handle = import_.out.material(import_.out.ctx, &desc);
    if (plugin == "interface") interfaces_.insert(handle);
    if (plugin == "hair") hair_.insert(handle);
    if (anonymous) materials_by_content_[key] = handle;
    if (!anonymous) material_names_[handle] = name;
    return handle;
}

// The colour of many strands together: Chiang et al. 2016, "A Practical and Controllable Hair and Fur Model for
// Production Path Tracing", Eq. 9, solved for the colour; pigments as in pbrt (hair.cpp, SigmaAFromConcentration).
Rgb Builder::hair_color(const Directive& d) {
    for (const char* name : {"reflectance", "color"})
        if (const auto given = import_.color(d.params, name, Role::albedo)) return *given;
    auto sigma = import_.color(d.params, "sigma_a", Role::unbounded);
    if (!sigma) {
        const bool pheomelanin = d.params.has("pheomelanin");
        const double eu = float_argument(d, "eumelanin", pheomelanin ? 0 : 1.3).value.r;
        sigma = Rgb{0.419, 0.697, 1.37} * eu + Rgb{0.187, 0.4, 1.05} * float_argument(d, "pheomelanin", 0).value.r;
    }
    const double b = float_argument(d, "beta_n", 0.3).value.r;
    const double depth =
        5.969 - 0.215 * b + 2.532 * b * b - 10.73 * b * b * b + 5.574 * std::pow(b, 4) + 0.245 * std::pow(b, 5);
    const auto of = [&](double absorbed) { return std::exp(-std::sqrt(std::max(absorbed, 0.0)) * depth); };
    return {of(sigma->r), of(sigma->g), of(sigma->b)};
}

void Builder::approximated_material(const Directive& d, const std::string& type, Values& values, std::string& plugin) {
    const std::string what = d.name == type ? "Material " + quote(type) : "material " + quote(d.name);
    const Rgb half{0.5, 0.5, 0.5};
    std::string note = "there is no such material in pbrt; a diffuse one is used instead";
    plugin = "diffuse";
    Rgb color = half;
    if (type == "subsurface" || type == "kdsubsurface") {
        note = subsurface(d, type, values, plugin);
    } else if (type == "hair") { // material_of_plugin reads it if the plugin is loaded
        note = "no plugin provides hair; a diffuse one of the hair's colour is used instead";
        color = hair_color(d);
    } else if (type == "disney") {
        note =
            "Disney's model: the principled material is used instead; its diffuse has no retro-reflection, its sheen "
            "and "
            "coat are other formulas, light under the surface is not simulated";
        plugin = "principled";
        disney(d, values);
    } else if (type == "shinymetal") { // pbrt-v2: a rough and a smooth layer, each a metal of that colour
        note = "of pbrt-v2; a rough metal of its colour Ks is used instead, its mirror is left out";
        plugin = "conductor";
        values.boolean("use_reflectance", true);
        put_color(values, "reflectance", d, "Ks", Role::albedo, {1, 1, 1});
        // Blinn's exponent is 1 / roughness; the slope of as wide a lobe: Walter et al. 2007, Sec. 5.2.
        const double roughness = std::max(float_argument(d, "roughness", 0.1).value.r, 1e-6);
        const double alpha = std::sqrt(2 / (1 / roughness + 2));
        values.number("uroughness", alpha);
        values.number("vroughness", alpha);
        values.choice("remap", "none");
        values.choice("distribution", "ggx");
    } else if (type == "fourier") {
        note = "measured data is not read; a grey diffuse one is used instead";
    } else if (type == "measured") {
        note = is_rgl(d) ? "data of RGL (.bsdf) is not read, only MERL's (.binary); a grey diffuse one is used instead"
                         : "no plugin provides measured; a grey diffuse one is used instead";
    } else if (import_.v3()) { // api.cpp, MakeMaterial
        note = "there is no such material in pbrt; matte with its parameters is used instead, as in pbrt";
        material_v3(d, "matte", values, plugin);
    }
    if (plugin == "diffuse" && values.size() == 0) values.color("reflectance", color);
    const bool dropped = type == "fourier";
    import_.report(dropped ? RESTAGE_DROPPED : RESTAGE_APPROXIMATED, d.at, what + " (" + type + ")", note);
}

RestageHandle Builder::named_material(const Directive& directive, const std::string& name) {
    if (const auto found = state_.names->materials.find(name); found != state_.names->materials.end())
        return found->second;
    if (const auto later = later_materials_.find(name); later != later_materials_.end()) {
        const Directive& made = *later->second;
        constexpr int deepest_mix = 100;
        if (material_depth_ >= deepest_mix)
            throw ImportError{directive.at, "materials mix each other more than 100 deep; flatten them"};
        later_materials_.erase(later);
        ++material_depth_;
        const RestageHandle handle = material(made, name, made.params.string("type", ""));
        --material_depth_;
        writable_names().materials[name] = handle;
        made_materials_.insert(name);
        return handle;
    }
    import_.warned(directive.at, directive.word + " " + quote(name),
                   "no material has that name; a grey diffuse one is used instead");
    if (!files_are_missing_) return default_material(directive);
    // A missing file may define it: it keeps its name, and is not defined on export ("extern").
    Values values;
    values.color("reflectance", {0.5, 0.5, 0.5});
    values.number("sigma", 0);
    const std::string verbatim = "=* extern " + quote(name) + "\n";
    const RestageMaterialDesc desc{.name = name.c_str(),
                                   .origin = import_.origin(verbatim),
                                   .type = "diffuse",
                                   .values = values.data(),
                                   .value_count = values.size()};
    const RestageHandle handle = import_.out.material(import_.out.ctx, &desc);
    writable_names().materials[name] = handle;
    return handle;
}

} // namespace restage::pbrt
