// SPDX-License-Identifier: Apache-2.0
// Partition of the sphere for comparing samples with a density: 80 x 160 cells of equal solid angle, split where pilot
// samples are dense, so that a lobe of any width covers many cells; and the integral of functions over the cells,
// by Gauss quadrature, split until certain. Works in a = 1 - |z|, which stays precise near the poles.
#pragma once

#include "base/jobs.hpp"
#include "check/bsdf_lab.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace restage::check {

struct CellRect { // solid angle = (a1 - a0) * (phi1 - phi0)
    double a0 = 0, a1 = 0, phi0 = 0, phi1 = 0;
    bool upper = true; // z > 0
    double solid_angle() const { return (a1 - a0) * (phi1 - phi0); }
    Vec3 at(double u, double v) const; // direction; u along a, v along phi, both in [0, 1]
};

class SphereCells {
  public:
    static constexpr int rows = 80, columns = 160;

    // Splits cells while more than `most` of the pilot directions fall into one.
    SphereCells(std::span<const Vec3> pilot, std::size_t most);
    std::size_t size() const { return leaves_.size(); }
    std::size_t find(const Vec3& w) const;
    const CellRect& cell(std::size_t leaf) const { return leaves_[leaf]; }

  private:
    struct Node {
        CellRect rect;
        std::int32_t child = -1; // the first of two
        std::int32_t leaf = -1;
    };
    void split(std::size_t node, std::vector<Vec3>& inside, std::size_t most, int depth);
    std::vector<Node> nodes_; // rows * columns roots first
    std::vector<CellRect> leaves_;
};

// The contribution of one direction: several functions at once (density, and the value's channels).
inline constexpr std::size_t integrands = 4;
using Integrand = std::array<double, integrands>;

struct CellIntegral {
    Integrand value{};
    double error = 0; // bound on that of value[0]
    double others_error = 0; // on that of each other value
};

struct Quadrature {
    std::vector<CellIntegral> cells;
    std::size_t evaluations = 0;
    bool certain = true; // every cell reached its tolerance
};

struct QuadratureOptions {
    // Called with batches of directions.
    std::function<Result<std::vector<Integrand>>(std::span<const Vec3>)> evaluate;
    std::function<double(double value)> tolerance; // allowed error of a cell's value[0]
    std::size_t most = 0;                          // evaluations
    // Cells whose sample counts disagree with their integral are integrated again in 64 parts: if a
    // density ends inside a cell, nine points may miss it. More exact integrals favour no outcome.
    std::function<bool(std::size_t cell, double value)> doubtful;
    // Allowed error of the other values in a cell; cells are split for them too. 0: unlimited.
    double others_tolerance = 0;
};
// Value 0 decides where to split, as do the others if they have a tolerance.
Result<Quadrature> integrate(const SphereCells& cells, Jobs& jobs, const QuadratureOptions& options);

} // namespace restage::check
