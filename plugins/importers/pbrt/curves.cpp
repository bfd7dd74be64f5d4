// SPDX-License-Identifier: Apache-2.0
// Parameters as in the pbrt-v4 book, sec. 6.7 (and pbrt-v3 book, sec. 3.7): curves of several segments, of
// degree 2 and 3, in Bezier or uniform B-spline form, widths interpolated from segment to segment.
#include "curves.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace restage::pbrt {

namespace {

constexpr std::size_t most_text = std::size_t(256) << 20; // [byte] kept for export

// A batch's triangle budget at each level of detail; the last level has no limit.
struct Level {
    int sides;
    double error; // of the widths
    double most_triangles;
};
constexpr Level levels[] = {{8, 0.02, 1e6}, {6, 0.05, 2e6}, {4, 0.1, 3e6}, {3, 0.25, 5e6}, {3, 1, 1e30}};

Vec3 mix(Vec3 a, Vec3 b, double t) { return a * (1 - t) + b * t; }

struct Bezier {
    Vec3 p[4];
    Vec3 at(double t) const {
        const double s = 1 - t;
        return p[0] * (s * s * s) + p[1] * (3 * s * s * t) + p[2] * (3 * s * t * t) + p[3] * (t * t * t);
    }
    Vec3 along(double t) const { // never zero unless the segment is a point
        const double s = 1 - t;
        const Vec3 d = (p[1] - p[0]) * (s * s) + (p[2] - p[1]) * (2 * s * t) + (p[3] - p[2]) * (t * t);
        return dot(d, d) > 0 ? normalize(d) : normalize(p[3] - p[0]);
    }
};

// The Bezier points of the segment after the first `have` points: B-splines by Boehm 1981 for uniform knots, degree 2
// by raising it.
void add_segment(std::vector<Vec3>& out, const Vec3* p, int degree, bool bspline) {
    Vec3 b[4];
    if (degree == 3 && bspline) {
        b[0] = (p[0] + p[1] * 4 + p[2]) * (1.0 / 6);
        b[1] = (p[1] * 2 + p[2]) * (1.0 / 3);
        b[2] = (p[1] + p[2] * 2) * (1.0 / 3);
        b[3] = (p[1] + p[2] * 4 + p[3]) * (1.0 / 6);
    } else if (degree == 3) {
        std::copy(p, p + 4, b);
    } else {
        const Vec3 q[3] = {bspline ? (p[0] + p[1]) * 0.5 : p[0], p[1], bspline ? (p[1] + p[2]) * 0.5 : p[2]};
        b[0] = q[0];
        b[1] = mix(q[0], q[1], 2.0 / 3);
        b[2] = mix(q[1], q[2], 1.0 / 3);
        b[3] = q[2];
    }
    if (out.empty()) out.push_back(b[0]);
    out.insert(out.end(), b + 1, b + 4);
}

void push(std::vector<float>& to, Vec3 v) {
    for (const double x : {v.x, v.y, v.z})
        to.push_back(static_cast<float>(x));
}

std::vector<Vec3> triples(const Param* param, const Directive& shape) {
    std::vector<Vec3> out;
    if (!param) return out;
    if (param->numbers.size() % 3 != 0)
        throw ImportError{param->at,
                          "\"" + param->name + "\" of Shape \"" + shape.name + "\" needs three numbers each"};
    for (std::size_t i = 0; i < param->numbers.size(); i += 3)
        out.push_back({param->numbers[i], param->numbers[i + 1], param->numbers[i + 2]});
    return out;
}

Vec3 any_across(Vec3 along) { // a perpendicular unit vector
    const Vec3 axis = std::abs(along.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    return normalize(cross(along, axis));
}

// Spherical interpolation between unit normals, as for pbrt's ribbons.
Vec3 slerp(Vec3 a, Vec3 b, double t) {
    const double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0));
    if (!(angle > 1e-4)) return normalize(mix(a, b, t));
    return (a * std::sin((1 - t) * angle) + b * std::sin(t * angle)) * (1 / std::sin(angle));
}

} // namespace

