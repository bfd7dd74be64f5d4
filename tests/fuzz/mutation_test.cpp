// SPDX-License-Identifier: Apache-2.0
// Good files, damaged at random with fixed seeds: the result is always a scene or an error with a message, never a
// crash, a leak (under AddressSanitizer), a long wait or much memory. RESTAGE_MUTATIONS raises the number per file.

#include "broken_files.hpp"
#include "io/image_file.hpp"
#include "io/import.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <cstdlib>

using namespace restage;
using test::data_folder;
namespace fs = std::filesystem;

namespace {

unsigned mutations(unsigned usual) {
    const char* wanted = std::getenv("RESTAGE_MUTATIONS");
    return wanted ? static_cast<unsigned>(std::atoi(wanted)) : usual;
}

using Random = std::mt19937;
std::size_t below(Random& random, std::size_t limit) { return limit ? random() % limit : 0; }

// Typical damage: cuts, repeats, flipped bits, extreme numbers, pieces moved elsewhere.
std::string damage(std::string bytes, Random& random) {
    static constexpr std::string_view edges[] = {"0",    "-1",     "1e9", "1e39", "4294967296", "2147483647", "nan",
                                                 "-inf", "1e-400", "]",   "[",    "\"",         "#",          "\n"};
    for (std::size_t rounds = 1 + below(random, 4); rounds > 0; --rounds) {
        const std::size_t at = below(random, bytes.size() + 1),
                          length = below(random, std::min<std::size_t>(bytes.size() - at + 1, 40));
        switch (random() % 7) {
            case 0:
                bytes.resize(at);
                break;
            case 1:
                bytes.insert(at, bytes.substr(at, length));
                break;
            case 2:
                bytes.erase(at, length);
                break;
            case 3:
                if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << (random() % 8)));
                break;
            case 4:
                if (at < bytes.size()) bytes[at] = static_cast<char>(random());
                break;
            case 5:
                bytes.insert(at, edges[below(random, std::size(edges))]);
                break;
            default: { // a number becomes another
                const auto digit = bytes.find_first_of("0123456789", at);
                if (digit == std::string::npos) break;
                const auto end = std::min(bytes.find_first_not_of("0123456789.-+e", digit), bytes.size());
                bytes.replace(digit, end - digit, edges[below(random, 9)]);
                break;
            }
        }
    }
    return bytes;
}

struct Limits {
    double seconds, megabytes;
};
constexpr Limits limits{20, 700};

} // namespace

TEST_CASE("mutations: scenes and what they refer to") {
    const test::Importers importers;
    const test::Folder folder;
    std::size_t loaded = 0, refused = 0;
    const std::array<const char*, 4> files = {"everything.pbrt", "part.pbrt", "tri.ply", "eta.spd"};
    for (const char* victim : files) {
        for (const char* name : files)
            test::write_bytes(folder / name, test::read_bytes(data_folder / "pbrt" / name));
        const std::string good = test::read_bytes(data_folder / "pbrt" / victim);
        REQUIRE_FALSE(good.empty());
        for (unsigned seed = 0; seed < mutations(100); ++seed) {
            Random random(seed);
            const std::string bad = damage(good, random);
            test::write_bytes(folder / victim, bad);
            CAPTURE(victim, seed);
            const test::Watch watch;
            const auto result = io::import_scene((folder / "everything.pbrt").string(), importers.registry);
            ++(result ? loaded : refused);
            if (!result) REQUIRE_FALSE(result.error().message.empty());
            REQUIRE(watch.seconds() < limits.seconds);
            REQUIRE(watch.grown() < limits.megabytes);
        }
    }
    CHECK(loaded > 10); // the damage is neither always fatal nor always harmless
    CHECK(refused > 10);
}

