// SPDX-License-Identifier: Apache-2.0
// Choosing a device, and running kernels on it through addresses.
#include "test_device.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <thread>

using namespace restage;
using namespace restage::gpu;
using namespace restage::gpu::test;

TEST_CASE("devices are listed, unusable ones with the reason", "[device]") {
    Log log;
    const auto devices = value(list_devices(log));
    REQUIRE_FALSE(devices.empty());
    for (const DeviceInfo& d : devices) {
        CHECK_FALSE(d.name.empty());
        CHECK(d.memory_bytes > 0);
        CHECK(d.ray_tracing == d.missing_ray_tracing.empty());
        if (d.missing.empty()) {
            CHECK(d.max_buffer_bytes >= std::uint64_t(1) << 27);
            CHECK(d.max_push_constant_bytes >= 128);
        }
    }
}

TEST_CASE("a device is selected by index or by part of its name", "[device]") {
    Log log([](LogLevel, std::string_view) {});
    const auto devices = value(list_devices(log));
    const auto usable =
        std::find_if(devices.begin(), devices.end(), [](const DeviceInfo& d) { return d.missing.empty(); });
    REQUIRE(usable != devices.end());
    CHECK(value(Device::create({.select = std::to_string(usable->index)}, log))->info().name == usable->name);
    std::string part = usable->name.substr(1, 5);
    for (char& c : part)
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    CHECK(Device::create({.select = part}, log).has_value());

    const auto none = Device::create({.select = "no such card"}, log);
    REQUIRE_FALSE(none.has_value());
    CHECK(none.error().message.find("no such card") != std::string::npos);
    CHECK(none.error().message.find(usable->name) != std::string::npos); // the available ones
    CHECK_FALSE(Device::create({.select = "99"}, log).has_value());
}

TEST_CASE("a missing extension is named", "[device]") {
    Log log([](LogLevel, std::string_view) {});
    const auto device = Device::create({.device_extensions = {"VK_RESTAGE_time_travel"}}, log);
    REQUIRE_FALSE(device.has_value());
    CHECK(device.error().message.find("VK_RESTAGE_time_travel") != std::string::npos);
    const auto instance = Device::create({.instance_extensions = {"VK_RESTAGE_telepathy"}}, log);
    REQUIRE_FALSE(instance.has_value());
    CHECK(instance.error().message.find("VK_RESTAGE_telepathy") != std::string::npos);
}

namespace {

// Scalar layout: a vec3 is 12 bytes, the same as in C++.
struct Particle {
    float position[3];
    float mass;
    std::uint32_t id;
    float velocity[3];
};
static_assert(sizeof(Particle) == 32);

struct Push {
    VkDeviceAddress in, out;
    std::uint32_t count;
    float scale;
};

const std::string particles = glsl_head + R"(
layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint offset = 0;
layout(constant_id = 2) const bool twice = false;
layout(constant_id = 3) const float extra = 0.0;
struct Particle { vec3 position; float mass; uint id; vec3 velocity; };
layout(buffer_reference, scalar) readonly buffer In { Particle p[]; };
layout(buffer_reference, scalar) buffer Out { Particle p[]; };
layout(push_constant, scalar) uniform Push { In src; Out dst; uint count; float scale; } push;
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    Particle p = push.src.p[i];
    p.position += push.scale * p.velocity;
    p.id += offset;
    p.mass = (twice ? 2.0 : 1.0) * p.mass + extra;
    push.dst.p[i] = p;
}
)";

} // namespace

