#include "raycast/ray_transfer.h"

#include <algorithm>
#include <cstdint>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <vector>

#include "sh/basis.h"

namespace kiln {

namespace {

constexpr std::size_t block_receivers = 256;  // one stream of rays
constexpr std::size_t group_blocks = 64;      // between two reports of progress
constexpr int sum_directions = 64;            // short sums added to long ones keep float32's error down

/// B_i(s_d) of all directions, row after row, with the quadrature weight and 1/pi in it.
std::vector<float> weighted_basis(std::span<const Eigen::Vector3f> directions, int bands) {
  const ShBasis basis(bands);
  std::vector<float> rows(directions.size() * basis.size());
  std::vector<double> values(basis.size());
  const double weight = 4.0 / static_cast<double>(directions.size());
  for (std::size_t d = 0; d < directions.size(); ++d) {
    basis.evaluate<double>(directions[d].cast<double>(), values);
    for (int i = 0; i < basis.size(); ++i) rows[d * basis.size() + i] = static_cast<float>(weight * values[i]);
  }
  return rows;
}

}  // namespace

TransferVectors transfer_by_rays(const RayScene& scene, const Receivers& receivers,
                                 std::span<const Eigen::Vector3f> directions, int bands, float ray_offset,
                                 const ProgressFunction& progress) {
  const int coefficients = coefficient_count(bands);
  const std::vector<float> basis_rows = weighted_basis(directions, bands);
  TransferVectors transfer(receivers.size(), coefficients);

  const auto shade_block = [&](std::size_t begin) {
    const std::size_t count = std::min(block_receivers, receivers.size() - begin);
    std::vector<float> sums(count * coefficients, 0.f), short_sums(count * coefficients, 0.f);
    std::vector<Eigen::Vector3f> origins(count);
    std::vector<std::uint32_t> facing(count);
    std::vector<float> cosines(count);
    std::vector<std::uint8_t> occluded(count);
    for (std::size_t d = 0; d < directions.size(); ++d) {
      // Step 1: the receivers that face the direction, and whether they see it.
      std::size_t rays = 0;
      for (std::size_t r = 0; r < count; ++r) {
        const Eigen::Vector3f& normal = receivers.normals[begin + r];
        const float cosine = normal.dot(directions[d]);
        if (cosine <= 0) continue;
        origins[rays] = receivers.positions[begin + r] + ray_offset * normal;
        cosines[rays] = cosine;
        facing[rays++] = static_cast<std::uint32_t>(r);
      }
      scene.occluded(std::span(origins).first(rays), directions[d], 0.f, occluded);
      // Step 2: project.
      const float* row = basis_rows.data() + d * coefficients;
      for (std::size_t k = 0; k < rays; ++k) {
        if (occluded[k] != 0) continue;
        float* sum = short_sums.data() + static_cast<std::size_t>(facing[k]) * coefficients;
        for (int i = 0; i < coefficients; ++i) sum[i] += cosines[k] * row[i];
      }
      if ((d + 1) % sum_directions == 0 || d + 1 == directions.size()) {
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += short_sums[k];
        std::fill(short_sums.begin(), short_sums.end(), 0.f);
      }
    }
    for (int i = 0; i < coefficients; ++i)
      for (std::size_t r = 0; r < count; ++r) transfer.plane(i)[begin + r] = sums[r * coefficients + i];
  };

  const std::size_t blocks = (receivers.size() + block_receivers - 1) / block_receivers;
  for (std::size_t first = 0; first < blocks; first += group_blocks) {
    const std::size_t last = std::min(first + group_blocks, blocks);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(first, last, 1),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t block = range.begin(); block != range.end(); ++block)
                          shade_block(block * block_receivers);
                      });
    progress(static_cast<double>(last) / static_cast<double>(blocks));
  }
  return transfer;
}

}  // namespace kiln
