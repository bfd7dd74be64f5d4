// SPDX-License-Identifier: Apache-2.0
// Ray tracing on the device: all five shader stages, the acceleration structure by address, instances that move.
#include "gpu/accel.hpp"
#include "test_device.hpp"

#include <array>
#include <cmath>

using namespace restage;
using namespace restage::gpu;
using namespace restage::gpu::test;

namespace {

constexpr std::uint32_t size = 32;

const std::string rt_head = glsl_head + R"(
#extension GL_EXT_ray_tracing : require
struct Payload { uint what; uint instance; uint triangle; float t; vec2 uv; };
)";

const std::string raygen = rt_head + R"(
layout(location = 0) rayPayloadEXT Payload payload;
layout(location = 0) callableDataEXT uint called;
layout(buffer_reference, scalar) buffer Out { Payload p[]; };
layout(push_constant, scalar) uniform Push { uint64_t tlas; Out dst; } push;
void main() {
    vec2 at = (vec2(gl_LaunchIDEXT.xy) + 0.5) / vec2(gl_LaunchSizeEXT.xy) * 2.0 - 1.0; // [-1, 1]
    payload.what = 0;
    traceRayEXT(accelerationStructureEXT(push.tlas), gl_RayFlagsNoneEXT, 0xff, 0, 0, 0, vec3(at, 1.0), 0.0, vec3(0, 0, -1), 100.0, 0);
    called = payload.what;
    executeCallableEXT(gl_LaunchIDEXT.x & 1, 0);
    payload.what = called;
    push.dst.p[gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x] = payload;
}
)";
const std::string miss = rt_head + R"(
layout(location = 0) rayPayloadInEXT Payload payload;
void main() { payload.what = 1; payload.instance = ~0u; }
)";
std::string closest_hit(int what) {
    return rt_head + R"(
layout(location = 0) rayPayloadInEXT Payload payload;
hitAttributeEXT vec2 uv;
void main() {
    payload = Payload()" +
           std::to_string(what) + R"(, gl_InstanceCustomIndexEXT, gl_PrimitiveID, gl_HitTEXT, uv);
}
)";
}
// Cuts away the half with u + v > 1/2.
const std::string any_hit = rt_head + R"(
layout(location = 0) rayPayloadInEXT Payload payload;
hitAttributeEXT vec2 uv;
void main() { if (uv.x + uv.y > 0.5) ignoreIntersectionEXT; }
)";
std::string callable(int factor) {
    return "#version 460\n#extension GL_EXT_ray_tracing : require\nlayout(location = 0) callableDataInEXT uint "
           "called;\n"
           "void main() { called *= " +
           std::to_string(factor) + "; }\n";
}

struct Payload {
    std::uint32_t what, instance, triangle;
    float t, u, v;
};
struct Push {
    VkDeviceAddress tlas, out;
};

// Rays go down from z = 1 on a grid over [-1, 1]^2; the callable multiplies `what` by 10 in even columns, 100 in odd
// ones.
class Scene {
  public:
    explicit Scene(TestDevice& device) : device_(device) {
        raygen_ = compile(raygen, ShaderStage::raygen);
        miss_ = compile(miss, ShaderStage::miss);
        closest_[0] = compile(closest_hit(2), ShaderStage::closest_hit);
        closest_[1] = compile(closest_hit(3), ShaderStage::closest_hit);
        any_ = compile(any_hit, ShaderStage::any_hit);
        call_[0] = compile(callable(10), ShaderStage::callable);
        call_[1] = compile(callable(100), ShaderStage::callable);
        const std::array<const Spirv*, 1> misses{&miss_};
        const std::array<HitGroup, 2> groups{HitGroup{&closest_[0], nullptr}, HitGroup{&closest_[1], &any_}};
        const std::array<const Spirv*, 2> callables{&call_[0], &call_[1]};
        pipeline_ = value(RayTracingPipeline::create(
            *device, {.raygen = &raygen_, .misses = misses, .hit_groups = groups, .callables = callables}, sizeof(Push),
            {}, "test"));
        // One triangle with the right angle at the origin, u along x, v along y.
        const std::array<float, 9> vertices{0, 0, 0, 1, 0, 0, 0, 1, 0};
        const std::array<std::uint32_t, 3> indices{0, 1, 2};
        vertices_ = value(device->create_buffer_of<float>(vertices, "vertices"));
        indices_ = value(device->create_buffer_of<std::uint32_t>(indices, "indices"));
        out_ = value(device->create_buffer(size * size * sizeof(Payload), BufferKind::readback, "out"));
    }

