// SPDX-License-Identifier: Apache-2.0
#include "document/assign.hpp"

#include "document/sky.hpp"
#include "io/sky.hpp"
#include "query/navigation.hpp"
#include "scene/development.hpp"
#include "scene/sky.hpp"
#include "scene/validate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::document {

using namespace scene;

namespace {

struct Assignment {
    std::string name, field, value, who; // who: for messages
};

// Names may contain dots: the last one before the first = separates.
Result<Assignment> split(const std::string& text) {
    const std::size_t equals = text.find('='), dot = text.rfind('.', equals);
    if (equals == std::string::npos || dot == std::string::npos || dot == 0 || dot > equals || dot + 1 == equals)
        return fail("\"" + text +
                    "\" changes nothing; write name.field=value, for example \"Wall paint.reflectance=0.2\"");
    return Assignment{text.substr(0, dot), text.substr(dot + 1, equals - dot - 1), text.substr(equals + 1),
                      "\"" + text.substr(0, equals) + "\""};
}

Result<std::vector<float>> numbers(const Assignment& a) {
    std::vector<float> out;
    const char *at = a.value.data(), *end = at + a.value.size();
    while (at <= end) {
        while (at < end && *at == ' ')
            ++at;
        float x = 0;
        const auto [stop, code] = std::from_chars(at, end, x);
        if (code != std::errc() || (stop != end && *stop != ','))
            return fail(a.who + ": \"" + a.value + "\" is not a number, nor three separated by commas");
        out.push_back(x);
        if (stop == end) break;
        at = stop + 1;
    }
    return out;
}

Result<float> number(const Assignment& a) {
    RESTAGE_TRY(const auto all, numbers(a));
    if (all.size() != 1) return fail(a.who + ": \"" + a.value + "\" is not one number");
    return all[0];
}

Result<std::uint32_t> whole(const Assignment& a) {
    std::uint32_t x = 0;
    const char* end = a.value.data() + a.value.size();
    if (const auto read = std::from_chars(a.value.data(), end, x); read.ec != std::errc() || read.ptr != end)
        return fail(a.who + ": \"" + a.value + "\" is not a whole number, 0 or more");
    return x;
}

Result<glm::vec3> color(const Assignment& a) {
    RESTAGE_TRY(const auto all, numbers(a));
    if (all.size() == 1) return glm::vec3(all[0]);
    if (all.size() != 3) return fail(a.who + ": a colour is one number or three separated by commas, linear sRGB");
    return glm::vec3(all[0], all[1], all[2]);
}

Result<bool> truth(const Assignment& a) {
    if (a.value == "true" || a.value == "false") return a.value == "true";
    return fail(a.who + ": \"" + a.value + "\" is neither true nor false");
}

template <class T>
Result<Id<T>> named(const Scene& scene, const Assignment& a) {
    const Id<T> id = find_by_name<T>(scene, a.value);
    if (!id) return fail(a.who + ": there is no " + kind_name<T> + " \"" + a.value + "\"");
    return id;
}

// A value that is not a number names a texture.
bool begins_number(const std::string& text) { return !text.empty() && text.find_first_of("0123456789.+-") == 0; }

Result<Value> value_of(const Scene& scene, const Assignment& a, model::ParamType type) {
    Value value{.type = type};
    switch (type) {
        case model::ParamType::number:
        case model::ParamType::color:
        case model::ParamType::texture: {
            if (const auto texture = find_by_name<Texture>(scene, a.value); texture && !begins_number(a.value)) {
                value.texture = texture;
                return value;
            }
            if (type == model::ParamType::texture || !begins_number(a.value))
                return fail(a.who + ": there is no texture \"" + a.value + "\"" +
                            (type == model::ParamType::texture ? "" : ", nor is it a number"));
            if (type == model::ParamType::number) {
                RESTAGE_TRY(value.v[0], number(a));
            } else {
                RESTAGE_TRY(const glm::vec3 c, color(a));
                value.v = {c.x, c.y, c.z, 0};
            }
            return value;
        }
        case model::ParamType::integer: {
            RESTAGE_TRY(const float x, number(a));
            if (x != std::floor(x) || std::abs(x) > 1e9f)
                return fail(a.who + ": \"" + a.value + "\" is not a whole number");
            value.i = static_cast<int>(x);
            return value;
        }
        case model::ParamType::boolean: {
            RESTAGE_TRY(const bool on, truth(a));
            value.i = on;
            return value;
        }
        case model::ParamType::material: {
            RESTAGE_TRY(value.material, named<Material>(scene, a));
            return value;
        }
        default: // choices, texts, paths of tables
            value.text = a.value;
            return value;
    }
}

constexpr std::string_view of_objects = "material, emission, hidden, catcher";
constexpr std::string_view of_lights = "value, cone_angle, cone_delta, hidden";
constexpr std::string_view of_cameras = "fov, lens_radius, focal_distance";

bool has(std::string_view fields, std::string_view field) {
    return (", " + std::string(fields) + ", ").find(", " + std::string(field) + ", ") != std::string::npos;
}

Result<Edit> object_edit(const Scene& scene, Id<Instance> id, const Assignment& a) {
    const Id<Instance> one[] = {id};
    if (a.field == "material") {
        RESTAGE_TRY(const auto material, named<Material>(scene, a));
        return set_material(scene, one, material);
    }
    if (a.field == "hidden") {
        RESTAGE_TRY(const bool hidden, truth(a));
        return set_hidden(scene, one, hidden);
    }
    if (a.field == "catcher") {
        RESTAGE_TRY(const bool catcher, truth(a));
        return set_catcher(scene, one, catcher);
    }
    if (a.value == "none") return set_emission(scene, id, std::nullopt);
    RESTAGE_TRY(const glm::vec3 radiance, color(a));
    Emission emission = scene.instances[id].emission.value_or(Emission{});
    emission.radiance = radiance;
    return set_emission(scene, id, emission);
}

Result<Edit> light_edit(const Scene& scene, Id<Light> id, const Assignment& a) {
    if (a.field == "hidden") {
        RESTAGE_TRY(const bool hidden, truth(a));
        return set_hidden(scene, id, hidden);
    }
    Light light = scene.lights[id];
    if (a.field == "value") {
        RESTAGE_TRY(light.value, color(a));
    } else {
        if (!scene::light_row(light.kind).cone)
            return fail(a.who + ": a " + scene::light_row(light.kind).id + " light has no cone");
        RESTAGE_TRY((a.field == "cone_angle" ? light.cone_angle : light.cone_delta), number(a));
    }
    return set_light(scene, id, std::move(light));
}

Result<Edit> camera_edit(const Scene& scene, Id<Camera> id, const Assignment& a) {
    Camera camera = scene.cameras[id];
    float& field = a.field == "fov"           ? camera.fov
                   : a.field == "lens_radius" ? camera.lens_radius
                                              : camera.focal_distance;
    RESTAGE_TRY(field, number(a));
    return set_camera(scene, id, std::move(camera), "Change camera");
}

// Its type, or a value of its plugin's table; null if it is another field.
std::optional<Result<Edit>> plugin_sky_edit(const Session& session, const Assignment& a) {
    const Scene& scene = session.scene();
    const Camera* camera = scene.cameras.find(scene.active_camera.value);
    const glm::dvec3 up = camera ? query::guess_up(*camera) : glm::dvec3(0, 1, 0);
    const auto made = [&](const std::string& type, const ParamSet& values) -> Result<Edit> {
        auto edit = plugin_sky(scene, session.registry(), type, values, up);
        if (!edit) return fail(a.who, edit.error());
        return edit;
    };
    if (a.field == "type") return made(a.value, {});
    const std::string type = scene.environment.value ? scene.environment.value->sky : "";
    const auto plugin = io::find_sky(session.registry(), type);
    const model::Param* line = plugin ? plugin->table->find(a.field) : nullptr;
    if (!line) return std::nullopt;
    auto value = value_of(scene, a, line->type);
    if (!value) return Result<Edit>(tl::unexpected<Error>(std::move(value.error())));
    ParamSet values;
    values.set(a.field, std::move(*value));
    return made(type, values);
}

Result<Edit> sky_edit(const Session& session, const Assignment& a) {
    if (auto edit = plugin_sky_edit(session, a)) return std::move(*edit);
    const Scene& scene = session.scene();
    if (!scene.environment.value) return fail(a.who + ": the scene has no sky; set one of a plugin with sky.type=NAME");
    Environment sky = *scene.environment.value;
    if (a.field == "scale") {
        RESTAGE_TRY(sky.scale, color(a));
    } else if (a.field == "rotation") {
        RESTAGE_TRY(const float angle, number(a));
        const Camera* camera = scene.cameras.find(scene.active_camera.value);
        const glm::dvec3 up = camera ? query::guess_up(*camera) : glm::dvec3(0, 1, 0);
        sky.light_to_world = glm::rotate(glm::dmat4(1), glm::radians(double(angle)), up) * upright_sky(up);
    } else if (a.field == "hidden_from_camera") {
        RESTAGE_TRY(sky.hidden_from_camera, truth(a));
    } else {
        std::string list = "type, scale, rotation and hidden_from_camera";
        if (const auto plugin = io::find_sky(session.registry(), sky.sky))
            for (const model::Param& line : plugin->table->params)
                list += ", " + line.id;
        return fail(a.who + ": the sky has " + list);
    }
    return set_environment(scene, std::move(sky));
}

Result<Edit> settings_edit(const Scene& scene, const Assignment& a) {
    Settings settings = scene.settings.value;
    if (a.field != "max_depth" && a.field != "samples")
        return fail(a.who + ": the settings have max_depth and samples");
    RESTAGE_TRY((a.field == "samples" ? settings.samples : settings.max_depth), whole(a));
    return set_settings(scene, settings);
}

Result<Edit> film_edit(const Scene& scene, const Assignment& a) {
    Film film = scene.film.value;
    Development& d = film.development;
    float* const value = a.field == "exposure"        ? &film.exposure
                         : a.field == "white_balance" ? &d.temperature
                         : a.field == "tint"          ? &d.tint
                         : a.field == "vignette"      ? &d.vignette
                         : a.field == "bloom"         ? &d.bloom
                                                      : nullptr;
    if (value) {
        RESTAGE_TRY(*value, number(a));
    } else if (a.field == "tone") {
        const auto tone = find_tone(a.value);
        if (!tone) return fail(fmt::format("{}: a tone is one of {}", a.who, fmt::join(tone_names, ", ")));
        d.tone = *tone;
    } else {
        return fail(a.who +
                    ": the film has exposure, tone, white_balance, tint, vignette and bloom; --size sets its size");
    }
    return set_film(scene, std::move(film));
}

class MaterialFields {
  public:
    MaterialFields(const Session& session, Id<Material> id) : material_(session.scene().materials[id]) {
        table_ = session.registry().find_material(material_.type);
    }
    std::optional<model::ParamType> type_of(const std::string& field) const {
        if (const model::Param* line = table_ ? table_->table->find(field) : nullptr) return line->type;
        if (const Value* there = material_.params.find(field)) return there->type;
        if (field == "bump") return model::ParamType::number;
        return std::nullopt;
    }
    std::string list() const {
        std::string text = "type";
        if (table_)
            for (const model::Param& line : table_->table->params)
                text += ", " + line.id;
        return text;
    }

