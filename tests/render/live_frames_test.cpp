// SPDX-License-Identifier: Apache-2.0
// The pictures seen by a user of the editor: every picture that LiveView offers is recorded and checked. With denoising
// on none is noisy, dark, of another document, older than one shown before, or a mixture of two scenes.
#include "io/image_file.hpp"
#include "paths.hpp"
#include "render/fixture.hpp"
#include "render/scene_builder.hpp"
#include "temporary_folder.hpp"
#include "view/live_view.hpp"
#include "view/pictures.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <thread>

using namespace restage;
using namespace restage::tests;
using view::Frame, view::LiveView, view::Pictures, view::ViewOptions, view::ViewState;
using FramePtr = std::shared_ptr<const Frame>;

namespace {

double luminance(const glm::vec3& c) { return glm::dot(glm::dvec3(c), glm::dvec3(0.2126, 0.7152, 0.0722)); }

double mean(const Frame& frame) {
    double sum = 0;
    for (const auto& c : frame.image.color)
        sum += luminance(c);
    return sum / double(frame.image.color.size());
}

// Deviation of pixels of a flat surface from the mean of their neighbours, in units of the mean: 0 for a gradient.
double noise(const Frame& frame) {
    const render::FilmImage& image = frame.image;
    double sum = 0, n = 0;
    for (std::size_t y = 0; y < image.height; ++y)
        for (std::size_t x = 1; x + 1 < image.width; ++x) {
            const std::size_t i = y * image.width + x;
            if (image.instance_id[i] != image.instance_id[i - 1] || image.instance_id[i] != image.instance_id[i + 1])
                continue;
            if (glm::dot(image.normal[i - 1], image.normal[i + 1]) < 0.98f) continue;
            sum += std::abs(luminance(image.color[i]) -
                            (luminance(image.color[i - 1]) + luminance(image.color[i + 1])) / 2);
            ++n;
        }
    return n > 0 ? sum / n / std::max(mean(frame), 1e-9) : 0;
}

// With RESTAGE_FRAMES_DIR set, pictures are left there for inspection.
void keep(const Frame& frame, const std::string& name) {
    const char* folder = std::getenv("RESTAGE_FRAMES_DIR");
    if (!folder) return;
    scene::PixelData pixels{.width = frame.image.width, .height = frame.image.height, .channels = 3, .values = {}};
    for (const auto& c : frame.image.color)
        pixels.values.insert(pixels.values.end(), {c.r, c.g, c.b});
    CHECK(io::write_png((std::filesystem::path(folder) / (name + ".png")).string(), pixels, -1));
}

// The horizontal position of the pixels selected by `in`, 0..1; -1 = none.
double place(const Frame& frame, const std::function<bool(std::size_t)>& in) {
    double sum = 0, n = 0;
    for (std::size_t i = 0; i < frame.image.color.size(); ++i)
        if (in(i)) {
            sum += (double(i % frame.image.width) + 0.5) / frame.image.width;
            ++n;
        }
    return n > 0 ? sum / n : -1;
}

// A grey room whose lamp lights the ceiling: nearly all light is indirect, one sample per pixel is mostly noise.
struct Room : SceneBuilder {
    scene::Id<scene::Instance> ball;
    scene::Id<scene::Material> red;
    Room() {
        const auto grey = diffuse(0.7f, 0.7f, 0.7f);
        const auto wall = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) { instance(quad(a, b, c, d), grey); };
        wall({-2, 0, -2}, {2, 0, -2}, {2, 0, 4}, {-2, 0, 4});
        wall({-2, 2, -2}, {2, 2, -2}, {2, 2, 4}, {-2, 2, 4});
        wall({-2, 0, 4}, {2, 0, 4}, {2, 2, 4}, {-2, 2, 4});
        wall({-2, 0, -2}, {2, 0, -2}, {2, 2, -2}, {-2, 2, -2});
        wall({-2, 0, -2}, {-2, 0, 4}, {-2, 2, 4}, {-2, 2, -2});
        wall({2, 0, -2}, {2, 0, 4}, {2, 2, 4}, {2, 2, -2});
        instance(quad({-.5f, 1.8f, 1.5f}, {-.5f, 1.8f, 2.5f}, {.5f, 1.8f, 2.5f}, {.5f, 1.8f, 1.5f}), grey,
                 glm::dmat4(1), scene::Emission{glm::vec3(40)});
        red = diffuse(0.9f, 0.02f, 0.02f);
        ball = instance(sphere(16, 32), red, at(-1));
        set_camera({0, 1, -1.8}, {0, 0.9, 4}, {0, 1, 0}, 60);
        scene.settings.value.max_depth = 6;
    }
    static glm::dmat4 at(double x) {
        return glm::scale(glm::translate(glm::dmat4(1), glm::dvec3(x, 0.5, 2)), glm::dvec3(0.5));
    }
    void move_ball(double x) {
        auto i = scene.instances[ball];
        i.object_to_world = at(x);
        scene.instances.set(ball, i, ++scene.clock);
    }
    void color_ball(glm::vec3 color) {
        auto m = scene.materials[red];
        m.params.set("reflectance", scene::Value::color(color.r, color.g, color.b));
        scene.materials.set(red, m, ++scene.clock);
    }
};

