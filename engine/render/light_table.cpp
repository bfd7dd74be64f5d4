// SPDX-License-Identifier: Apache-2.0
#include "render/light_table.hpp"

#include "render/cdf_table.hpp"
#include "render/light_tree.hpp"
#include "scene/quadric.hpp"
#include "shared/normal.h"

#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

namespace restage::render {
namespace {

using scene::Id;
using shared::LightData;
constexpr double pi = std::numbers::pi;

// Triangles are sampled by solid angle in emitters of up to so many. In others each is small.
constexpr std::size_t most_by_angle = 8;

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
    light.value = emits.stored.value_or(emits.radiance);
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

LightData triangle_light(const glm::dmat4& place, const scene::Instance& instance, const scene::MeshData& mesh,
                         const glm::uvec3& t, const Emitter& emits) {
    const auto world = [&](std::uint32_t i) { return glm::dvec3(place * glm::dvec4(mesh.positions[i], 1)); };
    const glm::dvec3 p0 = world(t.x);
    glm::dvec3 b = world(t.y) - p0, c = world(t.z) - p0;
    const bool swapped = glm::dot(glm::cross(b, c), outward_normal(instance, mesh, t)) < 0;
    if (swapped) std::swap(b, c);
    LightData light{};
    const Rounding rounding = light_rounding(place, mesh, t);
    const auto condition = std::isfinite(rounding.condition) ? std::min(rounding.condition * 16, 65535.0) : 16.0;
    light.kind = LIGHT_TRIANGLE | (emits.two_sided ? LIGHT_TWO_SIDED : 0) | (swapped ? LIGHT_SWAPPED : 0) |
                 std::uint32_t(std::ceil(condition)) << 16;
    light.offset = std::isfinite(rounding.offset) ? float(rounding.offset) : 0.f;
    light.a = p0;
    light.b = b;
    light.c = c;
    light.area = float(0.5 * glm::length(glm::cross(b, c)));
    light.value = emits.stored.value_or(emits.radiance);
    return light;
}

// Do two triangles, one after the other in a mesh, make a parallelogram? If so, turns them so that each begins at the
// corner that is only its own.
bool make_pair(const glm::dmat4& place, const scene::MeshData& mesh, glm::uvec3& first, glm::uvec3& second) {
    const auto world = [&](std::uint32_t i) { return glm::dvec3(place * glm::dvec4(mesh.positions[i], 1)); };
    const auto own = [&](const glm::uvec3& t, const glm::uvec3& other) {
        int corner = -1;
        for (int i = 0; i < 3; ++i) {
            const auto is = [&](std::uint32_t v) { return mesh.positions[v] == mesh.positions[t[i]]; };
            if (is(other.x) || is(other.y) || is(other.z)) continue;
            if (corner >= 0) return -1;
            corner = i;
        }
        return corner;
    };
    const int i = own(first, second), k = own(second, first);
    if (i < 0 || k < 0) return false;
    const auto turn = [](const glm::uvec3& t, int n) { return glm::uvec3(t[n], t[(n + 1) % 3], t[(n + 2) % 3]); };
    const glm::uvec3 a = turn(first, i), b = turn(second, k);
    if (mesh.positions[a.y] != mesh.positions[b.z] || mesh.positions[a.z] != mesh.positions[b.y]) return false;
    const glm::dvec3 p = world(a.x), q = world(b.x), s = world(a.y), t = world(a.z);
    if (glm::length(p + q - s - t) > 1e-6 * (glm::length(s - p) + glm::length(t - p))) return false;
    first = a;
    second = b;
    return true;
}

// Are the edges at a triangle's first corner at a right angle?
bool right_angle(const glm::dmat4& place, const scene::MeshData& mesh, const glm::uvec3& t) {
    const glm::dmat3 m(place);
    const glm::dvec3 p(mesh.positions[t.x]);
    const glm::dvec3 b = m * (glm::dvec3(mesh.positions[t.y]) - p), c = m * (glm::dvec3(mesh.positions[t.z]) - p);
    return std::abs(glm::dot(b, c)) <= 1e-5 * glm::length(b) * glm::length(c);
}

// The lights of one emitter as they are added to the table, and bounds for the tree.
class EmitterBuilder {
  public:
    explicit EmitterBuilder(LightTable& table) : table_(table), first_(std::uint32_t(table.lights.size())) {}

