// SPDX-License-Identifier: MIT
#include "mesh/disjoint_sets.h"

#include <algorithm>
#include <numeric>

namespace kiln {

DisjointSets::DisjointSets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }

std::uint32_t DisjointSets::root(std::uint32_t member) {
  while (parent_[member] != member) member = parent_[member] = parent_[parent_[member]];
  return member;
}

void DisjointSets::join(std::uint32_t a, std::uint32_t b) {
  const auto [lesser, greater] = std::minmax({root(a), root(b)});
  parent_[greater] = lesser;
}

std::vector<std::uint32_t> DisjointSets::roots() {
  std::vector<std::uint32_t> all(parent_.size());
  for (std::uint32_t member = 0; member < all.size(); ++member) all[member] = root(member);
  return all;
}

}  // namespace kiln
