// SPDX-License-Identifier: Apache-2.0
#include "plain_tracer.hpp"

#if RESTAGE_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <numbers>

namespace restage::bench {

using glm::vec2;
using glm::vec3;

namespace {

constexpr float pi = std::numbers::pi_v<float>;

enum class Kind { diffuse, conductor, dielectric };
struct Look {
    Kind kind = Kind::diffuse;
    vec3 color{0};
    float eta = 1, k = 0, alpha = 0;
};
struct Light {
    vec3 p, e1, e2, n, radiance;
    float area = 0;
};
struct Thing {
    glm::mat3 normal_to_world;
    Look look;
    vec3 emission{0};
};

struct Rng { // PCG 32, O'Neill 2014
    std::uint64_t state;
    float next() {
        state = state * 6364136223846793005ull + 1442695040888963407ull;
        const auto x = std::uint32_t(((state >> 18) ^ state) >> 27), r = std::uint32_t(state >> 59);
        return float(((x >> r) | (x << (-r & 31))) >> 8) * 0x1p-24f;
    }
    vec2 pair() {
        const float a = next();
        return {a, next()};
    }
};

struct Frame {
    vec3 s, t, n;
    explicit Frame(vec3 normal) : n(normal) { // Duff et al. 2017
        const float g = std::copysign(1.f, n.z), a = -1 / (g + n.z), b = n.x * n.y * a;
        s = {1 + g * n.x * n.x * a, g * b, -g * n.x};
        t = {b, g + n.y * n.y * a, -n.y};
    }
    vec3 local(vec3 w) const { return {glm::dot(w, s), glm::dot(w, t), glm::dot(w, n)}; }
    vec3 world(vec3 w) const { return s * w.x + t * w.y + n * w.z; }
};

// pbrt 4ed, Eq. 9.29 of unpolarised light at a conductor, by its usual real-valued form
float fresnel_conductor(float c, float eta, float k) {
    const float c2 = c * c, s2 = 1 - c2, e2 = eta * eta, k2 = k * k;
    const float t0 = e2 - k2 - s2, a2b2 = std::sqrt(t0 * t0 + 4 * e2 * k2),
                a = std::sqrt(std::max(0.f, 0.5f * (a2b2 + t0)));
    const float rs = (a2b2 + c2 - 2 * a * c) / (a2b2 + c2 + 2 * a * c);
    return 0.5f * rs * (1 + (c2 * a2b2 + s2 * s2 - 2 * a * c * s2) / (c2 * a2b2 + s2 * s2 + 2 * a * c * s2));
}
float fresnel_dielectric(float ci, float eta, float& ct) { // eta: transmitted over incident side
    const float s2 = (1 - ci * ci) / (eta * eta);
    if (s2 >= 1) return 1;
    ct = std::sqrt(1 - s2);
    const float a = (eta * ci - ct) / (eta * ci + ct), b = (ci - eta * ct) / (ci + eta * ct);
    return 0.5f * (a * a + b * b);
}

struct Ggx { // isotropic. Walter et al. 2007; Heitz 2018, "Sampling the GGX Distribution of Visible Normals"
    float alpha;
    float lambda(vec3 w) const {
        const float t2 = alpha * alpha * (w.x * w.x + w.y * w.y) / (w.z * w.z);
        return 0.5f * (std::sqrt(1 + t2) - 1);
    }
    float d(vec3 m) const {
        const float a2 = alpha * alpha, x = m.z * m.z * (a2 - 1) + 1;
        return a2 / (pi * x * x);
    }
    float pdf(vec3 wo, vec3 m) const { return d(m) / ((1 + lambda(wo)) * 4 * wo.z); } // of the reflected direction
    vec3 sample(vec3 wo, vec2 u) const {
        const vec3 v = glm::normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
        const vec3 t1 = v.z < 0.9999f ? glm::normalize(glm::cross(vec3(0, 0, 1), v)) : vec3(1, 0, 0),
                   t2 = glm::cross(v, t1);
        const float r = std::sqrt(u.x), phi = 2 * pi * u.y, a = r * std::cos(phi), s = 0.5f * (1 + v.z);
        const float b = (1 - s) * std::sqrt(1 - a * a) + s * r * std::sin(phi);
        const vec3 n = a * t1 + b * t2 + std::sqrt(std::max(0.f, 1 - a * a - b * b)) * v;
        return glm::normalize(vec3(alpha * n.x, alpha * n.y, std::max(0.f, n.z)));
    }
};

// f * cos and its density, both on the same side
vec3 evaluate(const Look& look, vec3 wo, vec3 wi, float& pdf) {
    pdf = 0;
    if (look.kind == Kind::dielectric || wi.z <= 0 || wo.z <= 0) return vec3(0);
    if (look.kind == Kind::diffuse) {
        pdf = wi.z / pi;
        return look.color * pdf;
    }
    const Ggx ggx{look.alpha};
    const vec3 m = glm::normalize(wo + wi);
    pdf = ggx.pdf(wo, m);
    return vec3(fresnel_conductor(glm::dot(wi, m), look.eta, look.k) * ggx.d(m) /
                (4 * wo.z * (1 + ggx.lambda(wo) + ggx.lambda(wi))));
}

float power(float a, float b) { return a * a / (a * a + b * b); } // Veach 1997, Eq. 9.14

} // namespace

struct PlainTracer::Data {
    RTCDevice device = nullptr;
    RTCScene top = nullptr;
    std::vector<RTCScene> meshes;
    std::vector<Thing> things;
    std::vector<Light> lights;
    scene::Camera camera;
    std::uint32_t width = 0, height = 0, bounces = 0;