class Recorder {
  public:
    explicit Recorder(render::RendererOptions options = {})
        : live(plugins().registry, plugins().log, with(std::move(options)), [this] { look(); }) {
        self_ = this;
    }
    void look() {
        if (!self_) return; // before `live` exists
        const std::lock_guard lock(mutex_);
        const FramePtr now = live.best(true);
        if (now && (frames_.empty() || frames_.back() != now)) frames_.push_back(now);
        compiled_.insert(live.status().compiling);
    }
    // The type being compiled, at each notification.
    bool said(const std::string& type) {
        const std::lock_guard lock(mutex_);
        return compiled_.contains(type);
    }
    std::set<std::string> compiled() {
        const std::lock_guard lock(mutex_);
        return compiled_;
    }
    std::vector<FramePtr> frames() {
        look();
        const std::lock_guard lock(mutex_);
        return frames_;
    }
    // Until the shown picture satisfies this.
    FramePtr wait(const std::function<bool(const Frame&)>& done) {
        for (int i = 0; i < 160000; ++i) { // ctest's limit comes first
            if (const auto status = live.status(); status.state == ViewState::failed) FAIL(status.text);
            if (const auto all = frames(); !all.empty() && done(*all.back())) return all.back();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        FAIL("no such picture");
        return nullptr;
    }
    FramePtr wait_clean(std::uint64_t request, std::uint32_t divider = 1) {
        return wait([&](const Frame& f) { return f.denoised && f.request >= request && f.divider <= divider; });
    }

  private:
    static render::RendererOptions with(render::RendererOptions options) {
        options.tracer = "embree";
        options.shader_dir = restage::test::source_dir() / "shaders";
        return options;
    }
    std::atomic<Recorder*> self_ = nullptr;
    std::mutex mutex_;
    std::vector<FramePtr> frames_;
    std::set<std::string> compiled_;

  public:
    LiveView live; // last: its threads call look() until it is destroyed
};

bool can_denoise() {
    const auto& denoisers = plugins().registry.denoisers();
    return !denoisers.empty() && denoisers[0].table->available();
}

constexpr ViewOptions view_options{.size = {240, 180}, .samples = 4};

} // namespace

TEST_CASE("live frames: which of the rendered pictures are shown") {
    const auto frame = [](std::uint64_t request, std::uint64_t document, bool denoised, bool clay = false) {
        auto f = std::make_shared<Frame>();
        f->request = request;
        f->document = document;
        f->denoised = denoised;
        f->clay = clay;
        return f;
    };
    Pictures p;
    CHECK_FALSE(p.best(true));
    p.ask(1, true);
    const auto clay = frame(1, 1, false, true), raw = frame(1, 1, false), clean = frame(1, 1, true);
    p.put(clay);
    CHECK(p.best(true) == clay);
    CHECK(p.best(false) == clay);
    p.put(raw);
    CHECK(p.best(true) == clay); // not the noise
    CHECK(p.best(false) == raw);
    p.put(clean);
    CHECK(p.best(true) == clean);
    p.ask(1, true); // an edit
    p.put(frame(2, 1, false));
    for (int i = 3; i < 100; ++i)
        p.put(frame(i, 1, false));
    CHECK(p.best(true) == clean); // no matter how late the next clean one is
    p.denoiser("it failed");
    CHECK(p.best(true)->request == 99);
    p.denoiser("");
    CHECK(p.best(true) == clean);
    p.ask(1, false); // denoising off
    CHECK(p.best(true)->request == 99);
    p.ask(2, true); // another scene: nothing of the old one, not even late pictures
    CHECK_FALSE(p.best(true));
    CHECK_FALSE(p.best(false));
    p.put(frame(100, 1, true));
    CHECK_FALSE(p.best(true));
    CHECK_FALSE(p.clean());
    p.put(frame(101, 2, false, true));
    CHECK(p.best(true)->request == 101);
}

