// SPDX-License-Identifier: Apache-2.0
// Buffers: sizes, mapping, alignment, transfers, and running out of memory.
#include "test_device.hpp"

#include <cstdint>
#include <cstring>
#include <numeric>

using namespace restage;
using namespace restage::gpu;
using namespace restage::gpu::test;

TEST_CASE("every kind of buffer stores and returns bytes", "[buffer]") {
    TestDevice device;
    const BufferKind kind = GENERATE(BufferKind::device, BufferKind::host, BufferKind::readback);
    std::vector<std::uint8_t> bytes(100'003);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        bytes[i] = static_cast<std::uint8_t>(i * 31 + i / 256);
    Buffer buffer = value(device->create_buffer(bytes.size() + 10, kind, "bytes"));
    CHECK(buffer.size() == bytes.size() + 10);
    CHECK(buffer.address() % 256 == 0);
    if (kind != BufferKind::device) {
        REQUIRE(buffer.mapped() != nullptr);
        CHECK(reinterpret_cast<std::uintptr_t>(buffer.mapped()) % 64 == 0);
        CHECK(buffer.span<std::uint32_t>().size() == buffer.size() / 4);
    }
    ok(device->upload(buffer, 10, std::as_bytes(std::span(bytes))));
    std::vector<std::uint8_t> back(bytes.size() - 5);
    ok(device->download(buffer, 15, std::as_writable_bytes(std::span(back))));
    CHECK(std::memcmp(back.data(), bytes.data() + 5, back.size()) == 0);
    device.silent();
}

TEST_CASE("a copy on the device moves exactly the range", "[buffer]") {
    TestDevice device;
    std::vector<std::uint32_t> numbers(1000);
    std::iota(numbers.begin(), numbers.end(), 0u);
    const Buffer a = value(device->create_buffer_of<std::uint32_t>(numbers, "a"));
    const Buffer b = value(device->create_buffer(4000, BufferKind::readback, "b"));
    std::memset(b.mapped(), 0xff, b.size());
    auto list = value(device->begin());
    list.copy(a, 400, b, 40, 800);
    list.copy(a, 0, b, 0, 0); // nothing
    ok(device->submit_and_wait(list));
    const auto out = b.span<std::uint32_t>();
    CHECK(out[9] == ~0u);
    for (std::uint32_t i = 0; i < 200; ++i)
        REQUIRE(out[10 + i] == 100 + i);
    CHECK(out[210] == ~0u);
    device.silent();
}

TEST_CASE("an empty buffer has an address and no bytes", "[buffer]") {
    TestDevice device;
    Buffer empty = value(device->create_buffer(0, BufferKind::host, "empty"));
    CHECK(empty.size() == 0);
    CHECK(empty.address() != 0);
    CHECK(empty.span<int>().empty());
    ok(device->upload(empty, 0, {}));
    ok(device->download(empty, 0, {}));
    CHECK(bool(value(device->create_buffer_of<int>({}, "none"))));
    auto list = value(device->begin());
    list.fill(empty, 0, CommandList::whole_size, 1);
    ok(device->submit_and_wait(list));
    device.silent();
}

TEST_CASE("moved buffers keep their memory, and moved-from ones are empty", "[buffer]") {
    TestDevice device;
    Buffer a = value(device->create_buffer(64, BufferKind::host, "a"));
    const auto address = a.address();
    Buffer b = std::move(a);
    CHECK(b.address() == address);
    CHECK(b.name() == std::string("a"));
    CHECK_FALSE(bool(a)); // NOLINT(bugprone-use-after-move): the tested case
    CHECK(a.size() == 0);
    b = value(device->create_buffer(128, BufferKind::host, "b"));
    CHECK(b.size() == 128);
    device.silent();
}

TEST_CASE("too large a buffer is an error with sizes, not a crash", "[buffer]") {
    TestDevice device;
    for (const std::size_t bytes : {std::size_t(1) << 50, ~std::size_t(0), device->info().max_buffer_bytes + 1}) {
        const auto buffer = device->create_buffer(bytes, BufferKind::host, "giant");
        REQUIRE_FALSE(buffer.has_value());
        CHECK(buffer.error().message.find("giant") != std::string::npos);
        CHECK(buffer.error().message.find("MiB") != std::string::npos);
    }
    device.silent();
}

TEST_CASE("running out of memory is an error, and the device stays usable", "[buffer]") {
    TestDevice device;
    if (device->info().type != DeviceType::cpu) SKIP("would fill a real card's memory");
    // Nothing is touched, so this takes address space only; the budget ends it.
    std::vector<Buffer> buffers;
    std::string error;
    const std::size_t piece = std::min<std::size_t>(device->info().max_buffer_bytes - 1024, std::size_t(1) << 30);
    for (std::uint64_t i = 0; i <= 2 * device->info().memory_bytes / piece && error.empty(); ++i) {
        if (auto buffer = device->create_buffer(piece, BufferKind::host, "filler"))
            buffers.push_back(std::move(*buffer));
        else
            error = buffer.error().message;
    }
    CHECK(error.find("filler") != std::string::npos);
    CHECK(error.find("out of device memory") != std::string::npos);
    CHECK_FALSE(buffers.empty());
    buffers.clear();
    CHECK(device->create_buffer(1 << 20, BufferKind::host, "small").has_value());
    device.silent();
}
