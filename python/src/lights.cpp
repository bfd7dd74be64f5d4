// SPDX-License-Identifier: Apache-2.0
// Lights without a surface, cameras, and the sky.
#include "values.hpp"

#include "scene/sky.hpp"

#include <glm/gtc/matrix_transform.hpp>

namespace restage::python {

using namespace scene;

namespace {

using LightHandle = Handle<Light>;
using CameraHandle = Handle<Camera>;

// Looks from `from` to `to` along +z with +y near `up`; `mirrored` frames have a negative determinant.
glm::dmat4 look_at(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& up, bool mirrored) {
    const glm::dvec3 z = to - from;
    const glm::dvec3 x = glm::cross(up, z);
    if (!(glm::length(z) > 0)) throw Failure("look_at: the target equals the viewpoint");
    if (!(glm::length(x) > 1e-9 * glm::length(z) * glm::length(up)))
        throw Failure("look_at: up is the direction of the view; name another up");
    const glm::dvec3 ez = glm::normalize(z), ex = glm::normalize(x), ey = glm::cross(ez, ex);
    return {glm::dvec4(mirrored ? -ex : ex, 0), glm::dvec4(ey, 0), glm::dvec4(ez, 0), glm::dvec4(from, 1)};
}

bool is_mirrored(const glm::dmat4& m) { return glm::determinant(glm::dmat3(m)) < 0; }

template <class T, auto Field>
void bind_place(nb::class_<Handle<T>>& c, const char* label) {
    using H = Handle<T>;
    c.def_prop_rw(
         "transform", [](const H& h) { return to_numpy(h.get().*Field); },
         [label](const H& h, nb::handle matrix) {
             h.change(label, [m = to_matrix(matrix)](T& thing) { thing.*Field = m; });
         },
         "To world: array (4, 4) float64, for column vectors; it looks or emits along its +z, +y is up.",
         nb::for_getter(nb::rv_policy::automatic),
         nb::for_getter(nb::sig("def transform(self) -> numpy.typing.NDArray[numpy.float64]")),
         nb::for_setter(nb::sig("def transform(self, matrix: numpy.typing.ArrayLike, /) -> None")))
        .def_prop_rw(
            "position", [](const H& h) { return triple(glm::dvec3((h.get().*Field)[3])); },
            [label](const H& h, const Three& place) {
                h.change(label, [&](T& thing) { (thing.*Field)[3] = glm::dvec4(vec(place), 1); });
            },
            "Position, world space [scene units].")
        .def(
            "look_at",
            [label](const H& h, const Three& target, const std::optional<Three>& from, const std::optional<Three>& up) {
                const glm::dmat4 before = h.get().*Field;
                const glm::dvec3 eye = from ? vec(*from) : glm::dvec3(before[3]);
                const glm::dmat4 m = look_at(eye, vec(target), up ? vec(*up) : h.in->up(), is_mirrored(before));
                h.change(label, [&](T& thing) { thing.*Field = m; });
            },
            "target"_a, "position"_a = nb::none(), "up"_a = nb::none(),
            "Rotates it towards a point, from its place or from `position`; `up`: default the scene's.");
}

template <class T, class Get, class Set>
void field(nb::class_<Handle<T>>& c, const char* name, const char* label, const char* doc, Get get, Set set) {
    using H = Handle<T>;
    using V = std::remove_cvref_t<decltype(get(std::declval<const T&>()))>;
    using In = std::conditional_t<std::is_same_v<V, Triple>, Three, V>;
    c.def_prop_rw(
        name, [get](const H& h) { return get(h.get()); },
        [label, set](const H& h, const In& value) { h.change(label, [&](T& thing) { set(thing, value); }); }, doc);
}

void bind_light(nb::module_& m) {
    nb::class_<LightHandle> c(m, "Light",
                              "A light without a surface: point, spot or distant. An emitting surface is an "
                              "Object with an emission.");
    bind_handle(c, "Light");
    bind_place<Light, &Light::light_to_world>(c, "Move light");
    c.def_prop_ro(
        "kind", [](const LightHandle& h) { return scene::light_row(h.get().kind).id; }, "point, spot or distant.");
    field<Light>(
        c, "value", "Change light",
        "Linear sRGB; point and spot: intensity [W/sr]; distant: irradiance at normal incidence [W/m^2].",
        [](const Light& l) { return triple(l.value); }, [](Light& l, const Three& v) { l.value = glm::vec3(vec(v)); });
    field<Light>(
        c, "cone_angle", "Change light", "Half angle of a spot [deg].",
        [](const Light& l) { return exact(l.cone_angle); }, [](Light& l, double v) { l.cone_angle = float(v); });
    field<Light>(
        c, "cone_delta", "Change light", "Width of a spot's smooth edge [deg].",
        [](const Light& l) { return exact(l.cone_delta); }, [](Light& l, double v) { l.cone_delta = float(v); });
    field<Light>(
        c, "falloff", "Change light", "How a spot's edge fades: smooth (pbrt-v4) or quartic (pbrt-v3: t^4).",
        [](const Light& l) { return std::string(l.falloff == scene::Falloff::quartic ? "quartic" : "smooth"); },
        [](Light& l, const std::string& v) {
            if (v != "smooth" && v != "quartic") throw Failure("falloff is smooth or quartic, not \"" + v + "\"");
            l.falloff = v == "quartic" ? scene::Falloff::quartic : scene::Falloff::smooth;
        });
    c.def_prop_rw(
        "hidden", [](const LightHandle& h) { return h.get().hidden; },
        [](const LightHandle& h, bool hidden) { h.in->edit(set_hidden(h.in->scene(), h.id, hidden)); },
        "Switched off: it stays in the scene but emits nothing.");
    c.def("remove", [](const LightHandle& h) { h.in->edit(remove(h.in->scene(), h.id)); }, "Removes it.");
}

constexpr const char* projections[] = {"perspective", "orthographic", "spherical", "spherical_equal_area"};

scene::Projection projection_of(const std::string& name) {
    for (int i = 0; i < 4; ++i)
        if (name == projections[i]) return scene::Projection(i);
    throw nb::value_error(
        ("there is no projection \"" + name + "\"; it is perspective, orthographic, spherical or spherical_equal_area")
            .c_str());
}

using Four = std::array<double, 4>;

void bind_camera(nb::module_& m) {
    nb::class_<CameraHandle> c(m, "Camera", "A camera; Session.camera is the one to render from.");
    bind_handle(c, "Camera");
    bind_place<Camera, &Camera::camera_to_world>(c, "Move camera");
    field<Camera>(
        c, "fov", "Change camera", "Field of view of the shorter side of the picture [deg].",
        [](const Camera& v) { return exact(v.fov); }, [](Camera& v, double x) { v.fov = float(x); });
    field<Camera>(
        c, "lens_radius", "Change camera", "Radius of the lens [scene units]; 0 = a pinhole.",
        [](const Camera& v) { return exact(v.lens_radius); }, [](Camera& v, double x) { v.lens_radius = float(x); });
    field<Camera>(
        c, "focal_distance", "Change camera", "Focus distance [scene units].",
        [](const Camera& v) { return exact(v.focal_distance); },
        [](Camera& v, double x) { v.focal_distance = float(x); });
    field<Camera>(
        c, "projection", "Change camera",
        "perspective, orthographic, spherical (all directions, equirectangular) or spherical_equal_area.",
        [](const Camera& v) { return std::string(projections[std::size_t(v.projection)]); },
        [](Camera& v, const std::string& x) { v.projection = projection_of(x); });
    field<Camera>(
        c, "screen_window", "Change camera",
        "The window of the film, x0 x1 y0 y1: for an orthographic camera in scene units, else relative to fov. "
        "None: from the picture's aspect; then the shorter side of an orthographic camera is 2.",
        [](const Camera& v) {
            return v.screen_window ? std::optional(Four{exact(v.screen_window->x), exact(v.screen_window->y),
                                                        exact(v.screen_window->z), exact(v.screen_window->w)})
                                   : std::nullopt;
        },
        [](Camera& v, const std::optional<Four>& x) {
            if (x && !((*x)[0] < (*x)[1] && (*x)[2] < (*x)[3]))
                throw nb::value_error("screen_window needs x0 < x1 and y0 < y1");
            v.screen_window.reset();
            if (x) v.screen_window = glm::vec4((*x)[0], (*x)[1], (*x)[2], (*x)[3]);
        });
    c.def(
        "remove", [](const CameraHandle& h) { h.in->edit(remove(h.in->scene(), h.id)); },
        "Removes it; refused for the active camera.");
}

} // namespace

void bind_lights(nb::module_& m) {
    bind_light(m);
    bind_camera(m);
    nb::class_<Environment>(m, "Sky", "The current environment; Session.set_sky changes it.")
        .def_prop_ro("name", [](const Environment& e) { return e.name; })
        .def_prop_ro(
            "is_image", [](const Environment& e) { return bool(e.image); }, "False: a single colour.")
        .def_prop_ro(
            "mapping",
            [](const Environment& e) { return e.mapping == scene::Mapping::equirect ? "equirect" : "octahedral"; },
            "equirect (a panorama) or octahedral (square, equal-area).")
        .def_prop_ro(
            "color", [](const Environment& e) { return triple(e.scale); },
            "Radiance of a single-colour sky, or the factor of its image.")
        .def_prop_ro(
            "transform", [](const Environment& e) { return to_numpy(e.light_to_world); }, nb::rv_policy::automatic,
            "Rotation: array (4, 4); a panorama's pole is +z.")
        .def_prop_ro(
            "type", [](const Environment& e) { return e.sky; },
            "The sky plugin that generates its image (\"sunsky\"), or \"\"; see Session.make_sky.")
        .def_prop_ro(
            "values",
            [](const Environment& e) {
                nb::dict all;
                for (const auto& [id, value] : e.sky_params.entries())
                    all[nb::str(id.c_str())] = to_python(nullptr, value);
                return all;
            },
            nb::sig("def values(self) -> dict[str, object]"), "The values set for that plugin's parameters.")
        .def_prop_ro("hidden_from_camera", [](const Environment& e) { return e.hidden_from_camera; })
        .def("__repr__", [](const Environment& e) {
            return e.image ? "<restage.Sky \"" + e.name + "\", an image>" : std::string("<restage.Sky of one colour>");
        });
}

} // namespace restage::python
