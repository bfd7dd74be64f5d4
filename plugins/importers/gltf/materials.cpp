// SPDX-License-Identifier: Apache-2.0
// Materials: metallic-roughness as our principled one, which is the same; alpha and emission go to the instances.
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

// The set and the turn of the first texture that has a say; the others follow as far as they can.
UvPlan Importer::uv_plan(int index) {
    if (index < 0) return {};
    const auto& m = at(model_.materials, index, "material", "a primitive");
    std::vector<TextureUse> uses = {use_of(m.pbrMetallicRoughness.baseColorTexture, "base colour"),
                                    use_of(m.normalTexture, "normal"),
                                    use_of(m.pbrMetallicRoughness.metallicRoughnessTexture, "metallic-roughness"),
                                    use_of(m.emissiveTexture, "emissive")};
    for (const auto& [name, value] : m.extensions)
        for (const char* key :
             {"transmissionTexture", "clearcoatTexture", "clearcoatRoughnessTexture", "specularTexture",
              "specularColorTexture", "diffuseTexture", "sheenColorTexture", "sheenRoughnessTexture",
              "anisotropyTexture", "iridescenceTexture", "iridescenceThicknessTexture"})
            uses.push_back(use_of(value, key, key));
    for (const TextureUse& use : uses)
        if (use) return {use.set, use.transform.diagonal() ? UvTransform{} : use.transform};
    return {};
}

void Importer::put_color(Values& values, const char* id, Rgb factor, const TextureUse& use, const MadeMaterial& made) {
    for (double& x : factor)
        x = std::clamp(x, 0.0, 1.0);
    RestageHandle handle = use ? texture(use, Purpose::srgb, made.uv, made.name) : 0;
    handle = add_scaled(out_, made.name + " " + id, handle, false, factor);
    if (handle)
        values.texture(id, RESTAGE_COLOR, handle);
    else
        values.color(id, factor);
}

void Importer::put_scalar(Values& values, const char* id, double factor, const TextureUse& use, unsigned channel,
                          const MadeMaterial& made) {
    static constexpr Purpose purposes[] = {Purpose::red, Purpose::green, Purpose::blue, Purpose::alpha};
    factor = std::clamp(factor, 0.0, 1.0);
    // Times nothing is nothing: no texture is needed, nor its code.
    RestageHandle handle = use && factor > 0 ? texture(use, purposes[channel], made.uv, made.name) : 0;
    handle = add_scaled(out_, made.name + " " + id, handle, true, {factor, factor, factor});
    if (handle)
        values.texture(id, RESTAGE_FLOAT, handle);
    else
        values.number(id, factor);
}

void Importer::alpha(const tinygltf::Material& m, const TextureUse& use, double factor, MadeMaterial& made) {
    if (m.alphaMode.empty() || m.alphaMode == "OPAQUE") return;
    if (m.alphaMode == "MASK") {
        const double least = factor > 0 ? m.alphaCutoff / factor : 2;
        made.alpha = least <= 1 ? 1.f : 0.f;
        if (use && least <= 1 && least > 0) made.alpha_texture = texture(use, Purpose::mask, made.uv, m.name, least);
        report_.kept("material " + quote(m.name) + ": alpha mask", "a cut-out");
        return;
    }
    made.alpha = static_cast<float>(std::clamp(factor, 0.0, 1.0));
    if (use)
        made.alpha_texture = add_scaled(out_, m.name + " alpha scaled", texture(use, Purpose::alpha, made.uv, m.name),
                                        true, {made.alpha, made.alpha, made.alpha});
    report_.kept("material " + quote(m.name) + ": alpha blending", "coverage: light passes with that probability");
}

void Importer::base_color(const tinygltf::Material& m, const VertexColor& color, MadeMaterial& made, Values& values) {
    const auto& pbr = m.pbrMetallicRoughness;
    Rgb factor = factor_of(pbr.baseColorFactor, {1, 1, 1});
    for (std::size_t i = 0; i < 3; ++i)
        factor[i] *= color.factor[i];
    const TextureUse use = use_of(pbr.baseColorTexture, "base colour");
    if (color.image) {
        const RestageHandle map = add_imagemap(out_, m.name + " vertex colours", color.image, false, {});
        values.texture("base_color", RESTAGE_COLOR,
                       add_scaled(out_, m.name + " vertex colours scaled", map, false, factor));
    } else {
        put_color(values, "base_color", factor, use, made);
    }
    alpha(m, use, pbr.baseColorFactor.size() > 3 ? pbr.baseColorFactor[3] : 1, made);
}

const MadeMaterial& Importer::material(int index, const VertexColor& color) {
    const auto key = std::tuple(index, color.image, color.factor);
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
    made.uv = uv_plan(index);
    made.two_sided = m.doubleSided;
    Values values;
    const auto finish = [&](const char* type) {
        const RestageMaterialDesc desc = {
            .text = {m.name.c_str(), "", ""}, .type = type, .values = values.data(), .value_count = values.size()};
        made.material = out_.material(out_.ctx, &desc);
        return made;
    };
    const std::string what = "material " + quote(m.name);
    const auto& pbr = m.pbrMetallicRoughness;
    if (m.extensions.contains("KHR_materials_unlit")) {
        const TextureUse use = use_of(pbr.baseColorTexture, "base colour");
        alpha(m, use, pbr.baseColorFactor.size() > 3 ? pbr.baseColorFactor[3] : 1, made);
        if (!use && !color.image) { // a colour that no light changes: it emits it and reflects nothing
            made.emission = factor_of(pbr.baseColorFactor, {1, 1, 1});
            made.two_sided = true;
            values.color("reflectance", {0, 0, 0});
            report_.approximated(what + ": unlit", "it emits its colour, and lights what is around it");
            return finish("diffuse");
        }
        report_.approximated(what + ": unlit", "emission has no texture; it is a matte surface of that picture");
        if (color.image)
            values.texture("reflectance", RESTAGE_COLOR,
                           add_imagemap(out_, m.name + " vertex colours", color.image, false, {}));
        else
            put_color(values, "reflectance", factor_of(pbr.baseColorFactor, {1, 1, 1}), use, made);
        return finish("diffuse");
    }

    base_color(m, color, made, values);
    const TextureUse packed = use_of(pbr.metallicRoughnessTexture, "metallic-roughness");
    const bool glossiness = m.extensions.contains("KHR_materials_pbrSpecularGlossiness");
    if (!glossiness) {
        put_scalar(values, "metallic", pbr.metallicFactor, packed, 2, made);
        put_scalar(values, "roughness", pbr.roughnessFactor, packed, 1, made);
    }
    if (const TextureUse normal = use_of(m.normalTexture, "normal")) {
        const double scale = m.normalTexture.scale;
        const RestageHandle map = scale == 1 ? texture(normal, Purpose::linear, made.uv, m.name)
                                             : texture(normal, Purpose::normal, made.uv, m.name, scale);
        if (map) values.texture("normalmap", RESTAGE_TEXTURE, map);
        made.normal_mapped = map != 0;
    }
    if (m.occlusionTexture.index >= 0)
        report_.dropped(what + ": occlusion texture", "shadows of ambient light are computed, not painted");
    made.emission = factor_of(m.emissiveFactor, {0, 0, 0});
    if (largest(made.emission) > 0) made.emission_texture = use_of(m.emissiveTexture, "emissive");
    extensions(m, made, values);
    return finish("principled");
}

} // namespace restage::gltf
