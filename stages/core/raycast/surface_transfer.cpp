// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/surface_transfer.h"

#include <algorithm>

#include "raycast/beam_transfer.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/ray_offset.h"

namespace kiln {

TransferVectors surface_transfer(const TriangleMesh& occluder, const Receivers& points,
                                 const SurfaceTransferSettings& settings) {
  constexpr std::uint64_t seed = 1;
  const BeamScene scene(occluder.positions, occluder.triangles);
  const BeamReceivers receivers(points, rounding_offset(occluder.positions));
  std::vector<Eigen::Vector3f> directions = sample_directions(Sampling::fibonacci, settings.directions, seed);
  order_coherently(directions);
  TransferSums sums(points.size(), coefficient_count(settings.bands));
  add_transfer_by_beams(scene, receivers, directions, sums);
  return sums.transfer();
}

std::vector<float> surface_openness(const TriangleMesh& occluder, const Receivers& points, int directions) {
  constexpr float unoccluded = 0.28209479f;
  std::vector<float> openness = surface_transfer(occluder, points, {.bands = 1, .directions = directions}).values;
  for (float& value : openness) value = std::min(1.f, value / unoccluded);
  return openness;
}

}  // namespace kiln
