// SPDX-License-Identifier: Apache-2.0
// Edits of a few of many instances: what they cost, and that rays find what they find in a scene just opened.
#include "render/checks.hpp"
#include "render/embree_scene.hpp"

#include <random>

using namespace restage;
using namespace restage::tests;

namespace {

constexpr std::uint32_t side = 130; // 16,900: enough for edited ones to be kept apart
constexpr glm::dvec3 eye(0, -52, 52);

// A grid of tiles, a unit apart, at several heights; some are balls (quadrics) if asked for.
struct Crowd {
    SceneBuilder b;
    std::vector<scene::Id<scene::Instance>> all;
    scene::Id<scene::Mesh> tile, box, ball;
    scene::Id<scene::Material> grey;

    explicit Crowd(bool balls) {
        b.set_film(16, 16);
        b.set_camera(eye, {0, 0, 0}, {0, 0, 1}, 50);
        grey = b.diffuse(0.5f, 0.5f, 0.5f);
        tile = b.quad({-0.4f, -0.4f, 0}, {0.4f, -0.4f, 0}, {0.4f, 0.4f, 0}, {-0.4f, 0.4f, 0});
        box = cube(b);
        ball = b.sphere(8, 12);
        b.scene.meshes.set(
            ball,
            [&] {
                auto mesh = b.scene.meshes[ball];
                mesh.primitive = "sphere \"float radius\" 0.4";
                return mesh;
            }(),
            ++b.scene.clock);
        for (std::uint32_t k = 0; k < side * side; ++k)
            all.push_back(b.instance(balls && k % 100 == 7 ? ball : tile, grey, home(k)));
    }
    static glm::dmat4 home(std::uint32_t k) {
        return placed({k % side - side * 0.5, k / side - side * 0.5, 0.1 * (k % 9)});
    }
    void edit(std::uint32_t k, const std::function<void(scene::Instance&)>& change) {
        edit_instance(b, all[k], change);
    }
    void move(std::uint32_t k, glm::dvec3 to) {
        edit(k, [&](scene::Instance& i) { i.object_to_world = placed(to); });
    }
};

struct Found {
    std::vector<std::uint32_t> instances;
    std::vector<float> distances;
    std::vector<char> blocked;
    bool operator==(const Found&) const = default;
};

// Of the same rays each time.
Found trace(const render::EmbreeScene& embree) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    constexpr std::uint32_t count = 20000;
    Found found;
    std::vector<shared::ShadowRay> shadows(count);
    std::vector<std::uint32_t> which(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        shared::RayHit ray{};
        const glm::vec3 from(70 * unit(random), 70 * unit(random), 5);
        const glm::vec3 to = from + glm::vec3(4 * unit(random), 4 * unit(random), -6 - unit(random));
        ray.origin = from - glm::vec3(eye); // as the scene's
        ray.direction = to - from;
        ray.tfar = 2;
        ray.mask = ~0u;
        ray.geom = ray.inst = NONE;
        shadows[i].origin = ray.origin, shadows[i].direction = ray.direction, shadows[i].tfar = ray.tfar;
        shadows[i].mask = ~0u;
        which[i] = i;
        embree.intersect(ray);
        found.instances.push_back(ray.inst);
        found.distances.push_back(ray.tfar);
    }
    embree.occluded(shadows, which);
    for (const auto& shadow : shadows)
        found.blocked.push_back(!(shadow.tfar > 0));
    return found;
}

struct Views {
    std::unique_ptr<render::Renderer> renderer = make_renderer("embree"); // its device
    Jobs jobs{2};
    render::GpuScene scene{renderer->device(), jobs, plugins().lookup()};
    std::unique_ptr<render::EmbreeScene> edited;

    Views() {
        auto made = render::EmbreeScene::create(2, {});
        REQUIRE(made.has_value());
        edited = std::move(*made);
    }
    void sync(const Crowd& crowd) {
        const auto changes = scene.sync(crowd.b.scene);
        REQUIRE(changes.has_value());
        REQUIRE(edited->update(scene, *changes).has_value());
    }
    // What the edited scene finds is what one made anew does.
    Found check() const {
        render::SceneChanges all;
        for (std::uint32_t m = 1; scene.mesh({m}); ++m)
            all.meshes.push_back({m});
        for (std::uint32_t i = 1; i < scene.instances().size(); ++i)
            all.instances.push_back({i});
        auto fresh = render::EmbreeScene::create(2, {});
        REQUIRE(fresh.has_value());
        REQUIRE((*fresh)->update(scene, all).has_value());
        REQUIRE((*fresh)->settled());
        const Found found = trace(*edited);
        CHECK(found == trace(**fresh));
        for (std::size_t i = 0; i < found.blocked.size(); ++i)
            CHECK(bool(found.blocked[i]) == (found.instances[i] != NONE));
        return found;
    }
};

} // namespace

