// SPDX-License-Identifier: Apache-2.0
// Textures: their picture, channel and mapping. Pictures in files stay files; embedded ones, single channels, masks and
// mirrored tilings become pixels.
#include "common/file.hpp"
#include "importer.hpp"

#include <cmath>
#include <cstring>

namespace restage::gltf {

double number_of(const tinygltf::Value& object, const char* key, double otherwise) {
    if (!object.IsObject() || !object.Has(key) || !object.Get(key).IsNumber()) return otherwise;
    const double value = object.Get(key).GetNumberAsDouble();
    return std::isfinite(value) ? value : otherwise;
}

Rgb color_of(const tinygltf::Value& object, const char* key, Rgb otherwise) {
    if (!object.IsObject() || !object.Has(key) || !object.Get(key).IsArray()) return otherwise;
    const auto& array = object.Get(key);
    for (std::size_t i = 0; i < 3 && i < array.ArrayLen(); ++i)
        if (array.Get(static_cast<int>(i)).IsNumber())
            otherwise[i] = array.Get(static_cast<int>(i)).GetNumberAsDouble();
    return otherwise;
}

TextureUse Importer::make_use(int index, int set, const tinygltf::ExtensionMap& extensions, const char* slot) const {
    TextureUse use{index, set, {}, slot};
    const auto it = extensions.find("KHR_texture_transform");
    if (it == extensions.end() || !it->second.IsObject()) return use;
    const auto& t = it->second;
    use.set = static_cast<int>(number_of(t, "texCoord", set));
    const Rgb offset = color_of(t, "offset", {0, 0, 0}), scale = color_of(t, "scale", {1, 1, 1});
    const double angle = number_of(t, "rotation", 0), cosine = std::cos(angle), sine = std::sin(angle);
    // Translation * Rotation * Scale; the extension's rotation is [cos sin; -sin cos] on (u, v).
    use.transform = {cosine * scale[0], sine * scale[1], -sine * scale[0], cosine * scale[1], offset[0], offset[1]};
    if (angle == 0) use.transform.b = use.transform.c = 0;
    return use;
}

TextureUse Importer::use_of(const tinygltf::Value& owner, const char* key, const char* slot) const {
    if (!owner.IsObject() || !owner.Has(key) || !owner.Get(key).IsObject()) return {};
    const auto& info = owner.Get(key);
    tinygltf::ExtensionMap extensions;
    if (info.Has("extensions") && info.Get("extensions").IsObject() &&
        info.Get("extensions").Has("KHR_texture_transform"))
        extensions["KHR_texture_transform"] = info.Get("extensions").Get("KHR_texture_transform");
    return make_use(static_cast<int>(number_of(info, "index", -1)), static_cast<int>(number_of(info, "texCoord", 0)),
                    extensions, slot);
}

int Importer::image_of(const TextureUse& use) {
    const auto& texture = at(model_.textures, use.index, "texture", use.slot + " texture");
    const auto webp = texture.extensions.find("EXT_texture_webp"); // source: the fallback for other readers
    const int source =
        webp == texture.extensions.end() ? texture.source : static_cast<int>(number_of(webp->second, "source", -1));
    if (source < 0) {
        report_.dropped("texture " + std::to_string(use.index), texture.extensions.contains("KHR_texture_basisu")
                                                                    ? "KTX2 pictures (KHR_texture_basisu) are not read"
                                                                    : "it names no picture");
        return -1;
    }
    at(model_.images, source, "image", "texture " + std::to_string(use.index));
    return source;
}

const Picture* Importer::picture(int index) {
    const auto [it, fresh] = pictures_.try_emplace(index);
    if (!fresh) return it->second ? &*it->second : nullptr;
    const auto& image = model_.images[static_cast<std::size_t>(index)];
    const std::string what = image.uri.empty() ? "image " + std::to_string(index) : decode_uri(image.uri);
    std::string reason;
    if (!image.uri.empty()) {
        it->second = read_picture(locate(image.uri).string(), reason);
    } else if (image.bufferView >= 0) {
        const auto bytes = view_bytes(model_, image.bufferView, what);
        it->second = decode_picture({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, what, reason);
    } else {
        const auto& bytes = image.image;
        it->second = decode_picture({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, what, reason);
    }
    if (!it->second)
        report_.dropped("image " + quote(image.uri.empty() ? std::to_string(index) : decode_uri(image.uri)), reason);
    else if (!it->second->problem.empty())
        report_.approximated("image " + quote(what), it->second->problem);
    return it->second ? &*it->second : nullptr;
}

RestageHandle Importer::image(int index, Purpose purpose, double number, bool mirror_u, bool mirror_v) {
    const auto key = std::tuple(index, static_cast<int>(purpose), number, mirror_u, mirror_v);
    if (const auto it = images_.find(key); it != images_.end()) return it->second;
    RestageHandle& handle = images_[key];
    const auto& source = model_.images[static_cast<std::size_t>(index)];
    const bool as_it_is = purpose == Purpose::srgb || purpose == Purpose::linear;
    if (as_it_is && !source.uri.empty() && !mirror_u && !mirror_v)
        return handle = add_image_file(out_, locate(source.uri).string(),
                                       purpose == Purpose::srgb ? RESTAGE_SRGB : RESTAGE_LINEAR);
    const Picture* p = picture(index);
    if (!p) return 0;
    static constexpr const char* suffixes[] = {"",       "",      " red",    " green",    " blue",
                                               " alpha", " mask", " scaled", " roughness"};
    std::string name = source.name.empty() ? decode_uri(source.uri) : source.name;
    if (name.empty()) name = "image " + std::to_string(index);
    name += suffixes[static_cast<int>(purpose)];
    if (mirror_u || mirror_v) name += " mirrored";
    const bool color = as_it_is || purpose == Purpose::normal;
    const std::uint32_t width = p->width * (mirror_u ? 2 : 1), height = p->height * (mirror_v ? 2 : 1);
    handle = add_pixels(out_, name, width, height, color ? 3 : 1, [&](std::size_t pixel, unsigned channel) {
        std::size_t x = pixel % width, y = pixel / width;
        if (x >= p->width) x = width - 1 - x;
        if (y >= p->height) y = height - 1 - y;
        const std::size_t from = y * p->width + x;
        switch (purpose) {
            case Purpose::srgb:
                return srgb_to_linear(p->value(from, channel));
            case Purpose::mask: // number: the smallest visible alpha
                return p->value(from, 3) >= number ? 1.0 : 0.0;
            case Purpose::normal: // number: scale of x and y (glTF 2.0, 3.9.3)
                return channel == 2 ? p->value(from, 2)
                                    : std::clamp(0.5 + (p->value(from, channel) - 0.5) * number, 0.0, 1.0);
            case Purpose::gloss: // number: the factor of the glossiness
                return 1 - std::clamp(p->value(from, 3) * number, 0.0, 1.0);
            case Purpose::linear:
                return p->value(from, channel);
            default:
                return p->value(from, static_cast<unsigned>(purpose) - static_cast<unsigned>(Purpose::red));
        }
    });
    return handle;
}

// uv of the mesh, v upwards -> st of the picture. Mirrored tilings are doubled pictures, tiled.
Mapping Importer::mapping(const TextureUse& use, const UvSets& sets, bool& mirror_u, bool& mirror_v,
                          const std::string& material) {
    const std::string what = "material " + quote(material) + ": " + use.slot + " texture";
    UvTransform t = use.transform;
    const int set = sets.find(use.set);
    if (set < 0)
        report_.approximated(what,
                             "TEXCOORD_" + std::to_string(use.set) +
                                 ": objects have two sets of texture coordinates, and others use them; it lies on "
                                 "the first");
    const auto& texture = model_.textures[static_cast<std::size_t>(use.index)];
    tinygltf::Sampler sampler;
    if (texture.sampler >= 0)
        sampler = at(model_.samplers, texture.sampler, "sampler", "texture " + std::to_string(use.index));
    mirror_u = sampler.wrapS == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    mirror_v = sampler.wrapT == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    const bool clamp_u = sampler.wrapS == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    const bool clamp_v = sampler.wrapT == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    if (clamp_u != clamp_v)
        report_.approximated(what, "it repeats in one direction and not in the other; here it repeats in both");
    if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST)
        report_.approximated(what, "nearest-neighbour filtering is bilinear here");
    if (mirror_u) t.a /= 2, t.b /= 2, t.x /= 2;
    if (mirror_v) t.c /= 2, t.d /= 2, t.y /= 2;
    return {.scale_u = t.a, // with v = 1 - v of the mesh, and t = 1 - v' of the picture
            .scale_v = t.d,
            .offset_u = t.b + t.x,
            .offset_v = 1 - t.d - t.y,
            .wrap = clamp_u && clamp_v ? "clamp" : "repeat",
            .shear_u = -t.b,
            .shear_v = -t.c,
            .set = std::max(set, 0)};
}

RestageHandle Importer::texture(const TextureUse& use, Purpose purpose, const UvSets& sets, const std::string& material,
                                double number) {
    const int index = image_of(use);
    if (index < 0) return 0;
    bool mirror_u = false, mirror_v = false;
    const Mapping map = mapping(use, sets, mirror_u, mirror_v, material);
    const bool color = purpose == Purpose::srgb || purpose == Purpose::linear || purpose == Purpose::normal;
    return add_imagemap(out_, material + " " + use.slot, image(index, purpose, number, mirror_u, mirror_v), !color,
                        map);
}

} // namespace restage::gltf