    // weight: of being chosen, a mean luminance times an area. corners: whose convex hull contains it. normal: of its
    // emitting side; 0 = all directions.
    void add(const LightData& light, double weight, std::span<const glm::dvec3> corners, const glm::dvec3& normal) {
        table_.lights.push_back(light);
        weights_.push_back(std::isfinite(weight) ? weight : 0);
        if (weights_.back() <= 0) return;
        corners_.insert(corners_.end(), corners.begin(), corners.end());
        normals_.push_back(normal);
    }
    // Sets the probabilities. nullopt, and nothing is added, if the sum of weights is 0.
    std::optional<shared::LightNode> finish(bool two_sided) {
        const auto cdf = make_cdf(weights_);
        if (cdf.empty()) {
            table_.lights.resize(first_);
            return std::nullopt;
        }
        table_.cdf.insert(table_.cdf.end(), cdf.begin(), cdf.end());
        for (std::size_t i = 0; i < cdf.size(); ++i) {
            LightData& light = table_.lights[first_ + i];
            if ((light.kind & 255) == LIGHT_TRIANGLE && !(light.kind & (LIGHT_PAIR | LIGHT_PAIR_END)) &&
                cdf.size() <= most_by_angle)
                light.kind |= LIGHT_BY_ANGLE;
            table_.kinds |= (light.kind & LIGHT_RECTANGLE ? LIGHTS_RECTANGLES : 0) |
                            (light.kind & LIGHT_BY_ANGLE ? LIGHTS_TRIANGLES : 0);
            light.pmf = float(cdf_probability(cdf, i));
            if (!(light.kind & LIGHT_PAIR_END)) continue;
            LightData& other = table_.lights[first_ + i - 1]; // one density over both
            light.pmf = other.pmf = light.pmf + other.pmf;
            light.area = other.area = light.area + other.area;
        }
        shared::LightNode node{};
        node.first = first_;
        node.lights = std::uint32_t(cdf.size());
        node.intensity = float(std::min(std::accumulate(weights_.begin(), weights_.end(), 0.0), 1e30));
        node.flags = two_sided ? LIGHT_TWO_SIDED : 0;
        const bool pair = cdf.size() == 2 && (table_.lights.back().kind & LIGHT_PAIR_END);
        if (cdf.size() > 1 && !pair) node.flags |= LIGHT_PIECES;
        table_.kinds |= LIGHTS_SURFACES | (node.flags & LIGHT_PIECES ? LIGHTS_MESHES : 0);
        bound(node);
        return node;
    }

  private:
    void bound(shared::LightNode& node) const {
        glm::dvec3 lower = corners_[0], upper = lower, axis(0);
        for (const glm::dvec3& p : corners_) {
            lower = glm::min(lower, p);
            upper = glm::max(upper, p);
        }
        node.center = 0.5 * (lower + upper);
        double radius = 0, spread = 1;
        for (const glm::dvec3& p : corners_)
            radius = std::max(radius, glm::length(p - glm::dvec3(node.center)));
        for (const glm::dvec3& n : normals_)
            axis += n;
        axis = glm::length(axis) > 1e-3 ? glm::normalize(axis) : glm::dvec3(0, 0, 1);
        for (const glm::dvec3& n : normals_)
            spread = std::min(spread, n == glm::dvec3(0) ? -1 : glm::dot(axis, n));
        node.radius = float(radius * (1 + 1e-6));
        node.axis = axis;
        node.cos_spread = float(std::max(-1.0, spread - 1e-6));
    }

