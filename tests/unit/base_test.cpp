// SPDX-License-Identifier: Apache-2.0
// base: the hash against published values, files that are complete or absent, loops that cover each index once.
#include "base/file.hpp"
#include "base/jobs.hpp"
#include "base/json.hpp"
#include "base/log.hpp"
#include "temporary_folder.hpp"

#include <sys/stat.h>
#include <atomic>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>
#include <vector>

namespace fs = std::filesystem;
using namespace restage;

namespace {

std::size_t files_in(const fs::path& folder) {
    std::size_t n = 0;
    for (const auto& entry : fs::directory_iterator(folder))
        n += entry.is_regular_file();
    return n;
}

} // namespace

TEST_CASE("hash64 is XXH64", "[base]") {
    CHECK(hash64("") == 0xEF46DB3751D8E999ull); // values of the xxHash project
    CHECK(hash64("a") == 0xD24EC4F1A98C6E5Bull);
    CHECK(hash64("abc") == 0x44BC2CF5AD770999ull);
    // Longer than a 32-byte stripe with a tail of 8 + 4 + 3 bytes, from unaligned memory: position must not matter.
    const std::string text = "?Nobody inspects the spammish repetition, and so on.";
    CHECK(hash64(std::string_view(text).substr(1)) == hash64("Nobody inspects the spammish repetition, and so on."));
    CHECK(hash64("Nobody inspects the spammish repetition") == 0xFBCEA83C8A378BF1ull);
    CHECK(hash64("abc", 1) != hash64("abc", 0));
}

TEST_CASE("an atomic write replaces the whole file or nothing", "[base]") {
    const test::TemporaryFolder temporary;
    const fs::path& folder = temporary.path();
    const fs::path path = folder / "a.txt";
    REQUIRE(write_file_atomic(path, std::string("one\0two", 7)));
    CHECK(read_file(path).value() == std::string("one\0two", 7));
    REQUIRE(write_file_atomic(path, ""));
    CHECK(read_file(path).value().empty());
    REQUIRE(write_file_atomic(path, "kept"));
    {
        auto file = AtomicFile::create(path);
        REQUIRE(file);
        REQUIRE(file->write("half a sen"));
        CHECK(files_in(folder) == 2);
    } // no commit
    CHECK(read_file(path).value() == "kept");
    CHECK(files_in(folder) == 1);
}

TEST_CASE("file errors name the file and the reason", "[base]") {
    const test::TemporaryFolder temporary;
    const fs::path& folder = temporary.path();
    const auto missing = read_file(folder / "missing.pbrt");
    REQUIRE_FALSE(missing);
    CHECK(missing.error().message ==
          (folder / "missing.pbrt").string() + ": cannot be opened: No such file or directory");
    const auto directory = read_file(folder);
    REQUIRE_FALSE(directory);
    CHECK(directory.error().message.find("is a folder") != std::string::npos);
    const auto unwritable = write_file_atomic(folder / "no" / "such" / "folder.txt", "x");
    REQUIRE_FALSE(unwritable);
    CHECK(unwritable.error().message.find("folder.txt: cannot be written: No such file") != std::string::npos);
    // The target is a folder: the write must fail and leave no temporary behind.
    fs::create_directories(folder / "taken" / "inside");
    REQUIRE_FALSE(write_file_atomic(folder / "taken", "x"));
    CHECK(files_in(folder) == 0);
}

TEST_CASE("writing replaces no pipe or device, and a link's target instead of the link", "[base]") {
    const test::TemporaryFolder folder;
    REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
    CHECK(write_file_atomic(folder / "pipe", "x").error().message ==
          (folder / "pipe").string() + ": is a pipe, not a regular file");
    CHECK(fs::is_fifo(folder / "pipe"));
    fs::create_symlink("/dev/null", folder / "null");
    CHECK(write_file_atomic(folder / "null", "x").error().message ==
          (folder / "null").string() + ": is a device, not a regular file");
    CHECK(fs::is_symlink(folder / "null"));
    fs::create_directory(folder / "elsewhere");
    REQUIRE(write_file_atomic(folder / "elsewhere" / "file", "old"));
    fs::create_symlink(fs::path("elsewhere") / "file", folder / "link");
    REQUIRE(write_file_atomic(folder / "link", "new"));
    CHECK(fs::is_symlink(folder / "link"));
    CHECK(read_file(folder / "elsewhere" / "file").value() == "new");
    fs::create_symlink("nowhere", folder / "dangling");
    REQUIRE(write_file_atomic(folder / "dangling", "x"));
    CHECK(read_file(folder / "dangling").value() == "x");
}

