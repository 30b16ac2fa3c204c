// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kiln {

/// Rows of numbers, one for each direction of a set, and their sums over eight and 32 neighbours, so that a sum over
/// many directions takes few additions. Which additions depends on the directions alone.
class DirectionSums {
 public:
  DirectionSums() = default;
  /// `rows` are direction * width + i.
  DirectionSums(std::span<const float> rows, std::size_t width);

  bool empty() const { return table_.empty(); }
  std::size_t width() const { return width_; }

  /// Sets `sum`, `width` numbers, to the sum of the rows of all directions that are 1, not 0.
  void add_up(std::span<const std::uint8_t> directions, std::span<float> sum) const;

 private:
  std::size_t width_ = 0, stride_ = 0, count_ = 0;
  std::vector<float> table_;  ///< rows, then sums of eight, then sums of 32, each padded to the stride
};

}  // namespace kiln
