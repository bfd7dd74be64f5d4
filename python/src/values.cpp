// SPDX-License-Identifier: Apache-2.0
#include "values.hpp"

#include "io/image_file.hpp"

#include <shared_mutex>

namespace restage::python {

using namespace scene;

nb::object to_python(const std::shared_ptr<Workspace>& in, const Value& value) {
    if (value.texture) return nb::cast(Handle<Texture>{in, value.texture});
    switch (value.type) {
        case RESTAGE_FLOAT:
            return nb::float_(exact(value.v[0]));
        case RESTAGE_COLOR:
            return nb::make_tuple(exact(value.v[0]), exact(value.v[1]), exact(value.v[2]));
        case RESTAGE_INT:
            return nb::int_(static_cast<long>(value.v[0]));
        case RESTAGE_BOOL:
            return nb::bool_(value.v[0] != 0);
        case RESTAGE_ENUM:
        case RESTAGE_TEXT:
        case RESTAGE_TABLE:
            return nb::str(value.text.c_str());
        case RESTAGE_MATERIAL:
            if (value.material) return nb::cast(Handle<Material>{in, value.material});
            break;
        case RESTAGE_TEXTURE:
            break;
    }
    return nb::none();
}

Value to_value(const Workspace* in, RestageType type, nb::handle h, const std::string& who) {
    Value value{.type = type};
    const auto wrong = [&](const char* expected) {
        return Failure(who + ": expected " + expected + ", not " + nb::cast<std::string>(nb::repr(h)));
    };
    Handle<Texture> texture;
    if (nb::try_cast(h, texture, false)) {
        if (texture.in.get() != in) throw Failure(who + ": this texture belongs to another session");
        if (type != RESTAGE_FLOAT && type != RESTAGE_COLOR && type != RESTAGE_TEXTURE)
            throw Failure(who + " takes no texture");
        (void)texture.get();
        value.texture = texture.id;
        return value;
    }
    switch (type) {
        case RESTAGE_FLOAT:
            if (nb::isinstance<nb::bool_>(h) || !nb::try_cast(h, value.v[0])) throw wrong("a number or a texture");
            return value;
        case RESTAGE_COLOR: {
            std::array<float, 3> rgb{};
            if (nb::try_cast(h, rgb[0])) {
                rgb[1] = rgb[2] = rgb[0];
            } else if (!nb::try_cast(h, rgb)) {
                throw wrong("a colour (three numbers, linear sRGB), one number or a texture");
            }
            value.v = {rgb[0], rgb[1], rgb[2], 0};
            return value;
        }
        case RESTAGE_INT: {
            int number = 0;
            if (!nb::try_cast(h, number)) throw wrong("a whole number");
            value.v[0] = static_cast<float>(number);
            return value;
        }
        case RESTAGE_BOOL: {
            bool flag = false;
            if (!nb::try_cast(h, flag)) throw wrong("True or False");
            value.v[0] = flag ? 1.f : 0.f;
            return value;
        }
        case RESTAGE_ENUM:
        case RESTAGE_TEXT:
            if (!nb::try_cast(h, value.text)) throw wrong("a word");
            return value;
        case RESTAGE_TABLE: {
            const auto path = to_path(h);
            if (!path) throw wrong("the path of a file");
            value.text = *path;
            return value;
        }
        case RESTAGE_MATERIAL: {
            Handle<Material> material;
            if (!nb::try_cast(h, material, false)) throw wrong("a material");
            if (material.in.get() != in) throw Failure(who + ": this material belongs to another session");
            value.material = material.id;
            return value;
        }
        case RESTAGE_TEXTURE:
            if (!h.is_none()) throw wrong("a texture, the path of an image, or None");
            return value;
    }
    throw wrong("another value");
}

RestageType guess_type(const Value* before, nb::handle h) {
    if (nb::isinstance<Handle<Texture>>(h)) return before ? before->type : RESTAGE_COLOR;
    if (nb::isinstance<nb::bool_>(h)) return RESTAGE_BOOL;
    if (nb::isinstance<Handle<Material>>(h)) return RESTAGE_MATERIAL;
    if (nb::isinstance<nb::str>(h)) return before && before->type == RESTAGE_TEXT ? RESTAGE_TEXT : RESTAGE_ENUM;
    float number = 0;
    if (nb::try_cast(h, number))
        return before && (before->type == RESTAGE_INT || before->type == RESTAGE_COLOR) ? before->type : RESTAGE_FLOAT;
    return RESTAGE_COLOR;
}

std::span<const RestageParam> table_of(Workspace& in, const std::string& type) {
    const auto entry = in.host().registry().find_material(type);
    if (!entry) return {};
    return {entry->table->params, entry->table->param_count};
}

std::optional<std::string> to_path(nb::handle h) {
    if (!nb::isinstance<nb::str>(h) && !nb::hasattr(h, "__fspath__")) return std::nullopt;
    const auto text = nb::cast<std::string>(nb::module_::import_("os").attr("fspath")(h));
    return std::filesystem::absolute(text).lexically_normal().string();
}

Image read_image(Workspace& in, const std::string& path, RestageEncoding encoding) {
    std::string warning;
    Result<PixelData> pixels = [&] {
        const nb::gil_scoped_release release;
        return io::read_image(path, encoding, 2.2f, &warning);
    }();
    auto data = std::make_shared<const PixelData>(take(std::move(pixels)));
    if (!warning.empty()) in.host().log().warning(warning);
    in.host().flush_log();
    return {.name = std::filesystem::path(path).stem().string(),
            .path = path,
            .encoding = encoding,
            .data = std::move(data)};
}

} // namespace restage::python
