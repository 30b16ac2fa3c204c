// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "image/image.h"
#include "maps/normal_space.h"
#include "maps/seams.h"

namespace kiln {

/// Weights of the least squares against equality, which has weight 1 per texel of seam.
struct SeamWeights {
  double covered = 0.1;    ///< a covered texel keeps its value
  double across = 0.1;     ///< a gutter texel has the value that lies across the seam
  double gutter = 0.0005;  ///< a gutter texel keeps its value
};

/// Makes values equal on both sides of every seam under bilinear lookup: least squares over the texels that lookups on
/// seams see, by sparse normal equations that are factorised once for any number of images ([Iwanicki 2013], [Liu
/// 2017]). A gutter texel is drawn to the value across the seam, at the place that is as far from the edge in the other
/// chart, so that lookups between a chart's last texel and the gutter follow the surface. May be used by several
/// threads at once; results do not depend on them.
class SeamSolver {
 public:
  /// `covered` has one entry per texel. For a tangent-space normal map pass `space`: its three channels are then solved
  /// together, and become equal in object space.
  SeamSolver(const Seams& seams, std::span<const std::uint8_t> covered, NormalSpace space = NormalSpace::object,
             const SeamWeights& weights = {});
  ~SeamSolver();
  SeamSolver(SeamSolver&&) noexcept;
  SeamSolver& operator=(SeamSolver&&) noexcept;

  /// Changes texels near seams, each channel separately (tangent space: all three together), and fills gutters. With
  /// bounds, values stay within `lowest` to `highest`: constrained least squares, by projected Gauss-Seidel from the
  /// free solution. Throws std::invalid_argument for another size, or without three channels in tangent space.
  void equalise(Image<float>& image, float lowest = -std::numeric_limits<float>::infinity(),
                float highest = std::numeric_limits<float>::infinity()) const;

  /// Returns the points at which equality is asked for.
  std::span<const SeamPoint> points() const;

  /// Raises the weight of equality at those points() that keep a larger mismatch than others: `mismatches`, one per
  /// point, are what equalise leaves (iteratively reweighted least squares). Must not run while other threads equalise.
  /// Throws std::invalid_argument for another number of mismatches.
  void reweigh(std::span<const double> mismatches);

  /// Counts the texels that equalise may change.
  std::size_t unknown_texels() const;

 private:
  struct System;
  std::unique_ptr<System> system_;
};

}  // namespace kiln
