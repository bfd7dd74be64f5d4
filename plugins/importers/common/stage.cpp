// SPDX-License-Identifier: Apache-2.0
#include "common/stage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace restage::importing {

namespace {

constexpr double fov = 40; // [deg], of the shorter side
constexpr double film_area = 1280.0 * 720.0;

// World axes as columns: x to the right, the second up, the third towards the viewer.
Matrix world_from_stage(Up up) {
    Matrix m;
    if (up == Up::z) {
        m.set_column(1, {0, 0, 1});
        m.set_column(2, {0, -1, 0});
    }
    return m;
}

// A round light, soft at its edge: 1 in the middle, falling as a Gaussian with the angle.
double lamp(Vec3 direction, Vec3 towards, double radius_deg) {
    const double angle = std::acos(std::clamp(dot(direction, normalized(towards)), -1.0, 1.0)) * 180 / std::numbers::pi;
    return std::exp(-(angle * angle) / (radius_deg * radius_deg));
}

double studio_radiance(Vec3 d) { // of the stage's axes
    const double walls = d[1] > 0 ? 0.45 + 0.45 * d[1] : 0.45 + 0.25 * d[1];
    return walls + 5 * lamp(d, {-0.6, 0.8, 0.7}, 22) + 2 * lamp(d, {0.8, 0.5, -0.8}, 15);
}

} // namespace

Matrix look_at(Vec3 eye, Vec3 target, Vec3 up) {
    const Vec3 forward = normalized(target - eye);
    const Vec3 right = normalized(cross(forward, up), {1, 0, 0});
    Matrix m;
    m.set_column(0, right);
    m.set_column(1, cross(right, forward));
    m.set_column(2, forward);
    m.set_column(3, eye);
    return m;
}

void add_camera(const RestageSceneWriter1& out, Report& report, const Bounds& bounds, Up up) {
    const Matrix stage = world_from_stage(up);
    const Vec3 center = bounds.empty() ? Vec3{0, 0, 0} : bounds.center();
    const Vec3 from = transform_vector(stage, normalized({0.45, 0.35, 1}));
    const Matrix view = look_at(center + from, center, stage.column(1));
    // The nearest place from which every corner is visible at 16:9: |x| <= tan(fov / 2) aspect (distance - z), y alike.
    const double tan_y = std::tan(fov / 2 * std::numbers::pi / 180), tan_x = tan_y * 16 / 9;
    double distance = std::max(bounds.radius(), 1e-6);
    for (std::size_t i = 0; i < 8 && !bounds.empty(); ++i) {
        const Vec3 corner = bounds.corner(i) - center;
        const double towards = dot(corner, from);
        distance = std::max({distance, towards + std::abs(dot(corner, view.column(0))) / tan_x,
                             towards + std::abs(dot(corner, view.column(1))) / tan_y});
    }
    distance *= 1.08;
    const Matrix placed = look_at(center + from * distance, center, stage.column(1));
    // The frame encloses the corners as seen from there, so that any other aspect shows them all as well.
    double half_x = 0, half_y = 0;
    for (std::size_t i = 0; i < 8 && !bounds.empty(); ++i) {
        const Vec3 corner = bounds.corner(i) - center;
        const double depth = std::max(distance - dot(corner, from), 1e-9);
        half_x = std::max(half_x, std::abs(dot(corner, view.column(0))) / depth);
        half_y = std::max(half_y, std::abs(dot(corner, view.column(1))) / depth);
    }
    const double filled = std::max(half_x / tan_x, half_y / tan_y); // the rest is margin
    half_x = filled > 0 ? std::max(half_x / filled, 0.01 * tan_x) : tan_x;
    half_y = filled > 0 ? std::max(half_y / filled, 0.01 * tan_y) : tan_y;
    RestageCamera camera{.name = "camera",
                         .camera_to_world = {},
                         .fov = static_cast<float>(2 * std::atan(std::min(half_x, half_y)) * 180 / std::numbers::pi),
                         .screen_window = {},
                         .lens_radius = 0,
                         .focal_distance = static_cast<float>(distance),
                         .frame_aspect = 0,
                         .projection = RESTAGE_PERSPECTIVE,
                         .fit_aspect = static_cast<float>(half_x / half_y)};
    std::copy(placed.m.begin(), placed.m.end(), camera.camera_to_world);
    out.camera(out.ctx, &camera);
    report.kept("camera", "the file has none; one that shows everything is added");
}

void add_film(const RestageSceneWriter1& out, double aspect, bool unexposed) {
    aspect = std::clamp(std::isfinite(aspect) && aspect > 0 ? aspect : 16.0 / 9, 0.1, 10.0);
    const double height = std::sqrt(film_area / aspect);
    const RestageFilm film = {.width = static_cast<std::uint32_t>(std::lround(height * aspect)),
                              .height = static_cast<std::uint32_t>(std::lround(height)),
                              .crop = {0, 1, 0, 1},
                              .filter = "gaussian", // pbrt-v4's own
                              .filter_radius = {1.5f, 1.5f},
                              .filter_params = {0.5f, 0},
                              .exposure = 1,
                              .filename = "",
                              .unexposed = unexposed};
    out.film(out.ctx, &film);
}

void add_studio(const RestageSceneWriter1& out, Report& report, Up up) {
    constexpr std::uint32_t width = 256, height = 128;
    std::vector<float> pixels(std::size_t{width} * height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) { // RESTAGE_EQUIRECT; its +z is up
            const double theta = (y + 0.5) / height * std::numbers::pi, phi = (x + 0.5) / width * 2 * std::numbers::pi;
            const Vec3 d = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
            pixels[std::size_t{y} * width + x] = static_cast<float>(studio_radiance({d[0], d[2], -d[1]}));
        }
    std::vector<float> rgb;
    for (const float value : pixels)
        rgb.insert(rgb.end(), 3, value);
    const RestageImage image = {.name = "studio",
                                .path = "",
                                .encoding = RESTAGE_LINEAR,
                                .gamma = 1,
                                .width = width,
                                .height = height,
                                .channels = 3,
                                .pixels = rgb.data()};
    RestageEnvironment environment{.name = "studio",
                                   .image = out.image(out.ctx, &image),
                                   .mapping = RESTAGE_EQUIRECT,
                                   .scale = {1, 1, 1},
                                   .light_to_world = {},
                                   .hidden_from_camera = 0};
    Matrix to_stage; // the picture's axes -> x right, y up, z towards the viewer
    to_stage.set_column(1, {0, 0, -1});
    to_stage.set_column(2, {0, 1, 0});
    const Matrix to_world = world_from_stage(up) * to_stage;
    std::copy(to_world.m.begin(), to_world.m.end(), environment.light_to_world);
    out.environment(out.ctx, &environment);
    report.kept("environment", "the file has no lights; a neutral studio is added");
}

} // namespace restage::importing
