// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "bake/bake_job.h"
#include "bake/bounce/bounces.h"
#include "base/progress.h"

namespace kiln {

/// Returns how many bytes of the receivers' rays may be kept, and as many of the surface's.
std::size_t bounce_memory_share(const BakeSettings& settings);

/// Directions that light is integrated over where it bounces.
struct BounceDirections {
  std::span<const Eigen::Vector3f> surface;    ///< on the surface: direct light and all bounces but the last
  std::span<const Eigen::Vector3f> receivers;  ///< of the final gather
};

/// Adds the light that bounces off the job's occluders to `channels`, the direct transfer of the job's receivers: one,
/// which becomes three where an albedo of the occluders is coloured, and as many as wavelengths where they have
/// reflectances. `direct`, an engine of `backend` for the
/// occluders, lights the surface; it is destroyed before the engine that gathers is made. `traced` lists all receivers,
/// and what is known of their rays along directions.receivers. The report's last bounce has the time of the final
/// gather.
BounceReport add_bounced_light(const BakeJob& job, BakeBackend backend, std::unique_ptr<TransferEngine> direct,
                               const BounceDirections& directions, std::span<TracedReceivers> traced,
                               std::vector<TransferVectors>& channels, const ProgressFunction& progress);

}  // namespace kiln
