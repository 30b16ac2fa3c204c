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

  static constexpr std::uint32_t block_directions = 32;
  /// Cones around blocks of so many directions.
  struct Block {
    Eigen::Vector3f axis;
    float half_angle;    ///< radians
    float cosine, sine;  ///< of that
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

/// Points of a disc, each the middle of an equal share of it: a Fibonacci spiral, neighbours together.
struct DiscPattern {
  std::vector<float> share;         ///< of the disc's area within the point's radius
  std::vector<float> cosine, sine;  ///< of the point's azimuth
};

/// Returns `count` >= 1 such points.
DiscPattern disc_pattern(int count);

/// Returns the directions of the cone of `half_angle` (0 to pi) around the unit vector `axis` that the points of a
/// pattern stand for, by equal areas; with `bands` of harmonics, or 0 for none.
DirectionSet cone_directions(const DiscPattern& pattern, const Eigen::Vector3d& axis, double half_angle, int bands);

/// Appends to `found` the directions that form an angle of `half_angle` (radians) or less with the unit vector `axis`
/// and are not `blocked` yet.
void find_in_cone(const DirectionSet& set, const Eigen::Vector3f& axis, float half_angle,
                  std::span<const std::uint8_t> blocked, std::vector<std::uint32_t>& found);

}  // namespace kiln
