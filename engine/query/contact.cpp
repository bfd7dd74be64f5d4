// SPDX-License-Identifier: Apache-2.0
#include "query/contact.hpp"

#if RESTAGE_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unordered_map>

namespace restage::query {

namespace {

using glm::dvec3;
using InstanceId = scene::Id<scene::Instance>;

constexpr int samples = 1500; // of an object's surface

// The point of a triangle nearest to p. Ericson, Real-Time Collision Detection (2005), section 5.1.5.
dvec3 nearest_point(const dvec3& p, const dvec3& a, const dvec3& b, const dvec3& c) {
    const dvec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const dvec3 bp = p - b;
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 > d3 ? d1 / (d1 - d3) : 0.0);
    const dvec3 cp = p - c;
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 > d6 ? d2 / (d2 - d6) : 0.0);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    const double sum = va + vb + vc;
    return sum > 0 ? a + ab * (vb / sum) + ac * (vc / sum) : a;
}

} // namespace

struct Contacts::Impl {
    explicit Impl(const scene::Scene& s) : scene(s), device(rtcNewDevice("threads=1")) {}
    ~Impl() {
        for (const auto& [mesh, tree] : trees)
            if (tree) rtcReleaseScene(tree);
        if (device) rtcReleaseDevice(device);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    const scene::MeshData* data(InstanceId id) const {
        const scene::Instance* instance = scene.instances.find(id);
        const scene::Mesh* mesh = instance ? scene.meshes.find(instance->mesh) : nullptr;
        return mesh && mesh->data && !mesh->data->triangles.empty() ? mesh->data.get() : nullptr;
    }
    RTCScene tree(InstanceId id, const scene::MeshData& mesh) {
        const auto [known, added] = trees.try_emplace(scene.instances[id].mesh.value, nullptr);
        if (!added || !device) return known->second;
        const RTCScene made = rtcNewScene(device);
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
        auto* positions = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), mesh.positions.size()));
        auto* triangles = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), mesh.triangles.size()));
        if (positions && triangles) {
            std::copy(mesh.positions.begin(), mesh.positions.end(), positions);
            std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
            rtcCommitGeometry(geometry);
            rtcAttachGeometry(made, geometry);
        }
        rtcReleaseGeometry(geometry);
        rtcCommitScene(made);
        return known->second = made;
    }

    const scene::Scene& scene;
    RTCDevice device;
    std::unordered_map<std::uint32_t, RTCScene> trees;                     // by Id<Mesh>::value
    std::unordered_map<std::uint32_t, std::vector<dvec3>> points;          // by Id<Instance>::value
};

Contacts::Contacts(const scene::Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
Contacts::~Contacts() = default;

const std::vector<dvec3>& Contacts::points(InstanceId id) {
    const auto [known, added] = impl_->points.try_emplace(id.value);
    std::vector<dvec3>& points = known->second;
    const scene::MeshData* mesh = impl_->data(id);
    if (!added || !mesh) return points;
    const auto place = [&](std::uint32_t i) {
        return dvec3(impl_->scene.instances[id].object_to_world * glm::dvec4(glm::dvec3(mesh->positions[i]), 1));
    };
    double area = 0;
    for (const glm::uvec3& t : mesh->triangles)
        area += glm::length(glm::cross(place(t.y) - place(t.x), place(t.z) - place(t.x)));
    if (!(area > 0) || !std::isfinite(area)) return points;
    // One in each of `samples` equal parts of the area, at points of a Kronecker lattice (Roberts 2018).
    points.reserve(samples);
    double sum = 0;
    for (const glm::uvec3& t : mesh->triangles) {
        const dvec3 a = place(t.x), ab = place(t.y) - a, ac = place(t.z) - a;
        sum += glm::length(glm::cross(ab, ac)) / area * samples;
        while (double(points.size()) + 0.5 < sum && points.size() < samples) {
            const double i = double(points.size());
            glm::dvec2 b = glm::fract(0.5 + i * glm::dvec2(0.7548776662466927, 0.5698402909980532));
            if (b.x + b.y > 1) b = 1.0 - b;
            points.push_back(a + ab * b.x + ac * b.y);
        }
    }
    return points;
}

bool Contacts::near(InstanceId id, const dvec3& point, double radius) {
    const scene::MeshData* mesh = impl_->data(id);
    const RTCScene tree = mesh ? impl_->tree(id, *mesh) : nullptr;
    if (!tree) return false;
    struct Search {
        const scene::MeshData& mesh;
        glm::dmat4 to_world;
        dvec3 point;
        double radius;
        bool found = false;
    } search{*mesh, impl_->scene.instances[id].object_to_world, point, radius};
    const glm::dmat4 to_object = glm::inverse(search.to_world);
    const dvec3 local(to_object * glm::dvec4(point, 1));
    double stretch = 0; // of lengths on the way to object space, at most (Frobenius norm)
    for (int i = 0; i < 3; ++i)
        stretch += glm::dot(dvec3(to_object[i]), dvec3(to_object[i]));
    RTCPointQuery query{};
    query.x = float(local.x), query.y = float(local.y), query.z = float(local.z);
    query.radius = float(radius * std::sqrt(stretch) * 1.001);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    const auto visit = [](RTCPointQueryFunctionArguments* args) {
        Search& s = *static_cast<Search*>(args->userPtr);
        const glm::uvec3 t = s.mesh.triangles[args->primID];
        const auto corner = [&](std::uint32_t i) {
            return dvec3(s.to_world * glm::dvec4(glm::dvec3(s.mesh.positions[i]), 1));
        };
        const dvec3 nearest = nearest_point(s.point, corner(t.x), corner(t.y), corner(t.z));
        if (glm::length(nearest - s.point) > s.radius) return false;
        s.found = true;
        args->query->radius = 0; // enough
        return true;
    };
    rtcPointQuery(tree, &query, &context, visit, &search);
    return search.found;
}

} // namespace restage::query
