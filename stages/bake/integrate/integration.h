// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bake/bake_job.h"
#include "bake/engines/transfer_engine.h"
#include "bake/integrate/error_driven.h"
#include "bake/integrate/shadow_choice.h"
#include "bake/integrate/sums_file.h"
#include "base/progress.h"
#include "raycast/known_rays.h"

namespace kiln {

/// Integral of one bake, cut into slabs of receivers (bounding memory) and blocks of directions (shards,
/// checkpoints). Because sums of blocks are exact, no cut changes a bit of the result.
class Integration {
 public:
  /// Chooses the backend, the receivers that need integrating at all, and the number of directions, and reports
  /// progress of that. `job` outlives the integration, which holds `slab_receivers` at a time.
  explicit Integration(const BakeJob& job, std::size_t slab_receivers = 1u << 20);

  std::size_t slabs() const;

  /// Sums one slab over the shard's directions, with the job's checkpoints. Throws Interrupted after it has left a
  /// checkpoint; BadInput for a checkpoint of another bake.
  SumsFile sum(std::size_t slab, const Shard& shard, const ProgressFunction& progress);

  /// Makes sum() keep blocked rays, as far as `memory` has room, which outlives the integration.
  void keep_blocked(RayMemory& memory) { memory_ = &memory; }

  /// Gives away, slab after slab, the receivers in packets and the rays that sum() kept of them.
  std::vector<TracedReceivers> take_traced();

  /// Writes a complete slab's transfer to its place. Throws std::logic_error if it is not complete.
  void put(std::size_t slab, const TransferSums& sums, TransferVectors& transfer) const;

  /// Writes the analytic transfer of the receivers that nothing can shadow.
  void put_unoccluded(TransferVectors& transfer) const;

  /// Returns everything that the sums of a shard, integrated by `renderer`, depend on, as JSON text.
  std::string key(const Shard& shard, const std::string& renderer) const;

  BakeBackend backend() const { return backend_; }
  /// Returns the engine, which is made at the first call. Throws MachineLacks where the backend cannot run.
  TransferEngine& engine();
  /// Gives the engine away, so that another can take its place in memory and on the GPU.
  std::unique_ptr<TransferEngine> take_engine() {
    engine();
    return std::move(engine_);
  }
  Sampling sampling() const { return sampling_; }
  int directions() const { return static_cast<int>(directions_.size()); }
  std::span<const Eigen::Vector3f> direction_list() const { return directions_; }  ///< coherent block after block
  std::span<const std::uint32_t> tested() const { return tested_; }  ///< receivers that something may shadow, ascending
  std::size_t unoccluded() const { return receivers_.size() - tested_.size(); }
  const std::optional<DirectionChoice>& choice() const { return choice_; }
  /// Returns the size of depth maps that was chosen when the engine was made, if it is automatic.
  const std::optional<ShadowSizeChoice>& shadow_choice() const { return shadow_choice_; }

 private:
  struct Slab {
    std::size_t first = 0;
    std::vector<Eigen::Vector3f> positions, normals;
  };
  Slab gather(std::size_t slab) const;

  const BakeJob& job_;
  Receivers receivers_;
  std::size_t slab_receivers_;
  BakeBackend backend_;
  Sampling sampling_;
  std::unique_ptr<TransferEngine> engine_;
  RayMemory* memory_ = nullptr;
  std::vector<BlockedRays> blocked_;   // by slab
  std::vector<std::uint32_t> tested_;  // receivers that something may shadow
  std::optional<DirectionChoice> choice_;
  std::optional<ShadowSizeChoice> shadow_choice_;
  std::vector<Eigen::Vector3f> directions_;  // coherent block after block
  std::string receivers_hash_, occluders_hash_;
};

/// Returns the name of a slab's file within a folder of checkpoints or of a shard.
std::string slab_name(std::size_t slab);

}  // namespace kiln
