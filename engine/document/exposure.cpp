// SPDX-License-Identifier: Apache-2.0
#include "document/exposure.hpp"

#include "io/material_emission.hpp"
#include "query/navigation.hpp"
#include "scene/edits.hpp"
#include "scene/sky.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace restage::document {

using namespace scene;

namespace {

constexpr double wanted = 0.6;                // the value of white in a metered picture
constexpr double too_dark = 0.08, too_bright = 4; // a picture in between keeps its file's exposure
constexpr double least_lit = 0.02;            // fraction of the picture; less counts as unlit

bool shines(const glm::vec3& c) { return c.x > 0 || c.y > 0 || c.z > 0; }
bool has_sky(const Scene& s) { return s.environment.value && shines(s.environment.value->scale); }

glm::vec3 mean_of_sky(const Scene& s) {
    if (!s.environment.value) return glm::vec3(0);
    const Environment& sky = *s.environment.value;
    const Image* image = s.images.find(sky.image);
    if (!image || !image->data) return sky.scale;
    const PixelData& p = *image->data; // panorama rows weighted by solid angle, octahedral ones equally
    glm::dvec3 sum(0);
    double weights = 0;
    for (std::uint32_t y = 0; y < p.height; ++y) {
        const double weight =
            sky.mapping == scene::Mapping::equirect ? std::sin((y + 0.5) / p.height * 3.14159265358979) : 1;
        for (std::uint32_t x = 0; x < p.width; ++x) {
            const float* v = &p.values[(std::size_t{y} * p.width + x) * p.channels];
            for (std::size_t c = 0; c < 3; ++c)
                if (const float value = v[p.channels >= 3 ? c : 0]; std::isfinite(value) && value > 0)
                    sum[int(c)] += weight * double(value);
        }
        weights += weight * p.width;
    }
    return glm::vec3(sum / std::max(weights, 1e-30)) * sky.scale;
}

// Glass, null surfaces, and those less than half opaque.
bool passes(const Scene& s, const plugin::Registry& registry, const Instance& in) {
    if (in.alpha < 0.5f) return true;
    const Material* m = s.materials.find(in.material);
    const auto plugin = m ? registry.find_material(m->type) : std::nullopt;
    if (!plugin) return false;
    if (plugin->table->null_surface) return true;
    if (!plugin->table->transmissive) return false;
    const model::Param* line = plugin->table->find("transmission");
    return !line || m->params.number("transmission", line->def[0]) > 0.5f;
}

// Of the type's first colour parameter that is not its emission.
double albedo_of(const Scene& s, const plugin::Registry& registry, const Instance& in) {
    const Material* m = s.materials.find(in.material);
    const auto plugin = m ? registry.find_material(m->type) : std::nullopt;
    if (!plugin) return 0.5;
    const auto& shine = plugin->table->emission;
    for (const model::Param& line : plugin->table->params) {
        if (line.type != model::ParamType::color || line.max != 1 || (shine && shine->radiance == line.id)) continue;
        const Value* set = m->params.find(line.id);
        const Value v = set ? *set : default_value(line);
        const glm::vec3 c = v.texture                           ? io::mean_of(s, v.texture)
                            : v.type == model::ParamType::color ? glm::vec3(v.v[0], v.v[1], v.v[2])
                                                                : glm::vec3(v.scalar());
        return std::clamp(double(0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z), 0.0, 1.0);
    }
    return 0.5;
}

void append(Edit& edit, Edit more) {
    std::move(more.changes.begin(), more.changes.end(), std::back_inserter(edit.changes));
}

// A point light at the camera, as bright on what it sees as a studio would be.
std::optional<Light> headlamp(const Scene& s, const plugin::Registry& registry) {
    const Camera* camera = s.cameras.find(s.active_camera.value);
    if (!camera) return std::nullopt;
    Light lamp{.name = "Camera lamp", .kind = scene::LightKind::point, .value = glm::vec3(1)};
    // A little above the camera, so that not every shadow is behind its object.
    lamp.light_to_world[3] = camera->camera_to_world[3];
    Scene lit = s;
    apply(lit, insert(lit, lamp, ""));
    const query::LightReading reading = read_light(lit, registry);
    if (!(reading.white > 0)) return std::nullopt;
    lamp.value = glm::vec3(float(wanted / reading.white));
    return lamp;
}

} // namespace