TEST_CASE("mutations: binary PLY files") {
    const test::Importers importers;
    const test::Folder folder;
    test::write_bytes(folder / "scene.pbrt", "WorldBegin\nShape \"plymesh\" \"string filename\" \"mesh.ply\"\n");
    for (const bool big : {false, true}) {
        std::string good = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                           "_endian 1.0\nelement vertex 40\nproperty float x\nproperty double y\nproperty float z\n"
                           "property uchar red\nproperty float u\nproperty float v\nelement face 20\n"
                           "property list uchar int vertex_indices\nproperty list ushort float weights\nend_header\n";
        Random fill(1);
        for (int vertex = 0; vertex < 40; ++vertex)
            good.append(4 + 8 + 4 + 1 + 4 + 4, static_cast<char>(fill() % 64));
        for (int face = 0; face < 20; ++face) {
            good += '\3';
            for (int i = 0; i < 3; ++i) {
                const char index = static_cast<char>(fill() % 40);
                good += big ? std::string({0, 0, 0, index}) : std::string({index, 0, 0, 0});
            }
            good += big ? std::string("\0\1\0\0\0\0", 6) : std::string("\1\0\0\0\0\0", 6);
        }
        test::write_bytes(folder / "mesh.ply", good);
        const auto whole = io::import_scene((folder / "scene.pbrt").string(), importers.registry);
        REQUIRE(whole);
        for (unsigned seed = 0; seed < mutations(400); ++seed) {
            Random random(seed);
            test::write_bytes(folder / "mesh.ply", damage(good, random));
            CAPTURE(big, seed);
            const test::Watch watch;
            const auto result = io::import_scene((folder / "scene.pbrt").string(), importers.registry);
            if (!result) REQUIRE(result.error().message.find("mesh.ply") != std::string::npos);
            REQUIRE(watch.seconds() < limits.seconds);
            REQUIRE(watch.grown() < limits.megabytes);
        }
    }
}

TEST_CASE("mutations: images of every format") {
    const test::Folder folder;
    const scene::PixelData ramp{
        .width = 16, .height = 8, .channels = 3, .values = std::vector<float>(16 * 8 * 3, 0.4f)};
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(data_folder / "images"))
        if (entry.path().extension() != ".py") files.push_back(entry.path());
    for (const char* name : {"a.exr", "a.hdr", "a.pfm"}) {
        files.push_back(folder / name);
        REQUIRE(io::write_image(files.back().string(), ramp));
    }
    std::sort(files.begin(), files.end());
    REQUIRE(files.size() >= 15);
    for (const fs::path& file : files) {
        const std::string good = test::read_bytes(file);
        for (unsigned seed = 0; seed < mutations(300); ++seed) {
            Random random(seed);
            const fs::path bad = folder / "bad";
            test::write_bytes(bad, damage(good, random));
            CAPTURE(file.filename().string(), seed);
            const test::Watch watch;
            const auto image = io::read_image(bad.string(), scene::Encoding::srgb);
            if (image) {
                REQUIRE(image->values.size() == std::size_t{image->width} * image->height * image->channels);
                REQUIRE(
                    std::all_of(image->values.begin(), image->values.end(), [](float v) { return std::isfinite(v); }));
            } else {
                REQUIRE(image.error().message.find(bad.string()) != std::string::npos);
            }
            REQUIRE(watch.seconds() < limits.seconds);
            REQUIRE(watch.grown() < limits.megabytes);
        }
    }
}

TEST_CASE("mutations: OBJ, MTL, STL and glTF models") {
    const test::Importers importers;
    const test::Folder folder;
    const auto copy_good = [&] {
        for (const auto& entry : fs::directory_iterator(data_folder / "models"))
            test::write_bytes(folder / entry.path().filename().string(), test::read_bytes(entry.path()));
    };
    copy_good();
    // victim, and the file to open
    const std::array<std::array<const char*, 2>, 7> files = {{{"thing.obj", "thing.obj"},
                                                              {"thing.mtl", "thing.obj"},
                                                              {"thing.stl", "thing.stl"},
                                                              {"binary.stl", "binary.stl"},
                                                              {"thing.gltf", "thing.gltf"},
                                                              {"thing.bin", "thing.gltf"},
                                                              {"thing.glb", "thing.glb"}}};
    std::size_t loaded = 0, refused = 0;
    for (const auto& [victim, opened] : files) {
        copy_good();
        REQUIRE(io::import_scene((folder / opened).string(), importers.registry));
        const std::string good = test::read_bytes(folder / victim);
        for (unsigned seed = 0; seed < mutations(150); ++seed) {
            Random random(seed);
            test::write_bytes(folder / victim, damage(good, random));
            CAPTURE(victim, seed);
            const test::Watch watch;
            const auto result = io::import_scene((folder / opened).string(), importers.registry);
            ++(result ? loaded : refused);
            if (!result) {
                REQUIRE_FALSE(result.error().message.empty());
                REQUIRE(result.error().message.find("a bug, please report it") == std::string::npos);
            }
            REQUIRE(watch.seconds() < limits.seconds);
            REQUIRE(watch.grown() < limits.megabytes);
        }
    }
    CHECK(loaded > 50);
    CHECK(refused > 50);
}
