// SPDX-License-Identifier: Apache-2.0
// The render region of the live picture: only it changes, at full resolution, and the whole picture comes back after
// it.
#include "paths.hpp"
#include "render/fixture.hpp"
#include "render/scene_builder.hpp"
#include "view/live_view.hpp"
#include "view/region.hpp"

#include <chrono>
#include <thread>

using namespace restage;
using namespace restage::tests;
using view::LiveView, view::ViewState;

namespace {

void finish(LiveView& live) {
    for (int i = 0; i < 30000; ++i) { // ctest's limit comes first
        const view::ViewStatus status = live.status();
        if (status.state == ViewState::failed) FAIL(status.text);
        if (status.current && status.state == ViewState::done && status.compiling.empty()) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    FAIL("it was never done");
}

} // namespace

TEST_CASE("live view: only the region is refined, and the rest stays as it was", "[region]") {
    LiveView live(plugins().registry, plugins().log,
                  {.tracer = "embree", .shader_dir = restage::test::source_dir() / "shaders"}, [] {});
    SceneBuilder b;
    b.set_camera({0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 20);
    b.instance(b.quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}), b.diffuse(0.5f, 0.5f, 0.5f));
    b.environment(glm::vec3(1));
    view::ViewOptions options{.size = {64, 48}, .denoise = false, .samples = 2};
    live.show(b.scene, options);
    finish(live);
    const auto before = live.frame();
    REQUIRE(before);

    b.environment(glm::vec3(3)); // outside the region it stays dark
    options.region = glm::vec4(0.25f, 0.5f, 0.5f, 1); // x 16 to 32, y 24 to 48
    options.samples = 8;
    const auto request = live.show(b.scene, options);
    finish(live);
    const auto during = live.frame();
    REQUIRE(during->request == request);
    REQUIRE((during->image.width == 64 && during->image.height == 48));
    CHECK(during->divider == 1);
    CHECK(during->image.samples == 8);
    std::size_t wrong = 0;
    for (std::uint32_t y = 0; y < 48; ++y)
        for (std::uint32_t x = 0; x < 64; ++x) {
            const std::size_t i = std::size_t{y} * 64 + x;
            const bool inside = x >= 16 && x < 32 && y >= 24;
            const glm::vec3 c = during->image.color[i], was = before->image.color[i];
            wrong += inside ? !(std::abs(c.x - 1.5f) < 0.15f) : !(c == was);
            wrong += during->counts[i] != (inside ? 8u : before->counts[i]);
            wrong += during->image.instance_id[i] != before->image.instance_id[i];
        }
    CHECK(wrong == 0);

    // Another region leaves the first as it is now.
    options.region = glm::vec4(0.5f, 1, 0, 1);
    live.show(b.scene, options);
    finish(live);
    CHECK(live.frame()->image.color[30 * 64 + 20] == during->image.color[30 * 64 + 20]);
    CHECK(std::abs(live.frame()->image.color[30 * 64 + 40].x - 1.5f) < 0.15f);
    CHECK(std::abs(live.frame()->image.color[10 * 64 + 10].x - 0.5f) < 0.15f);

    options.region.reset();
    live.show(b.scene, options);
    finish(live);
    CHECK(live.frame()->counts.size() == 64u * 48);
    CHECK(std::abs(live.frame()->image.color[10 * 64 + 10].x - 1.5f) < 0.15f);
}

TEST_CASE("a part is put into a picture of another size", "[region]") {
    render::FilmImage around = render::FilmImage::blank(2, 1), part = render::FilmImage::blank(2, 2);
    around.color = {glm::vec3(1), glm::vec3(2)};
    part.color.assign(4, glm::vec3(9));
    part.samples = 5;
    const render::FilmImage whole = view::with_part(around, {4, 4}, part, {3, 1}); // a column of it is outside
    CHECK(whole.samples == 5);
    REQUIRE(whole.color.size() == 16);
    CHECK(whole.depth.size() == 16);
    const float expected[4][4] = {{1, 1, 2, 2}, {1, 1, 2, 9}, {1, 1, 2, 9}, {1, 1, 2, 2}};
    for (std::size_t i = 0; i < 16; ++i)
        CHECK(whole.color[i].x == expected[i / 4][i % 4]);
    CHECK(view::with_part({}, {0, 0}, {2, 1}, {7}, {1, 1}, {1, 0}) == std::vector<std::uint32_t>{0, 7});
}
