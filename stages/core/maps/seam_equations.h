// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "maps/normal_space.h"
#include "maps/seams.h"

namespace kiln {

/// Equation of a SeamSolver: the sum over its terms of frame * weight * value of the texel is 0.
struct SeamEquation {
  /// Texel that the equation sees, on one side of the seam.
  struct Term {
    std::uint32_t texel;
    double weight;
    int side;
    int place = 0;  ///< among the unknown texels, or -1 - k for the k-th pinned one
  };
  std::vector<Term> terms;
  std::array<Eigen::Matrix3d, 2> frames;  ///< rotation that values of a side take before they are compared
  double weight = 0;
};

/// Makes the equations of equality at points along the seams, one for each point, weighted by length.
std::vector<SeamEquation> point_equations(const Seams& seams, std::span<const SeamPoint> points, NormalSpace space);

/// Texels whose values are to be found.
struct SeamUnknowns {
  static constexpr std::uint32_t none = ~0u;
  std::vector<std::uint32_t> texels;  ///< ascending
  std::vector<std::uint32_t> number;  ///< by texel: its index in `texels`, or none

  /// Takes all texels that `equations` see, of `count`.
  SeamUnknowns(std::span<const SeamEquation> equations, std::size_t count);
};

/// Makes an equation for each unknown texel near a seam that is not covered: its value is that at the place as far from
/// the seam on the other side. `covered` has one entry per texel; the equations have this weight.
std::vector<SeamEquation> gutter_equations(const Seams& seams, std::span<const std::uint8_t> covered,
                                           const SeamUnknowns& unknowns, NormalSpace space, double weight);

}  // namespace kiln
