// SPDX-License-Identifier: Apache-2.0
// Shaders are compiled on demand, on workers; an editor shows stand-ins meanwhile, a command waits.
#include "base/file.hpp"
#include "paths.hpp"
#include "render/checks.hpp"

#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>

#include <chrono>
#include <thread>

using namespace restage;
using namespace restage::tests;

namespace {

std::filesystem::path empty_cache(const std::string& name) {
    const auto folder = restage::test::build_dir() / "test_cache" / name;
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder;
}

std::unique_ptr<render::Renderer> editor(const std::string& tracer, const std::string& cache) {
    return make_renderer(tracer, {.stand_ins = true, .cache_dir = empty_cache(cache)});
}

// A ball on a floor under a sky.
struct Ball : SceneBuilder {
    scene::Id<scene::Instance> ball;
    explicit Ball(scene::Id<scene::Material> (*look)(SceneBuilder&)) {
        set_camera({0, -5, 2}, {0, 0, 0.6}, {0, 0, 1}, 30);
        set_film(24, 24);
        instance(quad({-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0}), diffuse(0.6f, 0.6f, 0.5f));
        glm::dmat4 m(1);
        m[3] = {0, 0, 1, 1};
        ball = instance(sphere(12, 24), look(*this), m);
        environment(glm::vec3(1, 1.1f, 1.3f));
    }
    void give(scene::Id<scene::Material> material) {
        auto i = scene.instances[ball];
        i.material = material;
        scene.instances.set(ball, i, ++scene.clock);
    }
};
scene::Id<scene::Mesh> round(SceneBuilder& b) { // an analytic sphere
    const auto id = b.sphere(12, 24);
    scene::Mesh mesh = b.scene.meshes[id];
    mesh.primitive = "sphere \"float radius\" 1";
    b.scene.meshes.set(id, mesh, ++b.scene.clock);
    return id;
}
scene::Id<scene::Material> red(SceneBuilder& b) { return b.diffuse(0.8f, 0.1f, 0.1f); }

void trace(render::Renderer& renderer, std::uint32_t samples) {
    const auto ok = renderer.trace(samples);
    if (!ok) FAIL(ok.error().message);
}
void sync(render::Renderer& renderer, const scene::Scene& scene) {
    const auto ok = renderer.sync(scene);
    if (!ok) FAIL(ok.error().message);
}
void settle(render::Renderer& renderer) {
    const auto start = std::chrono::steady_clock::now();
    do {
        trace(renderer, 1);
        REQUIRE(std::chrono::steady_clock::now() - start < std::chrono::minutes(3));
    } while (renderer.compiling());
}

void check_equal(const render::FilmImage& a, const render::FilmImage& b) {
    REQUIRE(a.samples == b.samples);
    double worst = 0;
    for (std::size_t i = 0; i < a.color.size(); ++i)
        worst = std::max(worst, double(glm::length(a.color[i] - b.color[i])));
    CHECK(worst < 1e-5);
}
glm::vec3 centre(const render::FilmImage& image) { return image.color[image.width * 12 + 12]; }

} // namespace

TEST_CASE("while a material compiles its colour replaces it, and then the film restarts") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = editor(tracer, "stand_in_" + tracer);
    Ball b(red);
    sync(*renderer, b.scene);
    settle(*renderer);

    scene::ParamSet coat;
    coat.set("reflectance", scene::Value::color(0.1f, 0.8f, 0.1f));
    b.give(b.material("coateddiffuse", coat));
    sync(*renderer, b.scene);
    trace(*renderer, 2);
    const auto compiling = renderer->compiling();
    REQUIRE(compiling);
    CHECK(compiling->left >= 1);
    if (tracer == "embree") CHECK(compiling->what == "coateddiffuse");
    const auto meanwhile = renderer->image();
    CHECK(meanwhile.samples == 2);
    CHECK(meanwhile.albedo[24 * 12 + 12].y > 0.7f); // a green diffuse ball
    CHECK(meanwhile.albedo[24 * 12 + 12].x < 0.2f);

    settle(*renderer);
    renderer->reset();
    trace(*renderer, 4);
    check_equal(renderer->image(), render_image(*make_renderer(tracer), b.scene, 4));
    CHECK(glm::length(centre(renderer->image()) - centre(meanwhile)) > 1e-3f);
}

TEST_CASE("samples of a stand-in do not stay in the film") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = editor(tracer, "restart_" + tracer);
    Ball b(red);
    sync(*renderer, b.scene);
    settle(*renderer);
    b.give(b.material("coateddiffuse"));
    sync(*renderer, b.scene);
    bool restarted = false;
    std::uint32_t before = 0;
    const auto start = std::chrono::steady_clock::now();
    while (!restarted && std::chrono::steady_clock::now() - start < std::chrono::minutes(3)) {
        trace(*renderer, 1);
        restarted = renderer->samples() <= before;
        before = renderer->samples();
    }
    REQUIRE(restarted);
    CHECK(renderer->samples() == 1);
    trace(*renderer, 3);
    check_equal(renderer->image(), render_image(*make_renderer(tracer), b.scene, 4));
}

