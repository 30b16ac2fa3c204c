// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "image/image.h"
#include "maps/footprint.h"
#include "maps/normal_space.h"
#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"

namespace kiln {

/// One side of a point on a seam: the triangle, the place in it, and the footprint of a lookup there.
struct SeamSide {
  TexelSource source;
  Footprint footprint;
};

/// Point on a seam, seen from its two triangles, and the length of seam that it stands for (texels of the longer side).
struct SeamPoint {
  std::array<SeamSide, 2> sides;
  float length_texels = 0;
};

/// Difference between the two sides of the seams, over points spread along them.
struct SeamMismatch {
  double mean = 0;  ///< weighted by length
  double largest = 0;
};

/// The seams of an atlas in a texture of `width` x `height` texels: edges between two triangles whose ends have the
/// same positions (exactly, as Draco decodes them) but different uvs. Hard edges (the mesh's normals differ on the
/// two sides) are not seams in this sense: their sides must not be made equal.
class Seams {
 public:
  /// Throws std::invalid_argument for a mesh without uvs.
  Seams(const TriangleMesh& atlas, int width, int height);

  struct Edge {
    std::array<std::uint32_t, 2> triangles;
    /// Corners (0 to 2) of each triangle at the seam's first and second end.
    std::array<std::array<std::uint8_t, 2>, 2> corners;
  };
  const std::vector<Edge>& edges() const { return edges_; }

  int width() const { return width_; }
  int height() const { return height_; }
  const TriangleMesh& atlas() const { return *atlas_; }

  /// Returns points along every seam, both ends of each edge included: at least `per_texel` per texel of the longer
  /// side.
  std::vector<SeamPoint> points(double per_texel) const;

  /// Measures the difference, over all channels, between bilinear lookups on the two sides.
  SeamMismatch mismatch(const Image<float>& image) const;

  /// Measures the angle in degrees between the normals, in object space and normalised, that bilinear lookups on the
  /// two sides give. `map` holds unit vectors in `space`.
  SeamMismatch mismatch_degrees(const Image<float>& map, NormalSpace space) const;

  /// Measures the same angle at each of `points`.
  std::vector<double> degrees_at(std::span<const SeamPoint> points, const Image<float>& map, NormalSpace space) const;

  /// Adds to `sums`, per point, the squared difference of one channel between lookups on the two sides.
  static void add_squared_differences(std::span<const SeamPoint> points, const Image<float>& image, int channel,
                                      std::span<double> sums);

  /// Reduces the differences at points to their mean and maximum.
  static SeamMismatch summarise(std::span<const SeamPoint> points, std::span<const double> differences);

  /// Returns points dense enough to see what happens between those of a SeamSolver.
  std::vector<SeamPoint> measuring_points() const { return points(5); }

 private:
  const TriangleMesh* atlas_;
  int width_, height_;
  std::vector<Edge> edges_;
};

}  // namespace kiln
