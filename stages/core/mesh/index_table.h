// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kiln {

/// Hash table of numbered things that finds equal ones; open addressing.
class IndexTable {
 public:
  /// Takes the largest number of things that will be added.
  explicit IndexTable(std::size_t things) {
    std::size_t slots = 16;
    while (slots < 2 * things) slots *= 2;
    slots_.assign(slots, none);
  }

  /// Returns the first index added for which `equal` holds; adds `index` and returns it where there is none. Equal
  /// things have equal words in `key`.
  template <class Equal>
  std::uint32_t find_or_add(std::span<const std::uint32_t> key, std::uint32_t index, const Equal& equal) {
    std::uint64_t hash = 0;
    for (const std::uint32_t word : key) {
      hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    for (std::size_t slot = hash & (slots_.size() - 1);; slot = (slot + 1) & (slots_.size() - 1)) {
      if (slots_[slot] == none) return slots_[slot] = index;
      if (equal(slots_[slot])) return slots_[slot];
    }
  }

 private:
  static constexpr std::uint32_t none = ~0u;
  std::vector<std::uint32_t> slots_;
};

}  // namespace kiln
