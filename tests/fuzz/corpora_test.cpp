// SPDX-License-Identifier: Apache-2.0
// Every scene, model and picture of RESTAGE_CORPORA, RESTAGE_CASES, RESTAGE_SCENES and tests/data is opened: read or
// refused with a message. Intended for AddressSanitizer and UndefinedBehaviorSanitizer, which end the process at a
// finding.
#include "broken_files.hpp"
#include "io/image_file.hpp"
#include "io/import.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cstdio>
#include <cstdlib>
#include <map>

using namespace restage;
namespace fs = std::filesystem;

namespace {

constexpr std::array scene_endings = {".pbrt", ".gltf", ".glb", ".obj", ".ply", ".stl"};
constexpr std::array image_endings = {".png", ".jpg", ".jpeg", ".webp", ".tga", ".bmp", ".hdr", ".exr"};

template <class Endings>
bool is_one_of(const std::string& ending, const Endings& endings) {
    return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

struct Count {
    int opened = 0, refused = 0;
};

} // namespace

TEST_CASE("every file of the corpora opens, or is refused with a message", "[corpora]") {
    const test::Importers importers;
    std::map<std::string, Count> counts;
    for (const char* variable : {"RESTAGE_CORPORA", "RESTAGE_CASES", "RESTAGE_SCENES", ""}) {
        const char* folder = *variable ? std::getenv(variable) : test::data_folder.c_str();
        if (!folder) continue;
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            if (!entry.is_regular_file()) continue;
            std::string ending = entry.path().extension().string();
            std::transform(ending.begin(), ending.end(), ending.begin(),
                           [](unsigned char c) { return std::tolower(c); });
            const std::string path = entry.path().string();
            CAPTURE(path);
            std::string error;
            if (is_one_of(ending, scene_endings)) {
                if (const auto scene = io::import_scene(path, importers.registry); !scene)
                    error = scene.error().message;
                else
                    ++counts[ending].opened;
            } else if (is_one_of(ending, image_endings)) {
                if (const auto image = io::read_image(path, scene::Encoding::srgb); !image)
                    error = image.error().message;
                else
                    ++counts[ending].opened;
            } else {
                continue;
            }
            if (!error.empty()) {
                ++counts[ending].refused;
                CAPTURE(error); // names the file, or an included one in the same folder
                CHECK(error.find(entry.path().parent_path().filename().string()) != std::string::npos);
                CHECK(error.find("a bug, please report it") == std::string::npos);
            }
        }
    }
    CHECK(counts[".pbrt"].opened > 0);
    for (const auto& [ending, count] : counts)
        std::printf("%s: %d opened, %d refused\n", ending.c_str(), count.opened, count.refused);
}
