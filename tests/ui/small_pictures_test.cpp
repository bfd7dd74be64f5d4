// SPDX-License-Identifier: Apache-2.0
// The queue of small pictures: the latest batch first, coarse before full, nothing while held; and balls beside a
// picture that is refined.
#include "editor/small_pictures.hpp"
#include "editor/material_balls.hpp"
#include "headless.hpp"
#include "temporary_folder.hpp"

#include <atomic>
#include <utility>
#include <vector>

using namespace restage;
using editor::SmallPictures;

namespace {

scene::Scene grey_ball() {
    scene::Scene s;
    scene::apply(s, scene::insert(s, scene::Material{.name = "grey", .type = "diffuse"}, ""));
    scene::Scene ball = editor::ball_scene(s, {1});
    ball.film.value.width = ball.film.value.height = 8;
    return ball;
}

// What is made until `count` pictures are: number and whether it is coarse.
std::vector<std::pair<std::uint64_t, bool>> wait_for(SmallPictures& pictures, std::size_t count) {
    std::vector<std::pair<std::uint64_t, bool>> order;
    const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(3);
    while (order.size() < count && std::chrono::steady_clock::now() < limit) {
        for (const SmallPictures::Made& made : pictures.take())
            order.emplace_back(made.number, made.coarse);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return order;
}

} // namespace

TEST_CASE("small pictures: the latest batch first, coarse before full, nothing while held", "[ui]") {
    Log log{[](LogLevel, std::string_view) {}};
    plugin::Registry registry{log, io::with_services()};
    registry.scan(std::vector<plugin::SearchPath>{{test::build_dir() / "lib/restage/plugins", true}});
    render::RendererOptions options;
    options.tracer = "embree";
    options.shader_dir = test::source_dir() / "shaders";
    std::atomic<int> prepared = 0;
    SmallPictures pictures([] {});
    const auto ask = [&](std::uint64_t number, std::uint64_t batch, bool wanted = true) {
        SmallPictures::Job job{.number = number, .scene = {}, .samples = 4, .coarse = 1, .batch = batch};
        job.prepare = [&prepared, wanted](scene::Scene& scene) -> Result<bool> {
            scene = grey_ball();
            ++prepared;
            return wanted;
        };
        pictures.ask({registry, log, options}, std::move(job));
    };
    pictures.hold(true);
    ask(1, 7);
    ask(2, 7);
    ask(3, 8);
    ask(4, 8);
    ask(5, 6, false);
    using Order = std::vector<std::pair<std::uint64_t, bool>>;
    CHECK(wait_for(pictures, 1) == Order{{5, false}}); // found elsewhere, though held
    while (prepared < 5)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    CHECK(pictures.take().empty());
    pictures.drop(4);
    pictures.hold(false);
    CHECK(wait_for(pictures, 6) == Order{{3, true}, {1, true}, {2, true}, {3, false}, {1, false}, {2, false}});
}

TEST_CASE("balls appear while the picture is still refined", "[ui][presets]") {
    const test::TemporaryFolder folder;
    tests::Headless h("demo/demo.pbrt", 1, {1500, 1000}, folder.path());
    h.editor().view.resolution = 0.3f;
    h.editor().view.samples = 1u << 20;
    double seconds[2] = {};
    h.play("balls", [&](ImGuiTestContext* ctx) {
        const view::LiveView& live = h.editor().live();
        const auto refines = [&] {
            const view::ViewStatus status = live.status();
            return status.current && status.divider == 1 && status.state == view::ViewState::rendering;
        };
        const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(3);
        while (!refines() && std::chrono::steady_clock::now() < limit)
            ctx->Yield();
        h.focus(ctx, "Materials");
        const auto start = std::chrono::steady_clock::now();
        for (std::size_t i = 0; i < 2; ++i) {
            h.wait_for(ctx, std::string("materials.ball.") + (i == 0 ? "Plaster" : "Ceiling paint"));
            seconds[i] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        }
        IM_CHECK(refines());
    });
    CAPTURE(seconds[0], seconds[1]);
    CHECK(seconds[0] <= seconds[1]);
}
