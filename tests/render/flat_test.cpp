// SPDX-License-Identifier: Apache-2.0
// A scene that hardly repeats its meshes is traced as triangles in world space, until an edit. An editor's never is.
#include "render/fixture.hpp"
#include "render/scene_builder.hpp"

using namespace restage;
using namespace restage::tests;

namespace {

// Three balls of a mesh each, 18,432 triangles, turned and sheared, over a floor under a sky.
SceneBuilder three_meshes() {
    SceneBuilder b;
    b.set_camera({0, -9, 3}, {0, 0, 0.6}, {0, 0, 1}, 35);
    b.instance(b.quad({-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0}), b.diffuse(0.6f, 0.6f, 0.5f));
    for (int i = 0; i < 3; ++i) {
        glm::dmat4 m(1);
        m[0] = {0.7, 0.1 * i, 0, 0};
        m[1] = {-0.2, 0.6, 0.1, 0};
        m[2] = {0, 0.1, 0.7 + 0.1 * i, 0};
        m[3] = {1.6 * i - 1.6, 0, 0.8, 1};
        b.instance(b.sphere(48, 64), b.diffuse(0.2f, 0.5f, 0.7f), m);
    }
    b.environment(glm::vec3(1, 1.1f, 1.3f));
    return b;
}

// Single samples differ where a ray meets an edge, or by rounding grows apart over the bounces.
void check_alike(const render::FilmImage& a, const render::FilmImage& b) {
    REQUIRE(a.color.size() == b.color.size());
    std::size_t apart = 0;
    for (std::size_t i = 0; i < a.color.size(); ++i)
        apart += glm::length(a.color[i] - b.color[i]) > 1e-3f * (1 + glm::length(a.color[i]));
    CHECK(double(apart) < 0.02 * double(a.color.size()));
}

} // namespace

TEST_CASE("a flat scene is the picture of its instances, before and after edits") {
    const auto flat = make_renderer("embree"), instances = make_renderer("embree", {.stand_ins = true});
    auto b = three_meshes();
    auto& scene = b.scene;
    const auto compare = [&] {
        flat->reset();
        const auto ours = render_image(*flat, scene, 4);
        // Another renderer's first picture may have stand-ins: it is taken once they are gone.
        REQUIRE(instances->sync(scene));
        do
            REQUIRE(instances->trace(1));
        while (instances->compiling());
        instances->reset();
        check_alike(ours, render_image(*instances, scene, 4));
        return ours;
    };
    const auto before = compare();
    const scene::Id<scene::Instance> id{std::uint32_t(scene.instances.size() - 1)}; // of a ball
    const auto original = scene.instances[id];
    auto moved = original;
    moved.object_to_world[3] = {2.4, 0.5, 1.1, 1};
    scene.instances.set(id, moved, ++scene.clock);
    compare();
    auto hidden = original;
    hidden.hidden = true;
    scene.instances.set(id, hidden, ++scene.clock);
    compare();
    scene.instances.set(id, original, ++scene.clock);
    check_alike(compare(), before);
    flat->forget_scene();
    flat->reset();
    const auto again = render_image(*flat, scene, 4); // new as a whole: flat once more
    double worst = 0;
    for (std::size_t i = 0; i < again.color.size(); ++i)
        worst = std::max(worst, double(glm::length(again.color[i] - before.color[i])));
    CHECK(worst == 0);
}

TEST_CASE("an empty scene shows nothing of the one before, flat or not") {
    auto balls = three_meshes();
    SceneBuilder few;
    few.set_camera({0, -9, 3}, {0, 0, 0.6}, {0, 0, 1}, 35);
    few.instance(few.quad({-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0}), few.diffuse(0.6f, 0.6f, 0.5f));
    few.environment(glm::vec3(1));
    for (SceneBuilder* before : {&balls, &few}) {
        const auto renderer = make_renderer("embree");
        render_image(*renderer, before->scene, 1);
        SceneBuilder b;
        b.set_camera({0, -9, 3}, {0, 0, 0.6}, {0, 0, 1}, 35);
        b.environment(glm::vec3(1, 2, 3));
        renderer->forget_scene();
        for (const glm::vec3& c : render_image(*renderer, b.scene, 1).color)
            REQUIRE((c == glm::vec3(1, 2, 3)));
    }
}
