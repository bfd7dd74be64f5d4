// SPDX-License-Identifier: Apache-2.0
// Textures: of images and of any type of a plugin, with values and operands checked against its table.
#include "values.hpp"

#include "scene/edits_texture.hpp"
#include "scene/uses.hpp"

#include <algorithm>

namespace restage::python {

using namespace scene;

namespace {

using TextureHandle = Handle<Texture>;
using Shared = std::shared_ptr<Workspace>;

std::string who_of(const Texture& texture, const std::string& id) {
    return "texture \"" + texture.name + "\": parameter \"" + id + "\"";
}

nb::object get_param(const TextureHandle& h, const std::string& id) {
    const Texture& texture = h.get();
    if (const Value* value = texture.params.find(id)) return to_python(h.in, *value);
    const auto table = texture_table_of(*h.in, texture.type);
    const model::Param* line = find_param(table, id);
    if (!line) throw nb::key_error((who_of(texture, id) + " does not exist in a " + texture.type).c_str());
    return to_python(h.in, default_value(*line));
}

void set_param(const TextureHandle& h, const std::string& id, nb::handle given) {
    const Texture& texture = h.get();
    const std::string who = who_of(texture, id);
    const auto table = texture_table_of(*h.in, texture.type);
    const model::Param* line = find_param(table, id);
    if (!line && !table.empty()) throw Failure(who + " does not exist in a " + texture.type);
    const Value* before = texture.params.find(id);
    const auto type = line ? line->type : guess_type(before, given);
    if (const auto path = line && line->texturable ? to_path(given) : std::nullopt) {
        const bool scalar = texture.is_float || type == model::ParamType::number;
        Image pixels = read_image(*h.in, *path, scalar ? scene::Encoding::linear : scene::Encoding::srgb);
        h.in->edit(set_image_texture(
            h.in->scene(),
            {.of = h.id, .param = id, .value = before ? *before : default_value(*line), .scalar = scalar},
            std::move(pixels)));
        return;
    }
    Value value = to_value(h.in.get(), type, given, who);
    if (line)
        if (const std::string why = misfit(*line, value); !why.empty()) throw Failure(who + why);
    h.in->edit(scene::set_param(h.in->scene(), h.id, id, std::move(value)));
}

std::vector<std::string> param_ids(const TextureHandle& h) { // the table's, then other values that are set
    std::vector<std::string> ids;
    const Texture& texture = h.get();
    for (const model::Param& line : texture_table_of(*h.in, texture.type))
        ids.push_back(line.id);
    for (const auto& entry : texture.params.entries())
        if (std::find(ids.begin(), ids.end(), entry.id) == ids.end()) ids.push_back(entry.id);
    return ids;
}

plugin::TextureEntry texture_type(Workspace& w, const std::string& type) {
    const auto entry = w.host().registry().find_texture(type);
    if (!entry) throw Failure("there is no texture type \"" + type + "\"; see restage.texture_types()");
    return *entry;
}

TextureHandle add_texture(const Shared& w, nb::handle image, const std::optional<std::string>& name, bool scalar,
                          const std::string& type, const nb::kwargs& values) {
    const auto entry = texture_type(*w, type);
    if (entry.table->image && image.is_none())
        throw Failure("add_texture: a texture of type " + type + " needs an image: a path or an array");
    if (!entry.table->image && !image.is_none()) throw Failure("add_texture: a " + type + " has no image");
    Texture texture{.name = name.value_or(entry.table->label), .type = type, .is_float = scalar};
    const TextureHandle h{w, w->scene().textures.next()};
    const Id<Image> image_id = w->scene().images.next();
    std::optional<Image> made;
    if (!image.is_none()) {
        if (const auto path = to_path(image))
            made = read_image(*w, *path, scalar ? scene::Encoding::linear : scene::Encoding::srgb);
        else
            made = {.name = "image", .encoding = scene::Encoding::linear, .data = pixels_of(image, "add_texture")};
        if (name) made->name = *name;
        texture.name = made->name;
        texture.image = image_id;
    }
    const std::string label = "Add texture " + texture.name;
    w->begin_step(label);
    const auto undo = [&] { // insertion and removal in one step cancel out
        w->edit(remove(w->scene(), h.id));
        if (made) w->edit(remove(w->scene(), image_id));
    };
    try {
        Edit edit{label, {}};
        if (made) edit.changes.push_back(Change<Image>{image_id, std::nullopt, made});
        edit.changes.push_back(Change<Texture>{h.id, std::nullopt, std::move(texture)});
        w->edit(std::move(edit));
        try {
            for (const auto& [id, value] : values)
                set_param(h, nb::cast<std::string>(id), value);
        } catch (...) {
            undo();
            throw;
        }
    } catch (...) {
        w->end_step();
        throw;
    }
    w->end_step();
    return h;
}

void set_type(const TextureHandle& h, const std::string& type) {
    const auto after = texture_type(*h.in, type);
    const auto before = h.in->host().registry().find_texture(h.get().type);
    h.in->edit(switch_texture_type(h.in->scene(), h.id, before ? before->table : nullptr, *after.table));
}

} // namespace

void bind_textures(nb::module_& m) {
    nb::class_<TextureHandle> c(m, "Texture",
                                "A texture: a type and values by parameter id, like a Material. t[\"uscale\"] = 2.0; "
                                "an operand, a parameter that\n"
                                "is texturable, may be a number, a colour, another Texture, or the path of an image.");
    bind_handle(c, "Texture");
    c.def_prop_rw(
         "type", [](const TextureHandle& h) { return h.get().type; }, &set_type,
         "imagemap, checkerboard, fbm, ...: see texture_types(). Changing it keeps the common values.")
        .def_prop_ro(
            "parameters", [](const TextureHandle& h) { return parameters(texture_table_of(*h.in, h.get().type)); },
            "The table of its type: a list of Parameter.")
        .def_prop_ro(
            "scalar", [](const TextureHandle& h) { return h.get().is_float; },
            "One channel (True) or a colour (False).")
        .def_prop_ro(
            "image_path",
            [](const TextureHandle& h) -> std::optional<std::string> {
                const Image* image = h.in->scene().images.find(h.get().image);
                if (!image || image->path.empty()) return std::nullopt;
                return image->path;
            },
            "File of its image, or None.")
        .def("__getitem__", &get_param, "id"_a, "The value, or the default if unset.")
        .def("__setitem__", &set_param, "id"_a, "value"_a,
             nb::sig("def __setitem__(self, id: str, value: float | int | bool | str | os.PathLike | "
                     "numpy.typing.ArrayLike | Texture) -> None"))
        .def(
            "__delitem__",
            [](const TextureHandle& h, const std::string& id) {
                (void)get_param(h, id);
                h.in->edit(reset_param(h.in->scene(), h.id, id));
            },
            "id"_a, "Resets it to the default.")
        .def("__contains__",
             [](const TextureHandle& h, const std::string& id) {
                 const auto ids = param_ids(h);
                 return std::find(ids.begin(), ids.end(), id) != ids.end();
             })
        .def(
            "__iter__", [](const TextureHandle& h) { return nb::iter(nb::cast(param_ids(h))); },
            nb::sig("def __iter__(self) -> collections.abc.Iterator[str]"))
        .def("__len__", [](const TextureHandle& h) { return param_ids(h).size(); })
        .def("keys", &param_ids, "The ids of all parameters: dict(t) is a copy of the values.")
        .def(
            "remove", [](const TextureHandle& h) { h.in->edit(remove(h.in->scene(), h.id)); },
            "Removes it; refused while something uses it.");
    m.def(
        "texture_types",
        [] {
            nb::typed<nb::dict, nb::str, nb::list> types;
            for (const auto& entry : Host::get()->registry().textures()) {
                std::vector<model::Param> lines = entry.table->params;
                if (entry.table->mapped)
                    lines.insert(lines.end(), model::mapping_params().begin(), model::mapping_params().end());
                types[entry.table->type.c_str()] = nb::cast(parameters(lines));
            }
            return types;
        },
        "The texture types of all loaded plugins: a dict from type to its table, a list of Parameter.",
        nb::sig("def texture_types() -> dict[str, list[Parameter]]"));
}

void bind_add_texture(nb::class_<Workspace>& session) {
    session.def(
        "add_texture", &add_texture, "image"_a = nb::none(), "name"_a = nb::none(), "scalar"_a = false,
        "type"_a = "imagemap", "values"_a,
        "A new texture of an image: a path (8-bit files are sRGB, or linear if scalar), or a linear array (H, W, C).\n"
        "Or of another type: add_texture(type=\"checkerboard\", tex1=(1, 0, 0), uscale=4.0); operands may be "
        "textures.\nscalar: one channel, for numbers and heights.",
        nb::sig("def add_texture(self, image: str | os.PathLike | numpy.typing.ArrayLike | None = None, "
                "name: str | None = None, scalar: bool = False, type: str = \"imagemap\", **values) -> Texture"));
}

} // namespace restage::python
