// SPDX-License-Identifier: Apache-2.0
// Pipelines built on worker threads while the device works.
#include "gpu/accel.hpp"
#include "gpu/pipeline_builder.hpp"
#include "test_device.hpp"

#include <catch2/matchers/catch_matchers_string.hpp>

#include <array>
#include <chrono>

using namespace restage;
using namespace restage::gpu;
using namespace restage::gpu::test;
using Catch::Matchers::StartsWith;

namespace {

struct Push {
    VkDeviceAddress out;
    std::uint32_t value, pad = 0;
};

ComputeRequest adder(int n, const std::string& extra = "") {
    return {.shader = {.name = "adder " + std::to_string(n),
                       .text = glsl_head + R"(
layout(local_size_x = 1) in;
layout(constant_id = 0) const uint bonus = 0;
layout(buffer_reference, scalar) buffer U { uint v; };
layout(push_constant, scalar) uniform P { U dst; uint value; } push;
void main() { push.dst.v = push.value + )" +
                               std::to_string(n) + "u + bonus; " + extra + "}\n"},
            .push_constant_bytes = sizeof(Push),
            .constants = {{0, 1000}},
            .name = "adder " + std::to_string(n)};
}

} // namespace

TEST_CASE("the builder delivers finished, distinct pipelines while the device works", "[builder]") {
    TestDevice device;
    const ShaderCompiler compiler({});
    const Buffer out = value(device->create_buffer(4, BufferKind::readback, "out"));
    const auto busy = value(ComputePipeline::create(*device, compile(adder(0).shader.text), sizeof(Push), {}, "busy"));
    const auto stalls = GENERATE(PipelineBuilder::Stalls::avoid, PipelineBuilder::Stalls::allow);
    PipelineBuilder builder(*device, compiler, 2, stalls);
    std::vector<std::future<Result<ComputePipeline>>> futures;
    for (int n = 0; n < 6; ++n)
        futures.push_back(builder.build(adder(n)));
    auto list = value(device->begin());
    list.dispatch(busy, push_bytes(Push{out.address(), 7}), 1);
    while (futures.back().wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
        ok(device->submit_and_wait(list));
        REQUIRE(out.span<std::uint32_t>()[0] == 7);
    }
    for (std::size_t n = 0; n < futures.size(); ++n) {
        const ComputePipeline pipeline = value(futures[n].get());
        auto once = value(device->begin());
        once.dispatch(pipeline, push_bytes(Push{out.address(), 5}), 1);
        ok(device->submit_and_wait(once));
        CHECK(out.span<std::uint32_t>()[0] == 1005 + n);
    }
    device.silent();
}

TEST_CASE("the future reports a shader error, and the builder stays usable", "[builder]") {
    TestDevice device;
    const ShaderCompiler compiler({});
    PipelineBuilder builder(*device, compiler, 1);
    auto bad = builder.build(adder(1, "oops;"));
    auto good = builder.build(adder(2));
    const auto result = bad.get();
    REQUIRE_FALSE(result.has_value());
    CHECK_THAT(result.error().message, StartsWith("adder 1:10: 'oops'"));
    CHECK(good.get().has_value());
    device.silent();
}

TEST_CASE("a destroyed builder completes every request", "[builder]") {
    TestDevice device;
    const ShaderCompiler compiler({});
    std::vector<std::future<Result<ComputePipeline>>> futures;
    {
        PipelineBuilder builder(*device, compiler, 2);
        for (int n = 0; n < 20; ++n)
            futures.push_back(builder.build(adder(n)));
    }
    std::size_t cancelled = 0;
    for (auto& future : futures) {
        const auto result = future.get(); // does not hang, does not throw
        cancelled += !result.has_value() && result.error().message.find("cancelled") != std::string::npos;
        CHECK((result.has_value() || result.error().message.find("cancelled") != std::string::npos));
    }
    CHECK(cancelled > 0);
    device.silent();
}

TEST_CASE("a request cancelled before its turn is not built", "[builder]") {
    TestDevice device;
    const ShaderCompiler compiler({});
    PipelineBuilder builder(*device, compiler, 1);
    auto first = builder.build(adder(1));
    std::stop_source stop;
    ComputeRequest request = adder(2);
    request.stop = stop.get_token();
    stop.request_stop();
    const auto result = builder.build(std::move(request)).get();
    REQUIRE_FALSE(result.has_value());
    CHECK_THAT(result.error().message, Catch::Matchers::ContainsSubstring("adder 2 was cancelled"));
    CHECK(first.get().has_value());
    device.silent();
}

TEST_CASE("ray-tracing pipelines are built too, and shaders may be shared by groups", "[builder]") {
    Log quiet([](LogLevel, std::string_view) {});
    if (!Device::create({.require_ray_tracing = true}, quiet)) SKIP("no device here traces rays");
    TestDevice device(true);
    const ShaderCompiler compiler({});
    const std::string head = glsl_head + "#extension GL_EXT_ray_tracing : require\n";
    RayTracingRequest request{.misses = {1},
                              .hit_groups = {{2, 3}, {2, RayTracingRequest::none}},
                              .callables = {4, 5},
                              .callable_constants = {{{3, 7}}, {{3, 100}}},
                              .push_constant_bytes = 16,
                              .name = "two groups"};
    request.shaders = {
        {.name = "raygen",
         .text = head + R"(
layout(location = 0) rayPayloadEXT uint hit;
layout(location = 0) callableDataEXT uint called;
layout(buffer_reference, scalar) buffer U { uint v; };
layout(push_constant, scalar) uniform P { uint64_t tlas; U dst; } push;
void main() {
    hit = 0;
    traceRayEXT(accelerationStructureEXT(push.tlas), 0, 0xff, 0, 0, 0, vec3(0), 0.0, vec3(0, 0, 1), 1.0, 0);
    called = hit;
    executeCallableEXT(0, 0);
    executeCallableEXT(1, 0);
    push.dst.v = called;
})",
         .stage = ShaderStage::raygen},
        {.name = "miss",
         .text = head + "layout(location = 0) rayPayloadInEXT uint hit;\nvoid main() { hit = 3; }\n",
         .stage = ShaderStage::miss},
        {.name = "closest",
         .text = head + "layout(location = 0) rayPayloadInEXT uint hit;\nvoid main() { hit = 4; }\n",
         .stage = ShaderStage::closest_hit},
        {.name = "any", .text = head + "void main() { ignoreIntersectionEXT; }\n", .stage = ShaderStage::any_hit},
        {.name = "call",
         .text = head + "layout(location = 0) callableDataInEXT uint c;\n"
                        "layout(constant_id = 3) const uint factor = 1;\nvoid main() { c *= factor; }\n",
         .stage = ShaderStage::callable},
        {.name = "call another",
         .text = head + "layout(location = 0) callableDataInEXT uint c;\n"
                        "layout(constant_id = 3) const uint more = 1;\nvoid main() { c += more; }\n",
         .stage = ShaderStage::callable}};
    PipelineBuilder builder(*device, compiler, 1);
    const RayTracingPipeline pipeline = value(builder.build(request).get());
    Tlas tlas = value(Tlas::create(*device, 1, "empty"));
    ok(tlas.build());
    const Buffer out = value(device->create_buffer(4, BufferKind::readback, "out"));
    auto list = value(device->begin());
    const std::array<VkDeviceAddress, 2> push{tlas.address(), out.address()};
    list.trace(pipeline, push_bytes(push), 1, 1);
    ok(device->submit_and_wait(list));
    CHECK(out.span<std::uint32_t>()[0] == 121); // 3 * 7 + 100
    device.silent();
}