    LightTable& table_;
    std::uint32_t first_;
    std::vector<double> weights_;
    std::vector<glm::dvec3> corners_, normals_;
};

double mean(const Emitter& emits, std::uint32_t triangle) {
    return emits.mean ? emits.mean(triangle) : luminance(emits.radiance);
}

void add_quadric(EmitterBuilder& builder, const scene::Quadric& q, const glm::dmat4& place, const Emitter& emits,
                 std::uint32_t id) {
    LightData light = quadric_light(q, place, emits);
    light.instance = id;
    std::array<glm::dvec3, 8> box;
    for (unsigned i = 0; i < 8; ++i)
        box[i] = place *
                 glm::dvec4(i & 1 ? q.radius : -q.radius, i & 2 ? q.radius : -q.radius, i & 4 ? q.z_max : q.z_min, 1);
    builder.add(light, world_area(q, glm::dmat3(place)) * mean(emits, 0), box, glm::dvec3(0));
}

void add_triangles(EmitterBuilder& builder, const scene::Instance& instance, const scene::MeshData& mesh,
                   const glm::dmat4& place, const Emitter& emits, std::uint32_t id) {
    const auto add = [&](std::uint32_t k, const glm::uvec3& t, std::uint32_t flags) {
        LightData light = triangle_light(place, instance, mesh, t, emits);
        light.kind |= flags;
        light.instance = emits.varies ? id : NONE;
        const glm::dvec3 n = glm::cross(glm::dvec3(light.b), glm::dvec3(light.c));
        const glm::dvec3 a(light.a), corners[] = {a, a + glm::dvec3(light.b), a + glm::dvec3(light.c)};
        builder.add(light, double(light.area) * mean(emits, k), corners, glm::normalize(n));
    };
    const auto count = std::uint32_t(mesh.triangles.size());
    for (std::uint32_t k = 0; k < count; ++k) {
        glm::uvec3 t = mesh.triangles[k];
        glm::uvec3 next = k + 1 < count ? mesh.triangles[k + 1] : t;
        // Emission that varies is looked up by the mesh's barycentric coordinates.
        if (!emits.varies && k + 1 < count && make_pair(place, mesh, t, next)) {
            const std::uint32_t right = right_angle(place, mesh, t) ? LIGHT_RECTANGLE : 0;
            add(k, t, LIGHT_PAIR | right);
            add(++k, next, LIGHT_PAIR_END | right);
        } else {
            add(k, t, 0);
        }
    }
}

shared::LightNode lamp_node(const scene::Light& item, const LightData& light, const scene::Cone& cone) {
    shared::LightNode node{};
    node.intensity = float(luminance(item.value));
    node.axis = light.b;
    node.cos_spread = 1;
    node.center = light.a;
    if (!scene::light_row(item.kind).placed) node.radius = -1;
    node.cos_reach = scene::light_row(item.kind).cone ? float(cone.edge) : -1.f;
    return node;
}

// nullopt: it has none.
std::optional<shared::LightNode> add_emitter(LightTable& table, const scene::Scene& scene, const glm::dvec3& origin,
                                             Id<scene::Instance> id, const std::optional<Emitter>& emits) {
    if (!emits || luminance(emits->radiance) <= 0) return std::nullopt;
    const scene::Instance& instance = scene.instances[id];
    glm::dmat4 place = instance.object_to_world;
    place[3] -= glm::dvec4(origin, 0);
    EmitterBuilder builder(table);
    if (const auto quadric = scene::quadric_of(scene.meshes[instance.mesh]))
        add_quadric(builder, *quadric, place, *emits, id.value);
    else
        add_triangles(builder, instance, *scene.meshes[instance.mesh].data, place, *emits, id.value);
    return builder.finish(emits->two_sided);
}

} // namespace

LightTable make_light_table(const scene::Scene& scene, const glm::dvec3& origin, const glm::vec3& environment_mean,
                            const std::function<std::optional<Emitter>(Id<scene::Instance>)>& emitter,
                            const std::function<glm::vec3(const scene::Light&)>& lamp) {
    LightTable table;
    table.light_base.assign(scene.instances.size() + 1, NONE);
    std::vector<shared::LightNode> emitters;
    scene.instances.each([&](Id<scene::Instance> id, const scene::Instance&) {
        const auto node = add_emitter(table, scene, origin, id, emitter(id));
        if (!node) return;
        table.light_base[id.value] = node->first;
        emitters.push_back(*node);
    });
    const auto add_single = [&](LightData light, shared::LightNode node) {
        light.pmf = 1;
        node.first = std::uint32_t(table.lights.size());
        node.lights = 1;
        table.lights.push_back(light);
        table.cdf.push_back({});
        emitters.push_back(node);
    };
    scene.lights.each([&](Id<scene::Light>, const scene::Light& item) {
        if (item.hidden || luminance(item.value) <= 0) return;
        const glm::dmat4& m = item.light_to_world;
        LightData light{};
        light.value = lamp ? lamp(item) : item.value;
        light.a = glm::dvec3(m[3]) - origin;
        light.b = glm::normalize(glm::dvec3(m[2]));
        const scene::Cone cone = scene::cone_of(item);
        light.c = {cone.edge, cone.start, cone.falloff == scene::Falloff::quartic ? 1 : 0};
        light.kind = LIGHT_LAMP + std::uint32_t(item.kind);
        table.kinds |= LIGHTS_LAMPS;
        add_single(light, lamp_node(item, light, cone));
    });
    if (scene.environment.value && luminance(environment_mean) > 0) {
        LightData light{};
        light.kind = LIGHT_ENVIRONMENT;
        table.environment = std::uint32_t(table.lights.size());
        shared::LightNode node{};
        node.radius = -1;
        node.intensity = float(pi * luminance(environment_mean));
        add_single(light, node);
    }
    LightTree tree = make_light_tree(std::move(emitters));
    table.nodes = std::move(tree.nodes);
    table.roots = tree.roots;
    for (std::uint32_t n = 0; n < table.nodes.size(); ++n)
        for (std::uint32_t i = 0; i < table.nodes[n].lights; ++i)
            table.lights[table.nodes[n].first + i].node = n;
    return table;
}

std::optional<Replaced> replace_emitter(LightTable& table, const scene::Scene& scene, const glm::dvec3& origin,
                                        Id<scene::Instance> id, const std::optional<Emitter>& emits) {
    const std::uint32_t first = id.value < table.light_base.size() ? table.light_base[id.value] : NONE;
    if (first == NONE) return std::nullopt;
    LightTable alone;
    const auto made = add_emitter(alone, scene, origin, id, emits);
    std::uint32_t at = table.lights[first].node;
    shared::LightNode& leaf = table.nodes[at];
    if (!made || (alone.kinds & ~table.kinds) || made->lights != leaf.lights ||
        ((made->flags ^ leaf.flags) & LIGHT_PIECES))
        return std::nullopt;
    Replaced out{.first = first, .count = leaf.lights, .nodes = {}};
    for (std::uint32_t i = 0; i < out.count; ++i) {
        alone.lights[i].node = at;
        table.lights[first + i] = alone.lights[i];
        table.cdf[first + i] = alone.cdf[i];
    }
    const std::uint32_t parent = leaf.parent;
    leaf = *made;
    leaf.first = first;
    leaf.parent = parent;
    for (;;) {
        out.nodes.push_back(at);
        at = table.nodes[at].parent;
        if (at == NONE) return out;
        refit(table.nodes[at], &table.nodes[table.nodes[at].first]);
    }
}

} // namespace restage::render
