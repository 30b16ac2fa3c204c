// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bake/bake_job.h"
#include "bake/bake_reports.h"
#include "bake/engines/transfer_work.h"
#include "base/outputs.h"
#include "sh/transfer.h"

namespace kiln {

/// Transfer of a bake, and how it came about.
struct BakeResult {
  /// Transfer of every receiver, bands^2 coefficients: one channel for all colours, or one each for red, green and
  /// blue.
  std::vector<TransferVectors> channels;
  std::vector<TransferVectors> arriving;  ///< transfer before subsurface scattering, for verify(); else empty
  std::optional<SubsurfaceReport> subsurface;
  BakeBackend backend = BakeBackend::embree;
  std::string renderer;  ///< name of the GL renderer or ray library
  bool software_renderer = false;
  Sampling sampling = Sampling::fibonacci;
  int directions = 0;          ///< directions of all shards together
  std::size_t unoccluded = 0;  ///< receivers that took the analytic transfer
  TransferWork work;           ///< work of this run, for the other receivers
  std::optional<DirectionChoice> choice;
  std::optional<AdaptiveReport> adaptive;  ///< report if some receivers were interpolated
  std::optional<BounceReport> bounces;     ///< report if light bounces
  std::optional<ShadowSizeChoice> shadow_choice;
  double seconds = 0;  ///< time of integrating, bouncing and scattering, the engines' start included
};

/// Integrates the transfer of every receiver, shadowed by the occluders, over directions drawn with the job's seed, and
/// adds bounces. Leaves and takes up checkpoints as the job asks. Throws MachineLacks where the backend cannot run,
/// Interrupted, and BadInput for checkpoints that do not fit.
BakeResult bake(const BakeJob& job);

/// Integrates one shard's directions alone and writes the sums into `outputs`; the result's channels have no receivers.
/// Throws as bake() does.
BakeResult bake_shard(OutputSet& outputs, const Shard& shard, const BakeJob& job);

/// Adds the sums that bake_shard left in `folders`, one for each shard of one bake, in any order: bit for bit what
/// bake() gives. Throws BadInput if a shard is missing, given twice, or of another bake.
BakeResult merge_shards(const std::vector<std::filesystem::path>& folders, const BakeJob& job);

}  // namespace kiln
