// SPDX-License-Identifier: Apache-2.0
// Camera moves for series of pictures (query/camera_path.hpp), and light mixing (view/light_layers.hpp).
#include "camera_moves.hpp"

#include "query/camera_path.hpp"
#include "values.hpp"
#include "view/light_layers.hpp"

#include <nanobind/stl/map.h>
#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <variant>

namespace restage::python {

using namespace scene;

namespace {

constexpr std::uint32_t most_frames = 100000;

const Camera& active_camera(Workspace& w) {
    const Camera* camera = w.scene().cameras.find(w.scene().active_camera.value);
    if (!camera) throw Failure("the scene has no camera; set session.camera");
    return *camera;
}

void check_frames(std::uint32_t frames) {
    if (frames == 0 || frames > most_frames) throw nb::value_error("frames must be 1 to 100000"); // most_frames
}

std::vector<Camera> turntable(Workspace& w, std::uint32_t frames) {
    check_frames(frames);
    const Camera& camera = active_camera(w);
    std::vector<Camera> all;
    for (std::uint32_t frame = 0; frame < frames; ++frame)
        all.push_back(query::turned(w.scene(), camera, 360.0 * frame / frames));
    return all;
}

std::vector<Camera> camera_path(Workspace& w, std::uint32_t frames,
                                const std::optional<std::vector<Handle<Camera>>>& cameras) {
    check_frames(frames);
    std::vector<Camera> through;
    if (cameras)
        for (const Handle<Camera>& camera : *cameras)
            through.push_back(camera.get());
    else
        through = query::all_cameras(w.scene());
    if (through.empty()) throw Failure("camera_path needs at least one camera");
    return query::camera_path(through, frames);
}

void set_view(Workspace& w, const Camera& view) {
    const auto id = w.scene().active_camera.value;
    Camera to = view;
    to.name = active_camera(w).name;
    w.edit(set_camera(w.scene(), id, to, "Move camera"));
}

// --- light mixing
using Weight = std::variant<double, Three>;

std::vector<view::LightLayer> layers_of(Workspace& w) {
    return view::light_layers(w.scene(), w.host().registry(), std::numeric_limits<std::size_t>::max());
}

std::vector<std::string> light_layers(Workspace& w) {
    std::vector<std::string> names;
    for (const view::LightLayer& layer : layers_of(w))
        names.push_back(layer.name);
    return names;
}

void weigh_lights(Workspace& w, const std::map<std::string, Weight>& by_name) {
    const std::vector<view::LightLayer> layers = layers_of(w);
    std::vector<glm::vec3> weights(layers.size(), glm::vec3(1));
    for (const auto& [name, weight] : by_name) {
        const auto layer = std::ranges::find(layers, name, &view::LightLayer::name);
        if (layer == layers.end())
            throw nb::key_error(("there is no light layer \"" + name + "\"; see Session.light_layers").c_str());
        const double* grey = std::get_if<double>(&weight);
        const glm::dvec3 by = grey ? glm::dvec3(*grey) : vec(std::get<Three>(weight));
        for (int i = 0; i < 3; ++i)
            if (!(by[i] >= 0)) throw nb::value_error("a weight is at least 0");
        weights[std::size_t(layer - layers.begin())] = glm::vec3(by);
    }
    w.edit(view::weigh_lights(w.scene(), w.host().registry(), layers, weights));
}

} // namespace

void bind_camera_moves(nb::module_& m, nb::class_<Workspace>& c) {
    nb::class_<Camera>(m, "CameraView", "A camera on its way: see Session.turntable and Session.camera_path.")
        .def_prop_ro(
            "transform", [](const Camera& v) { return to_numpy(v.camera_to_world); }, nb::rv_policy::automatic,
            "To world: array (4, 4) float64, as Camera.transform.",
            nb::sig("def transform(self) -> numpy.typing.NDArray[numpy.float64]"))
        .def_prop_ro(
            "fov", [](const Camera& v) { return exact(v.fov); },
            "Field of view of the shorter side of the picture [deg].");
    c.def("turntable", &turntable, "frames"_a,
          "The views of one turn of the camera around the visible objects, to the right, the first where it is now.\n"
          "frames: 1 to 100000. For pictures: for each, set_view and render.")
        .def("camera_path", &camera_path, "frames"_a, "cameras"_a = nb::none(),
             "The views on a smooth path through these cameras (default: all of the scene, in order), the first and "
             "the last\n"
             "included. Each stretch takes equally many. frames: 1 to 100000.")
        .def("set_view", &set_view, "view"_a,
             "Puts Session.camera there, with the view's field of view and lens. One undo step, \"Move camera\".")
        .def_prop_ro("light_layers", &light_layers,
                     "Names of the lights as they are mixed: the sky, each light that is on, and objects that emit, "
                     "those of equal\nmaterial together (\"Lamp and 3 more\").")
        .def("weigh_lights", &weigh_lights, "weights"_a,
             "Multiplies the light of layers: {\"Sky\": 0.5, \"Lamp\": (1, 0.8, 0.6)}, linear RGB or one number, at "
             "least 0; others\nkeep theirs. One undo step. KeyError: there is no such layer. Error: a colour for light "
             "whose colour is a texture.");
}

} // namespace restage::python
