// SPDX-License-Identifier: Apache-2.0
// Appearance: images, textures, materials with their values, media.
#include "io/scene_writer_calls.hpp"
#include "plugin/abi.hpp"

#include <memory>
#include <tuple>

namespace restage::io {

using namespace scene;

ParamSet SceneWriter::params(const RestageValue* values, std::uint32_t count, const std::string& who) {
    ParamSet result;
    for (std::uint32_t i = 0; values && i < count; ++i) {
        const RestageValue in = plugin::element(values, i);
        const std::string id = text(in.id);
        const auto drop = [&](const char* why) { refuse(who + ": parameter \"" + id + "\"", why); };
        const auto type = plugin::model_type(in.type);
        if (id.empty() || !type) {
            drop("it has no id or an unknown type");
            continue;
        }
        if (!finite(in.v[0], in.v[1], in.v[2], in.v[3])) {
            drop("not a finite number; the default is used");
            continue;
        }
        Value value{.type = *type, .text = text(in.text)};
        if (value.is_whole())
            value.i = in.i;
        else
            value.v = {in.v[0], in.v[1], in.v[2], *type == ParamType::color ? 0 : in.v[3]}; // a colour has three
        if (in.ref && value.type == ParamType::material) {
            value.material = {in.ref};
            if (!scene.materials.find(value.material)) {
                drop("there is no such material");
                continue;
            }
        } else if (in.ref) {
            value.texture = {in.ref};
            if (!scene.textures.find(value.texture)) {
                drop("there is no such texture");
                continue;
            }
        }
        result.set(id, std::move(value));
    }
    return result;
}

RestageHandle SceneWriter::Calls::image(void* ctx, const RestageImage* given) {
    return guarded(ctx, "image", [&](SceneWriter& w) -> RestageHandle {
        const RestageImage in = plugin::sized(*given);
        Image image{.path = text(in.path), .encoding = static_cast<Encoding>(in.encoding), .gamma = in.gamma};
        std::string name = text(in.name);
        if (name.empty()) name = image.path.substr(image.path.find_last_of("/\\") + 1);
        const std::string who = "image \"" + name + "\"";
        const auto key = std::tuple(image.path, in.encoding, in.gamma);
        if (!image.path.empty()) {
            if (const auto it = w.image_files_.find(key); it != w.image_files_.end()) return it->second;
        } else if (in.pixels) {
            if (in.width == 0 || in.height == 0 || in.width > 65536 || in.height > 65536 ||
                (in.channels != 1 && in.channels != 3 && in.channels != 4)) {
                w.refuse(who, "its size or number of channels is invalid");
                return 0;
            }
            auto data = std::make_shared<PixelData>();
            *data = {in.width, in.height, in.channels, {}};
            data->values.assign(in.pixels, in.pixels + std::size_t{in.width} * in.height * in.channels);
            image.data = std::move(data);
        } else {
            w.refuse(who, "it has neither a file nor pixels");
            return 0;
        }
        image.name = w.unique_name("image", name);
        image.origin = w.origin(in.origin);
        const bool file = !image.path.empty();
        const RestageHandle handle = w.push(std::move(image));
        if (file) w.image_files_[key] = handle;
        return handle;
    });
}

RestageHandle SceneWriter::Calls::texture(void* ctx, const RestageTexture* given) {
    return guarded(ctx, "texture", [&](SceneWriter& w) -> RestageHandle {
        const RestageTexture in = plugin::sized(*given);
        const std::string name = text(in.name);
        if (!w.known<Image>(in.image, "texture", name)) return 0;
        return w.push(Texture{.name = w.unique_name("texture", name),
                              .type = text(in.type),
                              .is_float = in.is_float != 0,
                              .image = {in.image},
                              .params = w.params(in.values, in.value_count, "texture \"" + name + "\""),
                              .origin = w.origin(in.origin)});
    });
}

RestageHandle SceneWriter::Calls::material(void* ctx, const RestageMaterialDesc* given) {
    return guarded(ctx, "material", [&](SceneWriter& w) -> RestageHandle {
        const RestageMaterialDesc in = plugin::sized(*given);
        const std::string name = text(in.name);
        return w.push(Material{.name = w.unique_name("material", name),
                               .type = text(in.type),
                               .params = w.params(in.values, in.value_count, "material \"" + name + "\""),
                               .origin = w.origin(in.origin)});
    });
}

RestageHandle SceneWriter::Calls::medium(void* ctx, const RestageMedium* given) {
    return guarded(ctx, "medium", [&](SceneWriter& w) -> RestageHandle {
        const RestageMedium in = plugin::sized(*given);
        if (!finite3(in.sigma_a) || !finite3(in.sigma_s) || !finite(in.g)) {
            w.refuse("medium \"" + text(in.name) + "\"", "it has a non-finite value");
            return 0;
        }
        return w.push(Medium{.name = w.unique_name("medium", text(in.name)),
                             .sigma_a = vec3(in.sigma_a),
                             .sigma_s = vec3(in.sigma_s),
                             .g = in.g,
                             .origin = w.origin(in.origin)});
    });
}

} // namespace restage::io