TEST_CASE("non-regular and oversized files are refused at once", "[base]") {
    const test::TemporaryFolder folder;
    const fs::path pipe = folder / "pipe.png";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0); // it has no writer: opening it would block forever
    CHECK(read_file(pipe).error().message == pipe.string() + ": is a pipe, not a regular file");
    CHECK(read_file("/dev/zero").error().message == "/dev/zero: is a device, not a regular file");
    REQUIRE(write_file_atomic(folder / "five", "12345"));
    CHECK(read_file(folder / "five", 5).value() == "12345");
    CHECK(read_file(folder / "five", 4).error().message.find("has 5 bytes, more than the 4") != std::string::npos);
    CHECK_FALSE(read_file("/proc/self/status", 10)); // reports no size
    REQUIRE(write_file_atomic(folder / "sparse", ""));
    fs::resize_file(folder / "sparse", std::uintmax_t{1} << 40); // sparse
    CHECK_FALSE(read_file(folder / "sparse"));
}

TEST_CASE("JSON that is nested too deep is refused with its place, whatever its strings contain", "[base]") {
    const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
    CHECK(parse_json<nlohmann::json>(nested(most_json_depth)));
    const auto deep = parse_json<nlohmann::json>("\n " + nested(20000));
    REQUIRE_FALSE(deep);
    CHECK(deep.error().message.starts_with("2:" + std::to_string(most_json_depth + 2) + ": JSON nested more than"));
    const std::string text = "{\"a\": \"" + std::string(1000, '[') + "\\\"" + std::string(1000, '{') + "\"}";
    CHECK(parse_json<nlohmann::json>(text));
    CHECK(parse_json<nlohmann::json>("{\n  \"a\": }").error().message.starts_with("2:8: not JSON: syntax error"));
}

TEST_CASE("files without a size are read to their end", "[base]") {
    const auto status = read_file("/proc/self/status");
    REQUIRE(status);
    CHECK(status->find("VmPeak") != std::string::npos);
}

TEST_CASE("the program finds its own path", "[base]") {
    const auto path = executable_path();
    REQUIRE(path);
    CHECK(fs::is_regular_file(*path));
    CHECK(executable_dir().value() == path->parent_path());
}

TEST_CASE("parallel_for visits each index once, for any grain", "[base]") {
    for (const unsigned threads : {1u, 2u, 5u}) {
        Jobs jobs(threads);
        CHECK(jobs.threads() == threads);
        for (const std::size_t count : {0u, 1u, 7u, 1000u})
            for (const std::size_t grain : {0u, 1u, 3u, 64u, 5000u}) {
                std::vector<std::atomic<int>> visits(count);
                std::atomic<bool> sane{true};
                jobs.parallel_for(count, grain, [&](std::size_t begin, std::size_t end, unsigned thread) {
                    if (begin >= end || end > count || end - begin > std::max<std::size_t>(grain, 1) ||
                        thread >= threads)
                        sane = false;
                    for (std::size_t i = begin; i < end; ++i)
                        ++visits[i];
                });
                CHECK(sane);
                for (std::size_t i = 0; i < count; ++i)
                    REQUIRE(visits[i] == 1);
            }
    }
}

TEST_CASE("nested and concurrent loops finish and are complete", "[base]") {
    Jobs jobs(3);
    std::atomic<int> sum{0};
    const auto outer = [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i)
            jobs.parallel_for(10, 2, [&](std::size_t b, std::size_t e, unsigned) { sum += static_cast<int>(e - b); });
    };
    std::thread other([&] {
        for (int i = 0; i < 50; ++i)
            jobs.parallel_for(20, 1, outer);
    });
    for (int i = 0; i < 50; ++i)
        jobs.parallel_for(20, 1, outer);
    other.join();
    CHECK(sum == 2 * 50 * 20 * 10);
}

TEST_CASE("an exception in a loop reaches the caller and the pool stays usable", "[base]") {
    Jobs jobs(2);
    CHECK_THROWS_AS(jobs.parallel_for(100, 1,
                                      [](std::size_t begin, std::size_t, unsigned) {
                                          if (begin == 37) throw std::runtime_error("37");
                                      }),
                    std::runtime_error);
    std::atomic<int> n{0};
    jobs.parallel_for(100, 1, [&](std::size_t, std::size_t, unsigned) { ++n; });
    CHECK(n == 100);
}

#if defined(__SSE2__)
TEST_CASE("denormals are zero inside a loop and only there", "[base]") {
    volatile float tiny = std::numeric_limits<float>::min();
    const auto quarter_is_zero = [&] {
        const volatile float q = tiny * 0.25f;
        return q == 0.0f;
    };
    Jobs jobs(2);
    std::atomic<int> flushed{0};
    jobs.parallel_for(64, 1, [&](std::size_t, std::size_t, unsigned) { flushed += quarter_is_zero(); });
    CHECK(flushed == 64);
    CHECK_FALSE(quarter_is_zero());
}
#endif

TEST_CASE("the log drops lines below its threshold", "[base]") {
    std::vector<std::string> lines;
    Log log([&](LogLevel, std::string_view line) { lines.emplace_back(line); });
    log.debug("a");
    log.set_threshold(LogLevel::warning);
    log.info("b");
    log.error("c");
    CHECK(lines == std::vector<std::string>{"a", "c"});
}
