// SPDX-License-Identifier: MIT
#include "mesh/same_position.h"

#include <bit>

#include "mesh/index_table.h"

namespace kiln {

namespace {

/// Appends the bits of a value, which are equal for equal values.
void append_bits(float value, std::vector<std::uint32_t>& bits) {
  bits.push_back(std::bit_cast<std::uint32_t>(value + 0.f));  // turns -0 into +0
}
void append_bits(double value, std::vector<std::uint32_t>& bits) {
  const auto both = std::bit_cast<std::uint64_t>(value + 0.0);
  bits.push_back(static_cast<std::uint32_t>(both >> 32));
  bits.push_back(static_cast<std::uint32_t>(both));
}

template <class Value>
std::vector<std::uint32_t> find_equals(std::span<const Value> values, std::size_t width) {
  constexpr std::size_t words = sizeof(Value) / sizeof(std::uint32_t);
  std::vector<std::uint32_t> bits;
  bits.reserve(words * values.size());
  for (const Value value : values) append_bits(value, bits);
  const std::size_t count = values.size() / width;
  const auto key = [&](std::uint32_t i) { return std::span(bits).subspan(i * width * words, width * words); };
  IndexTable table(count);
  std::vector<std::uint32_t> first(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::span<const std::uint32_t> own = key(i);
    first[i] = table.find_or_add(own, i, [&](std::uint32_t other) {
      const std::uint32_t* words_of_other = key(other).data();
      for (std::size_t k = 0; k < own.size(); ++k)
        if (own[k] != words_of_other[k]) return false;
      return true;
    });
  }
  return first;
}

}  // namespace

std::vector<std::uint32_t> first_at_position(std::span<const Eigen::Vector3f> positions) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  return positions.empty() ? std::vector<std::uint32_t>{}
                           : find_equals(std::span<const float>(positions[0].data(), 3 * positions.size()), 3);
}

std::vector<std::uint32_t> first_at_position(std::span<const Eigen::Vector3d> positions) {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  return positions.empty() ? std::vector<std::uint32_t>{}
                           : find_equals(std::span<const double>(positions[0].data(), 3 * positions.size()), 3);
}

std::vector<std::uint32_t> first_of_equals(std::span<const float> values, std::size_t width) {
  return find_equals(values, width);
}

std::vector<std::uint32_t> without_gaps(std::vector<std::uint32_t> first, std::uint32_t* count) {
  std::uint32_t firsts = 0;
  for (std::uint32_t i = 0; i < first.size(); ++i) first[i] = first[i] == i ? firsts++ : first[first[i]];
  if (count != nullptr) *count = firsts;
  return first;
}

TriangleMesh join_at_positions(const TriangleMesh& mesh) {
  TriangleMesh joined;
  joined.frame = mesh.frame;
  const std::vector<std::uint32_t> first = first_at_position(mesh.positions);
  for (std::uint32_t i = 0; i < first.size(); ++i)
    if (first[i] == i) joined.positions.push_back(mesh.positions[i]);
  const std::vector<std::uint32_t> number = without_gaps(first);
  joined.triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) joined.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  return joined;
}

}  // namespace kiln
