// SPDX-License-Identifier: Apache-2.0
// Cameras and KHR_lights_punctual. Both look along -z in glTF, along +z here.
#include "common/stage.hpp"
#include "importer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace restage::gltf {

namespace {

constexpr double degrees = 180 / std::numbers::pi;

// Unit axes of a node, without its scale.
Matrix directions(const Matrix& world) {
    Matrix m;
    m.set_column(1, normalized(world.column(1), {0, 1, 0}));
    m.set_column(2, normalized(world.column(2), {0, 0, 1}));
    m.set_column(0, normalized(world.column(0), {1, 0, 0}));
    m.set_column(3, world.column(3));
    return m;
}

Matrix turned_forward(Matrix m) { // -z becomes +z
    m.set_column(2, m.column(2) * -1);
    return m;
}

} // namespace

void Importer::camera(int index) {
    const auto& node = model_.nodes[static_cast<std::size_t>(index)];
    const auto& in = at(model_.cameras, node.camera, "camera", "node " + std::to_string(index));
    const std::string name = !in.name.empty() ? in.name : node.name.empty() ? "camera" : node.name;
    const std::string what = "camera " + quote(name);
    const Matrix placed = turned_forward(directions(world_[static_cast<std::size_t>(index)]));
    double aspect = 16.0 / 9, yfov = 45 / degrees;
    RestageCamera camera{};
    camera.name = name.c_str();
    const double away = std::max(dot(bounds_.center() - placed.column(3), placed.column(2)), 1e-3);
    if (in.type == "orthographic") {
        const auto& o = in.orthographic;
        if (!(o.xmag > 0 && o.ymag > 0 && std::isfinite(o.xmag / o.ymag))) { // half of what is seen
            report_.dropped(what, "its xmag and ymag are not above 0");
            return;
        }
        aspect = o.xmag / o.ymag;
        for (int side = 0; side < 2; ++side) { // x0 x1 y0 y1
            camera.screen_window[side] = static_cast<float>((side ? o.xmag : -o.xmag) * placement_.metres);
            camera.screen_window[2 + side] = static_cast<float>((side ? o.ymag : -o.ymag) * placement_.metres);
        }
        camera.projection = RESTAGE_ORTHOGRAPHIC;
    } else {
        yfov = in.perspective.yfov;
        if (in.perspective.aspectRatio > 0) aspect = in.perspective.aspectRatio;
        if (!(yfov > 0 && yfov < std::numbers::pi)) {
            report_.dropped(what, "its field of view is not between 0 and 180 degrees");
            return;
        }
    }
    // yfov is the vertical angle; ours is that of the shorter side.
    const double fov = aspect >= 1 ? yfov : 2 * std::atan(std::tan(yfov / 2) * aspect);
    camera.fov = static_cast<float>(fov * degrees);
    camera.focal_distance = static_cast<float>(away);
    camera.fit_aspect = static_cast<float>(aspect); // the file's framing is visible at any aspect
    std::copy(placed.m.begin(), placed.m.end(), camera.camera_to_world);
    if (!out_.camera(out_.ctx, &camera)) return;
    if (cameras_++ == 0) aspect_ = aspect;
}

void Importer::light(int index, int light_index) {
    const auto& in = at(model_.lights, light_index, "light", "node " + std::to_string(index));
    const std::string name = !in.name.empty() ? in.name : node_name(index), what = "light " + quote(name);
    RestageLight light{.name = name.c_str(),
                       .kind = RESTAGE_LIGHT_POINT,
                       .value = {},
                       .light_to_world = {},
                       .cone_angle = 30,
                       .cone_delta = 5};
    for (std::size_t i = 0; i < 3; ++i)
        light.value[i] = static_cast<float>(std::max(in.intensity * (i < in.color.size() ? in.color[i] : 1.0), 0.0));
    if (in.intensity < 0) report_.approximated(what, "its intensity is negative; 0 is taken");
    if (in.type == "directional") {
        light.kind = RESTAGE_LIGHT_DISTANT;
    } else if (in.type == "spot") {
        light.kind = RESTAGE_LIGHT_SPOT;
        light.cone_angle = static_cast<float>(std::clamp(in.spot.outerConeAngle * degrees, 0.01, 180.0));
        light.cone_delta = static_cast<float>(
            std::clamp((in.spot.outerConeAngle - in.spot.innerConeAngle) * degrees, 0.0, double(light.cone_angle)));
        report_.approximated(what, "its edge falls off as a smooth step of the cosine");
    } else if (in.type != "point") {
        report_.dropped(what, "a light of the unknown type " + quote(in.type));
        return;
    }
    if (hidden_[static_cast<std::size_t>(index)]) light.flags |= RESTAGE_LIGHT_HIDDEN;
    if (in.range > 0) report_.dropped(what + ": range", "light is not cut off at a range");
    report_.kept(what,
                 "1 lux or candela is taken as 1 W/m^2 or W/sr, so that a surface of 1 nit (emissive factor 1) "
                 "has the value 1 in the picture");
    const Matrix placed = turned_forward(directions(world_[static_cast<std::size_t>(index)]));
    std::copy(placed.m.begin(), placed.m.end(), light.light_to_world);
    lights_ += out_.light(out_.ctx, &light) != 0 && !(light.flags & RESTAGE_LIGHT_HIDDEN); // which do not light it
}

} // namespace restage::gltf
