// SPDX-License-Identifier: Apache-2.0
#include "query/light_meter.hpp"

#include "scene/projection.hpp"
#include "shared/lamps.h"

#if RESTAGE_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

namespace restage::query {
namespace {

using glm::dvec3;
constexpr double pi = std::numbers::pi;
constexpr int columns = 32;   // points across the picture
constexpr int directions = 24; // per point
constexpr int lamp_points = 8; // on emissive surfaces, per point
constexpr int bounces = 7;    // a path's default

double luminance(const dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }
// Kronecker lattice of the plastic number (Roberts 2018): point i, offset by `shift`.
glm::dvec2 lattice(int i, double shift) {
    return glm::fract(glm::dvec2(0.5 + shift) + double(i) * glm::dvec2(0.7548776662466927, 0.5698402909980532));
}

struct Hit {
    std::uint32_t instance = 0; // Id::value; 0 = none
    dvec3 position{0}, normal{0};
};

struct Shining { // a triangle
    dvec3 a, ab, ac;
    double radiance, sum; // luminance; cumulative power
    bool two_sided;
};

class Meter {
  public:
    Meter(const scene::Scene& scene, const MeterQuestions& ask) : scene_(scene), ask_(ask) {
        const scene::Camera* camera = scene.cameras.find(scene.active_camera.value);
        if (camera) origin_ = dvec3(camera->camera_to_world[3]);
        device_ = rtcNewDevice("");
        if (!device_) return;
        top_ = rtcNewScene(device_);
        rtcSetSceneFlags(top_, RTC_SCENE_FLAG_ROBUST);
        scene.instances.each([&](scene::Id<scene::Instance> id, const scene::Instance& in) { add(id, in); });
        rtcCommitScene(top_);
    }
    Meter(const Meter&) = delete;
    Meter& operator=(const Meter&) = delete;
    ~Meter() {
        if (top_) rtcReleaseScene(top_);
        for (const auto& [mesh, scene] : meshes_)
            rtcReleaseScene(scene);
        if (device_) rtcReleaseDevice(device_);
    }

    LightReading read() {
        LightReading reading;
        const scene::Camera* camera = scene_.cameras.find(scene_.active_camera.value);
        if (!camera || !device_) return reading;
        const scene::Film& film = scene_.film.value;
        const double aspect = double(film.width) / film.height;
        const glm::dvec4 window = scene::film_window(*camera, aspect);
        const int rows = std::clamp(int(std::lround(columns / aspect)), 4, 4 * columns);
        std::vector<double> values;
        int points = 0;
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x) {
                const dvec3 local(glm::mix(window.x, window.y, (x + 0.5) / columns),
                                  glm::mix(window.w, window.z, (y + 0.5) / rows), 1);
                const Hit hit = trace(dvec3(0), dvec3(camera->camera_to_world * glm::dvec4(local, 0)));
                if (!hit.instance) continue;
                ++points;
                const double value = std::max(irradiance(hit, y * columns + x) / pi, shine(hit));
                if (value > 0 && std::isfinite(value)) values.push_back(value);
            }
        reading.something = points > 0;
        if (values.empty()) return reading;
        double mean = 0, logs = 0;
        for (const double v : values)
            mean += v / double(values.size());
        for (const double v : values) // deep shadows are uninformative
            logs += std::log(std::max(v, 1e-3 * mean));
        reading.white = std::exp(logs / double(values.size()));
        reading.lit = double(values.size()) / points;
        return reading;
    }

