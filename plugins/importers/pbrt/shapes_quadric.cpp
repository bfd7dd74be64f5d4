// SPDX-License-Identifier: Apache-2.0
// Quadrics as triangle grids over pbrt's own (u, v), with its normals dp/du x dp/dv. pbrt-v4 book ch. 6; cone,
// paraboloid and hyperboloid: pbrt-v3 book ch. 3. Parameters are clamped and sorted as in pbrt. Spheres, disks
// and cylinders are rendered exactly (RestageMesh::primitive); their grids are for picking and bounds.
#include "mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace restage::pbrt {

namespace {

constexpr double pi = std::numbers::pi;

struct Sample {
    Vec3 p, n; // n: along dp/du x dp/dv, any length
};

template <class Surface>
Mesh grid(int columns, int rows, const Surface& surface) {
    Mesh mesh;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            const double u = double(i) / columns, v = double(j) / rows;
            const Sample s = surface(u, v);
            const Vec3 n = normalize(s.n);
            for (const double x : {s.p.x, s.p.y, s.p.z})
                mesh.positions.push_back(static_cast<float>(x));
            for (const double x : {n.x, n.y, n.z})
                mesh.normals.push_back(static_cast<float>(x));
            for (const double x : {u, v})
                mesh.uvs.push_back(static_cast<float>(x));
        }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
    const auto same = [&](std::uint32_t a, std::uint32_t b) { // corners that meet at a pole
        return std::equal(mesh.positions.begin() + 3 * std::ptrdiff_t(a),
                          mesh.positions.begin() + 3 * std::ptrdiff_t(a) + 3,
                          mesh.positions.begin() + 3 * std::ptrdiff_t(b));
    };
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (!same(a, b) && !same(b, c) && !same(c, a)) mesh.indices.insert(mesh.indices.end(), {a, b, c});
    };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) { // cross(du, dv) is the winding
            triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    return mesh;
}

// Moves the vertices away from the axis (and, of a sphere, from its centre) until the area is the exact one.
void match_area(Mesh& mesh, double exact, bool from_centre) {
    for (int round = 0; round < 8;
         ++round) { // linear in the factor for spheres and cylinders: one round is nearly enough
        const double now = area(mesh, Matrix{});
        if (!(now > 0) || std::abs(now / exact - 1) < 1e-7) return;
        const double factor = from_centre ? std::sqrt(exact / now) : exact / now;
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            if (from_centre || i % 3 != 2) mesh.positions[i] = static_cast<float>(double(mesh.positions[i]) * factor);
    }
}

constexpr int coarse = 48; // of a full turn, if the grid is not what is rendered

int segments(double phi_max, int full) { return std::max(3, static_cast<int>(std::ceil(full * phi_max / (2 * pi)))); }

void need(bool holds, const Directive& shape, const char* what) {
    if (!holds) throw ImportError{shape.at, "Shape \"" + shape.name + "\": " + what};
}

Mesh sphere(const Directive& shape, double phi_max) {
    const double radius = shape.params.number("radius", 1);
    need(radius > 0 && radius < 1e30, shape, "radius must be positive");
    const double z0 = shape.params.number("zmin", -radius), z1 = shape.params.number("zmax", radius);
    const double low = std::clamp(std::min(z0, z1), -radius, radius),
                 high = std::clamp(std::max(z0, z1), -radius, radius);
    const double theta0 = std::acos(std::clamp(low / radius, -1.0, 1.0)),
                 theta1 = std::acos(std::clamp(high / radius, -1.0, 1.0));
    need(high > low, shape, "zmin and zmax leave nothing of it");
    const int rows = std::max(2, static_cast<int>(std::ceil(coarse / 2 * (theta0 - theta1) / pi)));
    Mesh mesh = grid(segments(phi_max, coarse), rows, [&](double u, double v) {
        const double phi = u * phi_max, theta = theta0 + v * (theta1 - theta0);
        // Exact poles, so that the seam closes there.
        const double s = theta < 1e-9 || pi - theta < 1e-9 ? 0 : std::sin(theta);
        const Vec3 n{s * (u == 1 && phi_max == 2 * pi ? 1 : std::cos(phi)),
                     s * (u == 1 && phi_max == 2 * pi ? 0 : std::sin(phi)),
                     s == 0 ? (theta < 1 ? 1.0 : -1.0) : std::cos(theta)};
        return Sample{n * radius, n};
    });
    match_area(mesh, phi_max * radius * (high - low), true); // Archimedes
    return mesh;
}

Mesh disk(const Directive& shape, double phi_max) {
    const double height = shape.params.number("height", 0), radius = shape.params.number("radius", 1);
    const double inner = shape.params.number("innerradius", 0);
    need(radius > 0 && radius < 1e30 && inner >= 0 && inner < radius, shape, "0 <= innerradius < radius must hold");
    // v = 0 is the rim; the normal is +z.
    Mesh mesh = grid(segments(phi_max, coarse), inner > 0 ? 1 : 4, [&](double u, double v) {
        const double phi = u == 1 && phi_max == 2 * pi ? 0 : u * phi_max, r = radius + v * (inner - radius);
        return Sample{{r * std::cos(phi), r * std::sin(phi), height}, {0, 0, 1}};
    });
    const double exact = phi_max / 2 * (radius * radius - inner * inner);
    const double now = area(mesh, Matrix{});
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (i % 3 != 2) mesh.positions[i] = static_cast<float>(double(mesh.positions[i]) * std::sqrt(exact / now));
    return mesh;
}

