// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/egl/shadow_refine.h"

#include <algorithm>
#include <cmath>

#include "bake/egl/receiver_tiles.h"

namespace kiln {

bool resolve_ambiguous(const BlockWeights& block, const Receivers& receivers,
                       std::span<const Eigen::Vector3f> directions, bool refine, const ShadowRays& rays,
                       TransferWork& work) {
  // Step 1: collect the marked pairs.
  std::vector<ShadowRayQuery> queries;
  std::uint64_t marked = 0;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    float* row = block.weights.data() + d * block.count;
    ShadowRayQuery query{directions[d], {}, {}};
    for (std::uint32_t tile : block.tiles) {
      const std::size_t begin = tile * tile_receivers, end = std::min(begin + tile_receivers, block.count);
      for (std::size_t r = begin; r < end; ++r)
        if (std::signbit(row[r])) {
          row[r] = -row[r];
          query.receivers.push_back(static_cast<std::uint32_t>(block.first + r));
        }
    }
    marked += query.receivers.size();
    query.occluded.resize(query.receivers.size());
    queries.push_back(std::move(query));
  }
  work.ambiguous += marked;
  if (marked == 0 || !refine) return marked != 0;

  // Step 2: decide them by rays.
  rays.occluded(receivers, queries);
  for (std::size_t d = 0; d < directions.size(); ++d) {
    float* row = block.weights.data() + d * block.count;
    const ShadowRayQuery& query = queries[d];
    for (std::size_t k = 0; k < query.receivers.size(); ++k) {
      const std::uint32_t r = query.receivers[k];
      const float cosine = std::max(0.f, receivers.normals[r].dot(directions[d]));
      row[r - block.first] = query.occluded[k] != 0 ? 0.f : cosine;
    }
  }
  work.refined += marked;
  return true;
}

}  // namespace kiln