// The code is ready during a sample that has begun with the stand-in.
TEST_CASE("a film that contains a stand-in's samples waits for the real material") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto cache = empty_cache("late_" + tracer);
    Ball b(red);
    const auto was = b.scene.instances[b.ball].material, coat = b.material("coateddiffuse");
    b.give(coat);
    for (const bool stand_ins : {true, false}) { // both kinds of compiler leave their code in the cache
        const auto first = make_renderer(tracer, {.stand_ins = stand_ins, .cache_dir = cache});
        sync(*first, b.scene);
        settle(*first);
    }
    const auto renderer = make_renderer(tracer, {.stand_ins = true, .cache_dir = cache});
    b.give(was);
    sync(*renderer, b.scene);
    settle(*renderer);
    b.give(coat);
    sync(*renderer, b.scene);
    trace(*renderer, 1);
    REQUIRE(renderer->compiling());
    bool slept = false;
    REQUIRE(renderer->trace(1, [&] {
        if (!std::exchange(slept, true)) std::this_thread::sleep_for(std::chrono::seconds(3));
        return true;
    }));
    CHECK(slept);
    settle(*renderer);
    const auto image = renderer->image();
    check_equal(image, render_image(*make_renderer(tracer), b.scene, image.samples));
}

TEST_CASE("a material hit by only one path in many samples is compiled, too") {
    const auto renderer = editor("embree", "rare");
    Ball b(red);
    sync(*renderer, b.scene);
    settle(*renderer); // a kernel that arrives later restarts the film, and then nothing asks for the ball's
    auto i = b.scene.instances[b.ball];
    i.material = b.material("coateddiffuse");
    i.object_to_world = glm::scale(i.object_to_world, glm::dvec3(0.01)); // a fiftieth of a pixel
    b.scene.instances.set(b.ball, i, ++b.scene.clock);
    sync(*renderer, b.scene);
    std::uint32_t last = 0;
    bool met = false;
    for (int k = 0; k < 20000 && !met; ++k) {
        trace(*renderer, 1);
        const auto compiling = renderer->compiling();
        met = compiling && compiling->what == "coateddiffuse";
        last = renderer->samples();
    }
    REQUIRE(met);
    const auto start = std::chrono::steady_clock::now();
    while (renderer->compiling() && renderer->samples() >= last) {
        last = renderer->samples();
        trace(*renderer, 1);
        REQUIRE(std::chrono::steady_clock::now() - start < std::chrono::minutes(3));
    }
    CHECK(renderer->samples() == 1); // restarted, without the stand-in
}

TEST_CASE("what a scene has for the first time, or no longer, does no harm to shaders that were made before") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const bool appears = GENERATE(true, false);
    Ball b(red);
    scene::Light lamp; // photons would carry its light off a mirror
    lamp.kind = scene::LightKind::point;
    lamp.value = glm::vec3(3);
    lamp.light_to_world = glm::translate(glm::dmat4(1), glm::dvec3(2, -2, 3));
    b.light(lamp);
    // A sphere that is no mesh, of a material that has its shader; a mirror.
    const auto inserted = appears
                              ? b.instance(round(b), b.scene.instances[b.ball].material, placed({1.2, -1, 0.5}, 0.5))
                              : b.instance(cube(b), b.material("mirror"), placed({-2, 0, 0.5}, 0.5));
    const scene::Instance one = b.scene.instances[inserted];
    const auto change = [&](bool there) {
        if (there)
            b.scene.instances.set(inserted, one, ++b.scene.clock);
        else
            b.scene.instances.set(inserted, std::nullopt, ++b.scene.clock);
    };
    if (appears) change(false);
    const auto renderer = editor(tracer, "first_time_" + tracer);
    sync(*renderer, b.scene);
    settle(*renderer);
    change(appears);
    sync(*renderer, b.scene);
    REQUIRE(renderer->gpu_scene().features().quadrics == appears);
    REQUIRE(renderer->gpu_scene().features().caustics == false);
    trace(*renderer, 2); // with what there was
    settle(*renderer);
    CHECK(mean_luminance(renderer->image()).value > 0.1);
}

