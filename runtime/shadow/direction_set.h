// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace kiln {

/// Directions in blocks of neighbours, each of which stands for the same solid angle, and their spherical harmonics.
struct DirectionSet {
  std::vector<float> x, y, z;  ///< unit vectors
  int coefficients = 0;
  std::vector<float> basis;  ///< direction * coefficients + i; empty without harmonics

  /// Cones around blocks of 32 directions.
  struct Block {
    Eigen::Vector3f axis;
    float half_angle;  ///< radians
  };
  std::vector<Block> blocks;

  std::uint32_t count() const { return static_cast<std::uint32_t>(x.size()); }
  Eigen::Vector3f direction(std::uint32_t d) const { return {x[d], y[d], z[d]}; }
  std::span<const float> row(std::uint32_t d) const {
    return std::span(basis).subspan(static_cast<std::size_t>(d) * static_cast<std::size_t>(coefficients),
                                    static_cast<std::size_t>(coefficients));
  }
};

/// Returns `count` >= 1 directions of the whole sphere, a Fibonacci set in compact blocks; with `bands` of harmonics,
/// or 0 for none.
DirectionSet sphere_directions(int count, int bands);

/// Returns `count` directions of the cone of `half_angle` (0 to pi) around the unit vector `axis`: points of a
/// Fibonacci spiral, each the middle of an equal share of the cone.
DirectionSet cone_directions(int count, const Eigen::Vector3d& axis, double half_angle, int bands);

/// Appends to `found` the directions that form an angle of `half_angle` (radians) or less with the unit vector `axis`
/// and are not `blocked` yet.
void find_in_cone(const DirectionSet& set, const Eigen::Vector3f& axis, float half_angle,
                  std::span<const std::uint8_t> blocked, std::vector<std::uint32_t>& found);

}  // namespace kiln
