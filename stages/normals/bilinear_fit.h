// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "image/image.h"
#include "normals/texel_samples.h"

namespace kiln {

/// Finds the texels whose bilinear lookups come nearest to given values at a regular grid of side * side points per
/// texel: the least-squares projection onto what a texture can show. (A mean over each texel would blur twice.) Three
/// channels only. Memory: 32 bytes per texel, and 36 while it is solved.
class BilinearFit {
 public:
  BilinearFit(int width, int height, int side);

  /// Sums of some rows of texels, filled by one thread and joined in order.
  class Rows {
   public:
    Rows(const BilinearFit& fit, int begin, int end);

    /// Adds to the sums the values at the points of texel (i, j), in one of these rows.
    void add(int i, int j, const TexelPoints& points);

   private:
    friend class BilinearFit;
    const BilinearFit* fit_;
    int begin_, end_;  ///< range of the rows with sums: one more on either side
    std::vector<std::array<float, 5>> stencils_;
    std::vector<Eigen::Vector3f> right_sides_;
  };

  void join(const Rows& rows);

  /// Solves for `values` wherever there are points: minimises the mean squared difference over them plus `keep` times
  /// the squared change.
  void solve(Image<float>& values, float keep) const;

 private:
  using Stencil =
      std::array<float, 5>;  ///< products with the texel itself, its right, upper left, upper and upper right neighbour
  std::size_t index(int i, int j) const;
  /// Adds one point's products to the stencils of the four texels that it sees; `at` returns the place of a texel's
  /// stencil.
  template <class At>
  void add_products(int x, int y, const At& at) const;

  int width_, height_, side_;
  std::vector<std::array<float, 3>> weights_;  ///< weights that a point's column or row gives texels at offsets -1 to 1
  std::array<std::array<Stencil, 3>, 3>
      full_{};  ///< stencils of a texel with all points, by offset -1 to 1 (row, column)
  std::vector<Stencil> stencils_;
  std::vector<Eigen::Vector3f> right_sides_;
};

}  // namespace kiln
