// SPDX-License-Identifier: Apache-2.0
// The rays of a pixel: field of view, screen window, crop, lens, and the pixel filters. Both tracers begin a path by
// the same code (shaders/path/begin.glsl), so one of them is enough here.
#include "query/navigation.hpp"
#include "render/checks.hpp"
#include "render/filter_table.hpp"

#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;

namespace {

// The camera at the origin looks along +y, z up. pbrt's cameras are left-handed: the right of the picture is -x.
void look_ahead(SceneBuilder& b, float fov) { b.set_camera({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, fov); }

// A card of radiance 1 at distance d, [x0,x1] to the right and [z0,z1] up, as seen at distance 1.
void card(SceneBuilder& b, double d, glm::dvec4 r) {
    const auto p = [&](double x, double z) { return glm::vec3(float(-x * d), float(d), float(z * d)); };
    b.instance(b.quad(p(r.x, r.z), p(r.y, r.z), p(r.y, r.w), p(r.x, r.w)), b.diffuse(0, 0, 0), glm::dmat4(1),
               scene::Emission{glm::vec3(1), true});
    b.scene.settings.value.max_depth = 0;
}

void change_camera(SceneBuilder& b, auto&& change) {
    auto camera = b.scene.cameras[b.scene.active_camera.value];
    change(camera);
    b.scene.cameras.set(b.scene.active_camera.value, camera, ++b.scene.clock);
}

double overlap(double a0, double a1, double b0, double b1) {
    return std::max(0.0, std::min(a1, b1) - std::max(a0, b0));
}

// Each pixel of a picture of the card shows the fraction of it that the card covers. window: x0 x1 z0 z1 at distance 1.
void check_coverage(const render::FilmImage& image, glm::dvec4 window, glm::dvec4 card) {
    std::size_t off = 0;
    double sum = 0, expected = 0;
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const double w = (window.y - window.x) / image.width, h = (window.w - window.z) / image.height;
            const double left = window.x + x * w, top = window.w - y * h;
            const double c = overlap(left, left + w, card.x, card.y) / w * overlap(top - h, top, card.z, card.w) / h;
            const double got = image.color[std::size_t(y) * image.width + x].y;
            off += std::abs(got - c) > 0.06; // 256 stratified samples
            sum += got;
            expected += c;
        }
    INFO("covered " << sum << " pixels, expected " << expected << "; " << off << " pixels off");
    CHECK(off == 0);
    CHECK(std::abs(sum - expected) < 0.003 * expected);
}

} // namespace

TEST_CASE("camera: the field of view is that of the shorter side; screen windows") {
    const auto renderer = make_renderer("embree");
    const double t = std::tan(glm::radians(20.0));
    const glm::dvec4 patch(-0.101, 0.253, -0.057, 0.212);
    struct Case {
        glm::uvec2 size;
        glm::dvec4 window; // times t
        bool explicit_window;
    };
    for (const Case& c : {Case{{36, 24}, {-1.5, 1.5, -1, 1}, false},
                          {{24, 36}, {-1, 1, -1.5, 1.5}, false},
                          {{20, 20}, {-1, 1, -1, 1}, false},
                          {{24, 24}, {-0.4, 0.8, -0.2, 1}, true}}) {
        SceneBuilder b;
        b.set_film(c.size.x, c.size.y);
        look_ahead(b, 40);
        if (c.explicit_window) change_camera(b, [&](auto& camera) { camera.screen_window = glm::vec4(c.window); });
        card(b, 3, patch);
        renderer->forget_scene();
        INFO(c.size.x << " x " << c.size.y);
        check_coverage(render_image(*renderer, b.scene, 256), c.window * t, patch);
    }
}