    BlasInput triangle(bool opaque) const {
        return {.vertices = vertices_.address(),
                .vertex_stride = 12,
                .vertex_count = 3,
                .indices = indices_.address(),
                .triangle_count = 1,
                .opaque = opaque,
                .name = opaque ? "opaque triangle" : "cut-out triangle"};
    }

    std::span<const Payload> trace(const Tlas& tlas) {
        std::memset(out_.mapped(), 0xcd, out_.size());
        auto list = value(device_->begin());
        list.trace(pipeline_, push_bytes(Push{tlas.address(), out_.address()}), size, size);
        ok(device_->submit_and_wait(list));
        return out_.span<Payload>();
    }

    static std::uint32_t called(std::uint32_t what, std::uint32_t x) { return what * (x % 2 ? 100 : 10); }
    static float at(std::uint32_t i) { return (float(i) + 0.5f) / float(size) * 2 - 1; }

    // What the ray at (x, y) must return if the triangle's origin is moved by (dx, dy) and scaled.
    void expect(const Payload& p, std::uint32_t x, std::uint32_t y, float dx, float dy, float scale, bool cut,
                std::uint32_t index) const {
        const float u = (at(x) - dx) / scale, v = (at(y) - dy) / scale;
        const bool hit = u > 0 && v > 0 && u + v < (cut ? 0.5f : 1.0f);
        if (std::abs(u + v - (cut ? 0.5f : 1.0f)) < 1e-4f || std::abs(u) < 1e-4f || std::abs(v) < 1e-4f)
            return; // the edge
        INFO("x " << x << " y " << y << " u " << u << " v " << v);
        if (!hit) {
            REQUIRE(p.what == called(1, x));
            return;
        }
        REQUIRE(p.what == called(cut ? 3 : 2, x));
        REQUIRE(p.instance == index);
        REQUIRE(p.triangle == 0);
        REQUIRE(std::abs(p.t - 1) < 1e-5f);
        REQUIRE(std::abs(p.u - u) < 1e-4f);
        REQUIRE(std::abs(p.v - v) < 1e-4f);
    }

  private:
    TestDevice& device_;
    Spirv raygen_, miss_, closest_[2], any_, call_[2];
    RayTracingPipeline pipeline_;
    Buffer vertices_, indices_, out_;
};

bool no_ray_tracing() {
    Log quiet([](LogLevel, std::string_view) {});
    return !Device::create({.require_ray_tracing = true}, quiet).has_value();
}

TlasInstance moved(VkDeviceAddress blas, float x, float y, float scale) {
    return {.transform = {scale, 0, 0, x, 0, scale, 0, y, 0, 0, scale, 0}, .blas = blas};
}

} // namespace

