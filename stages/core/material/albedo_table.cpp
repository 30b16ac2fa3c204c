// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/albedo_table.h"

#include <algorithm>

#include "base/parallel.h"
#include "image/srgb.h"

namespace kiln {

AlbedoTable::AlbedoTable(int side, std::size_t size,
                         FunctionRef<void(const Eigen::Vector3d& albedo, std::span<float> numbers)> numbers_of)
    : side_(side), size_(size), numbers_(nodes() * size) {
  parallel_for(0, side * side, [&](int row) {
    for (std::size_t node = static_cast<std::size_t>(row) * static_cast<std::size_t>(side), end = node + side;
         node < end; ++node)
      numbers_of(albedo_of(node, side), std::span(numbers_).subspan(node * size, size));
  });
}

Eigen::Vector3d AlbedoTable::albedo_of(std::size_t node, int side) {
  const int k = static_cast<int>(node);
  const Eigen::Vector3f encoded =
      Eigen::Vector3i(k % side, k / side % side, k / (side * side)).cast<float>() / static_cast<float>(side - 1);
  return encoded.unaryExpr(&linear_from_srgb).cast<double>();
}

Eigen::Map<const Eigen::MatrixXf> AlbedoTable::columns() const {
  return {numbers_.data(), static_cast<Eigen::Index>(size_), static_cast<Eigen::Index>(nodes())};
}

void AlbedoTable::look_up(const Eigen::Vector3f& albedo, std::span<float> numbers) const {
  const Eigen::Vector3f place = albedo.unaryExpr(&srgb_from_linear) * static_cast<float>(side_ - 1);
  const Eigen::Vector3i low = place.cast<int>().cwiseMin(side_ - 2).cwiseMax(0);
  const Eigen::Vector3f share = place - low.cast<float>();
  std::ranges::fill(numbers, 0.f);
  for (int corner = 0; corner < 8; ++corner) {
    std::size_t node = 0, stride = 1;
    float weight = 1;
    for (int c = 0; c < 3; ++c, stride *= static_cast<std::size_t>(side_)) {
      const int up = corner >> c & 1;
      node += stride * static_cast<std::size_t>(low(c) + up);
      weight *= up != 0 ? share(c) : 1 - share(c);
    }
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] += weight * numbers_[node * size_ + k];
  }
}

}  // namespace kiln