TEST_CASE("camera: a lens blurs by the circle of confusion") {
    const auto renderer = make_renderer("embree");
    const double lens = 0.1, focus = 2;
    for (const double d : {1.25, 2.0, 5.0}) {
        SceneBuilder b;
        b.set_film(48, 48);
        look_ahead(b, 30);
        const double side = 0.02;
        card(b, d, {-side / 2, side / 2, -side / 2, side / 2});
        change_camera(b, [&](auto& camera) {
            camera.lens_radius = float(lens);
            camera.focal_distance = float(focus);
        });
        renderer->forget_scene();
        const auto image = render_image(*renderer, b.scene, 512);
        double sum = 0, second = 0;
        glm::dvec2 mean(0);
        const double pixel = 2 * std::tan(glm::radians(15.0)) / 48;
        for (std::uint32_t y = 0; y < 48; ++y)
            for (std::uint32_t x = 0; x < 48; ++x) {
                const double v = image.color[y * 48 + x].y;
                const glm::dvec2 p((x + 0.5 - 24) * pixel, (y + 0.5 - 24) * pixel);
                sum += v;
                mean += v * p;
                second += v * glm::dot(p, p);
            }
        // a uniform disk of radius r |1/f - 1/d| at distance 1: its second moment is half its radius squared, a
        // square's a sixth
        const double radius = lens * std::abs(1 / focus - 1 / d);
        const double expected = radius * radius / 2 + side * side / 6 + pixel * pixel / 6;
        if (d == focus) { // in focus: nearly all in the four pixels it covers
            CHECK(std::sqrt(second / sum) < 1.1 * pixel);
            continue;
        }
        INFO("distance " << d << ": spread " << std::sqrt(second / sum) << ", expected " << std::sqrt(expected));
        CHECK(std::abs(second / sum / expected - 1) < 0.04);
        CHECK(glm::length(mean / sum) < 0.05 * std::sqrt(expected) + 0.1 * pixel);
        CHECK(std::abs(sum * pixel * pixel / (side * side) - 1) < 0.05); // the light is spread, not lost
    }
}

TEST_CASE("camera: a crop window shows the same as the whole picture there") {
    for (const char* tracer : {"embree", "vulkan"}) {
        const auto renderer = make_renderer(tracer);
        const auto render = [&](glm::vec4 crop) {
            SceneBuilder b;
            b.set_film(30, 20);
            b.scene.film.value.crop = crop;
            look_ahead(b, 50);
            b.instance(b.sphere(12, 24), b.diffuse(0.5f, 0.4f, 0.3f), placed({0.3, 4, 0.2}));
            b.environment(glm::vec3(1, 2, 3));
            renderer->forget_scene();
            return render_image(*renderer, b.scene, 8);
        };
        const auto whole = render({0, 1, 0, 1}), part = render({0.2f, 0.75f, 0.1f, 0.6f}); // columns 6..22, rows 2..11
        REQUIRE(part.width == 17);
        REQUIRE(part.height == 10);
        std::size_t differ = 0;
        for (std::uint32_t y = 0; y < part.height; ++y)
            for (std::uint32_t x = 0; x < part.width; ++x)
                differ += part.color[y * part.width + x] != whole.color[(y + 2) * 30 + x + 6];
        INFO(tracer);
        CHECK(differ == 0);
    }
}

TEST_CASE("pixel filters: a constant is unchanged, and a dot takes the filter's shape") {
    const auto renderer = make_renderer("embree");
    using scene::FilterKind;
    for (const scene::Filter& filter : {scene::Filter{FilterKind::box, glm::vec2(0.5f), {}},
                                        {FilterKind::box, glm::vec2(1.5f, 0.8f), {}},
                                        {FilterKind::triangle, glm::vec2(2, 1.2f), {}},
                                        {FilterKind::gaussian, glm::vec2(1.5f), glm::vec2(0.5f, 0)},
                                        {FilterKind::mitchell, glm::vec2(2), glm::vec2(1 / 3.f, 1 / 3.f)},
                                        {FilterKind::sinc, glm::vec2(4, 3), glm::vec2(3, 0)}}) {
        INFO("filter " << int(filter.kind) << ", radius " << filter.radius.x << ", " << filter.radius.y);
        SceneBuilder white;
        white.set_film(12, 12);
        white.scene.film.value.filter = filter;
        look_ahead(white, 40);
        white.environment(glm::vec3(1));
        renderer->forget_scene();
        check_mean(render_image(*renderer, white.scene, 256), 1);

        // A dot of a quarter pixel, somewhere near the middle.
        const std::uint32_t size = 14;
        const double pixel = 2 * std::tan(glm::radians(20.0)) / size, side = 0.25;
        const glm::dvec2 at(7.3, 6.6); // pixels from the top left corner
        SceneBuilder b;
        b.set_film(size, size);
        b.scene.film.value.filter = filter;
        look_ahead(b, 40);
        const double x = (at.x - size / 2.0) * pixel, z = (size / 2.0 - at.y) * pixel, h = side / 2 * pixel;
        card(b, 2, {x - h, x + h, z - h, z + h});
        renderer->forget_scene();
        const auto image = render_image(*renderer, b.scene, 2048);
        const auto response = [&](int axis, double centre, double p) { // the filter about p, over the dot, normalised
            const int n = 400;
            double whole = 0, part = 0;
            const double r = filter.radius[axis];
            for (int k = 0; k < n * 8; ++k)
                whole += render::filter_value(filter, axis, (2 * (k + 0.5) / (n * 8) - 1) * r) * 2 * r / (n * 8);
            for (int k = 0; k < n; ++k)
                part += render::filter_value(filter, axis, centre + side * ((k + 0.5) / n - 0.5) - p) * side / n;
            return part / whole;
        };
        double chi = 0, worst = 0;
        int pixels = 0;
        for (std::uint32_t j = 0; j < size; ++j)
            for (std::uint32_t i = 0; i < size; ++i) {
                const double expected = response(0, at.x, i + 0.5) * response(1, at.y, j + 0.5);
                const double got = image.color[j * size + i].y;
                const double error = std::sqrt(image.luminance_variance[j * size + i]);
                if (expected == 0 || error == 0) {
                    CHECK(std::abs(got - expected) < 1e-3);
                    continue;
                }
                const double zs = (got - expected) / error;
                chi += zs * zs;
                worst = std::max(worst, std::abs(zs));
                ++pixels;
            }
        INFO("chi-square " << chi << " of " << pixels << " pixels, worst " << worst);
        CHECK(chi < pixels + 4 * std::sqrt(2.0 * pixels)); // stratified: usually much less
        CHECK(worst < 5);
        CHECK(pixels >= 1);
    }
}

