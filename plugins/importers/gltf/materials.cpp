// SPDX-License-Identifier: Apache-2.0
// Materials: metallic-roughness as our principled one, which matches it; alpha and even emission go to the instances.
#include "importer.hpp"

#include <algorithm>
#include <cmath>

namespace restage::gltf {

namespace {

double largest(const Rgb& c) { return std::max({c[0], c[1], c[2]}); }

Rgb factor_of(const std::vector<double>& v, Rgb otherwise) {
    for (std::size_t i = 0; i < 3 && i < v.size(); ++i)
        otherwise[i] = std::isfinite(v[i]) ? v[i] : otherwise[i];
    return otherwise;
}

} // namespace

std::vector<TextureUse> Importer::texture_uses(const tinygltf::Material& m) const {
    std::vector<TextureUse> uses = {use_of(m.pbrMetallicRoughness.baseColorTexture, "base colour"),
                                    use_of(m.normalTexture, "normal"),
                                    use_of(m.pbrMetallicRoughness.metallicRoughnessTexture, "metallic-roughness"),
                                    use_of(m.emissiveTexture, "emissive")};
    for (const auto& [name, value] : m.extensions)
        for (const char* key :
             {"diffuseTexture", "specularGlossinessTexture", "transmissionTexture", "clearcoatTexture",
              "clearcoatRoughnessTexture", "specularTexture", "specularColorTexture", "sheenColorTexture",
              "sheenRoughnessTexture", "anisotropyTexture", "iridescenceTexture", "iridescenceThicknessTexture"})
            uses.push_back(use_of(value, key, key));
    std::erase_if(uses, [](const TextureUse& use) { return !use; });
    return uses;
}

// The first two sets that textures use, in order of visual importance.
UvSets Importer::uv_sets(int index) const {
    UvSets sets;
    if (index < 0) return sets;
    for (const TextureUse& use : texture_uses(at(model_.materials, index, "material", "a primitive")))
        if (sets.find(use.set) < 0)
            if (const auto free = std::find(sets.texcoord.begin(), sets.texcoord.end(), -1);
                free != sets.texcoord.end())
                *free = use.set;
    return sets;
}

RestageHandle Importer::color_texture(const char* id, const Rgb& factor, const TextureUse& use,
                                      const MadeMaterial& made) {
    // Times 0 is 0: no texture is needed, nor its code.
    const RestageHandle handle = use && largest(factor) > 0 ? texture(use, Purpose::srgb, made.uv, made.name) : 0;
    return add_scaled(out_, made.name + " " + id, handle, false, factor);
}

void Importer::put_color(Values& values, const char* id, Rgb factor, const TextureUse& use, const MadeMaterial& made,
                         double most) {
    for (double& x : factor)
        x = std::clamp(x, 0.0, most);
    if (const RestageHandle handle = color_texture(id, factor, use, made))
        values.texture(id, RESTAGE_COLOR, handle);
    else
        values.color(id, factor);
}

void Importer::put_scalar(Values& values, const char* id, double factor, const TextureUse& use, unsigned channel,
                          const MadeMaterial& made) {
    static constexpr Purpose purposes[] = {Purpose::red, Purpose::green, Purpose::blue, Purpose::alpha};
    factor = std::clamp(factor, 0.0, 1.0);
    // Times 0 is 0: no texture is needed, nor its code.
    RestageHandle handle = use && factor > 0 ? texture(use, purposes[channel], made.uv, made.name) : 0;
    handle = add_scaled(out_, made.name + " " + id, handle, true, {factor, factor, factor});
    if (handle)
        values.texture(id, RESTAGE_FLOAT, handle);
    else
        values.number(id, factor);
}

void Importer::alpha(const tinygltf::Material& m, const BaseColor& base, const VertexColor& color, MadeMaterial& made) {
    if (m.alphaMode.empty() || m.alphaMode == "OPAQUE") return;
    const double factor = base.alpha * color.alpha;
    const auto vertices = [&] { // the alpha of vertex colours, where it varies
        Mapping lies;
        lies.set = color.set;
        return add_imagemap(out_, m.name + " vertex alpha", color.alpha_image, true, lies);
    };
    if (m.alphaMode == "MASK") {
        const double least = factor > 0 ? m.alphaCutoff / factor : 2;
        made.alpha = least <= 1 ? 1.f : 0.f;
        if (color.alpha_image && least <= 1 && least > 0) {
            const RestageHandle picture = base.use ? texture(base.use, Purpose::alpha, made.uv, m.name) : 0;
            made.alpha_texture = add_product(out_, m.name + " alpha", vertices(), picture, true);
            report_.approximated(
                "material " + quote(m.name) + ": alpha mask",
                "of vertex colours: their alpha is coverage, without the cutoff of " + std::to_string(m.alphaCutoff));
            return;
        }
        if (base.use && least <= 1 && least > 0)
            made.alpha_texture = texture(base.use, Purpose::mask, made.uv, m.name, least);
        report_.kept("material " + quote(m.name) + ": alpha mask", "a cut-out");
        return;
    }
    made.alpha = static_cast<float>(std::clamp(factor, 0.0, 1.0));
    RestageHandle picture = base.use ? texture(base.use, Purpose::alpha, made.uv, m.name) : 0;
    if (color.alpha_image) picture = add_product(out_, m.name + " alpha", picture, vertices(), true);
    made.alpha_texture =
        add_scaled(out_, m.name + " alpha scaled", picture, true, {made.alpha, made.alpha, made.alpha});
    report_.kept("material " + quote(m.name) + ": alpha blending", "coverage: light passes with that probability");
}

Importer::BaseColor Importer::base_color(const tinygltf::Material& m) const {
    const auto& pbr = m.pbrMetallicRoughness;
    std::vector<double> factor = pbr.baseColorFactor;
    TextureUse use = use_of(pbr.baseColorTexture, "base colour");
    double dimmed = 1;
    bool metal = false;
    if (const auto v = m.extensions.find("KHR_materials_pbrSpecularGlossiness"); v != m.extensions.end()) {
        use = use_of(v->second, "diffuseTexture", "diffuse");
        factor.clear();
        if (v->second.IsObject() && v->second.Has("diffuseFactor") && v->second.Get("diffuseFactor").IsArray())
            for (std::size_t i = 0; i < v->second.Get("diffuseFactor").ArrayLen(); ++i)
                factor.push_back(v->second.Get("diffuseFactor").Get(static_cast<int>(i)).GetNumberAsDouble());
        const Rgb specular = color_of(v->second, "specularFactor", {1, 1, 1});
        const bool packed = static_cast<bool>(use_of(v->second, "specularGlossinessTexture", ""));
        metal = !packed && !use && largest(factor_of(factor, {1, 1, 1})) <= 0 && largest(specular) > 0;
        if (metal)
            for (std::size_t i = 0; i < 3; ++i)
                factor[i] = specular[i];
        else if (!packed) // c_diff = diffuse * (1 - max(specular))
            dimmed = 1 - std::clamp(largest(specular), 0.0, 1.0);
    }
    BaseColor base{factor_of(factor, {1, 1, 1}), 1, use, metal};
    for (double& x : base.factor)
        x *= dimmed;
    if (factor.size() > 3 && std::isfinite(factor[3])) base.alpha = factor[3];
    return base;
}

// Factor times texture times vertex colours.
void Importer::put_base(Values& values, const char* id, const BaseColor& base, const VertexColor& color,
                        const MadeMaterial& made) {
    Rgb factor = base.factor;
    for (std::size_t i = 0; i < 3; ++i)
        factor[i] = std::clamp(factor[i] * color.factor[i], 0.0, 1.0);
    RestageHandle handle = color_texture(id, factor, base.use, made);
    if (color.image) {
        Mapping lies;
        lies.set = color.set;
        const RestageHandle map = add_imagemap(out_, made.name + " vertex colours", color.image, false, lies);
        handle = handle ? add_product(out_, made.name + " coloured", handle, map, false)
                        : add_scaled(out_, made.name + " vertex colours scaled", map, false, factor);
    }
    if (handle)
        values.texture(id, RESTAGE_COLOR, handle);
    else
        values.color(id, factor);
}

// Uniform emission is the instances'; an emissive picture is the material's.
void Importer::emission(const tinygltf::Material& m, MadeMaterial& made, Values& values) {
    const Rgb factor = factor_of(m.emissiveFactor, {0, 0, 0});
    double strength = 1;
    if (const auto v = m.extensions.find("KHR_materials_emissive_strength"); v != m.extensions.end())
        strength = std::max(number_of(v->second, "emissiveStrength", 1), 0.0);
    if (largest(factor) <= 0 || strength <= 0) return;
    if (const TextureUse use = use_of(m.emissiveTexture, "emissive")) {
        const int image = image_of(use);
        if (image < 0 || !picture(image)) return; // reported; an unreadable picture emits nothing
        put_color(values, "emission_color", factor, use, made);
        values.number("emission_scale", std::min(strength, 1e6));
        values.boolean("emission_two_sided", m.doubleSided);
        return;
    }
    for (std::size_t i = 0; i < 3; ++i)
        made.emission[i] = factor[i] * strength;
}

// An unlit colour: emitted, with nothing reflected.
void Importer::unlit(const BaseColor& base, const VertexColor& color, MadeMaterial& made, Values& values,
                     const char*& type) {
    values.color("reflectance", {0, 0, 0});
    report_.approximated("material " + quote(made.name) + ": unlit",
                         "it emits its colour, and lights what is around it");
    made.two_sided = true;
    if (base.use || color.image) {
        type = "emissive";
        put_base(values, "radiance", base, color, made);
        values.number("scale", 1);
        values.boolean("two_sided", true);
        return;
    }
    type = "diffuse";
    for (std::size_t i = 0; i < 3; ++i)
        made.emission[i] = base.factor[i] * color.factor[i];
}

const MadeMaterial& Importer::material(int index, const VertexColor& color) {
    const auto key = std::tuple(index, color.key());
    if (const auto it = materials_.find(key); it != materials_.end()) return it->second;
    return materials_[key] = make_material(index, color);
}

MadeMaterial Importer::make_material(int index, const VertexColor& color) {
    tinygltf::Material plain; // glTF's default: a white metal, rough (3.9.2 and 3.7.2.1)
    plain.name = "default";
    if (index < 0) plain.doubleSided = true;
    tinygltf::Material m = index < 0 ? plain : model_.materials[static_cast<std::size_t>(index)];
    if (m.name.empty()) m.name = "material " + std::to_string(index);
    MadeMaterial made;
    made.name = m.name;
    made.uv = uv_sets(index);
    made.two_sided = m.doubleSided;
    Values values;
    const char* type = "principled";
    const BaseColor base = base_color(m);
    alpha(m, base, color, made);
    if (m.extensions.contains("KHR_materials_unlit")) {
        unlit(base, color, made, values, type);
    } else {
        put_base(values, "base_color", base, color, made);
        const auto& pbr = m.pbrMetallicRoughness;
        const TextureUse packed = use_of(pbr.metallicRoughnessTexture, "metallic-roughness");
        if (!m.extensions.contains("KHR_materials_pbrSpecularGlossiness")) {
            put_scalar(values, "metallic", pbr.metallicFactor, packed, 2, made);
            put_scalar(values, "roughness", pbr.roughnessFactor, packed, 1, made);
        }
        if (const TextureUse normal = use_of(m.normalTexture, "normal")) {
            const double scale = m.normalTexture.scale;
            const RestageHandle map = scale == 1 ? texture(normal, Purpose::linear, made.uv, m.name)
                                                 : texture(normal, Purpose::normal, made.uv, m.name, scale);
            if (map) {
                values.texture("normalmap", RESTAGE_TEXTURE, map);
                made.normal = normal;
                made.needs_tangents = true;
            }
        }
        if (m.occlusionTexture.index >= 0)
            report_.dropped("material " + quote(m.name) + ": occlusion texture",
                            "shadows of ambient light are computed, not painted");
        emission(m, made, values);
        extensions(m, base, made, values);
    }
    const std::string indices = made.dispersion > 0 ? dispersed_index(made.ior, made.dispersion) : "";
    const RestageOriginValue spectrum = {.id = "spectrum:ior", .text = indices.c_str()};
    const RestageOrigin origin = {.value_count = 1, .format = "", .verbatim = "", .values = &spectrum};
    const RestageMaterialDesc desc = {.name = m.name.c_str(),
                                      .origin = made.dispersion > 0 ? &origin : nullptr,
                                      .type = type,
                                      .values = values.data(),
                                      .value_count = values.size()};
    made.material = out_.material(out_.ctx, &desc);
    return made;
}

} // namespace restage::gltf
