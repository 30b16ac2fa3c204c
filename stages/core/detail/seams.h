#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "detail/normal_space.h"
#include "image/image.h"
#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"

namespace kiln {

/// The four texels that a bilinear lookup weighs (clamped to the texture's edge), j * width + i.
struct Footprint {
  std::array<std::uint32_t, 4> texels{};
  std::array<float, 4> weights{};

  Footprint() = default;
  Footprint(const Eigen::Vector2f& uv, int width, int height);

  /// One channel of `image`, looked up.
  double lookup(const Image<float>& image, int channel) const;
};

/// One side of a point on a seam: where in which triangle it lies, and what a lookup there sees.
struct SeamSide {
  TexelSource source;
  Footprint footprint;
};

/// A point on a seam, as its two triangles know it, and the length of seam that it stands for (texels of the longer
/// side).
struct SeamPoint {
  std::array<SeamSide, 2> sides;
  float length_texels = 0;
};

/// How far both sides of the seams are apart, over points spread along them.
struct SeamMismatch {
  double mean = 0;  ///< weighted by length
  double largest = 0;
};

/// The seams of an atlas in a texture of `width` x `height` texels: edges between two triangles whose ends have the
/// same positions (bit for bit, as Draco decodes them) but not the same uvs. Hard edges, on either side of which the
/// mesh has other normals, are none: what lies on both sides is not to be made equal.
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

  /// Points along every seam, both ends of each edge included: at least `per_texel` for each texel of the longer side.
  std::vector<SeamPoint> points(double per_texel) const;

  /// The distance, over all channels, between bilinear lookups on either side.
  SeamMismatch mismatch(const Image<float>& image) const;

  /// The angle in degrees between the normals that bilinear lookups on either side give, in object space, normalised.
  /// `map` holds unit vectors in `space`.
  SeamMismatch mismatch_degrees(const Image<float>& map, NormalSpace space) const;

  /// The same angle at each of `points`.
  std::vector<double> degrees_at(std::span<const SeamPoint> points, const Image<float>& map, NormalSpace space) const;

  /// Squared differences of one channel between lookups on either side, added to `sums`, one per point.
  static void add_squared_differences(std::span<const SeamPoint> points, const Image<float>& image, int channel,
                                      std::span<double> sums);

  /// What differences of points come to.
  static SeamMismatch summarise(std::span<const SeamPoint> points, std::span<const double> differences);

  /// Enough points to see what is between those of a SeamSolver.
  std::vector<SeamPoint> measuring_points() const { return points(5); }

 private:
  const TriangleMesh* atlas_;
  int width_, height_;
  std::vector<Edge> edges_;
};

/// What the solve weighs against equality, which has weight 1 per texel of seam.
struct SeamWeights {
  double covered = 0.1;    ///< for a covered texel to keep its value
  double across = 0.1;     ///< for a gutter texel to have the value that lies across the seam
  double gutter = 0.0005;  ///< for a gutter texel to keep its value
};

/// Makes values equal on both sides of every seam under bilinear lookup: least squares over the texels that lookups on
/// seams see, sparse normal equations, factorised once for any number of images (Iwanicki, "Lighting technology of The
/// Last of Us", 2013; Liu, Ferguson, Jacobson and Gingold, "Seamless: seam erasure and seam-aware decoupling of shape
/// from mesh resolution", 2017). A gutter texel is drawn to the value across the seam: the place that is as far from
/// the edge in the other chart, so that lookups between a chart's last texel and the gutter follow the surface. May be
/// used by several threads at once; results do not depend on them.
class SeamSolver {
 public:
  /// `covered` has one entry per texel. For tangent-space normal maps give `space`: the three channels are then solved
  /// for together, equal in object space.
  SeamSolver(const Seams& seams, std::span<const std::uint8_t> covered, NormalSpace space = NormalSpace::object,
             const SeamWeights& weights = {});
  ~SeamSolver();
  SeamSolver(SeamSolver&&) noexcept;
  SeamSolver& operator=(SeamSolver&&) noexcept;

  /// Changes texels near seams, each channel on its own (tangent space: all three), to values of `lowest` to `highest`
  /// alone: the constrained least squares, by projected Gauss-Seidel from the free solution. Gutters are filled. Throws
  /// std::invalid_argument for another size, or without three channels in tangent space.
  void equalise(Image<float>& image, float lowest = -std::numeric_limits<float>::infinity(),
                float highest = std::numeric_limits<float>::infinity()) const;

  /// The points at which equality is asked for.
  std::span<const SeamPoint> points() const;

  /// From now on asks more for equality at those points() where more is left than elsewhere: `mismatches`, one per
  /// point, are what equalise leaves (iteratively reweighted least squares). Not while other threads equalise. Throws
  /// std::invalid_argument for another number of mismatches.
  void reweigh(std::span<const double> mismatches);

  /// Texels that equalise may change.
  std::size_t unknown_texels() const;

 private:
  struct System;
  std::unique_ptr<System> system_;
};

}  // namespace kiln