TEST_CASE("a kernel reads and writes structs through addresses", "[device][run]") {
    TestDevice device;
    const Spirv shader = compile(particles);
    const std::array constants{SpecConstant{0, 32}, SpecConstant{1, 100}, SpecConstant{2, 1},
                               SpecConstant{3, std::bit_cast<std::uint32_t>(0.5f)}, SpecConstant{77, 1}};
    const auto pipeline = value(ComputePipeline::create(*device, shader, sizeof(Push), constants, "particles"));
    const std::uint32_t count = 1000;
    std::vector<Particle> input(count);
    for (std::uint32_t i = 0; i < count; ++i)
        input[i] = {{float(i), 1, 2}, 3.0f * float(i), i, {1, float(i), -1}};
    const Buffer in = value(device->create_buffer_of<Particle>(input, "in"));
    const BufferKind kind = GENERATE(BufferKind::device, BufferKind::host, BufferKind::readback);
    const Buffer out = value(device->create_buffer(count * sizeof(Particle), kind, "out"));
    auto list = value(device->begin());
    list.dispatch(pipeline, push_bytes(Push{in.address(), out.address(), count, 2.0f}), (count + 31) / 32);
    ok(device->submit_and_wait(list));
    std::vector<Particle> output(count);
    ok(device->download(out, 0, std::as_writable_bytes(std::span(output))));
    for (std::uint32_t i = 0; i < count; ++i) {
        REQUIRE(output[i].position[0] == float(i) + 2);
        REQUIRE(output[i].position[1] == 1 + 2 * float(i));
        REQUIRE(output[i].position[2] == 0);
        REQUIRE(output[i].mass == 6.0f * float(i) + 0.5f);
        REQUIRE(output[i].id == i + 100);
    }
    device.silent();
}

namespace {

const std::string increment = glsl_head + R"(
layout(local_size_x = 64) in;
layout(buffer_reference, scalar) buffer U { uint v[]; };
layout(push_constant, scalar) uniform Push { U a; uint count; } push;
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < push.count) push.a.v[i] = push.a.v[i] * 3 + i;
}
)";
struct IncrementPush {
    VkDeviceAddress a;
    std::uint32_t count, pad = 0;
};

} // namespace

TEST_CASE("a list is recorded once and submitted often; barriers order dispatches", "[device][run]") {
    TestDevice device;
    const auto pipeline =
        value(ComputePipeline::create(*device, compile(increment), sizeof(IncrementPush), {}, "increment"));
    const std::uint32_t count = 4096;
    const Buffer data = value(device->create_buffer(count * 4, BufferKind::host, "data"));
    const Buffer counts = value(device->create_buffer(12, BufferKind::host, "counts"));
    std::fill_n(data.span<std::uint32_t>().data(), count, 1u);
    counts.span<std::uint32_t>()[0] = count / 64;
    counts.span<std::uint32_t>()[1] = counts.span<std::uint32_t>()[2] = 1;

    auto list = value(device->begin());
    const IncrementPush constants{data.address(), count};
    const auto push = push_bytes(constants);
    list.dispatch(pipeline, push, count / 64);
    list.barrier();
    list.dispatch_indirect(pipeline, push, counts, 0);
    std::vector<std::uint32_t> expected(count, 1);
    const auto step = [&](std::uint32_t limit) {
        for (std::uint32_t i = 0; i < limit; ++i)
            expected[i] = expected[i] * 3 + i;
    };
    for (int run = 0; run < 3; ++run) {
        const Submission submission = value(device->submit(list)); // the second submit waits for the first by itself
        step(count);
        step(count);
        if (run == 2) ok(submission.wait());
        if (run == 2) CHECK(value(submission.done()));
    }
    CHECK(std::equal(expected.begin(), expected.end(), data.span<std::uint32_t>().data()));

    counts.span<std::uint32_t>()[0] = 2; // the host changes the count, nothing is recorded again
    ok(device->submit_and_wait(list));
    step(count);
    step(128);
    CHECK(std::equal(expected.begin(), expected.end(), data.span<std::uint32_t>().data()));

    list.reset();
    list.fill(data, 0, CommandList::whole_size, 7);
    ok(device->submit_and_wait(list));
    CHECK(std::all_of(data.span<std::uint32_t>().begin(), data.span<std::uint32_t>().end(),
                      [](auto v) { return v == 7; }));
    device.silent();
}

TEST_CASE("lists submitted back to back without waiting see each other's writes", "[device][run]") {
    TestDevice device;
    const auto pipeline =
        value(ComputePipeline::create(*device, compile(increment), sizeof(IncrementPush), {}, "increment"));
    const Buffer data = value(device->create_buffer(256, BufferKind::readback, "data"));
    std::fill_n(data.span<std::uint32_t>().data(), 64, 0u);
    Submission last;
    for (int i = 0; i < 20; ++i) {
        auto list = value(device->begin());
        list.dispatch(pipeline, push_bytes(IncrementPush{data.address(), 64}), 1);
        last = value(device->submit(list));
    }
    ok(last.wait());
    std::uint32_t expected = 0;
    for (int i = 0; i < 20; ++i)
        expected = expected * 3 + 5;
    CHECK(data.span<std::uint32_t>()[5] == expected);
    device.silent();
}

