// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/ray_transfer.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "raycast/sh_rows.h"

namespace kiln {

namespace {

constexpr std::size_t stream_receivers = 256;
constexpr std::size_t group_streams = 64;  // streams between two reports of progress

}  // namespace

void add_transfer_by_rays(const RayScene& scene, const Receivers& receivers,
                          std::span<const Eigen::Vector3f> directions, float ray_offset, TransferSums& sums,
                          const ProgressFunction& progress) {
  const int coefficients = sums.coefficients;
  const std::vector<float> basis_rows = sh_rows(directions, band_of(coefficients - 1) + 1);

  const auto shade_stream = [&](std::size_t begin) {
    const std::size_t count = std::min(stream_receivers, receivers.size() - begin);
    std::vector<float> block_sums(count * coefficients, 0.f);
    std::vector<Eigen::Vector3f> origins(count);
    std::vector<std::uint32_t> facing(count);
    std::vector<float> cosines(count);
    std::vector<std::uint8_t> occluded(count);
    for (std::size_t d = 0; d < directions.size(); ++d) {
      // Step 1: find the receivers that face the direction, and whether they see it.
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
        float* sum = block_sums.data() + static_cast<std::size_t>(facing[k]) * coefficients;
        for (int i = 0; i < coefficients; ++i) sum[i] += cosines[k] * row[i];
      }
      if ((d + 1) % block_directions == 0 || d + 1 == directions.size()) {
        for (int i = 0; i < coefficients; ++i)
          for (std::size_t r = 0; r < count; ++r)
            sums.plane(i)[begin + r] += to_fixed_point(block_sums[r * coefficients + i]);
        std::fill(block_sums.begin(), block_sums.end(), 0.f);
      }
    }
  };

  const std::size_t streams = (receivers.size() + stream_receivers - 1) / stream_receivers;
  for (std::size_t first = 0; first < streams; first += group_streams) {
    const std::size_t last = std::min(first + group_streams, streams);
    parallel_for(first, last, [&](std::size_t stream) { shade_stream(stream * stream_receivers); });
    progress(static_cast<double>(last) / static_cast<double>(streams));
  }
  sums.directions += static_cast<std::int64_t>(directions.size());
}

TransferVectors transfer_by_rays(const RayScene& scene, const Receivers& receivers,
                                 std::span<const Eigen::Vector3f> directions, int bands, float ray_offset,
                                 const ProgressFunction& progress) {
  TransferSums sums(receivers.size(), coefficient_count(bands));
  add_transfer_by_rays(scene, receivers, directions, ray_offset, sums, progress);
  return sums.transfer();
}

}  // namespace kiln
