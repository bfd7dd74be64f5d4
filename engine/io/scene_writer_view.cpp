// SPDX-License-Identifier: Apache-2.0
// Lights without geometry, and single items: environment, camera, film, settings.
#include "io/scene_writer_calls.hpp"
#include "plugin/abi.hpp"

namespace restage::io {

using namespace scene;

std::optional<Light> SceneWriter::read(const RestageLight& given) {
    const RestageLight in = plugin::sized(given);
    const glm::dmat4 to_world = matrix(in.light_to_world);
    const std::string who = "light \"" + text(in.name) + "\"";
    if (in.kind - RESTAGE_LIGHT_POINT >= std::size(light_kinds)) {
        refuse(who, "a light of unknown kind");
        return std::nullopt;
    }
    if (!affine(to_world) || !finite3(in.value) || !finite(in.cone_angle, in.cone_delta)) {
        refuse(who, "it has a non-finite value, or its transform is not affine");
        return std::nullopt;
    }
    return Light{.name = text(in.name),
                 .kind = static_cast<LightKind>(in.kind - RESTAGE_LIGHT_POINT),
                 .value = vec3(in.value),
                 .light_to_world = to_world,
                 .cone_angle = in.cone_angle,
                 .cone_delta = in.cone_delta,
                 .origin = origin(in.origin),
                 .falloff = in.falloff == RESTAGE_FALLOFF_QUARTIC ? Falloff::quartic : Falloff::smooth,
                 .hidden = (in.flags & RESTAGE_LIGHT_HIDDEN) != 0};
}

RestageHandle SceneWriter::Calls::light(void* ctx, const RestageLight* given) {
    return guarded(ctx, "light", [&](SceneWriter& w) -> RestageHandle {
        auto light = w.read(*given);
        if (!light) return 0;
        light->name = w.unique_name("light", light->name);
        return w.push(std::move(*light));
    });
}

void SceneWriter::Calls::environment(void* ctx, const RestageEnvironment* given) {
    guarded(ctx, "environment", [&](SceneWriter& w) -> RestageHandle {
        const RestageEnvironment in = plugin::sized(*given);
        const glm::dmat4 to_world = matrix(in.light_to_world);
        if (!w.known<Image>(in.image, "environment", text(in.name))) return 0;
        if (!affine(to_world) || !finite3(in.scale)) {
            w.refuse("the environment", "its scale or transform is not finite, or not affine");
            return 0;
        }
        if (w.scene.environment.value)
            w.refuse("environment \"" + w.scene.environment.value->name + "\"",
                     "another one follows; the last one counts");
        const std::string name = text(in.name);
        w.scene.environment = {Environment{.name = name.empty() ? "environment" : name,
                                           .image = {in.image},
                                           .mapping = static_cast<Mapping>(in.mapping),
                                           .scale = vec3(in.scale),
                                           .light_to_world = to_world,
                                           .hidden_from_camera = in.hidden_from_camera != 0,
                                           .origin = w.origin(in.origin),
                                           .sky = text(in.sky),
                                           .sky_params = w.params(in.sky_values, in.sky_value_count, "the sky")},
                               w.scene.clock};
        return 1;
    });
}

std::optional<Camera> SceneWriter::read(const RestageCamera& given) {
    const RestageCamera in = plugin::sized(given);
    const float* sw = in.screen_window;
    const glm::dmat4 to_world = matrix(in.camera_to_world);
    if (in.projection > RESTAGE_SPHERICAL_EQUAL_AREA) {
        refuse("camera \"" + text(in.name) + "\"", "there is no projection " + std::to_string(in.projection));
        return std::nullopt;
    }
    if (!affine(to_world) || !finite(in.fov, sw[0], sw[1], sw[2], sw[3], in.lens_radius, in.focal_distance,
                                     in.frame_aspect, in.fit_aspect)) {
        refuse("camera \"" + text(in.name) + "\"", "it has a non-finite value, or its transform is not affine");
        return std::nullopt;
    }
    Camera camera{.name = text(in.name),
                  .camera_to_world = to_world,
                  .fov = in.fov,
                  .lens_radius = in.lens_radius,
                  .focal_distance = in.focal_distance,
                  .frame_aspect = in.frame_aspect,
                  .origin = origin(in.origin),
                  .projection = static_cast<Projection>(in.projection),
                  .fit_aspect = in.fit_aspect};
    if (sw[0] != 0 || sw[1] != 0 || sw[2] != 0 || sw[3] != 0)
        camera.screen_window = glm::vec4(sw[0], sw[1], sw[2], sw[3]);
    return camera;
}

RestageHandle SceneWriter::Calls::camera(void* ctx, const RestageCamera* given) {
    return guarded(ctx, "camera", [&](SceneWriter& w) -> RestageHandle {
        auto camera = w.read(*given);
        if (!camera) return 0;
        camera->name = w.unique_name("camera", camera->name);
        const RestageHandle handle = w.push(std::move(*camera));
        if (!w.scene.active_camera.value) w.scene.active_camera = {{handle}, w.scene.clock};
        return handle;
    });
}

void SceneWriter::Calls::camera_medium(void* ctx, RestageHandle medium) {
    guarded(ctx, "camera medium", [&](SceneWriter& w) -> RestageHandle {
        if (w.known<Medium>(medium, "medium of", "the camera")) w.scene.settings.value.camera_medium = {medium};
        return 0;
    });
}

void SceneWriter::Calls::film(void* ctx, const RestageFilm* given) {
    guarded(ctx, "film", [&](SceneWriter& w) -> RestageHandle {
        const RestageFilm in = plugin::sized(*given);
        w.scene.film = {Film{.width = in.width,
                             .height = in.height,
                             .crop = {in.crop[0], in.crop[1], in.crop[2], in.crop[3]},
                             .filter = {.kind = filter_kind(text(in.filter)),
                                        .radius = {in.filter_radius[0], in.filter_radius[1]},
                                        .params = {in.filter_params[0], in.filter_params[1]}},
                             .exposure = in.exposure,
                             .filename = text(in.filename)},
                        w.scene.clock};
        w.unexposed = in.unexposed != 0;
        return 0;
    });
}

void SceneWriter::Calls::settings(void* ctx, const RestageSettings* given) {
    guarded(ctx, "settings", [&](SceneWriter& w) -> RestageHandle {
        const RestageSettings in = plugin::sized(*given);
        Settings& s = w.scene.settings.value;
        s.max_depth = in.max_depth;
        if (in.samples) s.samples = in.samples;
        s.origin = w.origin(in.origin);
        return 0;
    });
}

} // namespace restage::io