TEST_CASE("raygen, miss, closest hit, any hit and callables work, with the structure by address", "[accel]") {
    if (no_ray_tracing()) SKIP("no device here traces rays");
    TestDevice device(true);
    Scene scene(device);
    const std::array inputs{scene.triangle(true), scene.triangle(false)};
    const bool compact = GENERATE(true, false);
    const auto blas = value(build_blas(*device, inputs, {.compact = compact}));
    REQUIRE(blas.size() == 2);
    Tlas tlas = value(Tlas::create(*device, 1, "tlas"));
    const bool cut = GENERATE(false, true);
    TlasInstance instance = moved(blas[cut].address(), -0.25f, -0.5f, 1);
    instance.custom_index = 0xabcdef;
    instance.hit_group = cut ? 1 : 0;
    tlas.set_all(std::span(&instance, 1));
    ok(tlas.build());
    const auto out = scene.trace(tlas);
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x)
            scene.expect(out[y * size + x], x, y, -0.25f, -0.5f, 1, cut, 0xabcdef);
    device.silent();
}

TEST_CASE("instances move, vanish and appear by rebuilding only the Tlas", "[accel]") {
    if (no_ray_tracing()) SKIP("no device here traces rays");
    TestDevice device(true);
    Scene scene(device);
    const std::array inputs{scene.triangle(true)};
    const auto blas = value(build_blas(*device, inputs));
    Tlas tlas = value(Tlas::create(*device, 8, "tlas"));
    const VkDeviceAddress address = tlas.address();
    const auto hits = [&] {
        std::size_t n = 0;
        for (const Payload& p : scene.trace(tlas))
            n += p.what == 20 || p.what == 200;
        return n;
    };
    tlas.set_all({});
    ok(tlas.build()); // an empty scene
    CHECK(hits() == 0);

    tlas.resize(1);
    tlas.set(0, moved(blas[0].address(), 0, 0, 1));
    auto list = value(device->begin());
    list.build(tlas);
    ok(device->submit_and_wait(list));
    const std::size_t one = hits();
    CHECK(one > size * size / 10);

    tlas.set(0, moved(blas[0].address(), -1, -1, 1));
    ok(tlas.build());
    const auto out = scene.trace(tlas);
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x)
            scene.expect(out[y * size + x], x, y, -1, -1, 1, false, 0);

    tlas.resize(2); // the new one is empty until it is set
    ok(tlas.build());
    CHECK(hits() == one);
    tlas.set(1, moved(blas[0].address(), 0, 0, 1));
    ok(tlas.build());
    CHECK(hits() == 2 * one);
    TlasInstance hidden = moved(blas[0].address(), 0, 0, 1);
    hidden.mask = 0;
    tlas.set(1, hidden);
    ok(tlas.build());
    CHECK(hits() == one);
    tlas.set(0, {}); // no Blas
    ok(tlas.build());
    CHECK(hits() == 0);
    CHECK(tlas.address() == address);
    device.silent();
}

TEST_CASE("many meshes are built in batches and stay distinct", "[accel]") {
    if (no_ray_tracing()) SKIP("no device here traces rays");
    TestDevice device(true);
    Scene scene(device);
    std::vector<BlasInput> inputs(40, scene.triangle(true));
    inputs[7].triangle_count = 0; // a mesh without triangles is hit by nothing
    const auto blas = value(build_blas(*device, inputs, {.max_scratch_bytes = 4096}));
    REQUIRE(blas.size() == inputs.size());
    Tlas tlas = value(Tlas::create(*device, 40, "tlas"));
    std::vector<TlasInstance> instances;
    for (std::uint32_t i = 0; i < 40; ++i) { // a row of small ones along y = 0
        instances.push_back(moved(blas[i].address(), -1 + 0.05f * float(i), -0.01f, 0.05f));
        instances.back().custom_index = i;
    }
    tlas.set_all(instances);
    ok(tlas.build());
    const auto out = scene.trace(tlas);
    std::size_t hit = 0;
    for (std::uint32_t x = 0; x < size; ++x) {
        const Payload& p = out[size / 2 * size + x]; // y = 0.03
        if (p.what != Scene::called(2, x)) continue;
        ++hit;
        CHECK(p.instance == static_cast<std::uint32_t>((Scene::at(x) + 1) / 0.05f));
        CHECK(p.instance != 7);
    }
    CHECK(hit >= 3);
    device.silent();
}