  private:
    const Material& material_;
    std::optional<plugin::MaterialEntry> table_;
};

Result<Edit> material_edit(const Session& session, Id<Material> id, const Assignment& a) {
    const Scene& scene = session.scene();
    if (a.field == "type") {
        if (!session.registry().find_material(a.value))
            return fail(a.who + ": there is no material type \"" + a.value + "\"; `restage plugins` lists them");
        return set_material_type(scene, id, a.value);
    }
    RESTAGE_TRY(auto value, value_of(scene, a, *MaterialFields(session, id).type_of(a.field)));
    return session.param_edit(id, a.field, std::move(value));
}

Result<Edit> edit_of(const Session& session, const Assignment& a) {
    const Scene& scene = session.scene();
    std::string known; // fields of the items of this name
    const auto note = [&](const char* kind, const std::string& fields) {
        known += std::string(known.empty() ? "" : "; ") + kind + " \"" + a.name + "\" has " + fields;
    };
    if (const auto id = find_by_name<Material>(scene, a.name)) {
        const MaterialFields fields(session, id);
        if (a.field == "type" || fields.type_of(a.field)) return material_edit(session, id, a);
        note("material", fields.list());
    }
    if (const auto id = find_by_name<Instance>(scene, a.name)) {
        if (has(of_objects, a.field)) return object_edit(scene, id, a);
        note("object", std::string(of_objects));
    }
    if (const auto id = find_by_name<Light>(scene, a.name)) {
        if (has(of_lights, a.field)) return light_edit(scene, id, a);
        note("light", std::string(of_lights));
    }
    if (const auto id = find_by_name<Camera>(scene, a.name)) {
        if (has(of_cameras, a.field)) return camera_edit(scene, id, a);
        note("camera", std::string(of_cameras));
    }
    if (a.name == "film") return film_edit(scene, a);
    if (a.name == "sky") return sky_edit(session, a);
    if (a.name == "settings") return settings_edit(scene, a);
    if (known.empty())
        return fail(a.who + ": there is no material, object, light or camera \"" + a.name +
                    "\"; `restage info` lists them");
    return fail(a.who + ": " + known);
}

} // namespace

Result<> assign(Session& session, const std::string& assignment) {
    RESTAGE_TRY(const Assignment a, split(assignment));
    RESTAGE_TRY(const bool changed, session.edit(edit_of(session, a)));
    static_cast<void>(changed);
    return {};
}

} // namespace restage::document