Mesh cylinder(const Directive& shape, double phi_max) {
    const double radius = shape.params.number("radius", 1);
    const double z0 = shape.params.number("zmin", -1), z1 = shape.params.number("zmax", 1);
    const double low = std::min(z0, z1), high = std::max(z0, z1);
    need(radius > 0 && radius < 1e30 && high > low, shape, "radius must be positive and zmin less than zmax");
    Mesh mesh = grid(segments(phi_max, coarse), 1, [&](double u, double v) {
        const double phi = u == 1 && phi_max == 2 * pi ? 0 : u * phi_max;
        const Vec3 n{std::cos(phi), std::sin(phi), 0};
        return Sample{{radius * n.x, radius * n.y, low + v * (high - low)}, n};
    });
    match_area(mesh, phi_max * radius * (high - low), false);
    return mesh;
}

// A curve turned about z. Its exact area is the sum of many frusta, pi (r0 + r1) s each (of a full turn).
template <class Profile>
Mesh revolve(double phi_max, const Profile& profile) {
    Mesh mesh = grid(segments(phi_max, 128), 64, [&](double u, double v) {
        const double phi = u == 1 && phi_max == 2 * pi ? 0 : u * phi_max, h = 1e-5;
        const auto turn = [&](double at, double angle) {
            const Vec3 p = profile(at);
            return Vec3{p.x * std::cos(angle) - p.y * std::sin(angle), p.x * std::sin(angle) + p.y * std::cos(angle),
                        p.z};
        };
        const double v0 = std::max(v - h, 0.0), v1 = std::min(v + h, 1.0);
        const Vec3 dv = turn(v1, phi) - turn(v0, phi);
        // Where the radius is 0, the direction around the axis is the limit of dp/du.
        const Vec3 around = turn(v < 0.5 ? v + 1e-3 : v - 1e-3, phi);
        return Sample{turn(v, phi), cross({-around.y, around.x, 0}, dv)};
    });
    double exact = 0;
    constexpr int frusta = 20000;
    for (int i = 0; i < frusta; ++i) {
        const Vec3 a = profile(double(i) / frusta), b = profile(double(i + 1) / frusta);
        const double r0 = std::hypot(a.x, a.y), r1 = std::hypot(b.x, b.y);
        exact += phi_max * (r0 + r1) / 2 * std::hypot(r1 - r0, b.z - a.z);
    }
    match_area(mesh, exact, false);
    return mesh;
}

Mesh cone(const Directive& shape, double phi_max) {
    const double radius = shape.params.number("radius", 1), height = shape.params.number("height", 1);
    need(radius > 0 && height != 0, shape, "radius must be positive and height not 0");
    return revolve(phi_max, [=](double v) { return Vec3{radius * (1 - v), 0, v * height}; });
}

Mesh paraboloid(const Directive& shape, double phi_max) {
    const double radius = shape.params.number("radius", 1);
    const double z0 = shape.params.number("zmin", 0), z1 = shape.params.number("zmax", 1);
    const double low = std::min(z0, z1), high = std::max(z0, z1);
    need(radius > 0 && high > 0 && low >= 0 && high > low, shape, "radius must be positive and 0 <= zmin < zmax");
    return revolve(phi_max, [=](double v) {
        const double z = low + v * (high - low);
        return Vec3{radius * std::sqrt(z / high), 0, z};
    });
}

Mesh hyperboloid(const Directive& shape, double phi_max) { // the line from p1 to p2, turned about z
    const auto a = shape.params.triple("p1", {0, 0, 0}), b = shape.params.triple("p2", {1, 1, 1});
    need(a != b, shape, "p1 and p2 must differ");
    return revolve(phi_max, [=](double v) { return Vec3{a[0], a[1], a[2]} * (1 - v) + Vec3{b[0], b[1], b[2]} * v; });
}

} // namespace

double area(const Mesh& mesh, const Matrix& to_world) {
    double sum = 0;
    const auto point = [&](std::uint32_t i) {
        const float* p = mesh.positions.data() + 3 * std::size_t(i);
        return transform_point(to_world, {double(p[0]), double(p[1]), double(p[2])});
    };
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const Vec3 a = point(mesh.indices[t]);
        sum += length(cross(point(mesh.indices[t + 1]) - a, point(mesh.indices[t + 2]) - a)) / 2;
    }
    return sum;
}

std::optional<Mesh> make_quadric(Import&, const Directive& shape) {
    static const std::map<std::string_view, Mesh (*)(const Directive&, double)> makers = {
        {"sphere", sphere},          {"disk", disk}, {"cylinder", cylinder}, {"cone", cone}, {"paraboloid", paraboloid},
        {"hyperboloid", hyperboloid}};
    const auto maker = makers.find(shape.name);
    if (maker == makers.end()) return std::nullopt;
    const double degrees = std::clamp(shape.params.number("phimax", 360), 0.0, 360.0);
    need(degrees > 0, shape, "phimax must be positive");
    return maker->second(shape, degrees == 360 ? 2 * pi : degrees * pi / 180);
}

} // namespace restage::pbrt
