// SPDX-License-Identifier: Apache-2.0
// LiveView: the newest scene wins, invisible changes restart nothing, and targets end the work.
#include "view/live_view.hpp"
#include "paths.hpp"
#include "render/fixture.hpp"
#include "render/scene_builder.hpp"

#include <chrono>
#include <functional>
#include <thread>

using namespace restage;
using namespace restage::tests;
using view::LiveView, view::ViewOptions, view::ViewState, view::ViewStatus;

namespace {

// A white floor under a white sky: the picture's mean is the sky's radiance.
struct Floor : SceneBuilder {
    scene::Id<scene::Instance> floor;
    Floor() {
        set_camera({0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 20);
        floor = instance(quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}), diffuse(1, 1, 1));
        shine(1);
    }
    void shine(float radiance) { environment(glm::vec3(radiance)); }
};

struct View {
    LiveView live;
    View()
        : live(plugins().registry, plugins().log,
               {.tracer = "embree", .shader_dir = restage::test::source_dir() / "shaders"}, [] {}) {}
    bool wait(const std::function<bool(const ViewStatus&)>& done) {
        for (int i = 0; i < 80000; ++i) { // ctest's limit comes first
            const ViewStatus status = live.status();
            if (status.state == ViewState::failed) FAIL(status.text);
            if (done(status)) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }
    bool finished() {
        return wait([](const ViewStatus& s) { return s.current && s.state == ViewState::done && s.compiling.empty(); });
    }
};

double mean(const view::Frame& frame) { return mean_luminance(frame.image).value; }

} // namespace

TEST_CASE("live view: a picture to its target, then another scene") {
    View view;
    Floor b;
    CHECK_FALSE(view.live.frame());
    const auto first = view.live.show(b.scene, {.size = {64, 48}, .denoise = false, .samples = 8});
    REQUIRE(view.finished());
    const auto frame = view.live.frame();
    REQUIRE(frame);
    CHECK(frame->request == first);
    CHECK(frame->divider == 1);
    CHECK((frame->image.width == 64 && frame->image.height == 48));
    CHECK(frame->image.samples == 8);
    CHECK(std::abs(mean(*frame) - 1) < 0.02);

    b.shine(3);
    const auto second = view.live.show(b.scene, {.size = {64, 48}, .denoise = false, .samples = 4});
    REQUIRE(view.finished());
    CHECK(view.live.frame()->request == second);
    CHECK(std::abs(mean(*view.live.frame()) - 3) < 0.06);
    CHECK(std::abs(mean(*frame) - 1) < 0.02); // pictures handed out are unchanged
}

TEST_CASE("live view: of many requests the last is shown finally, and no picture is a mixture") {
    View view;
    Floor b;
    std::uint64_t last = view.live.show(b.scene, {.size = {320, 240}, .denoise = false, .samples = 1});
    REQUIRE(view.finished()); // a stand-in, being dimmer than white, would look like a mixture
    for (int i = 2; i <= 40; ++i) {
        b.shine(float(i));
        last = view.live.show(b.scene, {.size = {320, 240}, .denoise = false, .samples = 1});
        if (i % 10 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(60));
        if (const auto frame = view.live.frame()) {
            const double radiance = mean(*frame);
            INFO("request " << frame->request << " shows " << radiance);
            CHECK(std::abs(radiance - double(frame->request)) < 0.05 * double(frame->request)); // numbered from 1
        }
    }
    REQUIRE(view.finished());
    CHECK(view.live.frame()->request == last);
    CHECK(std::abs(mean(*view.live.frame()) - 40) < 1);
}

TEST_CASE("live view: an invisible change continues the current picture") {
    View view;
    Floor b;
    const auto first = view.live.show(b.scene, {.size = {64, 48}, .denoise = false, .samples = 6});
    REQUIRE(view.finished());
    auto renamed = b.scene.instances[b.floor];
    renamed.name = "parquet";
    b.scene.instances.set(b.floor, renamed, ++b.scene.clock);
    auto material = b.scene.materials[renamed.material];
    material.name = "oak";
    b.scene.materials.set(renamed.material, material, ++b.scene.clock);
    SECTION("a bookmark") {
        scene::Camera other = b.scene.cameras[b.scene.active_camera.value];
        b.scene.cameras.set(b.scene.cameras.next(), other, ++b.scene.clock);
    }
    SECTION("the exposure, the development and the file's name") {
        b.scene.film.value.exposure = 2;
        b.scene.film.value.development = {.tone = scene::ToneCurve::agx, .bloom = 0.1f};
        b.scene.film.value.filename = "other.exr";
        b.scene.film.version = ++b.scene.clock;
    }
    view.live.show(b.scene, {.size = {64, 48}, .denoise = false, .samples = 12});
    REQUIRE(view.wait([](const ViewStatus& s) { return s.current && s.state == ViewState::done && s.samples == 12; }));
    CHECK(view.live.frame()->image.samples == 12);
    CHECK(view.live.frame()->request == first); // it was not restarted
}

