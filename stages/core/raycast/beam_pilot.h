// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "raycast/beam_transfer.h"

namespace kiln {

/// Work of single rays in the tree of a BeamScene, counted as BeamWork is.
struct RayWork {
  std::uint64_t rays = 0;
  std::uint64_t boxes = 0;  ///< tests of a ray against 16 boxes
};

/// A sample of a bake's rays, cast both as beams and one by one. Work is counted, not timed, so that the same input
/// gives the same numbers on every machine.
struct BeamPilot {
  BeamWork beams;
  std::uint64_t beam_rays = 0;  ///< rays that `beams` stands for: receivers times directions before them
  RayWork rays;

  BeamPilot& operator+=(const BeamPilot& more);

  /// Costs of a ray in nanoseconds of one core, by beams and by Embree's streams. The weights were fitted to the
  /// times of 12 meshes at 192 to 10,000 directions (docs/benchmarks.md); on another machine only the ratio counts.
  double beam_cost() const;
  double ray_cost() const;
};

/// Receivers divided by what is cheaper for them.
struct BeamSplit {
  BeamReceivers beams;              ///< whole packets, cheaper as beams
  std::vector<std::uint32_t> rays;  ///< receivers that are cheaper by rays, neighbours next to each other
  BeamPilot pilot;                  ///< all samples together

  /// The share of receivers whose rays are cast as beams, 0 to 1.
  double beam_share() const;
};

/// Divides `receivers`, 256 neighbours at a time, by a pilot of about 2 % of the work: each packet along every 48th
/// block of `directions`, which are coherent as for add_transfer_by_beams. The same for any number of threads.
BeamSplit split_by_cost(const BeamScene& scene, BeamReceivers receivers, std::span<const Eigen::Vector3f> directions);

}  // namespace kiln