bool has_light(const Scene& s, const plugin::Registry& registry) {
    bool found = has_sky(s);
    s.lights.each([&](Id<Light>, const Light& l) { found |= !l.hidden && shines(l.value); });
    if (found) return true;
    const io::MaterialEmissions emissions(registry, s);
    s.instances.each([&](Id<Instance>, const Instance& i) { found = found || (!i.hidden && emissions.shines(i)); });
    return found;
}

query::LightReading read_light(const Scene& s, const plugin::Registry& registry) {
    const io::MaterialEmissions emissions(registry, s);
    const query::MeterQuestions ask{.passes = [&](const Instance& in) { return passes(s, registry, in); },
                                    .emission = [&](const Instance& in) -> std::optional<MaterialEmission> {
                                        if (in.emission)
                                            return MaterialEmission{in.emission->radiance, {}, in.emission->two_sided};
                                        auto emission = emissions.of(in.material);
                                        if (emission && emission->texture)
                                            emission->radiance *= io::mean_of(s, emission->texture);
                                        return emission;
                                    },
                                    .albedo = [&](const Instance& in) { return albedo_of(s, registry, in); },
                                    .sky = mean_of_sky(s)};
    return query::read_light(s, ask);
}

Edit light_studio(const Scene& scene, const plugin::Registry& registry) {
    Edit edit{"Studio light", {}};
    Scene lit = scene;
    const auto use = [&](Edit more) {
        apply(lit, more);
        append(edit, std::move(more));
    };
    const Camera* camera = scene.cameras.find(scene.active_camera.value);
    if (!has_sky(scene)) use(studio_sky(scene, camera ? query::guess_up(*camera) : glm::dvec3(0, 1, 0)));
    const query::LightReading reading = read_light(lit, registry);
    if (reading.something && (reading.lit < least_lit || !(reading.white > 0)))
        if (auto lamp = headlamp(lit, registry)) use(insert(lit, std::move(*lamp), ""));
    return edit;
}

void expose(io::ImportedScene& in, const plugin::Registry& registry) {
    const auto tell = [&](const char* what, std::string note) { in.report.add(io::Fate::kept, what, std::move(note)); };
    if (!in.unexposed) {
        if (!has_light(in.scene, registry)) tell("light", std::string(no_light) + "; studio light can be added");
        return;
    }
    query::LightReading reading = read_light(in.scene, registry);
    if (!reading.something) return;
    if (reading.lit < least_lit || !(reading.white > 0)) {
        const std::size_t lamps = in.scene.lights.live();
        const bool sky = has_sky(in.scene);
        apply(in.scene, light_studio(in.scene, registry));
        const bool headlamp = in.scene.lights.live() > lamps;
        tell("light", std::string(lamps > 0 ? "that of the file" : "the studio's") +
                          " does not reach what the camera sees; " +
                          (!sky && headlamp ? "a neutral studio and a lamp at the camera are added"
                           : headlamp       ? "a lamp at the camera is added"
                                            : "a neutral studio is added"));
        reading = read_light(in.scene, registry);
    }
    if (!(reading.white > 0) || (reading.white >= too_dark && reading.white <= too_bright)) return;
    Film film = in.scene.film.value;
    film.exposure = float(wanted / reading.white);
    in.scene.film = {film, ++in.scene.clock};
    tell("exposure", fmt::format("set to {:.4g}: the file gives none, and a white surface where the camera looks "
                                 "would have the value {:.4g} in the picture",
                                 double(film.exposure), reading.white));
}

} // namespace restage::document
