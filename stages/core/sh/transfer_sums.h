// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "sh/transfer.h"

namespace kiln {

/// Number of directions in a block: directions are summed in float32 within a block, exactly across blocks.
inline constexpr int block_directions = 32;

/// Scale of a block's sum as an integer: multiples of 2^-23. A block holds at most 32 products of a cosine and a basis
/// function, each below 2.8 up to band 24, so a sum fits 31 bits.
inline constexpr float fixed_point_one = 8388608.f;
inline std::int32_t to_fixed_point(float block_sum) {
  return static_cast<std::int32_t>(std::lrint(block_sum * fixed_point_one));
}

/// Sums of B_i(s) V(s) max(0, n.s) over directions s, without the quadrature weight, as fixed-point integers. Blocks
/// added in any order, on any number of threads, machines and runs, give the same bits, and a billion directions lose
/// no precision ([US 7,948,490] keeps three accumulation buffers for that).
struct TransferSums {
  std::size_t receivers = 0;
  int coefficients = 0;
  std::int64_t directions = 0;       ///< number of directions added so far
  std::vector<std::int64_t> values;  ///< plane after plane, as in TransferVectors

  TransferSums() = default;
  TransferSums(std::size_t receiver_count, int coefficient_count)
      : receivers(receiver_count), coefficients(coefficient_count), values(receiver_count * coefficient_count, 0) {}

  std::span<std::int64_t> plane(int coefficient) { return {values.data() + coefficient * receivers, receivers}; }
  std::span<const std::int64_t> plane(int coefficient) const {
    return {values.data() + coefficient * receivers, receivers};
  }

  /// Adds the sums over other directions for the same receivers.
  void add(const TransferSums& other);

  /// Returns t_i = 4/N times the sums: the integral divided by pi, for N evenly spread directions.
  TransferVectors transfer() const;
};

}  // namespace kiln