TEST_CASE("instances: after edits of some of many, rays find what they find in a scene just opened") {
    Crowd crowd(true);
    Views views;
    views.sync(crowd);
    CHECK(views.edited->settled());
    const Found at_first = views.check();

    crowd.move(40, {3, 4, 2});
    crowd.move(41, {3, 5, 2});
    views.sync(crowd);
    CHECK(!views.edited->settled());
    CHECK(!(views.check() == at_first));
    crowd.move(40, {-3, 4, 2}); // again
    views.sync(crowd);
    views.check();
    crowd.edit(8000, [](scene::Instance& i) { i.hidden = true; }); // one that had not moved
    crowd.edit(41, [](scene::Instance& i) { i.hidden = true; }); // one that had
    views.sync(crowd);
    views.check();
    crowd.edit(8001, [&](scene::Instance& i) { i.mesh = crowd.box; });
    crowd.move(107, {6, 6, 3}); // a quadric
    const auto added = crowd.b.instance(crowd.box, crowd.grey, placed({-6, -6, 3}));
    views.sync(crowd);
    views.check();
    crowd.b.scene.instances.set(added, std::nullopt, ++crowd.b.scene.clock);
    views.sync(crowd);
    views.check();
    CHECK(!views.edited->settled());

    const Found before = trace(*views.edited);
    REQUIRE(views.edited->settle().has_value());
    CHECK(views.edited->settled());
    CHECK(views.check() == before);

    for (const std::uint32_t k : {40u, 41u, 8000u, 8001u, 107u}) // back
        crowd.edit(k, [&](scene::Instance& i) {
            i.hidden = false;
            i.mesh = k == 107 ? crowd.ball : crowd.tile;
            i.object_to_world = Crowd::home(k);
        });
    views.sync(crowd);
    CHECK(!views.edited->settled());
    CHECK(views.check() == at_first);
}

TEST_CASE("instances: edits far apart are joined again before they are too many") {
    Crowd crowd(false);
    Views views;
    views.sync(crowd);
    int settled = 0;
    for (std::uint32_t i = 0; i < 40; ++i) {
        crowd.move(i * 3571 % std::uint32_t(crowd.all.size()), {double(i) - 20, 3, 2});
        views.sync(crowd);
        settled += views.edited->settled();
        if (i % 8 == 7) views.check();
    }
    CHECK(settled > 0);
    CHECK(settled < 20);
}

TEST_CASE("instances: one that becomes cut out, and one whose mesh is replaced, among many") {
    Crowd crowd(false);
    Views views;
    views.sync(crowd);
    crowd.move(3, {1, 1, 2});
    views.sync(crowd);
    crowd.edit(3, [](scene::Instance& i) { i.alpha = 0.5f; }); // the tiles' first
    views.sync(crowd);
    views.check();
    crowd.edit(4, [](scene::Instance& i) { i.alpha = 0.5f; });
    views.sync(crowd);
    views.check();
    crowd.edit(5, [&](scene::Instance& i) { i.mesh = crowd.box; });
    views.sync(crowd);
    auto mesh = crowd.b.scene.meshes[crowd.box];
    auto data = *mesh.data;
    for (auto& p : data.positions)
        p *= 3.f;
    mesh.data = std::make_shared<scene::MeshData>(data);
    crowd.b.scene.meshes.set(crowd.box, mesh, ++crowd.b.scene.clock);
    views.sync(crowd);
    views.check();
}

TEST_CASE("instances: moving one lamp of many uploads little, and the picture is that of a scene just opened") {
    Crowd crowd(false);
    crowd.b.scene.settings.value.max_depth = 2;
    for (std::uint32_t k = 0; k < crowd.all.size(); k += 2)
        crowd.edit(k, [&](scene::Instance& i) {
            i.mesh = crowd.tile;
            i.emission = scene::Emission{.radiance = glm::vec3(float(1 + k % 5)), .two_sided = true};
        });
    crowd.b.instance(crowd.b.quad({-80, -80, -1}, {80, -80, -1}, {80, 80, -1}, {-80, 80, -1}), crowd.grey);
    const auto renderer = make_renderer("embree");
    render_image(*renderer, crowd.b.scene, 1);
    for (const std::uint32_t k : {16898u, 20u, 9000u}) { // towards the camera: bright
        const auto uploaded = renderer->gpu_scene().uploaded_bytes();
        crowd.edit(k, [&](scene::Instance& i) {
            i.object_to_world = placed({k * 1e-3 - 8, -39, 26}, 6);
            i.emission->radiance *= 3.f;
        });
        REQUIRE(renderer->sync(crowd.b.scene));
        CHECK(renderer->gpu_scene().uploaded_bytes() - uploaded < 2000);
    }
    const auto edited = render_image(*renderer, crowd.b.scene, 64); // of these, the last ones settled
    const auto fresh = make_renderer("embree", {.seed = 1});
    check_same_mean(edited, render_image(*fresh, crowd.b.scene, 64));
}
