// SPDX-License-Identifier: Apache-2.0
// The two tracers agree on real scenes: the eleven of RESTAGE_SCENES (Bitterli's rendering resources as pbrt files),
// small and with few samples. Without RESTAGE_SCENES there is nothing to test; with it, every file must be there.
#include "io/import.hpp"
#include "render/agreement.hpp"

#include <catch2/generators/catch_generators.hpp>
#include <cstdlib>

using namespace restage;
using namespace restage::tests;

TEST_CASE("tracers agree: real scenes") {
    const char* folder = std::getenv("RESTAGE_SCENES");
    if (!folder || !*folder) SKIP("RESTAGE_SCENES is not set: the eleven real scenes are left out");
    const std::string name =
        GENERATE("coffee", "cornell-box", "dining-room", "kitchen", "living-room", "material-testball", "staircase2",
                 "teapot-full", "veach-bidir", "veach-mis", "water-caustic");
    const auto path = std::filesystem::path(folder) / name / "scene.pbrt";
    INFO(path.string());
    auto imported = io::import_scene(path.string(), plugins().registry);
    if (!imported) FAIL(imported.error().message);
    scene::Scene& scene = imported->scene;
    auto& film = scene.film.value;
    const float scale = 64.f / float(std::max(film.width, film.height));
    film.width = std::max(1u, std::uint32_t(std::lround(scale * float(film.width))));
    film.height = std::max(1u, std::uint32_t(std::lround(scale * float(film.height))));
    scene.film.version = ++scene.clock;
    const std::uint32_t spp = 16;
    const auto vulkan = trace_scene("vulkan", scene, spp, 1);
    const auto other = trace_scene("embree", scene, spp, 2);
    check_independent(vulkan.image, other.image);
    const auto same = trace_scene("embree", scene, spp, 1);
    const double alike = share_alike(vulkan.image, same.image);
    CHECK(alike >= 0.9);
}
