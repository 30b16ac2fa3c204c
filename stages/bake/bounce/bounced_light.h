// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "bake/bounce/bounces.h"

namespace kiln {

/// Bytes that may be kept of the receivers' rays, and as many of those of the surface.
std::size_t bounce_memory_share(const BakeSettings& settings);

/// The light that a scene's surfaces send each other, ready to be gathered by any receivers.
class BouncedLight {
 public:
  /// Lights the surface by `direct`, an engine of `backend` whose scene are the occluders, then lets light bounce off
  /// it. The engine goes before the one that gathers comes, and of the rays of the surface's points nothing is kept
  /// after that. `occluders` outlives this.
  BouncedLight(std::unique_ptr<TransferEngine> direct, BakeBackend backend, const Occluders& occluders,
               std::span<const Eigen::Vector3f> directions, const BakeSettings& settings, int threads,
               const BounceTarget& target, const BounceSample& sample, const ProgressFunction& progress);

  int channels() const { return light_.channels; }

  /// Adds all bounces to the receivers' direct transfer, `channels` of them: to those of `traced`, of whose rays it has
  /// what the direct pass knew. Gives the report, the time of this among the last bounce's.
  BounceReport add_to(std::vector<TransferVectors>& channels, const Receivers& receivers,
                      std::span<TracedReceivers> traced, std::span<const Eigen::Vector3f> directions,
                      const ProgressFunction& progress) const;

 private:
  BounceReport report_;
  SentLight light_;
  std::unique_ptr<GatherEngine> engine_;
};

}  // namespace kiln
