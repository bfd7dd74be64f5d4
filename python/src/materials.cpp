// SPDX-License-Identifier: Apache-2.0
// Materials: types, and values by parameter id, checked against the plugins' tables.
#include "values.hpp"

#include "scene/uses.hpp"

#include <algorithm>
#include <cstring>

namespace restage::python {

using namespace scene;

namespace {

using MaterialHandle = Handle<Material>;

const model::Param* find_line(model::ParamTable table, const std::string& id) {
    const model::Param* line = find_param(table, id);
    return line ? line : find_param(model::surface_params(), id);
}

nb::object get_param(const MaterialHandle& h, const std::string& id) {
    const Material& material = h.get();
    if (const Value* value = material.params.find(id)) return to_python(h.in, *value);
    const auto table = table_of(*h.in, material.type);
    const model::Param* line = find_line(table, id);
    if (!line)
        throw nb::key_error(
            ("material \"" + material.name + "\": parameter \"" + id + "\" does not exist in a " + material.type)
                .c_str());
    return to_python(h.in, default_value(*line));
}

void set_param(const MaterialHandle& h, const std::string& id, nb::handle given) {
    const Material& material = h.get();
    const std::string who = "material \"" + material.name + "\": parameter \"" + id + "\"";
    const auto table = table_of(*h.in, material.type);
    const model::Param* line = find_line(table, id);
    if (!line && !table.empty()) throw Failure(who + " does not exist in a " + material.type);
    const auto type = line ? line->type : guess_type(material.params.find(id), given);
    const bool image =
        type == model::ParamType::number || type == model::ParamType::color || type == model::ParamType::texture;
    if (const auto path = image ? to_path(given) : std::nullopt) {
        if (line && type != model::ParamType::texture && !line->texturable) throw Failure(who + " takes no texture");
        // Colours are sRGB; heights, normals and roughness are data.
        Image pixels =
            read_image(*h.in, *path, type == model::ParamType::color ? scene::Encoding::srgb : scene::Encoding::linear);
        h.in->edit(set_image_texture(h.in->scene(), h.id, id, type, type == model::ParamType::number || id == "bump",
                                     std::move(pixels)));
        return;
    }
    if (type == model::ParamType::texture && given.is_none()) {
        h.in->edit(reset_param(h.in->scene(), h.id, id));
        return;
    }
    h.in->edit(h.in->session().param_edit(h.id, id, to_value(h.in.get(), type, given, who)));
}

std::vector<std::string> param_ids(const MaterialHandle& h) { // the table's, then other values that are set
    std::vector<std::string> ids;
    const Material& material = h.get();
    for (const model::Param& line : table_of(*h.in, material.type))
        ids.emplace_back(line.id);
    for (const auto& entry : material.params.entries())
        if (std::find(ids.begin(), ids.end(), entry.id) == ids.end()) ids.push_back(entry.id);
    return ids;
}

std::string type_name(const model::Param& line) {
    static constexpr const char* names[] = {"float", "color",    "int",     "bool", "enum",
                                            "text",  "material", "texture", "table"};
    return names[std::size_t(line.type)];
}

void bind_parameter(nb::module_& m) {
    nb::class_<Parameter>(m, "Parameter", "One line of a parameter table, of a material, texture or sky.")
        .def_prop_ro(
            "id", [](const Parameter& p) { return p.line.id; }, "Its key: m[id].")
        .def_prop_ro(
            "label", [](const Parameter& p) { return p.line.label; }, "Its name in the editor.")
        .def_prop_ro(
            "type", [](const Parameter& p) { return type_name(p.line); },
            "float, color, int, bool, enum, text, material, texture or table (a file).")
        .def_prop_ro(
            "unit", [](const Parameter& p) { return p.line.unit; }, "Unit, or \"\".")
        .def_prop_ro(
            "range",
            [](const Parameter& p) {
                const bool whole = p.line.type == model::ParamType::integer;
                return whole ? std::make_tuple(double(p.line.int_min), double(p.line.int_max))
                             : std::make_tuple(exact(p.line.min), exact(p.line.max));
            },
            "Smallest and largest value, of each component.")
        .def_prop_ro(
            "default", [](const Parameter& p) { return to_python({}, default_value(p.line)); }, "The default.")
        .def_prop_ro(
            "choices", [](const Parameter& p) { return p.line.choices; }, "Choices of an enum.")
        .def_prop_ro(
            "texturable", [](const Parameter& p) { return p.line.texturable; }, "Whether a texture may replace it.")
        .def_prop_ro(
            "tooltip", [](const Parameter& p) { return p.line.tooltip; }, "One sentence about it.")
        .def("__repr__",
             [](const Parameter& p) { return "<restage.Parameter " + p.line.id + ": " + type_name(p.line) + ">"; });
}

void bind_material(nb::module_& m) {
    nb::class_<MaterialHandle> c(
        m, "Material",
        "A material: a type and values by parameter id. m[\"roughness\"] reads, m[\"roughness\"] = 0.2 edits; a value "
        "may\n"
        "be a number, a colour (three numbers, linear sRGB), a word, a Texture, or the path of an image or a table.");
    bind_handle(c, "Material");
    c.def("__getitem__", &get_param, "id"_a, "The value, or the default if unset.")
        .def("__setitem__", &set_param, "id"_a, "value"_a.none(),
             nb::sig("def __setitem__(self, id: str, value: float | int | bool | str | os.PathLike | "
                     "numpy.typing.ArrayLike | Texture | Material | None) -> None"))
        .def(
            "__delitem__",
            [](const MaterialHandle& h, const std::string& id) {
                (void)get_param(h, id);
                h.in->edit(reset_param(h.in->scene(), h.id, id));
            },
            "id"_a, "Resets it to the default.")
        .def("__contains__",
             [](const MaterialHandle& h, const std::string& id) {
                 const auto ids = param_ids(h);
                 return std::find(ids.begin(), ids.end(), id) != ids.end();
             })
        .def(
            "__iter__", [](const MaterialHandle& h) { return nb::iter(nb::cast(param_ids(h))); },
            nb::sig("def __iter__(self) -> collections.abc.Iterator[str]"))
        .def("__len__", [](const MaterialHandle& h) { return param_ids(h).size(); })
        .def("keys", &param_ids, "The ids of all parameters: dict(m) is a copy of the values.")
        .def(
            "update",
            [](const MaterialHandle& h, const nb::kwargs& values) {
                h.in->begin_step("Change " + h.get().name);
                try {
                    for (const auto& [id, value] : values)
                        set_param(h, nb::cast<std::string>(id), value);
                } catch (...) {
                    h.in->end_step();
                    throw;
                }
                h.in->end_step();
            },
            "values"_a, "Sets several parameters as one undo step.")
        .def_prop_rw(
            "type", [](const MaterialHandle& h) { return h.get().type; },
            [](const MaterialHandle& h, const std::string& type) {
                const auto after = table_of(*h.in, type);
                if (!h.in->host().registry().find_material(type))
                    throw Failure("there is no material type \"" + type + "\"; see restage.material_types()");
                h.in->edit(switch_material_type(h.in->scene(), h.id, type, table_of(*h.in, h.get().type), after));
            },
            "Its type, \"dielectric\"; changing it keeps the common values.")
        .def_prop_ro(
            "parameters", [](const MaterialHandle& h) { return parameters(table_of(*h.in, h.get().type)); },
            "The table of its type: a list of Parameter.")
        .def_prop_ro(
            "objects",
            [](const MaterialHandle& h) {
                (void)h.get();
                std::vector<Handle<Instance>> users;
                h.in->scene().instances.each([&](Id<Instance> id, const Instance& instance) {
                    if (instance.material == h.id) users.push_back({h.in, id});
                });
                return users;
            },
            "The objects that use it.")
        .def(
            "remove", [](const MaterialHandle& h) { h.in->edit(remove(h.in->scene(), h.id)); },
            "Removes it; refused while something uses it.");
}

} // namespace

void bind_materials(nb::module_& m) {
    bind_parameter(m);
    bind_material(m);
    m.def(
        "material_types",
        [] {
            nb::typed<nb::dict, nb::str, nb::list> types;
            for (const auto& entry : Host::get()->registry().materials())
                types[entry.table->type.c_str()] = nb::cast(parameters(entry.table->params));
            return types;
        },
        "The material types of all loaded plugins: a dict from type to its table, a list of Parameter.",
        nb::sig("def material_types() -> dict[str, list[Parameter]]"));
    m.def(
        "sky_types",
        [] {
            nb::typed<nb::dict, nb::str, nb::list> types;
            for (const auto& sky : Host::get()->registry().catalogue()->skies)
                types[sky.table->type.c_str()] = nb::cast(parameters(sky.table->params));
            return types;
        },
        "The skies of all loaded plugins: a dict from type to its table, a list of Parameter. See Session.make_sky.",
        nb::sig("def sky_types() -> dict[str, list[Parameter]]"));
}

} // namespace restage::python