    bool occluded(vec3 o, vec3 d, float far) const {
        RTCRay r{};
        set(r, o, d, far);
#if RESTAGE_EMBREE_MAJOR == 3
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcOccluded1(top, &context, &r);
#else
        rtcOccluded1(top, &r, nullptr);
#endif
        return r.tfar < 0;
    }
    bool intersect(vec3 o, vec3 d, RTCRayHit& r) const {
        r = {};
        set(r.ray, o, d, 1e30f);
        r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RESTAGE_EMBREE_MAJOR == 3
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(top, &context, &r);
#else
        rtcIntersect1(top, &r, nullptr);
#endif
        return r.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    static void set(RTCRay& r, vec3 o, vec3 d, float far) {
        r.org_x = o.x, r.org_y = o.y, r.org_z = o.z;
        r.dir_x = d.x, r.dir_y = d.y, r.dir_z = d.z;
        r.tfar = far;
        r.mask = 0xffffffffu;
    }
    vec3 path(vec3 o, vec3 d, Rng& rng, PlainResult& count) const;
};

vec3 PlainTracer::Data::path(vec3 o, vec3 d, Rng& rng, PlainResult& count) const {
    vec3 throughput(1), radiance(0);
    float last_pdf = -1, eta_scale = 1; // -1: delta or camera
    for (std::uint32_t depth = 0;; ++depth) {
        RTCRayHit hit;
        ++count.rays;
        if (!intersect(o, d, hit)) break;
        const Thing& thing = things[hit.hit.instID[0]];
        const vec3 ng = glm::normalize(thing.normal_to_world * vec3(hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z));
        const float cosine = -glm::dot(ng, d);
        const vec3 p = o + hit.ray.tfar * d;
        if (cosine > 0 && thing.emission.x > 0) {
            const float area = lights[0].area; // all alike
            const float pdf = hit.ray.tfar * hit.ray.tfar / (cosine * area * float(lights.size()));
            radiance += throughput * thing.emission * (last_pdf < 0 ? 1.f : power(last_pdf, pdf));
        }
        if (depth >= bounces) break;
        const vec3 n = cosine > 0 ? ng : -ng;
        const Frame frame(n);
        const vec3 wo = frame.local(-d);
        const Look& look = thing.look;
        const vec3 outside = p + 1e-4f * n;
        if (look.kind != Kind::dielectric) {
            const Light& light = lights[std::min(std::size_t(rng.next() * float(lights.size())), lights.size() - 1)];
            vec2 u = rng.pair();
            if (u.x + u.y > 1) u = vec2(1) - u;
            const vec3 to = light.p + u.x * light.e1 + u.y * light.e2 - outside;
            const float dist2 = glm::dot(to, to), dist = std::sqrt(dist2), c = -glm::dot(light.n, to) / dist;
            if (c > 0) {
                const float pdf = dist2 / (c * light.area * float(lights.size()));
                float pdf_bsdf = 0;
                const vec3 f = evaluate(look, wo, frame.local(to / dist), pdf_bsdf);
                if (f.x + f.y + f.z > 0) {
                    ++count.shadow_rays;
                    if (!occluded(outside, to / dist, dist * 0.9999f))
                        radiance += throughput * f * light.radiance * (power(pdf, pdf_bsdf) / pdf);
                }
            }
        }
        vec3 wi;
        bool through = false;
        if (look.kind == Kind::dielectric) {
            const float eta = cosine > 0 ? look.eta : 1 / look.eta;
            float ct = 0;
            const float reflected = fresnel_dielectric(wo.z, eta, ct);
            through = rng.next() >= reflected;
            wi = through ? vec3(-wo.x / eta, -wo.y / eta, -ct) : vec3(-wo.x, -wo.y, wo.z);
            if (through) {
                throughput /= eta * eta;
                eta_scale *= eta * eta;
            }
            last_pdf = -1;
        } else {
            if (look.kind == Kind::diffuse) {
                const vec2 u = rng.pair();
                const float r = std::sqrt(u.x), phi = 2 * pi * u.y;
                wi = {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.f, 1 - u.x))};
            } else {
                const vec3 m = Ggx{look.alpha}.sample(wo, rng.pair());
                wi = 2 * glm::dot(wo, m) * m - wo;
            }
            const vec3 f = evaluate(look, wo, wi, last_pdf);
            if (!(last_pdf > 0)) break;
            throughput *= f / last_pdf;
        }
        if (depth > 0) {
            const float survive = std::max({throughput.x, throughput.y, throughput.z}) * eta_scale / 0.3f; // step.glsl
            if (survive < 1) {
                if (rng.next() >= survive) break;
                throughput /= survive;
            }
        }
        o = through ? p - 1e-4f * n : outside;
        d = glm::normalize(frame.world(wi));
    }
    return radiance;
}

