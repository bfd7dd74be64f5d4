// SPDX-License-Identifier: Apache-2.0
// Whole files: every broken one of tests/data/pbrt/broken gives the message and place in its first line; truncated
// or damaged files never crash; the scenes and corpora of the environment variables load or report why not.
#include "paths.hpp"
#include "pbrt_writer.hpp"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iterator>

using restage::pbrt::test::Folder;
using restage::pbrt::test::Recorder;
namespace fs = std::filesystem;

namespace {

std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<fs::path> files_of(const fs::path& folder) {
    std::vector<fs::path> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && entry.path().extension() == ".pbrt") out.push_back(entry.path());
    std::sort(out.begin(), out.end());
    return out;
}

struct Expected { // of the first line, "# expect 3:7 part of the message"
    unsigned line = 0, column = 0;
    std::string part;
};

Expected expected_of(const fs::path& path) {
    const std::string text = read(path);
    Expected out;
    int used = 0;
    REQUIRE(std::sscanf(text.c_str(), "# expect %u:%u %n", &out.line, &out.column, &used) == 2);
    out.part = text.substr(std::size_t(used), text.find('\n') - std::size_t(used));
    return out;
}

const fs::path data = restage::test::source_dir() / "tests/data/pbrt";

} // namespace

TEST_CASE("pbrt broken files: message and place", "[pbrt]") {
    const auto files = files_of(data / "broken");
    CHECK(files.size() >= 40);
    for (const fs::path& path : files) {
        INFO(path.filename().string());
        const Expected expected = expected_of(path);
        Recorder r;
        CHECK(r.load_file(path.string()) == 0);
        REQUIRE(r.error.set);
        CHECK(r.error.file == fs::weakly_canonical(path).string());
        CHECK(r.error.line == expected.line);
        CHECK(r.error.column == expected.column);
        CHECK_THAT(r.error.message, Catch::Matchers::ContainsSubstring(expected.part));
    }
}

TEST_CASE("pbrt files that pbrt warns about: read, with a line of the report and its place", "[pbrt]") {
    const auto files = files_of(data / "warned");
    CHECK(files.size() >= 7);
    for (const fs::path& path : files) {
        INFO(path.filename().string());
        const Expected expected = expected_of(path);
        Recorder r;
        REQUIRE(r.load_file(path.string()) == 1);
        INFO(r.all_reports());
        CHECK(std::any_of(r.lines.begin(), r.lines.end(), [&](const auto& said) {
            return said.fate != RESTAGE_KEPT && said.line == expected.line &&
                   (said.what + ": " + said.note).find(expected.part) != std::string::npos;
        }));
    }
}

TEST_CASE("pbrt broken files: non-files", "[pbrt]") {
    const Folder folder;
    for (const std::string& path :
         {folder.path().string(), (folder.path() / "none.pbrt").string(), std::string("/dev/null"), std::string()}) {
        Recorder r;
        CHECK(r.load_file(path) == 0);
        CHECK(r.error.message.find("cannot be read") != std::string::npos);
    }
    Recorder bomb; // half a gzip file
    CHECK(bomb.load_file(folder.file("x.pbrt", std::string("\x1f\x8b\x08\0\0\0\0\0\0\3\x4b", 11))) == 0);
    CHECK(bomb.error.message.find("gzip") != std::string::npos);
    Recorder empty;
    CHECK(empty.load_file(folder.file("empty.pbrt", "")) == 0);
    CHECK(empty.error.message.find("no WorldBegin") != std::string::npos);
}

// A small scene with every kind of statement, to damage.
TEST_CASE("pbrt broken files: truncated and damaged anywhere", "[pbrt]") {
    const std::string good = read(data / "everything.pbrt");
    const Folder folder;
    for (const char* name : {"part.pbrt", "tri.ply", "eta.spd"})
        folder.file(name, read(data / name));
    {
        Recorder r;
        REQUIRE(r.load_file(folder.file("s.pbrt", good)) == 1);
        CHECK(r.instances.size() == 14);
    }
    std::size_t loaded = 0, failed = 0;
    const auto run = [&](const std::string& text) {
        Recorder r;
        if (r.load_file(folder.file("s.pbrt", text)))
            ++loaded;
        else
            failed += r.error.set;
    };
    std::size_t runs = 0;
    for (std::size_t n = 0; n < good.size(); n += 7, ++runs)
        run(good.substr(0, n));
    for (std::size_t n = 0; n < good.size(); n += 5, ++runs) { // a character is replaced
        std::string damaged = good;
        damaged[n] = "\"[]9-#x\0 "[n % 9];
        run(damaged);
    }
    CHECK(loaded + failed == runs); // never without a message
    CHECK(loaded > 10);
    CHECK(failed > 100);
}

