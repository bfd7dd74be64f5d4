// SPDX-License-Identifier: Apache-2.0
// Integrator, camera and film.
#include "exporter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace restage::mitsuba_out {

namespace {

double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// pbrt's screen window: the shorter side of the frame is 2, unless the camera gives one.
std::array<double, 4> screen_window(const RestageCamera& camera, double aspect) {
    const float* w = camera.screen_window;
    if (w[0] != 0 || w[1] != 0 || w[2] != 0 || w[3] != 0)
        return {double(w[0]), double(w[1]), double(w[2]), double(w[3])};
    if (camera.frame_aspect > 0) aspect = static_cast<double>(camera.frame_aspect);
    const double x = std::max(aspect, 1.0), y = std::max(1 / aspect, 1.0);
    return {-x, x, -y, y};
}

} // namespace

void Exporter::integrator() {
    RestageSettings settings{};
    in_.settings(in_.ctx, &settings);
    head_.open("integrator", "path");
    head_.put("max_depth", static_cast<int>(std::min(settings.max_depth, 1000000u)) + 1); // counts the camera's edge
    head_.close();
}

// Near enough to hide nothing, far enough to see everything.
std::array<double, 2> Exporter::clip_distances(const Matrix& camera_to_world) {
    double farthest = 0;
    RestageInstance i{};
    RestageMesh mesh{};
    for (RestageHandle h = 1; h <= in_.count(in_.ctx, RESTAGE_KIND_INSTANCE); ++h) {
        if (!in_.instance(in_.ctx, h, &i) || !in_.mesh(in_.ctx, i.mesh, &mesh) || !mesh.positions) continue;
        std::array<double, 3> low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
        for (std::size_t v = 0; v < std::size_t{mesh.vertex_count} * 3; ++v) {
            low[v % 3] = std::min(low[v % 3], static_cast<double>(mesh.positions[v]));
            high[v % 3] = std::max(high[v % 3], static_cast<double>(mesh.positions[v]));
        }
        for (unsigned corner = 0; corner < 8; ++corner) {
            double squared = 0;
            for (std::size_t row = 0; row < 3; ++row) {
                double at = i.object_to_world[12 + row] - camera_to_world[12 + row];
                for (std::size_t k = 0; k < 3; ++k)
                    at += i.object_to_world[4 * k + row] * ((corner >> k & 1) ? high[k] : low[k]);
                squared += at * at;
            }
            if (std::isfinite(squared)) farthest = std::max(farthest, std::sqrt(squared));
        }
    }
    if (farthest == 0) farthest = 1;
    return {farthest * 1e-5, farthest * 10};
}

