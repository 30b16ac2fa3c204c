// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "base/function_ref.h"

namespace kiln {

/// Numbers that depend on an albedo, held at nodes that stand evenly in sRGB's encoding from 0 to 1 along each of red,
/// green and blue.
class AlbedoTable {
 public:
  AlbedoTable() = default;

  /// Computes `size` numbers at each of side^3 nodes; `numbers_of` gets a linear albedo, and is called by many threads.
  AlbedoTable(int side, std::size_t size,
              FunctionRef<void(const Eigen::Vector3d& albedo, std::span<float> numbers)> numbers_of);

  bool is_empty() const { return numbers_.empty(); }
  int side() const { return side_; }
  std::size_t nodes() const { return static_cast<std::size_t>(side_) * side_ * side_; }

  /// Returns the linear albedo of a node; nodes go by red, then green, then blue.
  static Eigen::Vector3d albedo_of(std::size_t node, int side);

  /// Returns the numbers, a column for each node.
  Eigen::Map<const Eigen::MatrixXf> columns() const;

  /// Interpolates between the eight nodes around a linear albedo.
  void look_up(const Eigen::Vector3f& albedo, std::span<float> numbers) const;

 private:
  int side_ = 0;
  std::size_t size_ = 0;
  std::vector<float> numbers_;
};

}  // namespace kiln
