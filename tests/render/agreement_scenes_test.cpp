// SPDX-License-Identifier: Apache-2.0
// The two tracers agree on real scenes: the eleven of RESTAGE_SCENES (Bitterli's rendering resources as pbrt files),
// small and with few samples. Without RESTAGE_SCENES there is nothing to test; with it, every file must be there.
#include "io/import.hpp"
#include "render/agreement.hpp"

#include <cstdlib>

using namespace restage;
using namespace restage::tests;

namespace {

void check_scene(const std::string& name) {
    const char* folder = std::getenv("RESTAGE_SCENES");
    if (!folder || !*folder) SKIP("RESTAGE_SCENES is not set: the eleven real scenes are left out");
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

} // namespace

// A case a scene: with cold caches each compiles for up to a minute.
#define REAL_SCENE(name) \
    TEST_CASE("tracers agree: real scene " name) { check_scene(name); }

REAL_SCENE("coffee")
REAL_SCENE("cornell-box")
REAL_SCENE("dining-room")
REAL_SCENE("kitchen")
REAL_SCENE("living-room")
REAL_SCENE("material-testball")
REAL_SCENE("staircase2")
REAL_SCENE("teapot-full")
REAL_SCENE("veach-bidir")
REAL_SCENE("veach-mis")
REAL_SCENE("water-caustic")