TEST_CASE("pbrt probe", "[pbrt]") {
    using restage::pbrt::probe;
    CHECK(probe("a/b.pbrt", "", 0) == 100);
    CHECK(probe("a/B.PBRT.gz", "", 0) == 100);
    const std::string text = "LookAt 0 0 1 0 0 0 0 1 0\nCamera \"perspective\"\nWorldBegin\n";
    CHECK(probe("a/b.txt", text.data(), text.size()) >= 50);
    const std::string other = "{ \"asset\": { \"version\": \"2.0\" } }";
    CHECK(probe("a/b.gltf", other.data(), other.size()) == 0);
    CHECK(probe("a/b.bin", "WorldBegin\0", 11) == 0);
    CHECK(probe("x", nullptr, 0) == 0);
}

TEST_CASE("pbrt scenes: all of RESTAGE_SCENES load", "[pbrt]") {
    const char* folder = std::getenv("RESTAGE_SCENES");
    if (!folder) SKIP("RESTAGE_SCENES is not set: the real scenes are left out");
    struct {
        const char* name;
        std::size_t instances;
        bool has_v3;
    } scenes[] = {{"coffee", 23, true},      {"cornell-box", 8, true},    {"dining-room", 53, false},
                  {"kitchen", 299, true},    {"living-room", 65, true},   {"material-testball", 4, true},
                  {"staircase2", 32, false}, {"teapot-full", 5, true},    {"veach-bidir", 14, false},
                  {"veach-mis", 9, true},    {"water-caustic", 10, false}};
    for (const auto& scene : scenes)
        for (const bool old : {false, true}) {
            if (old && !scene.has_v3) continue;
            const std::string path = (fs::path(folder) / scene.name / (old ? "scene-v3.pbrt" : "scene.pbrt")).string();
            INFO(path);
            REQUIRE(fs::exists(path));
            Recorder r;
            const auto start = std::chrono::steady_clock::now();
            const int ok = r.load_file(path);
            const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            INFO(r.error.message << r.all_reports());
            REQUIRE(ok == 1);
            CHECK(r.lines.at(0).what == (old ? "read as pbrt-v3" : "read as pbrt-v4"));
            CHECK(r.instances.size() == scene.instances);
            CHECK(r.raw_cameras.size() == 1);
            bool lit = !r.environments.empty() || !r.lights.empty();
            std::size_t triangles = 0;
            for (const auto& instance : r.instances)
                lit |= (instance.raw.flags & RESTAGE_INSTANCE_EMITS) != 0;
            for (const auto& mesh : r.meshes)
                triangles += mesh.indices.size() / 3;
            CHECK(lit);
            for (const auto& line : r.lines) { // nothing of these scenes is missing
                INFO(line.what << ": " << line.note);
                CHECK(line.fate != RESTAGE_DROPPED);
            }
            std::printf(
                "%-18s %s: %3zu meshes, %8zu triangles, %2zu materials, %2zu textures, %zu report lines, %.3f s\n",
                scene.name, old ? "v3" : "v4", r.meshes.size(), triangles, r.materials.size(), r.textures.size(),
                r.lines.size(), seconds);
        }
}

TEST_CASE("pbrt scenes: a corpus in RESTAGE_CORPORA loads or reports why not", "[pbrt]") {
    const char* folder = std::getenv("RESTAGE_CORPORA");
    if (!folder) SKIP("RESTAGE_CORPORA is not set: the corpus is left out");
    const fs::path root = fs::path(folder) / "pbrt";
    REQUIRE(fs::exists(root));
    std::size_t loaded = 0, fragments = 0, lines = 0;
    for (const fs::path& path : files_of(root)) {
        INFO(path.string());
        Recorder r;
        const int ok = r.load_file(path.string());
        INFO(r.error.message);
        lines += r.lines.size();
        if (ok) {
            ++loaded;
            CHECK_FALSE(r.error.set);
            CHECK(r.raw_cameras.size() == 1);
        } else { // geometry meant for Include
            ++fragments;
            CHECK(r.error.message.find("WorldBegin") != std::string::npos);
            CHECK(r.error.line > 0);
        }
    }
    CHECK(loaded > 100);
    std::printf("corpus: %zu files load, %zu are fragments without WorldBegin, %zu report lines\n", loaded, fragments,
                lines);
}