PlainTracer::PlainTracer(const scene::Scene& scene) : d_(std::make_unique<Data>()) {
    Data& d = *d_;
    d.device = rtcNewDevice("set_affinity=0");
    d.meshes.resize(scene.meshes.size() + 1);
    scene.meshes.each([&](scene::Id<scene::Mesh> id, const scene::Mesh& mesh) {
        const auto& data = *mesh.data;
        const auto geometry = rtcNewGeometry(d.device, RTC_GEOMETRY_TYPE_TRIANGLE);
        const auto copy = [&](RTCBufferType type, RTCFormat format, const void* from, std::size_t n) {
            std::memcpy(rtcSetNewGeometryBuffer(geometry, type, 0, format, 12, n), from, 12 * n);
        };
        copy(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, data.positions.data(), data.positions.size());
        copy(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, data.triangles.data(), data.triangles.size());
        rtcCommitGeometry(geometry);
        d.meshes[id.value] = rtcNewScene(d.device);
        rtcSetSceneFlags(d.meshes[id.value], RTC_SCENE_FLAG_ROBUST); // as the engine
        rtcAttachGeometry(d.meshes[id.value], geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(d.meshes[id.value]);
    });
    d.top = rtcNewScene(d.device);
    rtcSetSceneFlags(d.top, RTC_SCENE_FLAG_ROBUST);
    d.things.resize(scene.instances.size() + 1);
    scene.instances.each([&](scene::Id<scene::Instance> id, const scene::Instance& instance) {
        const glm::mat4x3 m(instance.object_to_world);
        const auto geometry = rtcNewGeometry(d.device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry, d.meshes[instance.mesh.value]);
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &m);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(d.top, geometry, id.value);
        rtcReleaseGeometry(geometry);
        const auto& material = scene.materials[instance.material];
        const auto color = [&](const char* name) { return material.params.color(name, {0, 0, 0}); };
        Thing& thing = d.things[id.value];
        thing.normal_to_world = glm::mat3(glm::transpose(glm::inverse(glm::dmat3(instance.object_to_world))));
        thing.look.kind = material.type == "conductor"    ? Kind::conductor
                          : material.type == "dielectric" ? Kind::dielectric
                                                          : Kind::diffuse;
        const auto reflectance = color("reflectance");
        thing.look.color = {reflectance[0], reflectance[1], reflectance[2]};
        thing.look.eta = thing.look.kind == Kind::conductor ? color("eta")[0] : material.params.number("eta", 1.5f);
        thing.look.k = color("k")[0];
        thing.look.alpha = material.params.number("uroughness", 0);
        if (!instance.emission) return;
        thing.emission = instance.emission->radiance;
        const auto& mesh = *scene.meshes[instance.mesh].data;
        for (const auto& t : mesh.triangles) {
            const vec3 p = mesh.positions[t.x], e1 = mesh.positions[t.y] - p, e2 = mesh.positions[t.z] - p,
                       n = glm::cross(e1, e2);
            d.lights.push_back({p, e1, e2, glm::normalize(n), thing.emission, glm::length(n) / 2});
        }
    });
    rtcCommitScene(d.top);
    d.camera = scene.cameras[scene.active_camera.value];
    d.width = scene.film.value.width;
    d.height = scene.film.value.height;
    d.bounces = scene.settings.value.max_depth;
}

