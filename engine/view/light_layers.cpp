// SPDX-License-Identifier: Apache-2.0
#include "view/light_layers.hpp"

#include "io/material_emission.hpp"
#include "scene/edits_light.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

namespace restage::view {

using namespace scene;

namespace {

// What objects of one layer have in common. Those that emit by their material share all that it says.
struct Lamp {
    std::uint32_t material = 0;
    std::array<float, 3> radiance{}; // of their own emission
    bool own = false, two_sided = false;
    auto operator<=>(const Lamp&) const = default;
};

double area(const MeshData& mesh) {
    double sum = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        sum += glm::length(glm::cross(b - a, c - a)) / 2;
    }
    return sum;
}

struct Lamps {
    LightLayer layer;
    std::string first; // object
    double power = 0;
};

std::vector<LightLayer> lamps_of(const Scene& scene, const plugin::Registry& registry) {
    const io::MaterialEmissions emissions(registry, scene);
    std::map<Lamp, Lamps> found;
    std::map<std::uint32_t, double> areas; // of meshes
    scene.instances.each([&](Id<Instance> id, const Instance& instance) {
        const Mesh* mesh = scene.meshes.find(instance.mesh);
        if (instance.hidden || !mesh || !mesh->data) return;
        Lamp lamp{.material = instance.material.value};
        glm::vec3 radiance(0);
        bool tinted = true;
        if (instance.emission) {
            radiance = instance.emission->radiance;
            lamp.own = true;
            lamp.radiance = {radiance.x, radiance.y, radiance.z};
            lamp.two_sided = instance.emission->two_sided;
        } else if (const auto emission = emissions.of(instance.material)) {
            radiance = emission->radiance;
            tinted = !emission->texture;
        }
        if (radiance == glm::vec3(0)) return;
        const auto [known, fresh] = areas.try_emplace(instance.mesh.value);
        if (fresh) known->second = area(*mesh->data);
        const double size = std::cbrt(std::abs(glm::determinant(glm::dmat3(instance.object_to_world))));
        Lamps& lamps = found[lamp];
        if (lamps.layer.lights.empty()) lamps.first = instance.name;
        lamps.layer.lights.push_back(key_of(id));
        lamps.layer.tinted = tinted;
        lamps.power += glm::dot(glm::dvec3(radiance), glm::dvec3(0.2126, 0.7152, 0.0722)) * known->second * size * size;
    });
    std::vector<Lamps> list;
    for (auto& [lamp, lamps] : found)
        list.push_back(std::move(lamps));
    std::ranges::stable_sort(list, std::greater<>(), &Lamps::power);
    std::vector<LightLayer> layers;
    for (Lamps& lamps : list) {
        const std::size_t more = lamps.layer.lights.size() - 1;
        lamps.layer.name = more ? fmt::format("{} and {} more", lamps.first, more) : lamps.first;
        lamps.layer.kind = more ? "Lamps" : "Lamp";
        layers.push_back(std::move(lamps.layer));
    }
    return layers;
}

} // namespace

std::vector<LightLayer> light_layers(const Scene& scene, const plugin::Registry& registry, std::size_t most) {
    std::vector<LightLayer> layers;
    if (const auto& sky = scene.environment.value; sky && sky->scale != glm::vec3(0))
        layers.push_back({.name = "The sky", .kind = "Sky", .lights = {sky_key}});
    scene.lights.each([&](Id<Light> id, const Light& light) {
        if (!light.hidden && light.value != glm::vec3(0))
            layers.push_back({.name = light.name, .kind = light_row(light.kind).label, .lights = {key_of(id)}});
    });
    std::ranges::move(lamps_of(scene, registry), std::back_inserter(layers));
    if (layers.size() <= most || most == 0) return layers;
    LightLayer others{.name = fmt::format("{} others", layers.size() - most + 1), .kind = "Lights", .lights = {}};
    for (std::size_t i = most - 1; i < layers.size(); ++i) {
        std::ranges::copy(layers[i].lights, std::back_inserter(others.lights));
        others.tinted = others.tinted && layers[i].tinted;
    }
    layers.resize(most - 1);
    layers.push_back(std::move(others));
    return layers;
}

Result<Edit> weigh_lights(const Scene& scene, const plugin::Registry& registry, std::span<const LightLayer> layers,
                          std::span<const glm::vec3> weights) {
    Edit edit{"Mix lights", {}};
    std::set<std::uint32_t> materials; // weighed already
    const auto weigh = [&](LightKey key, const glm::vec3& weight) -> Result<Edit> {
        if (key.kind == LightKey::Kind::sky) {
            if (!scene.environment.value) return fail("there is no sky any more");
            Environment sky = *scene.environment.value;
            sky.scale *= weight;
            return set_environment(scene, sky);
        }
        if (key.kind == LightKey::Kind::light)
            return modify(scene, Id<Light>{key.id}, "", [&](Light& light) { light.value *= weight; });
        const Instance* instance = scene.instances.find({key.id});
        if (!instance) return fail("there is no object with id " + std::to_string(key.id));
        if (instance->emission)
            return modify(scene, Id<Instance>{key.id}, "", [&](Instance& i) { i.emission->radiance *= weight; });
        const Material* material = scene.materials.find(instance->material);
        const auto type = material ? registry.find_material(material->type) : std::nullopt;
        if (!type || !type->table->emission) return fail("\"" + instance->name + "\" does not emit light any more");
        if (!materials.insert(instance->material.value).second) return Edit{};
        return scale_emission(scene, instance->material, *type->table, weight);
    };
    for (std::size_t i = 0; i < std::min(layers.size(), weights.size()); ++i) {
        if (weights[i] == glm::vec3(1)) continue;
        for (const LightKey key : layers[i].lights) {
            RESTAGE_TRY(Edit one, weigh(key, weights[i]));
            std::ranges::move(one.changes, std::back_inserter(edit.changes));
        }
    }
    return edit;
}

} // namespace restage::view
