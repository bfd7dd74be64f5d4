// SPDX-License-Identifier: Apache-2.0
#include "values.hpp"

#include "io/image_file.hpp"

#include <shared_mutex>

namespace restage::python {

using namespace scene;

nb::object to_python(const std::shared_ptr<Workspace>& in, const Value& value) {
    if (value.texture) return nb::cast(Handle<Texture>{in, value.texture});
    switch (value.type) {
        case model::ParamType::number:
            return nb::float_(exact(value.v[0]));
        case model::ParamType::color:
            return nb::make_tuple(exact(value.v[0]), exact(value.v[1]), exact(value.v[2]));
        case model::ParamType::integer:
            return nb::int_(value.i);
        case model::ParamType::boolean:
            return nb::bool_(value.i != 0);
        case model::ParamType::choice:
        case model::ParamType::text:
        case model::ParamType::table:
            return nb::str(value.text.c_str());
        case model::ParamType::material:
            if (value.material) return nb::cast(Handle<Material>{in, value.material});
            break;
        case model::ParamType::texture:
            break;
    }
    return nb::none();
}

Value to_value(const Workspace* in, model::ParamType type, nb::handle h, const std::string& who) {
    Value value{.type = type};
    const auto wrong = [&](const char* expected) {
        return Failure(who + ": expected " + expected + ", not " + nb::cast<std::string>(nb::repr(h)));
    };
    Handle<Texture> texture;
    if (nb::try_cast(h, texture, false)) {
        if (texture.in.get() != in) throw Failure(who + ": this texture belongs to another session");
        if (type != model::ParamType::number && type != model::ParamType::color && type != model::ParamType::texture)
            throw Failure(who + " takes no texture");
        (void)texture.get();
        value.texture = texture.id;
        return value;
    }
    switch (type) {
        case model::ParamType::number:
            if (nb::isinstance<nb::bool_>(h) || !nb::try_cast(h, value.v[0])) throw wrong("a number or a texture");
            return value;
        case model::ParamType::color: {
            std::array<float, 3> rgb{};
            if (nb::try_cast(h, rgb[0])) {
                rgb[1] = rgb[2] = rgb[0];
            } else if (!nb::try_cast(h, rgb)) {
                throw wrong("a colour (three numbers, linear sRGB), one number or a texture");
            }
            value.v = {rgb[0], rgb[1], rgb[2], 0};
            return value;
        }
        case model::ParamType::integer: {
            if (!nb::try_cast(h, value.i)) throw wrong("a whole number");
            return value;
        }
        case model::ParamType::boolean: {
            bool flag = false;
            if (!nb::try_cast(h, flag)) throw wrong("True or False");
            value.i = flag;
            return value;
        }
        case model::ParamType::choice:
        case model::ParamType::text:
            if (!nb::try_cast(h, value.text)) throw wrong("a word");
            return value;
        case model::ParamType::table: {
            const auto path = to_path(h);
            if (!path) throw wrong("the path of a file");
            value.text = *path;
            return value;
        }
        case model::ParamType::material: {
            Handle<Material> material;
            if (!nb::try_cast(h, material, false)) throw wrong("a material");
            if (material.in.get() != in) throw Failure(who + ": this material belongs to another session");
            value.material = material.id;
            return value;
        }
        case model::ParamType::texture:
            if (!h.is_none()) throw wrong("a texture, the path of an image, or None");
            return value;
    }
    throw wrong("another value");
}

model::ParamType guess_type(const Value* before, nb::handle h) {
    if (nb::isinstance<Handle<Texture>>(h)) return before ? before->type : model::ParamType::color;
    if (nb::isinstance<nb::bool_>(h)) return model::ParamType::boolean;
    if (nb::isinstance<Handle<Material>>(h)) return model::ParamType::material;
    if (nb::isinstance<nb::str>(h))
        return before && before->type == model::ParamType::text ? model::ParamType::text : model::ParamType::choice;
    float number = 0;
    if (nb::try_cast(h, number))
        return before && (before->type == model::ParamType::integer || before->type == model::ParamType::color)
                   ? before->type
                   : model::ParamType::number;
    return model::ParamType::color;
}

std::vector<model::Param> table_of(Workspace& in, const std::string& type) {
    const auto entry = in.host().registry().find_material(type);
    return entry ? entry->table->params : std::vector<model::Param>();
}

std::vector<model::Param> texture_table_of(Workspace& in, const std::string& type) {
    const auto entry = in.host().registry().find_texture(type);
    if (!entry) return {};
    std::vector<model::Param> lines = entry->table->params;
    if (entry->table->mapped) lines.insert(lines.end(), model::mapping_params().begin(), model::mapping_params().end());
    return lines;
}

std::vector<Parameter> parameters(model::ParamTable table) {
    std::vector<Parameter> out;
    for (const model::Param& line : table)
        out.push_back({line});
    return out;
}

std::optional<std::string> to_path(nb::handle h) {
    if (!nb::isinstance<nb::str>(h) && !nb::hasattr(h, "__fspath__")) return std::nullopt;
    const auto text = nb::cast<std::string>(nb::module_::import_("os").attr("fspath")(h));
    return std::filesystem::absolute(text).lexically_normal().string();
}

Image read_image(Workspace& in, const std::string& path, scene::Encoding encoding) {
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

using Pixels = nb::ndarray<const float, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

std::shared_ptr<const PixelData> pixels_of(nb::handle h, const char* who) {
    const nb::object array = nb::module_::import_("numpy").attr("ascontiguousarray")(h, "dtype"_a = "float32");
    Pixels view;
    if (!nb::try_cast(array, view) || view.shape(0) == 0 || view.shape(1) == 0 ||
        (view.shape(2) != 1 && view.shape(2) != 3 && view.shape(2) != 4))
        throw Failure(std::string(who) + ": pixels are an array (height, width, 1, 3 or 4), linear");
    PixelData data{.width = std::uint32_t(view.shape(1)),
                   .height = std::uint32_t(view.shape(0)),
                   .channels = std::uint32_t(view.shape(2)),
                   .values = {view.data(), view.data() + view.size()}};
    return std::make_shared<const PixelData>(std::move(data));
}

} // namespace restage::python
