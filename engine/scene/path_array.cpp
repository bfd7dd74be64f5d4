// SPDX-License-Identifier: Apache-2.0
#include "scene/path_array.hpp"

#include "scene/arrange.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::scene {

namespace {

constexpr int pieces = 24; // of the curve between two points

// Between b and c, at `part` of the way in the spline's parameter: the pyramid of Barry and Goldman with knots at
// square roots of distances.
glm::dvec3 catmull_rom(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d,
                       double part) {
    const double t1 = std::sqrt(glm::length(b - a)), t2 = t1 + std::sqrt(glm::length(c - b)),
                 t3 = t2 + std::sqrt(glm::length(d - c)), t = glm::mix(t1, t2, part);
    const auto between = [t](const glm::dvec3& p, double from, const glm::dvec3& q, double to) {
        return glm::mix(p, q, (t - from) / (to - from));
    };
    const glm::dvec3 ab = between(a, 0, b, t1), bc = between(b, t1, c, t2), cd = between(c, t2, d, t3);
    return between(between(ab, 0, bc, t2), t1, between(bc, t1, cd, t3), t2);
}

// The part of `v` across `up`.
glm::dvec3 flat(const glm::dvec3& v, const glm::dvec3& up) { return v - up * glm::dot(v, up); }

glm::dmat4 turn_about(const glm::dvec3& up, const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 a = flat(from, up), b = flat(to, up);
    const double sine = glm::dot(glm::cross(a, b), up), cosine = glm::dot(a, b);
    if (sine == 0 && cosine == 0) return glm::dmat4(1); // one of them is vertical
    return glm::rotate(glm::dmat4(1), std::atan2(sine, cosine), up);
}

} // namespace

std::vector<glm::dvec3> path_through(std::span<const glm::dvec3> given, bool smooth) {
    std::vector<glm::dvec3> points;
    for (const glm::dvec3& p : given)
        if (points.empty() || glm::length(p - points.back()) > 0) points.push_back(p);
    if (!smooth || points.size() < 3) return points;
    std::vector<glm::dvec3> path;
    const std::size_t last = points.size() - 1;
    for (std::size_t i = 0; i < last; ++i) {
        const glm::dvec3 &b = points[i], &c = points[i + 1];
        const glm::dvec3 a = i > 0 ? points[i - 1] : 2.0 * b - c, d = i + 1 < last ? points[i + 2] : 2.0 * c - b;
        for (int k = 0; k < pieces; ++k)
            path.push_back(catmull_rom(a, b, c, d, double(k) / pieces));
    }
    path.push_back(points.back());
    return path;
}

double length_of(std::span<const glm::dvec3> path) {
    double length = 0;
    for (std::size_t i = 1; i < path.size(); ++i)
        length += glm::length(path[i] - path[i - 1]);
    return length;
}

std::vector<glm::dmat4> path_array(std::span<const glm::dvec3> path, const PathArray& array) {
    const double length = length_of(path);
    if (!(length > 0)) return {};
    const double copies = array.spacing > 0 ? std::floor(length / array.spacing * (1 + 1e-12)) : array.count - 1;
    const auto n = std::size_t(std::clamp(copies, 0.0, double(most_copies)));
    const double step = array.spacing > 0 ? array.spacing : length / double(std::max<std::size_t>(n, 1));
    std::vector<glm::dmat4> moves;
    moves.reserve(n);
    std::size_t piece = 1; // ends at path[piece]
    double before = 0; // its beginning's distance along the path
    const glm::dvec3 first = path[1] - path[0];
    for (std::size_t i = 1; i <= n; ++i) {
        const double at = std::min(step * double(i), length);
        double own = glm::length(path[piece] - path[piece - 1]);
        while (at > before + own && piece + 1 < path.size()) {
            before += own;
            ++piece;
            own = glm::length(path[piece] - path[piece - 1]);
        }
        const glm::dvec3 along = path[piece] - path[piece - 1];
        const glm::dvec3 place = path[piece - 1] + along * std::min((at - before) / own, 1.0);
        glm::dmat4 move = glm::translate(glm::dmat4(1), place);
        if (array.turn) move *= turn_about(array.up, first, along);
        moves.push_back(move * glm::translate(glm::dmat4(1), -path[0]));
    }
    return moves;
}

} // namespace restage::scene
