// SPDX-License-Identifier: Apache-2.0
#include "scene/edits_light.hpp"

#include "scene/bounds.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <vector>

namespace restage::scene {

Result<DuplicateLight> duplicate_light(const Scene& scene, Id<Light> id, const glm::dmat4& move) {
    const Light* light = scene.lights.find(id);
    if (!light) return fail("there is no light with id " + std::to_string(id.value));
    std::set<std::string> names;
    scene.lights.each([&](auto, const Light& other) { names.insert(other.name); });
    Light copy = *light;
    copy.name = next_name(copy.name, names);
    copy.light_to_world = move * copy.light_to_world;
    return DuplicateLight{insert(scene, std::move(copy), "Duplicate " + light->name), scene.lights.next()};
}

namespace {

// Around `at`, from the direction of `from` to `direction`, by the shortest way.
Result<glm::dmat4> turn_around(const glm::dvec3& at, const glm::dvec3& from, const glm::dvec3& direction) {
    const double distance = glm::length(from - at);
    if (!(distance > 0)) return fail("the light is at that point itself");
    const glm::dmat4 turn = glm::mat4_cast(glm::dquat((from - at) / distance, direction));
    return glm::translate(glm::dmat4(1), at) * turn * glm::translate(glm::dmat4(1), -at);
}

} // namespace

Result<Edit> light_from(const Scene& scene, Id<Light> id, const glm::dvec3& at, const glm::dvec3& direction) {
    const Light* light = scene.lights.find(id);
    if (!light) return fail("there is no light with id " + std::to_string(id.value));
    glm::dmat4 place = light->light_to_world;
    const LightKindRow& kind = light_row(light->kind);
    if (kind.placed) {
        RESTAGE_TRY(const glm::dmat4 turn, turn_around(at, glm::dvec3(place[3]), direction));
        place = turn * place;
    }
    if (kind.aimed) {
        const glm::dvec3 now = glm::normalize(glm::dvec3(place[2]));
        const glm::dmat3 turned = glm::mat3_cast(glm::dquat(now, -direction)) * glm::dmat3(place);
        for (int i = 0; i < 3; ++i)
            place[i] = glm::dvec4(turned[i], 0);
    }
    return modify(scene, id, "Highlight by " + light->name, [&](Light& l) { l.light_to_world = place; });
}

Result<Edit> light_from(const Scene& scene, std::span<const Id<Instance>> ids, const glm::dvec3& at,
                        const glm::dvec3& direction) {
    Bounds box;
    for (const Id<Instance> id : ids)
        box.add(world_bounds(scene, id));
    if (box.empty()) return fail("these objects have no extent");
    RESTAGE_TRY(const glm::dmat4 turn, turn_around(at, box.center(), direction));
    RESTAGE_TRY(Edit edit, move_instances(scene, ids, turn));
    edit.label =
        "Highlight by " + (ids.size() == 1 ? scene.instances[ids[0]].name : std::to_string(ids.size()) + " objects");
    return edit;
}

Result<Edit> scale_emission(const Scene& scene, Id<Material> id, const model::Material& type, const glm::vec3& factor) {
    const Material* material = scene.materials.find(id);
    if (!material) return fail("there is no material with id " + std::to_string(id.value));
    const model::Emission& names = *type.emission;
    const auto value = [&](const std::string& param) {
        const Value* set = material->params.find(param);
        const model::Param* line = type.find(param);
        return set ? *set : line ? default_value(*line) : Value{};
    };
    std::vector<std::pair<std::string, Value>> values;
    glm::vec3 tint = factor; // what the colour takes: with a scale it stays within 0 to 1
    if (!names.scale.empty()) {
        const float most = std::max({factor.x, factor.y, factor.z});
        tint = most > 0 ? factor / most : glm::vec3(1);
        values.emplace_back(names.scale, Value::number(value(names.scale).scalar() * most));
    }
    if (tint != glm::vec3(1)) {
        const Value color = value(names.radiance);
        if (color.texture)
            return fail("the light of \"" + material->name + "\" is coloured by a texture: it is not tinted");
        const bool rgb = color.type == ParamType::color; // else a grey
        const glm::vec3 now = rgb ? glm::vec3(color.v[0], color.v[1], color.v[2]) : glm::vec3(color.scalar());
        const glm::vec3 tinted = now * tint;
        values.emplace_back(names.radiance, Value::color(tinted.x, tinted.y, tinted.z));
    }
    return set_params(scene, id, values, "Light of " + material->name);
}

} // namespace restage::scene
