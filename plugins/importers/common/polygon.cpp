// SPDX-License-Identifier: Apache-2.0
#include "common/polygon.hpp"

#include <algorithm>
#include <cmath>

namespace restage::importing {

namespace {

using Point = std::array<double, 2>;

// Twice the signed area of a, b, c.
double turn(const Point& a, const Point& b, const Point& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

class EarCutter {
  public:
    EarCutter(std::vector<Point> points, std::vector<std::uint32_t>& out) : points_(std::move(points)), out_(out) {
        const auto n = static_cast<std::uint32_t>(points_.size());
        next_.resize(n), before_.resize(n);
        for (std::uint32_t i = 0; i < n; ++i)
            next_[i] = (i + 1) % n, before_[i] = (i + n - 1) % n;
        for (std::uint32_t i = 0; i < n; ++i)
            if (is_reflex(i)) reflex_.push_back(i);
    }

    bool is_convex() const { return reflex_.empty(); }

    void run() {
        auto left = static_cast<std::uint32_t>(points_.size());
        std::uint32_t at = 0, misses = 0;
        while (left > 3 && misses <= left) {
            if (!is_ear(at)) {
                at = next_[at], ++misses;
                continue;
            }
            cut(at);
            --left, misses = 0;
            at = next_[next_[at]]; // not the neighbour: slivers around one corner are avoided
        }
        for (std::uint32_t first = at; left >= 3; --left) { // the last triangle, or an uncuttable rest
            out_.insert(out_.end(), {first, next_[first], next_[next_[first]]});
            next_[first] = next_[next_[first]];
        }
    }

  private:
    bool is_reflex(std::uint32_t i) const { return turn(points_[before_[i]], points_[i], points_[next_[i]]) < 0; }

    bool is_ear(std::uint32_t i) const {
        const Point &a = points_[before_[i]], &b = points_[i], &c = points_[next_[i]];
        if (turn(a, b, c) < 0) return false;
        return std::none_of(reflex_.begin(), reflex_.end(), [&](std::uint32_t r) { // others cannot obstruct
            const Point& p = points_[r];
            if (r == before_[i] || r == i || r == next_[i] || p == a || p == b || p == c) return false;
            return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
        });
    }

    void cut(std::uint32_t i) {
        const std::uint32_t a = before_[i], c = next_[i];
        out_.insert(out_.end(), {a, i, c});
        next_[a] = c, before_[c] = a;
        std::erase_if(reflex_, [&](std::uint32_t r) { return r == i || ((r == a || r == c) && !is_reflex(r)); });
    }

    std::vector<Point> points_;
    std::vector<std::uint32_t>& out_;
    std::vector<std::uint32_t> next_, before_, reflex_;
};

} // namespace

double cut_polygon(std::span<const Vec3> all, std::vector<std::uint32_t>& out) {
    // A corner that repeats the previous one adds nothing, and would hide the polygon's direction of turning there.
    std::vector<std::uint32_t> which;
    std::vector<Vec3> corners;
    for (std::uint32_t i = 0; i < all.size(); ++i)
        if (all[i] != all[(i + all.size() - 1) % all.size()]) which.push_back(i), corners.push_back(all[i]);
    if (corners.size() < all.size()) {
        std::vector<std::uint32_t> cut;
        const double off = cut_polygon(corners, cut);
        for (const std::uint32_t i : cut)
            out.push_back(which[i]);
        return off;
    }
    const std::size_t n = corners.size();
    if (n < 3) return 0;
    const auto fan = [&] {
        for (std::uint32_t i = 2; i < n; ++i)
            out.insert(out.end(), {0u, i - 1, i});
    };
    if (n == 3) {
        fan();
        return 0;
    }
    Vec3 normal{}, center{}; // Newell: the areas of the projections, for any shape; about a corner, for precision
    double size = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 a = corners[i] - corners[0], b = corners[(i + 1) % n] - corners[0];
        normal = normal + cross(a, b);
        center = center + a * (1.0 / static_cast<double>(n));
        size = std::max(size, length(a));
    }
    const Vec3 n1 = normalized(normal, {0, 0, 0});
    if (n1 == Vec3{0, 0, 0}) { // no area, or not finite
        fan();
        return 0;
    }
    const Vec3 u = normalized(cross(std::abs(n1[0]) < 0.8 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, n1));
    const Vec3 v = cross(n1, u);
    std::vector<Point> points;
    double off = 0;
    for (const Vec3& corner : corners) {
        const Vec3 p = corner - corners[0] - center;
        points.push_back({dot(p, u), dot(p, v)});
        off = std::max(off, std::abs(dot(p, n1)));
    }
    EarCutter cutter(std::move(points), out);
    if (cutter.is_convex())
        fan();
    else
        cutter.run();
    return size > 0 ? off / size : 0;
}

} // namespace restage::importing
