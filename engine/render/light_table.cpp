// SPDX-License-Identifier: Apache-2.0
#include "render/light_table.hpp"

#include "render/alias_table.hpp"
#include "scene/quadric.hpp"
#include "shared/normal.h"

#include <cmath>
#include <numbers>

namespace restage::render {
namespace {

using scene::Id;
using shared::LightData;
constexpr double pi = std::numbers::pi;

double luminance(const glm::vec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

} // namespace

glm::dvec3 outward_normal(const scene::Instance& instance, const scene::MeshData& mesh, const glm::uvec3& t) {
    const glm::dvec3 p0(mesh.positions[t.x]), p1(mesh.positions[t.y]), p2(mesh.positions[t.z]);
    const glm::dmat3 normal_to_world = glm::transpose(glm::inverse(glm::dmat3(instance.object_to_world)));
    glm::dvec3 n = normal_to_world * glm::cross(p1 - p0, p2 - p0);
    double along = 0;
    if (!mesh.normals.empty()) {
        const glm::dvec3 s = normal_to_world * glm::dvec3(mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]);
        along = glm::dot(n, s);
    }
    return shared::points_inward(along, instance.reverse_orientation) ? -n : n;
}

namespace {

// Inputs of light_offset (shaders/lib/light.glsl), which ends shadow rays before a light's triangle: `offset`, the part
// that does not depend on the ray, and `condition`. Error analysis as in shaders/lib/ray_offset.glsl.
struct Rounding {
    double offset, condition;
};
Rounding light_rounding(const glm::dmat4& object_to_render, const scene::MeshData& mesh, const glm::uvec3& t) {
    constexpr double eps = 0x1p-24;
    const auto absolute = [](glm::dmat3 m) {
        for (int i = 0; i < 3; ++i)
            m[i] = glm::abs(m[i]);
        return m;
    };
    const glm::dmat3 m(object_to_render);
    const glm::dvec3 v0(mesh.positions[t.x]), v1(mesh.positions[t.y]), v2(mesh.positions[t.z]);
    const glm::dvec3 b = m * (v1 - v0), c = m * (v2 - v0), n = glm::abs(glm::normalize(glm::cross(b, c)));
    const glm::dmat3 scale = absolute(m), inverse = absolute(glm::inverse(m));
    const glm::dvec3 spread = n * scale * inverse; // an error of the origin in object space, along n
    const glm::dvec3 move = glm::abs(glm::dvec3(object_to_render[3])),
                     corner = glm::abs(v0) + glm::abs(v1) + glm::abs(v2);
    const glm::dvec3 edges = glm::abs(b) + glm::abs(c);
    // A long thin triangle's normal is ill-conditioned.
    const double thin =
        glm::length(b) * glm::length(c) / glm::length(glm::cross(b, c)) * (glm::length(b) + glm::length(c));
    const glm::dvec3 point = glm::abs(glm::dvec3(object_to_render * glm::dvec4(v0, 1))) + edges;
    return {
        eps * (glm::dot(n, point + 5.0 * edges) + glm::dot(n * scale, corner) + 6 * glm::dot(spread, move) + 4 * thin),
        std::max({spread.x, spread.y, spread.z, 1.0})};
}

LightData quadric_light(const scene::Quadric& q, const glm::dmat4& place, const Emitter& emits) {
    // Bounds like those of triangles, but along any normal, and with the quadric's own: the sampled point, and
    // the error of solving for it, are each a few ulps of its size.
    constexpr double eps = 0x1p-24;
    const glm::dmat3 m(place);
    glm::dmat3 scale(0), inverse(0);
    const glm::dmat3 back = glm::inverse(m);
    for (int i = 0; i < 3; ++i) {
        scale[i] = glm::abs(m[i]);
        inverse[i] = glm::abs(back[i]);
    }
    const glm::dvec3 ones(1), corner(q.radius, q.radius, std::max(std::abs(q.z_min), std::abs(q.z_max)));
    const glm::dvec3 spread = ones * scale * inverse, move = glm::abs(glm::dvec3(place[3]));
    const double size = glm::length(scale * corner);
    const double offset = eps * (3 * glm::length(move) + 20 * size + 6 * glm::dot(spread, move));
    const double condition = 1.5 * std::max({spread.x, spread.y, spread.z, 1.0});
    LightData light{};
    const double sixteenths = std::isfinite(condition) ? std::min(condition * 16, 65535.0) : 16.0;
    light.kind = LIGHT_QUADRIC | (emits.two_sided ? LIGHT_TWO_SIDED : 0) | std::uint32_t(std::ceil(sixteenths)) << 16;
    light.offset = std::isfinite(offset) ? float(offset) : 0.f;
    light.area = float(q.area());
    light.value = emits.radiance;
    return light;
}

// Under an affine map areas grow by |det m| |m^-T n|. Over a lattice: it only chooses among lights.
double world_area(const scene::Quadric& q, const glm::dmat3& m) {
    const glm::dmat3 normals = glm::transpose(glm::inverse(m));
    double sum = 0, weights = 0;
    for (int i = 0; i < 16; ++i)
        for (int j = 0; j < 16; ++j) {
            const glm::dvec3 p = q.at({(i + 0.5) / 16, (j + 0.5) / 16});
            const double weight = q.kind == scene::Quadric::Kind::cylinder ? 1 : std::hypot(p.x, p.y);
            sum += weight * glm::length(normals * q.normal(p));
            weights += weight;
        }
    const double area = q.area() * std::abs(glm::determinant(m)) * sum / weights;
    return std::isfinite(area) ? area : 0;
}

} // namespace

LightTable make_light_table(const scene::Scene& scene, const glm::dvec3& origin, const glm::vec3& environment_mean,
                            double radius, const std::function<std::optional<Emitter>(Id<scene::Instance>)>& emitter) {
    LightTable table;
    table.light_base.assign(scene.instances.size() + 1, NONE);
    std::vector<double> power;

    scene.instances.each([&](Id<scene::Instance> id, const scene::Instance& instance) {
        const auto emits = emitter(id);
        if (!emits || luminance(emits->radiance) <= 0) return;
        const auto& mesh = *scene.meshes[instance.mesh].data;
        if (const auto quadric = scene::quadric_of(scene.meshes[instance.mesh])) {
            table.light_base[id.value] = std::uint32_t(table.lights.size());
            glm::dmat4 place = instance.object_to_world;
            place[3] -= glm::dvec4(origin, 0);
            table.lights.push_back(quadric_light(*quadric, place, *emits));
            table.lights.back().instance = id.value;
            const double mean = emits->mean ? emits->mean(0) : luminance(emits->radiance);
            power.push_back(pi * mean * (emits->two_sided ? 2 : 1) * world_area(*quadric, glm::dmat3(place)));
            return;
        }
        table.light_base[id.value] = std::uint32_t(table.lights.size());
        const double exitance = pi * luminance(emits->radiance) * (emits->two_sided ? 2 : 1);
        glm::dmat4 place = instance.object_to_world;
        place[3] -= glm::dvec4(origin, 0);
        for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
            const auto& t = mesh.triangles[k];
            const auto world = [&](std::uint32_t i) { return glm::dvec3(place * glm::dvec4(mesh.positions[i], 1)); };
            const glm::dvec3 p0 = world(t.x);
            glm::dvec3 b = world(t.y) - p0, c = world(t.z) - p0;
            const bool swapped = glm::dot(glm::cross(b, c), outward_normal(instance, mesh, t)) < 0;
            if (swapped) std::swap(b, c);
            const double area = 0.5 * glm::length(glm::cross(b, c));
            LightData light{};
            const Rounding rounding = light_rounding(place, mesh, t);
            const auto condition =
                std::isfinite(rounding.condition) ? std::min(rounding.condition * 16, 65535.0) : 16.0;
            light.kind = LIGHT_TRIANGLE | (emits->two_sided ? LIGHT_TWO_SIDED : 0) | (swapped ? LIGHT_SWAPPED : 0) |
                         std::uint32_t(std::ceil(condition)) << 16;
            light.offset = std::isfinite(rounding.offset) ? float(rounding.offset) : 0.f;
            light.a = p0;
            light.b = b;
            light.c = c;
            light.area = float(area);
            light.value = emits->radiance;
            light.instance = emits->varies ? id.value : NONE;
            table.lights.push_back(light);
            const double mean = emits->mean ? emits->mean(k) / luminance(emits->radiance) : 1;
            power.push_back(std::isfinite(area * mean) ? exitance * mean * area : 0);
        }
    });
    scene.lights.each([&](Id<scene::Light>, const scene::Light& item) {
        if (item.hidden) return;
        const glm::dmat4& m = item.light_to_world;
        LightData light{};
        light.value = item.value;
        light.a = glm::dvec3(m[3]) - origin;
        light.b = glm::normalize(glm::dvec3(m[2]));
        const scene::Cone cone = scene::cone_of(item);
        light.c = {cone.edge, cone.start, cone.falloff == scene::Falloff::quartic ? 1 : 0};
        light.kind = LIGHT_LAMP + std::uint32_t(item.kind);
        power.push_back(scene::light_row(item.kind).power(cone, radius) * luminance(item.value));
        table.lights.push_back(light);
    });
    if (scene.environment.value && luminance(environment_mean) > 0) {
        LightData light{};
        light.kind = LIGHT_ENVIRONMENT;
        table.environment = std::uint32_t(table.lights.size());
        table.lights.push_back(light);
        power.push_back(4 * pi * pi * radius * radius * luminance(environment_mean));
    }
    table.alias = make_alias_table(power);
    if (table.alias.empty()) {
        table.lights.clear();
        table.environment = NONE;
        table.light_base.assign(table.light_base.size(), NONE);
    }
    for (std::size_t i = 0; i < table.lights.size(); ++i)
        table.lights[i].pmf = table.alias[i].pmf;
    return table;
}

} // namespace restage::render
