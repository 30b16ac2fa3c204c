// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kiln {

/// Partition of the numbers 0 to n - 1 (union-find with path halving).
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size);
  std::uint32_t root(std::uint32_t member);

  /// Joins two sets; the lesser of the two roots becomes the root of both.
  void join(std::uint32_t a, std::uint32_t b);

  /// Returns the root of every member, in order.
  std::vector<std::uint32_t> roots();

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace kiln
