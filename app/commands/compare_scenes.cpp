// SPDX-License-Identifier: Apache-2.0
// restage compare A B for two scenes (files or projects): lists differences that affect the picture.
#include "commands/commands.hpp"
#include "document/session.hpp"
#include "io/scene_compare.hpp"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

namespace restage::app {

bool is_scene_file(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    constexpr const char* scenes[] = {".restage", ".pbrt", ".gltf", ".glb", ".obj", ".ply", ".stl"};
    return std::find(std::begin(scenes), std::end(scenes), extension) != std::end(scenes);
}

Result<int> compare_scenes(Context& context, const std::string& a, const std::string& b, bool json) {
    document::Session first(context.registry()), second(context.registry());
    RESTAGE_CHECK(first.open(a));
    RESTAGE_CHECK(second.open(b));
    const auto differences = io::structural_differences(first.scene(), second.scene(), context.registry());
    if (json) {
        const nlohmann::ordered_json out = {
            {"a", a}, {"b", b}, {"same", differences.empty()}, {"differences", differences}};
        std::printf("%s\n", out.dump(2).c_str());
        return differences.empty() ? exit_ok : exit_failed;
    }
    std::printf("%s\n", differences.empty() ? "the same scene" : "the scenes differ:");
    for (const std::string& line : differences)
        std::printf("  %s\n", line.c_str());
    return differences.empty() ? exit_ok : exit_failed;
}

} // namespace restage::app
