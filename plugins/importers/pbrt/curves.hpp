// SPDX-License-Identifier: Apache-2.0
// Curves ("curve" shapes: hair, fur, grass, ropes) that share material and attributes, gathered into one mesh. Ribbons
// become strips; flat curves, which pbrt turns to each ray, and cylinders become tubes whose mean silhouette is as wide
// as the curve.
#pragma once

#include "mesh.hpp"

#include <string>
#include <unordered_set>

namespace restage::pbrt {

class CurveBatch {
  public:
    // `to_batch`: from the curve's frame to the batch's; must be a similarity. Throws ImportError for an invalid curve.
    void add(const Directive& shape, const Matrix& to_batch);
    std::size_t size() const { return strands_.size(); }
    std::size_t coincident() const { return coincident_; } // skipped duplicates
    // Triangles of all of them; the more there are, the coarser each is. `error`: largest distance of a tube's axis
    // from the curve, in widths of the curve.
    Mesh tessellate(int& sides, double& error) const;
    // One line `curve "point3 P" [...] ...` each, "" if there are too many to keep.
    const std::string& text() const { return text_; }

  private:
    struct Strand {
        std::size_t first_point = 0; // 3 * segments + 1 control points of cubic Bezier segments
        std::size_t first_normal = 0; // of ribbons: segments + 1
        std::uint32_t segments = 0;
        bool is_ribbon = false;
        float width[2]{};
    };
    std::uint32_t pieces(const Strand& strand, std::uint32_t segment, double error) const;
    void tube(const Strand& strand, int sides, double error, Mesh& mesh) const;
    void strip(const Strand& strand, double error, Mesh& mesh) const;
    Vec3 point(std::size_t index) const;
    void keep_text(const ParamList&, const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                   const double (&widths)[2], bool moved);

    std::vector<Strand> strands_;
    std::vector<float> points_, normals_; // 3 each
    std::unordered_set<std::string> known_; // shapes, as bytes
    std::size_t coincident_ = 0;
    std::string text_;
    bool too_many_for_text_ = false;
};

// Uniform scaling, rotation, mirror, translation; returns the scale.
std::optional<double> similarity(const Matrix& matrix);

} // namespace restage::pbrt