TEST_CASE("live frames: ten user actions, and every picture of them") {
    if (!can_denoise()) SKIP("no denoiser is installed");
    Recorder r;
    Room b;
    std::uint64_t last = r.live.show(b.scene, view_options);
    r.wait_clean(last);
    const FramePtr raw = r.live.frame();
    REQUIRE(raw->image.samples >= 1);

    struct Do {
        const char* what;
        std::vector<std::function<void()>> steps;
    };
    auto& s = b.scene;
    const scene::Scene before = s;
    scene::Id<scene::Instance> copy;
    std::vector<Do> all;
    const auto steps = [](int n, const std::function<void(int)>& step) {
        std::vector<std::function<void()>> list;
        for (int i = 1; i <= n; ++i)
            list.push_back([step, i] { step(i); });
        return list;
    };
    all.push_back({"drag", steps(8, [&](int i) { b.move_ball(-1 + 0.25 * i); })});
    all.push_back({"orbit", steps(6, [&](int i) {
                       const double a = 0.05 * i;
                       b.set_camera({std::sin(a), 1, -1.8 + 0.1 * i}, {0, 0.9, 3}, {0, 1, 0}, 60);
                   })});
    all.push_back({"zoom", steps(4, [&](int i) { b.set_camera({0, 1, -1.8 + 0.2 * i}, {0, 0.9, 4}, {0, 1, 0}, 60); })});
    all.push_back({"material type", steps(1, [&](int) {
                       s.materials.set(b.red, scene::Material{.name = "gold", .type = "conductor"}, ++s.clock);
                   })});
    all.push_back({"colour", steps(6, [&](int i) {
                       s.materials.set(b.red, before.materials[b.red], ++s.clock);
                       b.color_ball({0.9f - 0.1f * float(i), 0.1f * float(i), 0.05f});
                   })});
    all.push_back({"sky", steps(1, [&](int) { b.environment(glm::vec3(1)); })});
    all.push_back(
        {"duplicate", steps(1, [&](int) { copy = b.instance(s.instances[b.ball].mesh, b.red, Room::at(-1)); })});
    all.push_back({"delete", steps(1, [&](int) { s.instances.set(copy, {}, ++s.clock); })});
    all.push_back({"undo", steps(1, [&](int) { b.move_ball(-1); })});
    for (const Do& one : all) {
        INFO(one.what);
        const std::size_t first = r.frames().size();
        for (const auto& step : one.steps) {
            step();
            last = r.live.show(s, view_options);
            for (int i = 0; i < 4000 && r.live.frame()->request < last && !r.live.status().current; ++i)
                std::this_thread::sleep_for(std::chrono::milliseconds(1)); // as fast as pictures come
        }
        const FramePtr end = r.wait_clean(last);
        const auto frames = r.frames();
        CHECK(frames.size() > first); // it was shown at least once
        for (std::size_t i = first; i < frames.size(); ++i) {
            const Frame& f = *frames[i];
            INFO("picture " << i - first << " of request " << f.request << ", " << f.image.width << "x"
                            << f.image.height << ", mean " << mean(f) << ", noise " << noise(f));
            keep(f, std::string(one.what) + "-" + std::to_string(100 + i - first));
            CHECK(f.denoised);
            CHECK(f.request >= frames[i - 1]->request); // never back to an older scene
            CHECK((f.request > frames[i - 1]->request || f.divider <= frames[i - 1]->divider)); // only ever finer
            CHECK(noise(f) < 0.15);
            CHECK(f.image.width * f.image.height >= 3000);
            CHECK(mean(f) > 0.5 * std::min(mean(*end), mean(*frames[first - 1])));
            CHECK(mean(f) < 2 * std::max(mean(*end), mean(*frames[first - 1])));
        }
    }
    // The test can fail: a raw picture of one sample is far above the limit.
    Recorder noisy;
    noisy.live.show(before, {.size = view_options.size, .denoise = false, .samples = 1});
    const auto one = noisy.wait([](const Frame& f) { return !f.clay; });
    CHECK_FALSE(one->denoised);
    CHECK(noise(*one) > 0.3);
}