TEST_CASE("camera: an orthographic one shows the world at its scale, from any distance") {
    const auto renderer = make_renderer("embree");
    const glm::dvec4 patch(-0.101, 0.253, -0.057, 0.212);
    struct Case {
        glm::uvec2 size;
        glm::dvec4 window;
        bool explicit_window;
    };
    for (const Case& c : {Case{{24, 24}, {-1, 1, -1, 1}, false},
                          {{36, 24}, {-1.5, 1.5, -1, 1}, false},
                          {{24, 24}, {-0.4, 0.8, -0.2, 1}, true}})
        for (const double distance : {0.5, 40.0}) {
            SceneBuilder b;
            b.set_film(c.size.x, c.size.y);
            look_ahead(b, 13); // irrelevant here
            change_camera(b, [&](auto& camera) {
                camera.projection = scene::Projection::orthographic;
                if (c.explicit_window) camera.screen_window = glm::vec4(c.window);
            });
            card(b, distance, patch / distance); // the same size at any distance
            renderer->forget_scene();
            INFO(c.size.x << " x " << c.size.y << " at " << distance);
            check_coverage(render_image(*renderer, b.scene, 256), c.window, patch);
        }
}

TEST_CASE("camera: an orthographic one with a lens is sharp at its focus and blurs like pbrt's elsewhere") {
    // pbrt 4ed, 5.2.3, as its OrthographicCamera has it: rays leave the lens around the axis for the point in focus.
    const auto renderer = make_renderer("embree");
    const auto look_at = [&](double distance, glm::dvec4 patch, glm::dvec4 seen) {
        SceneBuilder b;
        b.set_film(24, 24);
        look_ahead(b, 13);
        change_camera(b, [](auto& camera) {
            camera.projection = scene::Projection::orthographic;
            camera.lens_radius = 1e-4f;
            camera.focal_distance = 4;
        });
        card(b, distance, patch / distance);
        renderer->forget_scene();
        INFO("at " << distance);
        check_coverage(render_image(*renderer, b.scene, 256), {-1, 1, -1, 1}, seen);
    };
    const glm::dvec4 patch(-0.101, 0.253, -0.057, 0.212);
    look_at(4, patch, patch);
    look_at(8, 2.0 * patch, patch); // twice as far from the lens, twice as wide
}