std::optional<double> similarity(const Matrix& m) {
    const Vec3 c[3] = {{m.at(0, 0), m.at(1, 0), m.at(2, 0)},
                       {m.at(0, 1), m.at(1, 1), m.at(2, 1)},
                       {m.at(0, 2), m.at(1, 2), m.at(2, 2)}};
    const double s = dot(c[0], c[0]);
    const double off = std::max({std::abs(dot(c[0], c[1])), std::abs(dot(c[1], c[2])), std::abs(dot(c[2], c[0])),
                                 std::abs(dot(c[1], c[1]) - s), std::abs(dot(c[2], c[2]) - s)});
    if (!(s > 0) || off > 1e-6 * s) return std::nullopt;
    return std::sqrt(s);
}

void CurveBatch::add(const Directive& d, const Matrix& to_batch) {
    const ParamList& params = d.params;
    const auto fail = [&](const std::string& why) { throw ImportError{d.at, "Shape \"curve\": " + why}; };
    const int degree = params.integer("degree", 3);
    if (degree != 2 && degree != 3) fail("\"degree\" is " + std::to_string(degree) + "; it must be 2 or 3");
    const std::string basis = params.string("basis", "bezier"), type = params.string("type", "flat");
    if (basis != "bezier" && basis != "bspline") fail("basis " + quote(basis) + "; write \"bezier\" or \"bspline\"");
    if (type != "flat" && type != "ribbon" && type != "cylinder")
        fail("type " + quote(type) + "; write \"flat\", \"ribbon\" or \"cylinder\"");
    const bool bspline = basis == "bspline", is_ribbon = type == "ribbon", moved = !(to_batch == Matrix{});
    const double scale = moved ? similarity(to_batch).value_or(1) : 1;
    const double width = params.number("width", 1);
    const double w[2] = {params.number("width0", width) * scale, params.number("width1", width) * scale};
    params.find("splitdepth"); // affects tessellation only

    const auto order = static_cast<std::size_t>(degree);
    std::vector<Vec3> given = triples(params.has("P") ? params.find("P") : nullptr, d);
    const std::size_t n = given.size();
    if (n < order + 1 || (!bspline && (n - 1) % order != 0))
        fail(std::to_string(n) + " points; it needs " +
             (bspline ? "at least " + std::to_string(degree + 1)
                      : std::to_string(degree + 1) + " and " + std::to_string(degree) + " for each further segment"));
    const std::size_t segments = bspline ? n - order : (n - 1) / order;
    std::vector<Vec3> normals = triples(params.has("N") ? params.find("N") : nullptr, d);
    if (is_ribbon && normals.size() != segments + 1)
        fail(std::to_string(normals.size()) + " normals; a ribbon of " + std::to_string(segments) +
             " segments needs one more than those");
    for (Vec3& p : given) {
        if (moved) p = transform_point(to_batch, p);
        if (!(std::abs(p.x) + std::abs(p.y) + std::abs(p.z) < 1e30)) fail("a point is too far away for a float");
    }
    for (Vec3& normal : normals)
        if (moved) normal = transform_vector(to_batch, normal) * (1 / scale);
    if (!(w[0] >= 0 && w[1] >= 0 && w[0] + w[1] < 1e30)) fail("its widths must not be negative");

    std::vector<Vec3> bezier;
    for (std::size_t s = 0; s < segments; ++s)
        add_segment(bezier, given.data() + s * (bspline ? 1 : order), degree, bspline);
    keep_text(params, given, normals, w, moved);
    // A duplicate curve is invisible; but thousands of them would be intersected by every ray.
    std::vector<float> shape{static_cast<float>(w[0]), static_cast<float>(w[1]), is_ribbon ? 1.f : 0.f};
    for (const Vec3 p : bezier)
        push(shape, p);
    if (is_ribbon)
        for (const Vec3 normal : normals)
            push(shape, normal);
    if (!known_.emplace(reinterpret_cast<const char*>(shape.data()), shape.size() * sizeof(float)).second) {
        ++coincident_;
        return;
    }
    strands_.push_back({.first_point = points_.size() / 3,
                        .first_normal = normals_.size() / 3,
                        .segments = static_cast<std::uint32_t>(segments),
                        .is_ribbon = is_ribbon,
                        .width = {static_cast<float>(w[0]), static_cast<float>(w[1])}});
    for (const Vec3 p : bezier)
        push(points_, p);
    if (is_ribbon)
        for (const Vec3 normal : normals)
            push(normals_, normalize(normal));
}

