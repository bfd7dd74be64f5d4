// SPDX-License-Identifier: Apache-2.0
// NURBS surfaces of pbrt-v3, diced as in pbrt-v3 (nurbs.cpp: 30 x 30 points, uniform in the parameters), so that
// the triangles are the same. Basis functions: Piegl and Tiller 1997, "The NURBS Book", Eqs. 2.5 and 2.7.
#include "mesh.hpp"

#include <algorithm>
#include <cmath>

namespace restage::pbrt {

namespace {

struct Direction { // u or v
    int count = 0, order = 0;
    std::vector<double> knots;
    double from = 0, to = 0;
};

struct Basis { // of the control points first ... first + order - 1
    int first = 0;
    std::vector<double> value, slope;
};

Direction direction(const Directive& shape, const std::string& axis) {
    Direction out;
    out.count = shape.params.integer("n" + axis, -1);
    out.order = shape.params.integer(axis + "order", -1);
    constexpr int most = 1 << 20, highest_order = 32;
    if (out.order < 2 || out.order > highest_order || out.count < out.order || out.count > most)
        throw ImportError{shape.at, "Shape \"nurbs\" needs \"integer " + axis +
                                        "order\" of 2 or more and at least as many \"integer n" + axis + "\" points"};
    if (const std::vector<double>* knots = shape.params.numbers(axis + "knots")) out.knots = *knots;
    const auto n = static_cast<std::size_t>(out.count), order = static_cast<std::size_t>(out.order);
    if (out.knots.size() != n + order || !std::is_sorted(out.knots.begin(), out.knots.end()) ||
        !(out.knots[order - 1] < out.knots[n]))
        throw ImportError{shape.at, "Shape \"nurbs\" needs " + std::to_string(n + order) + " rising \"float " + axis +
                                        "knots\" (points and order together)"};
    out.from = std::clamp(shape.params.number(axis + "0", out.knots[order - 1]), out.knots[order - 1], out.knots[n]);
    out.to = std::clamp(shape.params.number(axis + "1", out.knots[n]), out.knots[order - 1], out.knots[n]);
    return out;
}

Basis basis(const Direction& d, double t) {
    const auto order = static_cast<std::size_t>(d.order);
    const auto first = d.knots.begin() + d.order - 1, last = d.knots.begin() + d.count;
    auto span = std::upper_bound(first, last, t) - d.knots.begin() - 1; // knots[span] <= t < knots[span + 1]
    while (span > d.order - 1 && d.knots[static_cast<std::size_t>(span)] == d.knots[static_cast<std::size_t>(span) + 1])
        --span; // at the end: the last span that is not empty
    const auto knot = [&](std::ptrdiff_t i) { return d.knots[static_cast<std::size_t>(i)]; };
    Basis out;
    out.first = static_cast<int>(span) - d.order + 1;
    std::vector<double> lower, n{1}; // of the next lower degree
    for (std::size_t degree = 1; degree < order; ++degree) {
        lower = n;
        n.assign(degree + 1, 0);
        for (std::size_t i = 0; i < degree; ++i) {
            const auto k = span - static_cast<std::ptrdiff_t>(degree) + 1 + static_cast<std::ptrdiff_t>(i);
            const double width = knot(k + static_cast<std::ptrdiff_t>(degree)) - knot(k);
            const double rises = width > 0 ? lower[i] / width : 0;
            n[i] += (knot(k + static_cast<std::ptrdiff_t>(degree)) - t) * rises;
            n[i + 1] += (t - knot(k)) * rises;
        }
    }
    out.value = n;
    out.slope.assign(order, 0);
    const double degree = d.order - 1;
    for (std::size_t i = 0; i + 1 < order; ++i) {
        const auto k = span - d.order + 2 + static_cast<std::ptrdiff_t>(i);
        const double width = knot(k + d.order - 1) - knot(k);
        const double rises = width > 0 ? degree * lower[i] / width : 0;
        out.slope[i] -= rises;
        out.slope[i + 1] += rises;
    }
    return out;
}

} // namespace

Mesh make_nurbs(Import&, const Directive& shape) {
    const Direction u = direction(shape, "u"), v = direction(shape, "v");
    const bool weighted = !shape.params.has("P");
    const std::vector<double>* points = shape.params.numbers(weighted ? "Pw" : "P");
    const std::size_t width = weighted ? 4 : 3, count = std::size_t(u.count) * std::size_t(v.count);
    if (!points || points->size() != count * width)
        throw ImportError{shape.at, "Shape \"nurbs\" needs nu x nv points \"P\" (three numbers each) or \"Pw\" (four)"};
    constexpr int dice = 30;
    Mesh mesh;
    for (int j = 0; j < dice; ++j)
        for (int i = 0; i < dice; ++i) {
            const double s = u.from + (u.to - u.from) * i / (dice - 1), t = v.from + (v.to - v.from) * j / (dice - 1);
            const Basis bu = basis(u, s), bv = basis(v, t);
            Vec3 p, du, dv; // homogeneous, weights apart
            double w = 0, wu = 0, wv = 0;
            for (std::size_t b = 0; b < bv.value.size(); ++b)
                for (std::size_t a = 0; a < bu.value.size(); ++a) {
                    const std::size_t at =
                        (std::size_t(bv.first) + b) * std::size_t(u.count) + std::size_t(bu.first) + a;
                    const double* q = points->data() + at * width;
                    const Vec3 c{q[0], q[1], q[2]};
                    const double weight = weighted ? q[3] : 1;
                    const double n = bu.value[a] * bv.value[b], nu = bu.slope[a] * bv.value[b],
                                 nv = bu.value[a] * bv.slope[b];
                    p = p + c * n;
                    du = du + c * nu;
                    dv = dv + c * nv;
                    w += weight * n;
                    wu += weight * nu;
                    wv += weight * nv;
                }
            if (!(std::abs(w) > 0)) throw ImportError{shape.at, "Shape \"nurbs\": the weights of \"Pw\" add up to 0"};
            const Vec3 at = p * (1 / w);
            const Vec3 n = normalize(cross((du - at * wu) * (1 / w), (dv - at * wv) * (1 / w))); // Eq. 4.20
            for (const double x : {at.x, at.y, at.z})
                mesh.positions.push_back(static_cast<float>(x));
            for (const double x : {n.x, n.y, n.z})
                mesh.normals.push_back(static_cast<float>(x));
            for (const double x : {s, t})
                mesh.uvs.push_back(static_cast<float>(x));
        }
    for (std::uint32_t j = 0; j + 1 < dice; ++j)
        for (std::uint32_t i = 0; i + 1 < dice; ++i) {
            const std::uint32_t a = j * dice + i, b = a + 1, c = b + dice, d = a + dice;
            mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
        }
    return mesh;
}

} // namespace restage::pbrt