TEST_CASE("live frames: during a drag no picture is a mixture of two scenes") {
    if (!can_denoise()) SKIP("no denoiser is installed");
    Recorder r;
    Room b;
    std::vector<double> where(1, 0); // the ball's place, by request
    const auto show = [&](double x) {
        b.move_ball(x);
        const auto request = r.live.show(b.scene, view_options);
        where.resize(request + 1, x);
        where[request] = x;
        return request;
    };
    std::uint64_t last = show(-1);
    r.wait_clean(last);
    for (int i = 1; i <= 12; ++i) {
        last = show(-1 + i / 6.0);
        if (i % 3 == 0) r.wait_clean(last, 16);
    }
    r.wait_clean(last);
    for (const FramePtr& f : r.frames()) {
        if (f->clay) continue;
        const double ids = place(*f, [&](std::size_t i) { return f->image.instance_id[i] == b.ball.value; });
        const double red = place(*f, [&](std::size_t i) {
            const glm::vec3 c = f->image.color[i];
            return c.r > 3 * c.g && c.r > 3 * c.b;
        });
        // In the camera's view: z = 3.8 away, 60 degrees over the height.
        const double expected = 0.5 + where[f->request] / (2 * 3.8 * std::tan(0.5236) * 240 / 180);
        INFO("request " << f->request << ", " << f->image.width << " wide: ids " << ids << ", red " << red << ", "
                        << expected);
        const double pixel = 1.0 / f->image.width;
        CHECK(std::abs(ids - expected) < 0.02 + pixel);
        CHECK(std::abs(red - expected) < 0.03 + pixel);
    }
}

TEST_CASE("live frames: another document begins with clay, and nothing of the old one") {
    Recorder r;
    Room first;
    first.scene.film.value.exposure = 1;
    auto options = view_options;
    options.document = 1;
    auto last = r.live.show(first.scene, options);
    r.wait([&](const Frame& f) { return !f.clay && f.divider == 1; });
    Room second;
    second.move_ball(1);
    second.set_camera({0, 1, -1.8}, {0, 0.9, 4}, {0, 1, 0}, 80);
    // A type that no picture has used yet: its shader is compiled.
    second.scene.materials.set(second.red, scene::Material{.name = "wax", .type = "coateddiffuse"},
                               ++second.scene.clock);
    options = {.size = {120, 200}, .document = 2, .samples = 4};
    const auto asked = r.live.show(second.scene, options);
    const FramePtr at_once = r.live.best(true); // content of the window's next frame
    CHECK((!at_once || at_once->document == 2));
    r.wait([&](const Frame& f) { return f.request == asked && !f.clay && f.divider == 1; });
    const auto all = r.frames();
    std::size_t i = 0;
    while (all[i]->document != 2)
        ++i;
    const Frame& clay = *all[i];
    REQUIRE(clay.clay);
    CHECK(clay.request > last);
    CHECK(std::abs(double(clay.image.width) / clay.image.height - 0.6) < 0.02); // its own shape, not the old one's
    double dark = 0, ball = 0;
    for (std::size_t k = 0; k < clay.image.color.size(); ++k) {
        dark += clay.image.depth[k] > 0 && luminance(clay.image.color[k]) < 0.05;
        ball += clay.image.instance_id[k] == second.ball.value;
    }
    CHECK(dark == 0);
    CHECK(ball > 0.01 * double(clay.image.color.size()));
    // Then real pictures, all of them of the new document, none with a stand-in.
    for (++i; i < all.size(); ++i) {
        CHECK(all[i]->document == 2);
        if (all[i]->clay) continue;
        CHECK((all[i]->denoised || !can_denoise()));
        const double material = place(*all[i], [&](std::size_t k) {
            return all[i]->image.material_id[k] == second.red.value && luminance(all[i]->image.color[k]) < 1e-4;
        });
        CHECK(material == -1); // nothing of it is black
    }
}

