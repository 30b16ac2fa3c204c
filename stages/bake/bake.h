// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bake/adaptive/adaptive.h"
#include "bake/bake_settings.h"
#include "bake/bounce/bounces.h"
#include "bake/integrate/integration.h"
#include "bake/integrate/shadow_choice.h"
#include "bake/scene/occluders.h"
#include "bake/scene/texel_receivers.h"
#include "bake/subsurface/subsurface.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "sh/transfer.h"

namespace kiln {

struct BakeResult {
  /// Of every receiver, bands^2 coefficients: one for all colours, or one for each of red, green and blue.
  std::vector<TransferVectors> channels;
  std::vector<TransferVectors> arriving;  ///< before it was scattered beneath the surface, for verify(); else empty
  std::optional<SubsurfaceReport> subsurface;
  BakeBackend backend = BakeBackend::embree;
  std::string renderer;  ///< what did the work
  bool software_renderer = false;
  Sampling sampling = Sampling::fibonacci;
  int directions = 0;          ///< of all shards together
  std::size_t unoccluded = 0;  ///< receivers that took the analytic transfer
  TransferWork work;           ///< of this run, for the others
  std::optional<DirectionChoice> choice;
  std::optional<AdaptiveReport> adaptive;  ///< where some receivers were interpolated
  std::optional<BounceReport> bounces;     ///< where light bounces
  std::optional<ShadowSizeChoice> shadow_choice;
  double seconds = 0;  ///< of integrating, bouncing and scattering alone, the engines' start included
};

/// Integrates the transfer of every receiver, shadowed by the occluders, over directions drawn with `seed`. `threads`
/// is for a software GL renderer. Leaves and takes up checkpoints as asked for, and removes them when done. Throws
/// MachineLacks where the backend cannot run, Interrupted, and BadInput for checkpoints that do not fit.
BakeResult bake(const TexelReceivers& receivers, const Occluders& occluders, const BakeSettings& settings, int seed,
                int threads, const Checkpoints& checkpoints = {}, const ProgressFunction& progress = no_progress);

/// Integrates one shard's directions alone and writes the sums into `outputs`; the channels of the result are of no
/// receivers.
BakeResult bake_shard(OutputSet& outputs, const Shard& shard, const TexelReceivers& receivers,
                      const Occluders& occluders, const BakeSettings& settings, int seed, int threads,
                      const Checkpoints& checkpoints = {}, const ProgressFunction& progress = no_progress);

/// Adds what bake_shard left in `folders`, one for each shard of one bake, in any order: bit for bit what bake() gives.
/// Throws BadInput where a shard is missing, there twice, or of another bake.
BakeResult merge_shards(const std::vector<std::filesystem::path>& folders, const TexelReceivers& receivers,
                        const Occluders& occluders, const BakeSettings& settings, int seed, int threads,
                        const ProgressFunction& progress = no_progress);

/// How far a baked asset is from the truth.
struct BakeVerification {
  std::string other_backend;
  std::size_t backend_texels = 0;   ///< that both backends baked, spread evenly
  SampledError backend_difference;  ///< relative L2 to the other backend over the same directions, before quantisation
  int reference_directions = 0;
  std::size_t reference_texels = 0;
  SampledError integration_error;  ///< relative L2 to that many rays, before quantisation
  // Of the planes read back, which hold what the rays measure unless it was scattered beneath the surface.
  std::optional<SampledError> error;             ///< relative L2 to that many rays
  std::optional<SampledError> relighting_error;  ///< the same as expected relighting error
};

/// Texels on which two backends are compared. A defect that misses all of them has, with a confidence of 95 %, less
/// than 3 in 16,384 of the texels: 1.4 % in relative L2 where it is as large as the transfer itself.
inline constexpr std::size_t compared_texels = 16384;

/// Compares `result` with the other backend (embree, or egl if embree baked it), and it and the planes read back
/// (`stored`) with settings.verify_directions rays from settings.verify_texels of the texels.
BakeVerification verify(const BakeResult& result, const std::vector<TransferVectors>& stored,
                        const TexelReceivers& receivers, const Occluders& occluders, const BakeSettings& settings,
                        int seed, int threads, const ProgressFunction& progress = no_progress);

}  // namespace kiln
