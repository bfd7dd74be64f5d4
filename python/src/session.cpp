// SPDX-License-Identifier: Apache-2.0
// Session: opening, finding, adding, history, writing. Rendering is in render.cpp.
#include "collections.hpp"
#include "values.hpp"
#include "work.hpp"

#include "document/linking.hpp"
#include "document/pack.hpp"
#include "document/preset.hpp"
#include "document/project.hpp"
#include "io/strict.hpp"
#include "query/wholes.hpp"
#include "scene/development.hpp"
#include "scene/links.hpp"
#include "scene/same_material.hpp"
#include "scene/share_materials.hpp"
#include "scene/sky.hpp"
#include "scene/studio.hpp"

#include <fmt/ranges.h>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

namespace restage::python {

using namespace scene;
using Shared = std::shared_ptr<Workspace>;

namespace {

// A dict of them. The importer refuses unknown options and wrong types.
std::optional<ParamSet> import_options(const std::optional<nb::dict>& given) {
    if (!given) return std::nullopt;
    ParamSet options;
    for (const auto& [key, value] : *given) {
        const auto id = nb::cast<std::string>(nb::str(key));
        if (nb::isinstance<nb::bool_>(value))
            options.set(id, Value::boolean(nb::cast<bool>(value)));
        else if (int whole = 0; nb::isinstance<nb::int_>(value) && nb::try_cast(value, whole))
            options.set(id, Value::integer(whole));
        else if (nb::isinstance<nb::float_>(value))
            options.set(id, Value::number(nb::cast<float>(value)));
        else if (nb::isinstance<nb::str>(value))
            options.set(id, Value::choice(nb::cast<std::string>(value)));
        else
            throw Failure("option \"" + id + "\": a value is text, a number, True or False, not " +
                          nb::cast<std::string>(nb::repr(value)));
    }
    return options;
}

Shared open(const std::filesystem::path& path, const std::optional<std::filesystem::path>& base,
            const nb::object& progress, bool strict, const std::optional<nb::dict>& options_given) {
    auto workspace = std::make_shared<Workspace>(Host::get());
    const std::optional<ParamSet> wanted = import_options(options_given);
    auto document = work(workspace->host(), progress, [&](io::Progress tell) {
        document::ReadOptions options;
        options.progress = std::move(tell);
        if (base) options.base = *base;
        options.import_options = wanted;
        return document::read_document(path.string(), workspace->host().registry(), options);
    });
    if (strict) take(io::refuse_losses(document.report, path.string()));
    workspace->session().adopt(std::move(document));
    return workspace;
}

Handle<Material> add_material(const Shared& w, const std::string& name, const std::string& type,
                              const nb::kwargs& values) {
    if (!w->host().registry().find_material(type))
        throw Failure("there is no material type \"" + type + "\"; see restage.material_types()");
    const Handle<Material> h{w, w->scene().materials.next()};
    w->begin_step("Add " + name);
    try {
        w->edit(insert(w->scene(), Material{.name = name, .type = type}, "Add " + name));
        nb::cast(h).attr("update")(**values);
    } catch (...) { // reverted completely: insert and remove in one step cancel out
        w->edit(remove(w->scene(), h.id));
        w->end_step();
        throw;
    }
    w->end_step();
    return h;
}

Handle<Material> add_preset(const Shared& w, const std::filesystem::path& file) {
    auto preset = take(document::read_preset(file, w->host().registry()));
    take(document::read_images(preset));
    w->edit(document::give_preset(w->scene(), preset, {}));
    return {w, find_same_material(w->scene(), preset.parts, preset.material)};
}

Handle<Light> add_light(const Shared& w, const std::string& kind, const Three& value, const std::string& name) {
    Light light{.name = name, .value = glm::vec3(vec(value))};
    const auto known = scene::light_kind(kind);
    if (!known) {
        std::string all;
        for (const scene::LightKindRow& row : scene::light_kinds)
            all += (all.empty() ? "" : ", ") + std::string(row.id);
        throw Failure("there is no kind of light \"" + kind + "\"; there are " + all);
    }
    light.kind = *known;
    const Handle<Light> h{w, w->scene().lights.next()};
    w->edit(insert(w->scene(), std::move(light), "Add " + name));
    return h;
}

void set_sky(const Shared& w, nb::handle image, const std::optional<Three>& color, double strength,
             std::optional<double> rotation, std::optional<bool> hidden) {
    const glm::dvec3 up = w->up();
    Edit edit{"Change sky", {}};
    Environment sky;
    if (const auto& now = w->scene().environment.value) sky = *now;
    if (!image.is_none()) {
        std::shared_ptr<const PixelData> pixels;
        if (const auto path = to_path(image)) {
            pixels = read_image(*w, *path, scene::Encoding::srgb).data;
            edit = scene::image_sky(w->scene(), *path, pixels, up);
            sky = *std::get<ChangeOne<std::optional<Environment>>>(edit.changes.back()).after;
            edit.changes.pop_back();
        } else {
            pixels = pixels_of(image, "set_sky");
            sky = {.name = "sky",
                   .image = w->scene().images.next(),
                   .mapping = pixels->width == pixels->height ? scene::Mapping::octahedral : scene::Mapping::equirect,
                   .light_to_world = scene::upright_sky(up)};
            edit.changes.push_back(
                Change<Image>{sky.image, std::nullopt,
                              Image{.name = "sky", .encoding = scene::Encoding::linear, .data = std::move(pixels)}});
        }
        sky.scale = glm::vec3(1);
    } else if (color) {
        sky.image = {}, sky.sky.clear(), sky.sky_params = {};
        sky.name = "constant";
    } else if (!w->scene().environment.value) {
        throw Failure("there is no sky to change; give an image or a color");
    }
    if (color) sky.scale = glm::vec3(vec(*color));
    sky.scale *= float(strength);
    if (rotation)
        sky.light_to_world =
            glm::rotate(glm::dmat4(1), glm::radians(*rotation), glm::normalize(up)) * scene::upright_sky(up);
    if (hidden) sky.hidden_from_camera = *hidden;
    const Edit change = set_environment(w->scene(), sky);
    edit.changes.insert(edit.changes.end(), change.changes.begin(), change.changes.end());
    w->edit(std::move(edit));
}

nb::object find(const Shared& w, const std::string& name) {
    if (const auto group = w->session().find<Group>(name)) return nb::cast(Handle<Group>{w, group});
    if (const auto object = w->session().find<Instance>(name)) return nb::cast(Handle<Instance>{w, object});
    std::vector<std::string> names;
    w->scene().groups.each([&](auto, const Group& g) { names.push_back(g.name); });
    w->scene().instances.each([&](auto, const Instance& i) { names.push_back(i.name); });
    const std::string near = nearest_name(names, name);
    throw nb::key_error(("there is no group or object called \"" + name + "\"" +
                         (near.empty() ? "" : "; did you mean \"" + near + "\"?"))
                            .c_str());
}

nb::object insert_file(const Shared& w, const std::filesystem::path& path, const nb::object& progress,
                       const std::optional<nb::dict>& options_given, bool link) {
    const std::optional<ParamSet> wanted = import_options(options_given);
    const auto imported = work(w->host(), progress, [&](io::Progress tell) {
        io::ImportOptions options;
        options.progress = std::move(tell);
        if (wanted) options.values = *wanted;
        return io::import_scene(path.string(), w->host().registry(), options);
    });
    const auto merged = take(link ? document::link(w->session(), imported, path.string())
                                  : w->session().insert(imported, path.string()));
    if (merged.group) return nb::cast(Handle<Group>{w, merged.group});
    return nb::cast(Handle<Instance>{w, merged.instances.at(0)});
}

void reload_links(const Shared& w, const nb::object& progress) {
    for (const Id<Group> id : all_links(w->scene())) {
        const LinkSource source = *link_source(w->scene().groups[id]);
        const auto imported = work(w->host(), progress, [&](io::Progress tell) {
            document::ReadOptions reading = document::reading_of(source, w->host().registry());
            reading.progress = std::move(tell);
            return document::read_scene(source.file, w->host().registry(), reading, source.format);
        });
        take(document::reload_link(w->session(), id, imported));
    }
}

io::Report export_to(const Shared& w, const std::filesystem::path& path, const std::string& format,
                     const nb::object& progress, bool strict, const nb::kwargs& options) {
    auto& registry = w->host().registry();
    io::ExportOptions how;
    how.format = format;
    const auto exporter = take(io::find_exporter(path.string(), format, registry));
    for (const auto& [key, value] : options) {
        const std::string text = nb::isinstance<nb::bool_>(value) ? (nb::cast<bool>(value) ? "true" : "false")
                                                                  : nb::cast<std::string>(nb::str(value));
        take(io::set_option(*exporter.table, nb::cast<std::string>(key) + "=" + text, how.values));
    }
    const Scene copy = w->scene();
    return work(w->host(), progress, [&](io::Progress tell) {
        how.progress = std::move(tell);
        return strict ? io::export_strictly(copy, path.string(), registry, how)
                      : io::export_scene(copy, path.string(), registry, how);
    });
}

struct Step {
    Shared in;
    std::string label;
};

void bind_history(nb::module_& m, nb::class_<Workspace>& c) {
    nb::class_<Step>(m, "Step", "The context manager that Session.step returns.")
        .def("__enter__", [](const Step& s) { s.in->begin_step(s.label); })
        .def("__exit__", [](const Step& s, const nb::args&) { s.in->end_step(); });
    c.def(
         "undo", [](Workspace& w) { return w.session().undo(); }, "Undoes the latest step. False: there was none.")
        .def(
            "redo", [](Workspace& w) { return w.session().redo(); }, "Redoes the next step. False: there was none.")
        .def(
            "step", [](const Shared& w, std::string label) { return Step{w, std::move(label)}; }, "label"_a,
            "with session.step(\"Restyle\"): all edits within are one undo step.")
        .def_prop_ro(
            "history",
            [](Workspace& w) {
                std::vector<std::string> labels;
                const auto& history = w.session().history();
                for (std::size_t i = 0; i < history.position(); ++i)
                    labels.push_back(history.label(i));
                return labels;
            },
            "The labels of the undo steps so far, oldest first.")
        .def_prop_ro(
            "modified", [](Workspace& w) { return w.session().modified(); }, "Whether there are unsaved changes.");
}

void bind_film(nb::class_<Workspace>& c) {
    const auto film = [](Workspace& w, auto&& f) {
        Film copy = w.scene().film.value;
        f(copy);
        w.edit(set_film(w.scene(), std::move(copy)));
    };
    const auto settings = [](Workspace& w, auto&& f) {
        Settings copy = w.scene().settings.value;
        f(copy);
        w.edit(set_settings(w.scene(), std::move(copy)));
    };
    c.def_prop_rw(
         "size", [](Workspace& w) { return std::make_tuple(w.scene().film.value.width, w.scene().film.value.height); },
         [film](Workspace& w, std::tuple<std::uint32_t, std::uint32_t> size) {
             if (!std::get<0>(size) || !std::get<1>(size)) throw Failure("size: width and height must be at least 1");
             film(w, [&](Film& f) { std::tie(f.width, f.height) = size; });
         },
         "Width and height of the film [pixel].")
        .def_prop_rw(
            "crop",
            [](Workspace& w) {
                const glm::vec4& crop = w.scene().film.value.crop;
                return std::make_tuple(exact(crop.x), exact(crop.y), exact(crop.z), exact(crop.w));
            },
            [film](Workspace& w, const std::array<double, 4>& crop) {
                film(w, [&](Film& f) { f.crop = glm::vec4(crop[0], crop[1], crop[2], crop[3]); });
            },
            "The rendered part of the film, x0 x1 y0 y1 as fractions from the upper left corner: (0, 1, 0, 1) = "
            "all.")
        .def_prop_rw(
            "exposure", [](Workspace& w) { return exact(w.scene().film.value.exposure); },
            [film](Workspace& w, double x) { film(w, [&](Film& f) { f.exposure = float(x); }); },
            "Linear exposure factor; 1 = unchanged.")
        .def_prop_rw(
            "tone", [](Workspace& w) { return scene::tone_name(w.scene().film.value.development.tone); },
            [film](Workspace& w, const std::string& name) {
                const auto tone = scene::find_tone(name);
                if (!tone)
                    throw Failure(
                        fmt::format("tone: \"{}\" is unknown; known: {}", name, fmt::join(scene::tone_names, ", ")));
                film(w, [&](Film& f) { f.development.tone = *tone; });
            },
            "Tone curve of pictures saved as .png or .jpg: 'srgb' (clipped), 'filmic', 'agx' or 'neutral'.");
    const auto development = [&](const char* name, float scene::Development::* field, const char* doc) {
        c.def_prop_rw(
            name, [field](Workspace& w) { return exact(w.scene().film.value.development.*field); },
            [film, field](Workspace& w, double x) { film(w, [&](Film& f) { f.development.*field = float(x); }); }, doc);
    };
    development(
        "white_balance", &scene::Development::temperature,
        "Colour temperature of the light shown as white in a .png or .jpg [K], 1667 to 25000; 6504 = unchanged.");
    development("tint", &scene::Development::tint, "Tint of that light, -150 to 150: above 0 greenish, below pinkish.");
    development("vignette", &scene::Development::vignette,
                "Darkening of the corners of a .png or .jpg, 0 to 1: 1 leaves a quarter there.");
    development("bloom", &scene::Development::bloom,
                "Fraction of the light of a .png or .jpg that is scattered as in a lens, 0 to 1.");
    c.def_prop_rw(
         "samples", [](Workspace& w) { return w.scene().settings.value.samples; },
         [settings](Workspace& w, std::uint32_t n) { settings(w, [&](Settings& s) { s.samples = n; }); },
         "The scene's samples per pixel.")
        .def_prop_rw(
            "max_depth", [](Workspace& w) { return w.scene().settings.value.max_depth; },
            [settings](Workspace& w, std::uint32_t n) { settings(w, [&](Settings& s) { s.max_depth = n; }); },
            "Longest path: vertices beyond the camera, as in pbrt.")
        .def_prop_rw(
            "spectral", [](Workspace& w) { return w.scene().settings.value.spectral; },
            [settings](Workspace& w, bool on) { settings(w, [&](Settings& s) { s.spectral = on; }); },
            "Whether paths carry wavelengths instead of RGB: exact saturated colours and metals, dispersion.")
        .def_prop_rw(
            "adaptive", [](Workspace& w) { return w.scene().settings.value.adaptive; },
            [settings](Workspace& w, bool on) { settings(w, [&](Settings& s) { s.adaptive = on; }); },
            "Whether noisy parts of the picture get more samples than others; Session.samples is their mean.")
        .def_prop_rw(
            "guiding", [](Workspace& w) { return scene::technique_name(w.scene().settings.value.guiding); },
            [settings](Workspace& w, const std::string& name) {
                settings(w, [&](Settings& s) { s.guiding = technique("guiding", name); });
            },
            "Whether paths are sent where earlier samples found light: 'on', 'off', or 'auto', which is off as yet.")
        .def_prop_rw(
            "caustics", [](Workspace& w) { return scene::technique_name(w.scene().settings.value.caustics); },
            [settings](Workspace& w, const std::string& name) {
                settings(w, [&](Settings& s) { s.caustics = technique("caustics", name); });
            },
            "Whether light through glass and off mirrors comes from photon maps (biased, less with every sample): "
            "'auto'\n(where the scene has any), 'on' or 'off'.");
}

std::vector<Selection> things_of(const Shared& w) {
    const Scene scene = w->scene();
    const glm::dvec3 up = w->up();
    const std::uint32_t imported = w->session().base().scene.groups.size();
    query::Things things;
    {
        const nb::gil_scoped_release released;
        things = query::find_things(scene, up, imported);
    }
    std::vector<Selection> found;
    std::set<query::Whole> seen;
    scene.instances.each([&](Id<Instance> id, const Instance&) {
        const auto wholes = query::wholes_around(scene, things, id);
        if (wholes.empty())
            found.push_back({w, {id}});
        else if (seen.insert(wholes.front()).second)
            found.push_back({w, query::members_of(scene, things, wholes.front())});
    });
    return found;
}

void bind_contents(nb::class_<Workspace>& c) {
    c.def_prop_ro(
         "objects", [](const Shared& w) { return Collection<Instance>{w}; }, "All objects.")
        .def_prop_ro(
            "groups", [](const Shared& w) { return Collection<Group>{w}; }, "All groups of objects.")
        .def_prop_ro(
            "materials", [](const Shared& w) { return Collection<Material>{w}; }, "All materials.")
        .def_prop_ro(
            "textures", [](const Shared& w) { return Collection<Texture>{w}; }, "All textures.")
        .def_prop_ro(
            "lights", [](const Shared& w) { return Collection<Light>{w}; }, "All lights without a surface.")
        .def_prop_ro(
            "cameras", [](const Shared& w) { return Collection<Camera>{w}; }, "All cameras.")
        .def("find", &find, "name"_a, "The group or, if there is none, the object of that name.",
             nb::sig("def find(self, name: str) -> Group | Object"))
        .def(
            "select", [](const Shared& w, const nb::args& things) { return Selection{w, objects_of(*w, things)}; },
            "things"_a, "Objects and groups as one: select(a, b).move((1, 0, 0)).",
            nb::sig("def select(self, *things: Object | Group | Selection) -> Selection"))
        .def("things", &things_of,
             "Every object once, with those that a click in the editor takes together: parts of a chair, groups.\n"
             "Found from what touches and what rests on what; see engine/query/things.hpp.",
             nb::sig("def things(self) -> list[Selection]"))
        .def_prop_rw(
            "camera",
            [](const Shared& w) -> std::optional<Handle<Camera>> {
                const auto id = w->scene().active_camera.value;
                return id ? std::optional(Handle<Camera>{w, id}) : std::nullopt;
            },
            [](const Shared& w, const Handle<Camera>& h) {
                if (h.in != w) throw Failure("this camera belongs to another session");
                w->edit(set_active_camera(w->scene(), h.id));
            },
            "The camera to render from, or None.")
        .def_prop_ro(
            "sky", [](Workspace& w) { return w.scene().environment.value; }, "The environment, or None.")
        .def("set_sky", &set_sky, "image"_a = nb::none(), "color"_a = nb::none(), "strength"_a = 1.0,
             "rotation"_a = nb::none(), "hidden_from_camera"_a = nb::none(),
             "Changes the sky. image: path, or linear array (H, W, 3); square ones are equal-area octahedral maps as "
             "in\n"
             "pbrt-v4, others panoramas (u = phi / 2 pi, row 0 = the pole). color: radiance of a single-colour sky, or "
             "the\n"
             "factor of the image. strength: times that. rotation: about the scene's up [deg]. With neither "
             "image nor\n"
             "color, the present sky is changed.",
             nb::sig("def set_sky(self, image: str | os.PathLike | numpy.typing.ArrayLike | None = None, "
                     "color: numpy.typing.ArrayLike | None = None, strength: float = 1.0, "
                     "rotation: float | None = None, hidden_from_camera: bool | None = None) -> None"))
        .def(
            "remove_sky", [](Workspace& w) { w.edit(set_environment(w.scene(), std::nullopt, "Remove sky")); },
            "Removes the environment.")
        .def("add_material", &add_material, "name"_a, "type"_a, "values"_a,
             "A new material: add_material(\"Brass\", \"conductor\", uroughness=0.2, vroughness=0.2).")
        .def("add_preset", &add_preset, "path"_a,
             "The material of a preset, see restage.presets(): an equal one of the scene, or a new one.",
             nb::sig("def add_preset(self, path: str | os.PathLike) -> Material"))
        .def("add_light", &add_light, "kind"_a, "value"_a = Three{1, 1, 1}, "name"_a = "Light",
             "A new light at the origin. kind: point, spot or distant; value: see Light.value.")
        .def("insert", &insert_file, "path"_a, "progress"_a = nb::none(), "options"_a = nb::none(), "link"_a = false,
             "The objects of another file, as one group (or one object). progress and options: see restage.open. "
             "link: they stay the file's, are changed only as a whole, and follow the file; a project stores its path. "
             "Materials that the scene has already, under the same name, are shared.",
             nb::sig("def insert(self, path: str | os.PathLike, progress: collections.abc.Callable[[float, str], "
                     "bool | None] | None = None, options: dict[str, str | float | bool] | None = None, "
                     "link: bool = False) -> Group | Object"))
        .def("reload_links", &reload_links, "progress"_a = nb::none(),
             "Reads the files of all links again; each is one undo step. progress: see restage.open.",
             nb::sig("def reload_links(self, progress: collections.abc.Callable[[float, str], bool | None] | None = "
                     "None) -> None"))
        .def(
            "merge_equal_materials",
            [](Workspace& w) {
                MergedMaterials merged = merge_equal_materials(w.scene());
                if (merged.merged > 0) w.edit(std::move(merged.edit));
                return merged.merged;
            },
            "One material instead of several that are equal and called the same but for a number at the end; returns "
            "how many were removed.")
        .def(
            "remove_unused", [](Workspace& w) { w.edit(remove_unused(w.scene())); },
            "Removes every mesh, image, texture, material and group that is not used.")
        .def_prop_ro(
            "bounds",
            [](Workspace& w) {
                const Bounds b = world_bounds(w.scene());
                if (b.empty()) throw Failure("the scene has no visible geometry, so there are no bounds");
                return to_numpy(b.lower, b.upper);
            },
            nb::rv_policy::automatic, "Axis-aligned box of the visible objects: array (2, 3) [scene units].")
        .def_prop_ro("up", [](Workspace& w) { return triple(w.up()); }, "The up axis, from the active camera.");
}

} // namespace

void bind_session(nb::module_& m, nb::class_<Workspace>& c) {
    c.def("__enter__", [](const Shared& w) { return w; })
        .def("__exit__",
             [](Workspace& w, const nb::args&) {
                 const nb::gil_scoped_release release;
                 w.close();
             })
        .def("close", &Workspace::close, nb::call_guard<nb::gil_scoped_release>(),
             "Frees the renderer and its memory; the session cannot be used afterwards. `with` does it.")
        .def_prop_ro(
            "path", [](Workspace& w) { return w.session().path(); }, "File it was opened from or saved to, or \"\".")
        .def_prop_ro(
            "format", [](Workspace& w) { return w.scene().format; }, "Format it was imported from: \"pbrt-v4\".")
        .def_prop_ro(
            "report", [](Workspace& w) { return w.session().report(); }, "What the import did: a Report.")
        .def("export", &export_to, "path"_a, "format"_a = "", "progress"_a = nb::none(), "strict"_a = false,
             "options"_a,
             "Writes a copy in another format, by the extension: export(\"a.pbrt\", version=\"v3\"). Returns a "
             "Report. strict=True: raises restage.Error, and writes nothing, if not all of the scene can be written.",
             nb::sig(
                 "def export(self, path: str | os.PathLike, format: str = '', progress: "
                 "collections.abc.Callable[[float, str], bool | None] | None = None, strict: bool = False, **options: "
                 "str) -> Report"))
        .def(
            "save",
            [](Workspace& w, const std::filesystem::path& path) {
                if (!document::is_project(path))
                    throw Failure(path.string() + ": save writes projects, *.restage; export writes other formats");
                take(w.session().save_project(path.string()));
            },
            "path"_a, "Writes a project, *.restage: a reference to the original file, and the changes.")
        .def(
            "pack",
            [](Workspace& w, const std::filesystem::path& path, const nb::object& progress) {
                const std::string project = w.session().recovery_text({});
                return work(w.host(), progress,
                            [&](io::Progress tell) {
                                document::ReadOptions reading;
                                reading.progress = std::move(tell);
                                return document::pack_project(project, path, w.host().registry(), reading);
                            })
                    .problems;
            },
            "path"_a, "progress"_a = nb::none(),
            "Writes the project with all files that it needs into a new or empty folder, or a file .zip, which opens "
            "like a "
            "project. Returns a sentence for each thing that is missing or will not be found on another machine. The "
            "session and its file stay as they are. progress: see restage.open.",
            nb::sig("def pack(self, path: str | os.PathLike, progress: collections.abc.Callable[[float, str], bool | "
                    "None] | None = None) -> list[str]"))
        .def("__repr__", [](Workspace& w) {
            if (w.closed()) return std::string("<restage.Session (closed)>");
            return "<restage.Session \"" + w.session().path() + "\": " + std::to_string(w.scene().instances.live()) +
                   " objects, " + std::to_string(w.scene().materials.live()) + " materials>";
        });
    bind_contents(c);
    bind_history(m, c);
    bind_film(c);
    m.def(
        "open", &open, "path"_a, "base"_a = nb::none(), "progress"_a = nb::none(), "strict"_a = false,
        "options"_a = nb::none(),
        "Opens a scene (pbrt, glTF, OBJ, PLY, STL: any format that a plugin reads) or a project (*.restage).\n"
        "base: replaces the scene that a project names. progress(fraction, what): called about 20 times a second;\n"
        "False stops, and restage.Cancelled is raised. strict=True: an error if something is approximated or dropped\n"
        "(missing files, undefined names ...). options: of the importer, as in `restage render --import-set`:\n"
        "{\"units\": \"mm\", \"up\": \"z\"} of OBJ, PLY, STL and glTF, {\"merge\": True} of OBJ, {\"scene\": "
        "\"Night\"} of\n"
        "glTF; a project stores them; these replace them. Raises restage.Error with file, line and reason.",
        nb::sig("def open(path: str | os.PathLike, base: str | os.PathLike | None = None, progress: "
                "collections.abc.Callable[[float, str], bool | None] | None = None, strict: bool = False, options: "
                "dict[str, str | float | bool] | None = None) -> Session"));
    m.def(
        "new",
        [] {
            auto workspace = std::make_shared<Workspace>(Host::get());
            workspace->session().adopt(scene::studio_scene());
            return workspace;
        },
        "A new scene: a floor, a neutral sky, a camera. y is up, lengths in metres.");
}

} // namespace restage::python