PlainTracer::~PlainTracer() {
    rtcReleaseScene(d_->top);
    for (auto* mesh : d_->meshes)
        if (mesh) rtcReleaseScene(mesh);
    rtcReleaseDevice(d_->device);
}

PlainResult PlainTracer::trace(std::uint32_t samples, Jobs& jobs) const {
    const Data& d = *d_;
    const glm::mat3 to_world(d.camera.camera_to_world);
    const vec3 eye(d.camera.camera_to_world[3]);
    const float half = std::tan(glm::radians(d.camera.fov) / 2), short_side = float(std::min(d.width, d.height));
    std::vector<PlainResult> rows(d.height);
    jobs.parallel_for(d.height, 4, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t y = begin; y < end; ++y) {
            Rng rng{y * 0x9e3779b97f4a7c15ull + 1};
            for (std::uint32_t x = 0; x < d.width; ++x)
                for (std::uint32_t s = 0; s < samples; ++s) {
                    const vec2 u = rng.pair();
                    const vec3 dir((2 * (float(x) + u.x) - float(d.width)) / short_side * half,
                                   (float(d.height) - 2 * (float(y) + u.y)) / short_side * half, 1);
                    const vec3 c = d.path(eye, glm::normalize(to_world * dir), rng, rows[y]);
                    rows[y].mean_luminance += glm::dot(c, vec3(0.2126f, 0.7152f, 0.0722f));
                }
        }
    });
    PlainResult sum;
    for (const auto& row : rows) {
        sum.rays += row.rays;
        sum.shadow_rays += row.shadow_rays;
        sum.mean_luminance += row.mean_luminance / (double(d.width) * d.height * samples);
    }
    return sum;
}

} // namespace restage::bench