TEST_CASE("camera: spherical ones map directions like pbrt's") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const scene::Projection projection =
        GENERATE(scene::Projection::spherical, scene::Projection::spherical_equal_area);
    SceneBuilder b;
    b.set_film(32, 24);
    b.set_camera({0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 45);
    change_camera(b, [&](auto& camera) {
        camera.camera_to_world = glm::dmat4(1);
        camera.projection = projection;
    });
    b.scene.settings.value.max_depth = 0;
    // A box around the camera; each of its sides has its own radiance, 1 + its number: +x +y +z -x -y -z.
    for (int side = 0; side < 6; ++side) {
        const auto corner = [&](float u, float v) {
            glm::vec3 p;
            p[side % 3] = side < 3 ? 1.f : -1.f;
            p[(side + 1) % 3] = u;
            p[(side + 2) % 3] = v;
            return p;
        };
        b.instance(b.quad(corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)), b.diffuse(0, 0, 0),
                   glm::dmat4(1), scene::Emission{glm::vec3(float(1 + side)), true});
    }
    const auto image = render_image(*make_renderer(tracer), b.scene, 16);
    const scene::Camera& camera = b.scene.cameras[b.scene.active_camera.value];
    const auto side_of = [&](double x, double y) {
        const glm::dvec3 d = query::view_ray(camera, {x / 32, y / 24}, 4.0 / 3).direction;
        const glm::dvec3 a = glm::abs(d);
        const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
        return axis + (d[axis] < 0 ? 3 : 0);
    };
    std::size_t whole = 0, off = 0;
    double up = 0, weights = 0; // the fraction of the sphere that the upper side covers
    for (std::uint32_t y = 0; y < 24; ++y)
        for (std::uint32_t x = 0; x < 32; ++x) {
            const float got = image.color[y * 32 + x].y;
            const double weight =
                projection == scene::Projection::spherical ? std::sin((y + 0.5) / 24 * std::numbers::pi) : 1.0;
            const int side = side_of(x + 0.5, y + 0.5);
            weights += weight;
            up += side == 1 ? weight : 0;
            bool one = true;
            for (const auto& [dx, dy] : {std::pair{0.01, 0.01}, {0.99, 0.01}, {0.01, 0.99}, {0.99, 0.99}})
                one &= side_of(x + dx, y + dy) == side;
            if (!one) continue;
            ++whole;
            off += std::abs(got - float(1 + side)) > 1e-4f;
        }
    CHECK(whole > 500);
    CHECK(off == 0);
    CHECK(std::abs(up / weights - 1.0 / 6) < 0.02);
    // pbrt-v4's conventions at one place each: the middle of the upper edge looks up, or +x is at the left edge.
    const auto at = [&](double u, double v) { return glm::normalize(query::view_ray(camera, {u, v}, 1).direction); };
    if (projection == scene::Projection::spherical) {
        CHECK(glm::length(at(0, 0.5) - glm::dvec3(1, 0, 0)) < 1e-9);
        CHECK(glm::length(at(0.25, 0.5) - glm::dvec3(0, 0, 1)) < 1e-9);
        CHECK(glm::length(at(0.3, 0) - glm::dvec3(0, 1, 0)) < 1e-9);
    } else {
        CHECK(glm::length(at(0.5, 0.5) - glm::dvec3(0, 1, 0)) < 1e-9);
        CHECK(glm::length(at(1, 0.5) - glm::dvec3(1, 0, 0)) < 1e-9);
        CHECK(glm::length(at(0, 0) - glm::dvec3(0, -1, 0)) < 1e-9);
    }
}

TEST_CASE("camera: points projected to the film are visible there") {
    for (const auto projection : {scene::Projection::perspective, scene::Projection::orthographic,
                                  scene::Projection::spherical, scene::Projection::spherical_equal_area}) {
        SceneBuilder b;
        b.set_camera({1, 2, 3}, {-2, 5, 1}, {0, 0, 1}, 50);
        scene::Camera camera = b.scene.cameras[b.scene.active_camera.value];
        camera.projection = projection;
        for (const glm::dvec2& film : {glm::dvec2(0.3, 0.6), {0.81, 0.13}, {0.5, 0.5}, {0.02, 0.97}}) {
            const auto ray = query::view_ray(camera, film, 1.5);
            const auto p = query::project(camera, ray.origin + 7.0 * ray.direction, 1.5);
            INFO("projection " << int(projection));
            CHECK(glm::length(glm::dvec2(p) - film) < 1e-9);
            CHECK(std::abs(p.z - 7) < 1e-9);
        }
        if (projection != scene::Projection::orthographic) continue;
        // The wheel enlarges around the point under the mouse, and framing fits.
        const auto ray = query::view_ray(camera, {0.7, 0.4}, 1.5);
        const glm::dvec3 there = ray.origin + 3.0 * ray.direction;
        query::dolly(camera, there, 0.25);
        CHECK(glm::length(glm::dvec2(query::project(camera, there, 1.5)) - glm::dvec2(0.7, 0.4)) < 1e-6);
        const auto height = [&] { return 2 * glm::length(glm::dvec3(camera.camera_to_world[1])); }; // of the film
        CHECK(std::abs(height() - 1.5) < 1e-6);
        query::frame(camera, scene::Bounds{{-1, -1, -1}, {1, 1, 1}}, 1.5);
        CHECK(std::abs(height() - 2 * std::sqrt(3.0)) < 1e-6);
        CHECK(query::project(camera, {0, 0, 0}, 1.5).z > 2);
    }
}