// A type not used before, in an open document: the shader is compiled while rendering continues.
TEST_CASE("live frames: a new type of material shows its colour immediately, and the status names the compiling type") {
    const test::TemporaryFolder cache; // nothing is compiled yet
    Recorder r({.cache_dir = cache.path()});
    Room room;
    r.live.show(room.scene, view_options);
    r.wait([&](const Frame& f) { return !f.clay && f.divider == 1; });
    scene::Material wax{.name = "wax", .type = "coateddiffuse"};
    double most_red = 0.5; // of the mean colour, where the ball is seen
    SECTION("of one colour") {
        wax.params.set("reflectance", scene::Value::color(0.05f, 0.8f, 0.05f));
        most_red = 0.4;
    }
    SECTION("textured") { // a texture's constant is not its colour
        const auto green = room.image(1, 1, 3, {0.05f, 0.8f, 0.05f});
        const auto texture = room.scene.textures.next();
        room.scene.textures.set(texture, scene::Texture{.name = "green", .type = "imagemap", .image = green},
                                ++room.scene.clock);
        scene::Value value = scene::Value::color(0, 0, 0);
        value.texture = texture;
        wax.params.set("reflectance", value);
    }
    room.scene.materials.set(room.red, wax, ++room.scene.clock);
    const auto asked = r.live.show(room.scene, view_options);
    const FramePtr last = r.wait([&](const Frame& f) {
        const auto status = r.live.status();
        return f.request == asked && status.state == ViewState::done && status.compiling.empty() &&
               f.seconds >= r.live.frame()->seconds; // of the latest samples
    });
    const auto colour = [&](const Frame& frame) {
        glm::dvec3 sum(0);
        double n = 0;
        for (std::size_t k = 0; k < frame.image.color.size(); ++k)
            if (frame.image.instance_id[k] == room.ball.value) {
                sum += glm::dvec3(frame.image.color[k]);
                ++n;
            }
        return sum / std::max(n, 1.0);
    };
    {
        std::string all;
        for (const auto& type : r.compiled())
            all += type + "; ";
        INFO(all);
        CHECK(r.said("coateddiffuse"));
    }
    const glm::dvec3 right = colour(*last);
    CHECK(right.g > 2 * right.r);
    std::size_t meanwhile = 0;
    for (const FramePtr& frame : r.frames()) {
        if (frame->request != asked) continue;
        const glm::dvec3 seen = colour(*frame);
        INFO(seen.r << " " << seen.g << " " << seen.b << " of " << frame->image.samples << " samples");
        CHECK(seen.g > 0.3 * right.g); // never black
        CHECK(seen.r < most_red * (seen.r + seen.g + seen.b)); // nor red, as before
        ++meanwhile;
    }
    CHECK(meanwhile >= 2);
}

TEST_CASE("live frames: a lost device is reopened once") {
    {
        Recorder r({.fault = std::make_shared<gpu::DeviceFault>(40, 1)});
        Room b;
        const auto request = r.live.show(b.scene, {.size = {64, 48}, .denoise = false, .samples = 16});
        r.wait([&](const Frame& f) { return f.request == request && !f.clay && f.image.samples == 16; });
        CHECK(r.live.status().state != ViewState::failed);
        // Edits continue.
        b.move_ball(1);
        const auto next = r.live.show(b.scene, {.size = {64, 48}, .denoise = false, .samples = 4});
        r.wait([&](const Frame& f) { return f.request == next && !f.clay && f.image.samples == 4; });
    }
    // Lost again before any picture: reported, and not retried forever.
    const auto fault = std::make_shared<gpu::DeviceFault>(1, 1000);
    Recorder r({.fault = fault});
    Room b;
    r.live.show(b.scene, {.size = {64, 48}, .denoise = false, .samples = 4});
    for (int i = 0; i < 80000 && r.live.status().state != ViewState::failed; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const auto status = r.live.status();
    REQUIRE(status.state == ViewState::failed);
    CHECK(status.text.find("stopped again") != std::string::npos);
    CHECK(fault->times == 998);
}
