// SPDX-License-Identifier: Apache-2.0
// Looks of first hits in the live picture: they replace it while they are asked for, and it continues afterwards.
#include "paths.hpp"
#include "render/fixture.hpp"
#include "render/renderer.hpp"
#include "render/scene_builder.hpp"
#include "view/live_view.hpp"
#include "view/pictures.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

using namespace restage;
using namespace restage::tests;
using render::ClayLook;
using view::Frame, view::LiveView, view::Pictures;
using FramePtr = std::shared_ptr<const Frame>;

namespace {

struct Wall : SceneBuilder { // one quad, which fills the picture: two triangles
    Wall() {
        instance(quad({-4, -4, 4}, {4, -4, 4}, {4, 4, 4}, {-4, 4, 4}), diffuse(0.7f, 0.7f, 0.7f), glm::dmat4(1),
                 scene::Emission{glm::vec3(1)});
        set_camera({0, 0, 0}, {0, 0, 4}, {0, 1, 0}, 40);
    }
};

render::RendererOptions embree() {
    render::RendererOptions options;
    options.tracer = "embree";
    options.shader_dir = restage::test::source_dir() / "shaders";
    return options;
}

FramePtr wait(LiveView& live, const std::function<bool(const Frame&)>& done) {
    for (int i = 0; i < 60000; ++i) { // ctest's limit comes first
        if (const auto status = live.status(); status.state == view::ViewState::failed) FAIL(status.text);
        if (const auto now = live.best(false); now && done(*now)) return now;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    FAIL("no such picture");
    return nullptr;
}

std::size_t dark(const render::FilmImage& image) {
    return std::size_t(std::ranges::count_if(image.color, [](const glm::vec3& c) { return c.r < 0.2f; }));
}

} // namespace

TEST_CASE("looks: which picture is shown") {
    const auto frame = [](std::uint64_t request, std::optional<ClayLook> look, bool clay) {
        auto f = std::make_shared<Frame>();
        f->request = request;
        f->document = 1;
        f->look = look;
        f->clay = clay;
        return f;
    };
    Pictures p;
    p.ask(1, false);
    const auto raw = frame(1, {}, false), wires = frame(2, ClayLook::wires, true);
    p.put(raw);
    p.ask(1, false, ClayLook::wires);
    CHECK(p.best(false) == raw); // until there is one
    p.put(frame(2, {}, true)); // the preview of an opened scene is not what was asked for
    CHECK(p.best(false) == raw);
    p.put(wires);
    CHECK(p.best(false) == wires);
    CHECK(p.best(true) == wires);
    CHECK(p.of_look() == wires);
    p.ask(1, false, ClayLook::uv);
    CHECK(p.best(false) == raw);
    p.ask(1, false);
    CHECK(p.best(false) == raw);
    CHECK_FALSE(p.of_look());
}

TEST_CASE("looks: the picture continues after one as if nothing had been") {
    LiveView live(plugins().registry, plugins().log, embree(), [] {});
    Wall b;
    view::ViewOptions options{.size = {96, 64}, .denoise = false, .samples = 3};
    const auto first = live.show(b.scene, options);
    const auto before = wait(live, [](const Frame& f) { return !f.clay && f.divider == 1 && f.image.samples == 3; });
    CHECK(before->counts == std::vector<std::uint32_t>(96 * 64, 3));
    for (const ClayLook look : {ClayLook::wires, ClayLook::uv}) {
        options.look = look;
        const auto asked = live.show(b.scene, options);
        const auto seen = wait(live, [&](const Frame& f) { return f.look == look && f.divider == 1; });
        CHECK(seen->request == asked);
        CHECK(seen->image.width == 96);
        while (!live.status().current)
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    options.look.reset();
    live.show(b.scene, options);
    const auto after = live.best(false);
    REQUIRE(after);
    CHECK(after == before); // at once, not a picture that starts again
    options.samples = 5; // the same film goes on
    live.show(b.scene, options);
    const auto more = wait(live, [](const Frame& f) { return f.image.samples == 5; });
    CHECK(more->request == first);
}

TEST_CASE("looks: a change of the scene while one is shown") {
    LiveView live(plugins().registry, plugins().log, embree(), [] {});
    Wall b;
    view::ViewOptions options{.size = {96, 64}, .denoise = false, .samples = 2};
    live.show(b.scene, options);
    wait(live, [](const Frame& f) { return !f.clay && f.divider == 1 && f.image.samples == 2; });
    options.look = ClayLook::clay;
    b.set_camera({0, 0, 0}, {4, 0, 0}, {0, 1, 0}, 40); // past the wall
    const auto asked = live.show(b.scene, options);
    const auto seen = wait(live, [&](const Frame& f) { return f.look && f.request == asked; });
    CHECK(std::ranges::count(seen->image.instance_id, 0u) > 0);
    options.look.reset();
    const auto back = live.show(b.scene, options);
    const auto picture = wait(live, [&](const Frame& f) { return !f.clay && f.request >= back && f.divider == 1; });
    CHECK(picture->image.instance_id == seen->image.instance_id);
}

TEST_CASE("looks: wires are the edges of triangles, chequers follow texture coordinates") {
    LiveView live(plugins().registry, plugins().log, embree(), [] {});
    Wall b;
    view::ViewOptions options{.size = {96, 96}, .denoise = false, .look = ClayLook::clay};
    live.show(b.scene, options);
    const auto clay = wait(live, [](const Frame& f) { return f.look == ClayLook::clay; });
    CHECK(dark(clay->image) == 0);
    options.look = ClayLook::wires;
    live.show(b.scene, options);
    const auto wires = wait(live, [](const Frame& f) { return f.look == ClayLook::wires; });
    CHECK(wires->image.instance_id == clay->image.instance_id);
    const std::size_t diagonal = dark(wires->image); // of the quad
    CHECK(diagonal >= 90);
    CHECK(diagonal <= 300);
    options.look = ClayLook::uv;
    live.show(b.scene, options);
    const auto uv = wait(live, [](const Frame& f) { return f.look == ClayLook::uv; });
    CHECK(uv->image.color != clay->image.color);
}