TEST_CASE("shaders of a scene do not read the textures of another one") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto textured = [](Ball& b, std::vector<scene::Texture> textures) {
        scene::Value value = scene::Value::color(0.5f, 0.5f, 0.5f);
        for (scene::Texture& texture : textures) {
            value.texture = b.scene.textures.next();
            b.scene.textures.set(value.texture, std::move(texture), ++b.scene.clock);
        }
        scene::Material floor = b.scene.materials[b.scene.instances[b.ball].material];
        floor.params.set("reflectance", value);
        b.scene.materials.set(b.scene.instances[b.ball].material, floor, ++b.scene.clock);
    };
    Ball first(red), second(red);
    const auto grey = first.image(1, 1, 3, {0.5f, 0.5f, 0.5f});
    textured(first, {scene::Texture{.name = "image", .type = "imagemap", .image = grey}});
    textured(second, {scene::Texture{.name = "checks", .type = "checkerboard"}});
    const auto renderer = editor(tracer, "another_scene_" + tracer);
    sync(*renderer, first.scene);
    settle(*renderer);
    renderer->forget_scene();
    sync(*renderer, second.scene);
    trace(*renderer, 2);
    settle(*renderer);
    renderer->reset();
    trace(*renderer, 4);
    check_equal(renderer->image(), render_image(*make_renderer(tracer), second.scene, 4));
}

TEST_CASE("an undone edit cancels its compilation") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = editor(tracer, "cancel_" + tracer);
    Ball b(red);
    const auto was = b.scene.instances[b.ball].material;
    sync(*renderer, b.scene);
    settle(*renderer);
    trace(*renderer, 2);
    const auto before = renderer->image();
    b.give(b.material("coatedconductor"));
    sync(*renderer, b.scene);
    trace(*renderer, 1);
    REQUIRE(renderer->compiling());
    b.give(was);
    sync(*renderer, b.scene);
    for (int i = 0; i < 2; ++i)
        trace(*renderer, 1);
    CHECK_FALSE(renderer->compiling());
    trace(*renderer, before.samples - 2);
    check_equal(before, renderer->image());
}

TEST_CASE("a command waits for its shaders, and stops waiting on request") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer, {.cache_dir = empty_cache("wait_" + tracer)});
    Ball b([](SceneBuilder& s) { return s.material("coatedconductor"); });
    sync(*renderer, b.scene);
    const auto start = std::chrono::steady_clock::now();
    int asked = 0;
    REQUIRE(renderer->trace(4, [&] { return !renderer->compiling() || ++asked < 3; }));
    const auto stopped = std::chrono::steady_clock::now() - start;
    CHECK(renderer->samples() == 0);
    CHECK(renderer->compiling());
    CHECK(stopped < std::chrono::seconds(1));
    trace(*renderer, 4);
    CHECK_FALSE(renderer->compiling());
    CHECK(renderer->image().samples == 4);
}

TEST_CASE("a type that no path hits is not compiled by the wavefront") {
    Ball b(red);
    const auto renderer = make_renderer("embree");
    render_image(*renderer, b.scene, 1);
    const auto alone = renderer->stats().shader_bytes;
    auto m = glm::dmat4(0.1);
    m[3] = {0, 0, -3, 1}; // under the floor
    b.instance(b.scene.instances[b.ball].mesh, b.material("coateddiffuse"), m);
    render_image(*renderer, b.scene, 1);
    CHECK(renderer->stats().shader_bytes == alone);
}

TEST_CASE("a material whose shader has an error keeps its stand-in in an editor, and ends a command") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto folder = empty_cache("broken_" + tracer);
    REQUIRE(write_file_atomic(folder / "broken.glsl",
                              "Spectrum broken_eval(broken_Params m, vec3 wo, vec3 wi) { oops; }\n"));
    const model::Material table{
        .type = "broken",
        .label = "Broken",
        .prefix = "broken",
        .glsl_file = "broken.glsl",
        .params = {{.id = "color", .label = "Colour", .type = model::ParamType::color, .def = {0.2f, 0.3f, 0.8f}}}};
    const auto lookup = [&](const std::string& type) {
        return type == "broken" ? render::MaterialPlugin{&table, folder} : plugins().lookup()(type);
    };
    std::string said;
    Log log([&](LogLevel level, std::string_view text) {
        if (level == LogLevel::error) said += text;
    });
    const bool stand_ins = GENERATE(true, false);
    render::RendererOptions options{.tracer = tracer, .stand_ins = stand_ins};
    options.shader_dir = restage::test::source_dir() / "shaders";
    auto renderer = render::Renderer::create(options, lookup, log);
    REQUIRE(renderer);
    Ball b([](SceneBuilder& s) { return s.material("broken"); });
    sync(**renderer, b.scene);
    if (!stand_ins) {
        const auto failed = (*renderer)->trace(1);
        REQUIRE_FALSE(failed);
        CHECK_THAT(failed.error().message, Catch::Matchers::ContainsSubstring("broken.glsl:1"));
        return;
    }
    settle(**renderer);
    trace(**renderer, 1);
    CHECK_THAT(said, Catch::Matchers::ContainsSubstring("broken.glsl:1"));
    CHECK((*renderer)->image().albedo[24 * 12 + 12].z > 0.7f);
}