void CurveBatch::keep_text(const ParamList& params, const std::vector<Vec3>& given, const std::vector<Vec3>& normals,
                           const double (&w)[2], bool moved) {
    if (too_many_for_text_) return;
    text_ += text_.empty() ? "curve" : "\ncurve";
    for (const Param& param : params.params) {
        const bool changed = moved && (param.name == "P" || param.name == "N" || param.name.starts_with("width"));
        if (param.name == "alpha" || param.name == "shadowalpha" || is_material_parameter(param.name)) continue;
        if (!changed) {
            (text_ += ' ') += to_text(param);
        } else if (param.name == "P" || param.name == "N") {
            Param here = param;
            here.numbers.clear();
            for (const Vec3 v : param.name == "P" ? given : normals)
                here.numbers.insert(here.numbers.end(), {v.x, v.y, v.z});
            (text_ += ' ') += to_text(here);
        }
    }
    if (moved) text_ += " \"float width0\" [ " + shortest(w[0]) + " ] \"float width1\" [ " + shortest(w[1]) + " ]";
    if (text_.size() > most_text) {
        too_many_for_text_ = true;
        text_ = std::string();
    }
}

Vec3 CurveBatch::point(std::size_t i) const {
    return {double(points_[3 * i]), double(points_[3 * i + 1]), double(points_[3 * i + 2])};
}

// A cubic in k equal pieces deviates from its chords by at most 3/4 of its largest second difference over k^2 (Wang
// 1984).
std::uint32_t CurveBatch::pieces(const Strand& strand, std::uint32_t segment, double error) const {
    const std::size_t i = strand.first_point + 3 * std::size_t(segment);
    const Vec3 p[4] = {point(i), point(i + 1), point(i + 2), point(i + 3)};
    const double bend = std::max(length(p[0] - p[1] * 2 + p[2]), length(p[1] - p[2] * 2 + p[3]));
    const double width = std::max({double(strand.width[0]), double(strand.width[1]), 1e-4 * length(p[3] - p[0])});
    constexpr double most = 256;
    const double k = std::sqrt(0.75 * bend / std::max(error * width, 1e-30));
    return static_cast<std::uint32_t>(std::clamp(std::ceil(k), 1.0, most));
}

Mesh CurveBatch::tessellate(int& sides, double& error) const {
    std::size_t vertices = 0, triangles = 0;
    for (const Level& level : levels) {
        sides = level.sides;
        error = level.error;
        vertices = triangles = 0;
        for (const Strand& strand : strands_) {
            std::size_t steps = 0;
            for (std::uint32_t s = 0; s < strand.segments; ++s)
                steps += pieces(strand, s, error);
            const auto around = static_cast<std::size_t>(strand.is_ribbon ? 2 : sides);
            vertices += (steps + 1) * around;
            triangles += 2 * steps * (strand.is_ribbon ? 1 : around);
        }
        if (double(triangles) <= level.most_triangles) break;
    }
    Mesh mesh;
    mesh.positions.reserve(3 * vertices);
    mesh.normals.reserve(3 * vertices);
    mesh.uvs.reserve(2 * vertices);
    mesh.indices.reserve(3 * triangles);
    for (const Strand& strand : strands_)
        if (strand.is_ribbon)
            strip(strand, error, mesh);
        else
            tube(strand, sides, error, mesh);
    return mesh;
}