TEST_CASE("several threads record and submit", "[device][run]") {
    TestDevice device;
    const auto pipeline =
        value(ComputePipeline::create(*device, compile(increment), sizeof(IncrementPush), {}, "increment"));
    std::array<Buffer, 4> buffers;
    for (Buffer& b : buffers) {
        b = value(device->create_buffer(256, BufferKind::readback, "data"));
        std::fill_n(b.span<std::uint32_t>().data(), 64, 0u);
    }
    std::array<std::thread, 4> threads;
    std::array<std::string, 4> errors;
    for (std::size_t t = 0; t < threads.size(); ++t)
        threads[t] = std::thread([&, t] {
            for (int i = 0; i < 50; ++i) {
                auto list = device->begin();
                if (!list) return void(errors[t] = list.error().message);
                list->dispatch(pipeline, push_bytes(IncrementPush{buffers[t].address(), 64}), 1);
                if (auto done = device->submit_and_wait(*list); !done) return void(errors[t] = done.error().message);
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    std::uint32_t expected = 0;
    for (int i = 0; i < 50; ++i)
        expected = expected * 3 + 1;
    for (std::size_t t = 0; t < threads.size(); ++t) {
        CHECK(errors[t] == "");
        CHECK(buffers[t].span<std::uint32_t>()[1] == expected);
    }
    device.silent();
}

TEST_CASE("validation reports errors", "[device]") {
    Log quiet([](LogLevel, std::string_view) {});
    auto device = value(Device::create({.validation = true}, quiet));
    const Buffer a = value(device->create_buffer(256, BufferKind::device, "the buffer in question"));
    auto list = value(device->begin());
    const VkBufferCopy outside{.srcOffset = 1 << 20, .dstOffset = 0, .size = 16};
    device->vk().vkCmdCopyBuffer(list.handle(), a.handle(), a.handle(), 1, &outside); // never submitted
    const auto messages = device->validation_messages();
    REQUIRE_FALSE(messages.empty());
    CHECK(messages.front().find("the buffer in question") != std::string::npos);
    device->clear_validation_messages();
    CHECK(device->validation_messages().empty());
}

TEST_CASE("synchronization validation reports a missing barrier", "[device]") {
    Log quiet([](LogLevel, std::string_view) {});
    auto device = value(Device::create({.validation = true}, quiet));
    const Buffer a = value(device->create_buffer(256, BufferKind::device, "a"));
    const Buffer b = value(device->create_buffer(256, BufferKind::device, "b"));
    const bool barrier = GENERATE(false, true);
    auto list = value(device->begin());
    list.copy(a, 0, b, 0, 64);
    if (barrier) list.barrier();
    list.copy(b, 0, a, 0, 64);
    ok(device->submit_and_wait(list));
    CHECK(device->validation_messages().empty() == barrier);
}

TEST_CASE("timestamps grow", "[device]") {
    TestDevice device;
    auto times = value(Timestamps::create(*device, 3));
    const Buffer buffer = value(device->create_buffer(std::size_t(32) << 20, BufferKind::device, "filled"));
    auto list = value(device->begin());
    list.timestamp(times, 0);
    list.fill(buffer, 0, CommandList::whole_size, 1);
    list.timestamp(times, 1);
    ok(device->submit_and_wait(list));
    const auto seconds = value(times.read());
    if (device->info().timestamps) {
        CHECK(seconds[0] == 0);
        CHECK(seconds[1] > 0);
        CHECK(seconds[1] < 10);
    } else {
        CHECK(std::isnan(seconds[1]));
    }
    CHECK(std::isnan(seconds[2]));
    device.silent();
}

TEST_CASE("push constants beyond the device's limit are an error", "[device]") {
    TestDevice device;
    const auto pipeline = ComputePipeline::create(*device, compile(increment), 1 << 16, {}, "greedy");
    REQUIRE_FALSE(pipeline.has_value());
    CHECK(pipeline.error().message.find("greedy") != std::string::npos);
    device.silent();
}