  private:
    void add(scene::Id<scene::Instance> id, const scene::Instance& in) {
        const scene::Mesh* mesh = scene_.meshes.find(in.mesh);
        if (in.hidden || !mesh || !mesh->data || mesh->data->triangles.empty() || ask_.passes(in)) return;
        const scene::MeshData& data = *mesh->data;
        RTCScene& shared = meshes_[in.mesh.value];
        if (!shared) {
            shared = rtcNewScene(device_);
            RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
            if (void* v =
                    rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, data.positions.size()))
                std::copy_n(data.positions.data(), data.positions.size(), static_cast<glm::vec3*>(v));
            if (void* v =
                    rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, data.triangles.size()))
                std::copy_n(data.triangles.data(), data.triangles.size(), static_cast<glm::uvec3*>(v));
            rtcCommitGeometry(g);
            rtcAttachGeometryByID(shared, g, 0);
            rtcReleaseGeometry(g);
            rtcSetSceneFlags(shared, RTC_SCENE_FLAG_ROBUST);
            rtcCommitScene(shared);
        }
        glm::dmat4 place = in.object_to_world;
        place[3] -= glm::dvec4(origin_, 0);
        const glm::mat4x3 matrix(place);
        RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(g, shared);
        rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &matrix[0].x);
        rtcCommitGeometry(g);
        rtcAttachGeometryByID(top_, g, id.value);
        rtcReleaseGeometry(g);
        for (int k = 0; k < 8; ++k)
            size_ = std::max(size_, glm::length(dvec3(place * glm::dvec4(k & 1 ? data.upper.x : data.lower.x,
                                                                         k & 2 ? data.upper.y : data.lower.y,
                                                                         k & 4 ? data.upper.z : data.lower.z, 1))));
        albedo_[id.value] = ask_.albedo(in);
        if (const auto emission = ask_.emission(in)) {
            emission_[id.value] = *emission;
            const double radiance = luminance(dvec3(emission->radiance));
            for (const glm::uvec3& t : data.triangles) {
                const auto corner = [&](std::uint32_t i) {
                    return dvec3(place * glm::dvec4(dvec3(data.positions[i]), 1));
                };
                const dvec3 a = corner(t.x), ab = corner(t.y) - a, ac = corner(t.z) - a;
                const double power = radiance * glm::length(glm::cross(ab, ac)) / 2;
                if (!(power > 0) || !std::isfinite(power)) continue;
                shining_.push_back(
                    {a, ab, ac, radiance, (shining_.empty() ? 0 : shining_.back().sum) + power, emission->two_sided});
            }
        }
    }

    static RTCRay ray(const dvec3& o, const dvec3& d, double far) {
        RTCRay r{};
        r.org_x = float(o.x), r.org_y = float(o.y), r.org_z = float(o.z);
        r.dir_x = float(d.x), r.dir_y = float(d.y), r.dir_z = float(d.z);
        r.tfar = float(far);
        r.mask = 0xffffffffu;
        return r;
    }
    bool sees(const dvec3& from, const dvec3& d, double far) const {
        RTCRay r = ray(from, d, far);
#if RESTAGE_EMBREE_MAJOR == 3
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcOccluded1(top_, &context, &r);
#else
        rtcOccluded1(top_, &r);
#endif
        return r.tfar >= 0;
    }
    Hit trace(const dvec3& from, const dvec3& d) const {
        RTCRayHit h{};
        h.ray = ray(from, d, std::numeric_limits<double>::infinity());
        h.hit.geomID = h.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RESTAGE_EMBREE_MAJOR == 3
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(top_, &context, &h);
#else
        rtcIntersect1(top_, &h);
#endif
        if (h.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
        Hit hit{.instance = h.hit.instID[0]};
        const scene::Instance& in = scene_.instances[{hit.instance}];
        const dvec3 object(double(h.hit.Ng_x), double(h.hit.Ng_y), double(h.hit.Ng_z));
        dvec3 n = glm::transpose(glm::inverse(glm::dmat3(in.object_to_world))) * object;
        n = glm::length(n) > 0 ? glm::normalize(n) : -glm::normalize(d);
        hit.normal = glm::dot(n, d) > 0 ? -n : n;
        hit.position = from + double(h.ray.tfar) * d + hit.normal * (1e-5 * size_);
        return hit;
    }

    double shine(const Hit& hit) const {
        const auto it = emission_.find(hit.instance);
        return it == emission_.end() ? 0 : luminance(dvec3(it->second.radiance));
    }

    // Lamps without a surface.
    double from_lamps(const Hit& at) const {
        double sum = 0;
        scene_.lights.each([&](scene::Id<scene::Light>, const scene::Light& l) {
            if (l.hidden) return;
            const scene::Cone cone = scene::cone_of(l);
            const shared::LampRay ray = shared::lamp_ray(
                std::uint32_t(l.kind), dvec3(l.light_to_world[3]) - origin_, glm::normalize(dvec3(l.light_to_world[2])),
                {cone.edge, cone.start, cone.falloff == scene::Falloff::quartic ? 1 : 0}, at.position);
            const dvec3 d(ray.wi);
            const double value = luminance(dvec3(l.value)) * double(ray.amount) * glm::dot(d, at.normal);
            if (value > 0 && sees(at.position, d, double(ray.dist))) sum += value;
        });
        return sum;
    }

    double from_surfaces(const Hit& at, double shift) const {
        if (shining_.empty()) return 0;
        const double total = shining_.back().sum;
        double sum = 0;
        for (int i = 0; i < lamp_points; ++i) {
            const double pick = (i + glm::fract(shift)) / lamp_points * total;
            auto it = std::upper_bound(shining_.begin(), shining_.end(), pick,
                                       [](double x, const Shining& s) { return x < s.sum; });
            if (it == shining_.end()) --it;
            glm::dvec2 b = lattice(i, shift);
            if (b.x + b.y > 1) b = 1.0 - b;
            const dvec3 normal = glm::normalize(glm::cross(it->ab, it->ac));
            dvec3 d = it->a + b.x * it->ab + b.y * it->ac - at.position;
            const double distance = glm::length(d);
            if (!(distance > 0)) continue;
            d /= distance;
            const double cosine = it->two_sided ? std::abs(glm::dot(d, normal)) : std::max(-glm::dot(d, normal), 0.0);
            // density: radiance / total over the area
            const double value = std::max(glm::dot(d, at.normal), 0.0) * cosine * total /
                                 std::max(distance * distance, 1e-10 * size_ * size_);
            if (value > 0 && sees(at.position, d, distance * (1 - 1e-4))) sum += value / lamp_points;
        }
        return sum;
    }

    double irradiance(const Hit& at, int number) const {
        const double shift = glm::fract(double(number) * 0.6180339887498949);
        double reflected = 0, kept = 0, sky = 0; // kept: fraction of the light per bounce
        const dvec3 other = std::abs(at.normal.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        const dvec3 s = glm::normalize(glm::cross(at.normal, other)), t = glm::cross(at.normal, s);
        for (int i = 0; i < directions; ++i) { // cosine-distributed: each weighs pi / directions
            const glm::dvec2 u = lattice(i, shift);
            const double r = std::sqrt(u.x), phi = 2 * pi * u.y;
            const dvec3 d =
                s * (r * std::cos(phi)) + t * (r * std::sin(phi)) + at.normal * std::sqrt(std::max(1 - u.x, 0.0));
            const Hit hit = trace(at.position, d);
            if (!hit.instance) {
                sky += luminance(dvec3(ask_.sky)) * pi / directions;
                continue;
            }
            const double albedo = albedo_.at(hit.instance);
            reflected += albedo * from_lamps(hit) / directions;
            kept += albedo / directions;
        }
        double series = 0; // 1 + kept + kept^2 + ...
        for (int i = 0; i < bounces; ++i)
            series = 1 + kept * series;
        return from_lamps(at) + from_surfaces(at, shift) + sky + reflected * series;
    }

    const scene::Scene& scene_;
    const MeterQuestions& ask_;
    dvec3 origin_{0};
    double size_ = 1e-30; // of the scene, from the camera
    RTCDevice device_ = nullptr;
    RTCScene top_ = nullptr;
    std::map<std::uint32_t, RTCScene> meshes_;
    std::map<std::uint32_t, scene::MaterialEmission> emission_;
    std::map<std::uint32_t, double> albedo_; // by Id<Instance>::value, as emission_
    std::vector<Shining> shining_;
};

} // namespace

LightReading read_light(const scene::Scene& scene, const MeterQuestions& ask) { return Meter(scene, ask).read(); }

} // namespace restage::query