void CurveBatch::tube(const Strand& strand, int sides, double error, Mesh& mesh) const {
    // The mean projected width of a convex shape is its perimeter over pi (Cauchy); of a regular n-gon: 2 n r
    // sin(pi/n).
    const double pi = std::numbers::pi, radius_of_width = pi / (2 * sides * std::sin(pi / sides));
    Vec3 across;
    bool first = true;
    const auto ring = [&](const Bezier& curve, double t, double u) {
        const Vec3 centre = curve.at(t), along = curve.along(t);
        // The frame is transported without rotation about the curve.
        Vec3 carried = across - along * dot(across, along);
        across = first || !(dot(carried, carried) > 1e-12) ? any_across(along) : normalize(carried);
        first = false;
        const Vec3 other = cross(along, across);
        const double r = radius_of_width * (double(strand.width[0]) * (1 - u) + double(strand.width[1]) * u);
        for (int k = 0; k < sides; ++k) {
            const double angle = 2 * pi * k / sides;
            const Vec3 out = across * std::cos(angle) + other * std::sin(angle);
            push(mesh.positions, centre + out * r);
            push(mesh.normals, out);
            mesh.uvs.push_back(static_cast<float>(u));
            mesh.uvs.push_back(static_cast<float>(1 - std::abs(1 - 2.0 * k / sides))); // there and back: no seam
        }
    };
    const auto n = static_cast<std::uint32_t>(sides);
    for (std::uint32_t s = 0; s < strand.segments; ++s) {
        const std::size_t i = strand.first_point + 3 * std::size_t(s);
        const Bezier curve{{point(i), point(i + 1), point(i + 2), point(i + 3)}};
        const std::uint32_t steps = pieces(strand, s, error);
        for (std::uint32_t step = s == 0 ? 0 : 1; step <= steps; ++step) {
            const double t = double(step) / steps;
            ring(curve, t, (s + t) / strand.segments);
            if (step == 0) continue;
            const auto b = static_cast<std::uint32_t>(mesh.vertex_count()) - n, a = b - n;
            for (std::uint32_t k = 0; k < n; ++k) { // outward: around x along
                const std::uint32_t next = (k + 1) % n;
                mesh.indices.insert(mesh.indices.end(), {a + k, a + next, b + next, a + k, b + next, b + k});
            }
        }
    }
}

void CurveBatch::strip(const Strand& strand, double error, Mesh& mesh) const {
    const auto normal = [&](std::size_t i) {
        const float* n = normals_.data() + 3 * (strand.first_normal + i);
        return Vec3{double(n[0]), double(n[1]), double(n[2])};
    };
    for (std::uint32_t s = 0; s < strand.segments; ++s) {
        const std::size_t i = strand.first_point + 3 * std::size_t(s);
        const Bezier curve{{point(i), point(i + 1), point(i + 2), point(i + 3)}};
        const std::uint32_t steps = pieces(strand, s, error);
        for (std::uint32_t step = s == 0 ? 0 : 1; step <= steps; ++step) {
            const double t = double(step) / steps, u = (s + t) / strand.segments;
            const Vec3 centre = curve.at(t), along = curve.along(t), up = slerp(normal(s), normal(s + 1), t);
            Vec3 across = normalize(cross(up, along));
            if (!(dot(across, across) > 0.5)) across = any_across(along);
            const Vec3 half = across * ((double(strand.width[0]) * (1 - u) + double(strand.width[1]) * u) / 2);
            const Vec3 out = cross(along, across);
            for (const double side : {-1.0, 1.0}) {
                push(mesh.positions, centre + half * side);
                push(mesh.normals, out);
                mesh.uvs.push_back(static_cast<float>(u));
                mesh.uvs.push_back(static_cast<float>((1 + side) / 2));
            }
            if (step == 0) continue;
            const auto b = static_cast<std::uint32_t>(mesh.vertex_count()) - 2, a = b - 2;
            mesh.indices.insert(mesh.indices.end(), {a, b, b + 1, a, b + 1, a + 1}); // along x across
        }
    }
}

} // namespace restage::pbrt