TEST_CASE("live view: a visible change restarts") {
    View view;
    Floor b;
    const auto ball = b.instance(b.sphere(8, 16), b.diffuse(0.5f, 0.1f, 0.1f));
    const ViewOptions options{.size = {64, 48}, .denoise = false, .samples = 2};
    view.live.show(b.scene, options);
    REQUIRE(view.finished());
    const auto change = [&](const char* what, const std::function<void()>& edit) {
        INFO(what);
        edit();
        const auto request = view.live.show(b.scene, options);
        REQUIRE(view.finished());
        CHECK(view.live.frame()->request == request);
    };
    auto& s = b.scene;
    change("moved", [&] {
        auto i = s.instances[ball];
        i.object_to_world[3].x += 0.25;
        s.instances.set(ball, i, ++s.clock);
    });
    change("filtered", [&] {
        s.film.value.filter.radius = glm::vec2(3);
        s.film.version = ++s.clock;
    });
    change("hidden", [&] {
        auto i = s.instances[ball];
        i.hidden = true;
        s.instances.set(ball, i, ++s.clock);
    });
    change("shown", [&] {
        auto i = s.instances[ball];
        i.hidden = false;
        s.instances.set(ball, i, ++s.clock);
    });
    change("a value of its material", [&] {
        auto m = s.materials[s.instances[ball].material];
        m.params.set("reflectance", scene::Value::color(0.1f, 0.5f, 0.1f));
        s.materials.set(s.instances[ball].material, m, ++s.clock);
    });
    change("the type of its material", [&] {
        s.materials.set(s.instances[ball].material, scene::Material{.name = "gold", .type = "conductor"}, ++s.clock);
    });
    change("another material", [&] {
        auto i = s.instances[ball];
        i.material = b.diffuse(0.2f, 0.2f, 0.9f);
        s.instances.set(ball, i, ++s.clock);
    });
    change("a lamp", [&] {
        auto i = s.instances[ball];
        i.emission = scene::Emission{glm::vec3(2)};
        s.instances.set(ball, i, ++s.clock);
    });
    change("the sky", [&] { b.shine(2); });
    change("a light", [&] { b.light({.kind = scene::LightKind::point, .value = glm::vec3(5)}); });
    change("depth", [&] {
        s.settings.value.max_depth = 2;
        s.settings.version = ++s.clock;
    });
    change("the camera", [&] { b.set_camera({0, 1, 10}, {0, 0, 0}, {0, 1, 0}, 20); });
    change("deleted", [&] { s.instances.set(ball, {}, ++s.clock); });
}

TEST_CASE("live view: paused, it keeps the picture; resumed, it continues") {
    View view;
    Floor b;
    view.live.show(b.scene, {.size = {64, 48}, .denoise = false, .paused = true});
    REQUIRE(view.finished());
    const auto samples = view.live.frame()->image.samples;
    CHECK(samples == 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    CHECK(view.live.frame()->image.samples == samples);
    view.live.show(b.scene, {.size = {64, 48}, .denoise = false, .samples = 16});
    REQUIRE(view.wait([](const ViewStatus& s) { return s.current && s.state == ViewState::done && s.samples == 16; }));
}

TEST_CASE("live view: a large picture begins coarse and ends at full resolution") {
    View view;
    Floor b;
    view.live.show(b.scene, {.size = {1600, 1200}, .denoise = false, .samples = 1});
    REQUIRE(view.wait([](const ViewStatus& s) { return s.current; }));
    const auto first = view.live.frame();
    CHECK(first->divider > 1);
    CHECK(first->image.width == 1600 / first->divider);
    REQUIRE(view.finished());
    CHECK(view.live.frame()->divider == 1);
    CHECK(view.live.frame()->image.width == 1600);
}

TEST_CASE("live view: another tracer shows the same scene") {
    View view;
    Floor b;
    view.live.show(b.scene, {.size = {64, 48}, .denoise = false, .samples = 4});
    REQUIRE(view.finished());
    CHECK(view.live.status().tracer == "embree");
    view.live.configure({.tracer = "vulkan", .shader_dir = restage::test::source_dir() / "shaders"});
    REQUIRE(
        view.wait([](const ViewStatus& s) { return s.tracer == "vulkan" && s.current && s.state == ViewState::done; }));
    CHECK(std::abs(mean(*view.live.frame()) - 1) < 0.02);
    view.live.configure({.tracer = "none"});
    bool failed = false;
    for (int i = 0; i < 80000 && !failed; ++i) {
        failed = view.live.status().state == ViewState::failed;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    CHECK(failed);
    CHECK_FALSE(view.live.status().text.empty());
}
