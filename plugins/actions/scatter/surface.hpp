// SPDX-License-Identifier: Apache-2.0
// The surface to scatter on: points on it, uniform by area in world space.
#pragma once

#include "vec.hpp"

#include <restage/scene_io.h>
#include <cstdint>
#include <vector>

namespace scatter {

struct Spot {
    Vec at, normal; // unit, of the triangle, on the chosen side
};

struct SurfaceOptions {
    bool back = false;    // the other side
    Vec up;               // unit
    double least_cos = -1; // triangles whose normal is further from up are left out
};

class Surface {
  public:
    Surface(const RestageMesh& mesh, const RestageInstance& instance, const SurfaceOptions& options);

    double area() const { return areas_.empty() ? 0 : areas_.back(); } // of the triangles that are not left out
    double whole_area() const { return whole_area_; }
    Spot sample(double u, double v, double w) const; // of [0, 1) each; area() > 0

  private:
    struct Triangle {
        Vec corner, edge1, edge2, normal;
    };
    std::vector<Triangle> triangles_; // of positive area
    std::vector<double> areas_;       // cumulative area, including each triangle
    double whole_area_ = 0;
};

// Poisson disks by dart throwing (R. Cook, "Stochastic Sampling in Computer Graphics", 1986): a point that is nearer
// than `distance` to an earlier one is rejected. Points are kept in a grid of that cell width, so each dart checks 27
// cells.
class Disks {
  public:
    explicit Disks(double distance) : distance_(distance) {}
    bool add(Vec point); // false: too near

  private:
    struct Cell {
        std::int64_t x, y, z;
        bool operator==(const Cell&) const = default;
    };
    std::vector<std::uint32_t>& bucket(const Cell&);

    double distance_;
    std::vector<Vec> points_;
    std::vector<std::vector<std::uint32_t>> buckets_ = std::vector<std::vector<std::uint32_t>>(1 << 15);
};

} // namespace scatter