// pbrt's camera has +x to the right, Mitsuba's to the left; both look along +z. Mitsuba refuses scaled cameras.
void Exporter::sensor() {
    RestageCamera camera{};
    const RestageHandle active = in_.active_camera(in_.ctx);
    if (!active || !in_.camera(in_.ctx, active, &camera)) {
        dropped("camera", "the scene has none; Mitsuba's default is used");
        return;
    }
    for (RestageHandle h = 1; h <= in_.count(in_.ctx, RESTAGE_KIND_CAMERA); ++h)
        if (RestageCamera other{}; h != active && in_.camera(in_.ctx, h, &other))
            dropped(std::string("camera \"") + other.name + "\"", "the file has the active camera only");
    const std::string what = std::string("camera \"") + camera.name + "\"";
    report_kept(*camera.origin, what);
    if (in_.camera_medium(in_.ctx)) dropped(what, "it is inside a medium; media are not written");

    Matrix m;
    std::copy(camera.camera_to_world, camera.camera_to_world + 16, m.begin());
    std::array<double, 3> sizes{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        sizes[axis] = std::sqrt(dot(&m[4 * axis], &m[4 * axis]));
    const double size = std::cbrt(sizes[0] * sizes[1] * sizes[2]);
    if (!(size > 0)) throw ExportError("", what + " has a transform that cannot be inverted");
    bool rigid = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
        rigid = rigid && std::abs(sizes[axis] / size - 1) < 1e-4 &&
                std::abs(dot(&m[4 * axis], &m[4 * ((axis + 1) % 3)])) < 1e-4 * size * size;
    RestageFilm settings{};
    in_.film(in_.ctx, &settings);
    const double aspect = double(settings.width) / std::max(settings.height, 1u);
    auto window = screen_window(camera, aspect);
    if (window[0] > window[1]) { // mirrored
        std::swap(window[0], window[1]);
        for (std::size_t row = 0; row < 3; ++row)
            m[row] = -m[row];
        window = {-window[1], -window[0], window[2], window[3]};
    }
    const double half_x = (window[1] - window[0]) / 2, half_y = (window[3] - window[2]) / 2;
    const double centre_x = (window[1] + window[0]) / 2, centre_y = (window[3] + window[2]) / 2;
    const bool parallel = camera.projection == RESTAGE_ORTHOGRAPHIC;
    if (camera.projection == RESTAGE_SPHERICAL || camera.projection == RESTAGE_SPHERICAL_EQUAL_AREA)
        dropped(what, "Mitsuba has no camera that sees all directions; a perspective one is written");
    if (!parallel) {
        if (!rigid)
            approximated(what, "Mitsuba's cameras cannot be stretched or sheared; the nearest rotation is written");
        // Gram-Schmidt, in the order in which the axes matter: view, up, right; keeping the handedness.
        const double hand = determinant(m.data()) < 0 ? -1 : 1;
        for (std::size_t row = 0; row < 3; ++row)
            m[8 + row] /= sizes[2];
        const double along = dot(&m[4], &m[8]);
        for (std::size_t row = 0; row < 3; ++row)
            m[4 + row] -= along * m[8 + row];
        const double up = std::sqrt(dot(&m[4], &m[4]));
        for (std::size_t row = 0; row < 3; ++row)
            m[4 + row] /= up;
        for (std::size_t row = 0; row < 3; ++row)
            m[row] = hand * (m[4 + (row + 1) % 3] * m[8 + (row + 2) % 3] - m[4 + (row + 2) % 3] * m[8 + (row + 1) % 3]);
    }
    const bool lens = camera.lens_radius > 0;
    if (parallel && lens) dropped(what, "Mitsuba's orthographic camera has no lens");
    head_.open("sensor", parallel ? "orthographic" : lens ? "thinlens" : "perspective");
    if (parallel) { // its film is 2 wide, and as high as the aspect makes it
        for (std::size_t row = 0; row < 3; ++row) {
            m[12 + row] += centre_x * m[row] + centre_y * m[4 + row];
            m[row] *= half_x;
            m[4 + row] *= half_y * aspect;
        }
    } else {
        const bool all_around = camera.projection != RESTAGE_PERSPECTIVE;
        const double tangent = std::tan(static_cast<double>(all_around ? 90.f : camera.fov) * std::numbers::pi / 360);
        if (std::abs(half_x / half_y / aspect - 1) > 1e-4)
            approximated(what, "its pixels are not square, but Mitsuba's are: the field of view across is kept");
        head_.put("fov", std::atan(tangent * half_x) * 360 / std::numbers::pi);
        head_.put("fov_axis", std::string_view("x"));
        if (centre_x != 0) head_.put("principal_point_offset_x", centre_x / (2 * half_x));
        if (centre_y != 0) head_.put("principal_point_offset_y", -centre_y / (2 * half_y));
        if (lens) {
            head_.put("aperture_radius", static_cast<double>(camera.lens_radius) * size);
            head_.put("focus_distance", static_cast<double>(camera.focal_distance) * size);
        }
    }
    const auto clip = clip_distances(m);
    head_.put("near_clip", clip[0]);
    head_.put("far_clip", clip[1]);
    for (std::size_t row = 0; row < 3; ++row)
        m[row] = 0 - m[row];
    head_.matrix("to_world", m);
    film();
    head_.close();
}

void Exporter::film() {
    RestageFilm film{};
    in_.film(in_.ctx, &film);
    RestageSettings settings{};
    in_.settings(in_.ctx, &settings);
    head_.open("sampler", "multijitter");
    head_.put("sample_count", static_cast<int>(settings.samples ? std::min(settings.samples, 1u << 30) : 16));
    head_.close();
    head_.open("film", "hdrfilm");
    const int width = static_cast<int>(film.width), height = static_cast<int>(film.height);
    head_.put("width", width);
    head_.put("height", height);
    const float* c = film.crop;
    if (c[0] != 0 || c[1] != 1 || c[2] != 0 || c[3] != 1) { // pbrt: from ceil(x0 width) to ceil(x1 width)
        const auto at = [](float part, int size) {
            return std::clamp(static_cast<int>(std::ceil(part * float(size))), 0, size);
        };
        const int x0 = at(c[0], width), x1 = at(c[1], width), y0 = at(c[2], height), y1 = at(c[3], height);
        head_.put("crop_offset_x", x0);
        head_.put("crop_offset_y", y0);
        head_.put("crop_width", std::max(x1 - x0, 1));
        head_.put("crop_height", std::max(y1 - y0, 1));
    }
    head_.put("pixel_format", std::string_view("rgb"));
    head_.put("component_format", std::string_view("float32"));
    if (film.exposure != 1)
        approximated("film",
                     "Mitsuba's film has no exposure: its picture is in the scene's own units, before exposure");
    filter(film);
    head_.close();
}

void Exporter::filter(const RestageFilm& film) {
    const std::string name = film.filter;
    const float rx = film.filter_radius[0], ry = film.filter_radius[1], a = film.filter_params[0];
    const auto unlike = [&](const char* note) { approximated("pixel filter \"" + name + "\"", note); };
    if (rx != ry) unlike("Mitsuba's filters are equally wide in both directions: the width across is kept");
    if (name == "box") {
        if (rx != 0.5f) unlike("Mitsuba's box is one pixel wide");
        head_.open("rfilter", "box");
    } else if (name == "triangle") {
        head_.open("rfilter", "tent");
        head_.put("radius", rx);
    } else if (name == "gaussian") {
        if (std::abs(rx - 4 * a) > 1e-3f) unlike("Mitsuba's Gaussian ends at four standard deviations");
        head_.open("rfilter", "gaussian");
        head_.put("stddev", a);
    } else if (name == "mitchell") {
        if (rx != 2) unlike("Mitsuba's filter of Mitchell and Netravali has a radius of two pixels");
        head_.open("rfilter", "mitchell");
        head_.put("B", a);
        head_.put("C", film.filter_params[1]);
    } else {
        unlike("Mitsuba's nearest filter is written, lanczos");
        head_.open("rfilter", "lanczos");
        head_.put("lobes", std::max(static_cast<int>(std::lround(rx)), 1));
    }
    head_.close();
}

} // namespace restage::mitsuba_out
