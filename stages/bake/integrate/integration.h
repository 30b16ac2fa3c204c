// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "bake/bake_settings.h"
#include "bake/engines/transfer_engine.h"
#include "bake/integrate/error_driven.h"
#include "bake/integrate/shadow_choice.h"
#include "bake/integrate/sums_file.h"
#include "bake/scene/occluders.h"
#include "base/progress.h"
#include "raycast/known_rays.h"

namespace kiln {

/// One part of a bake that several machines share: of every `count` blocks of directions the `index`-th, from 1.
struct Shard {
  int index = 1;
  int count = 1;
};

/// "k/n". Throws WrongUsage.
Shard parse_shard(const std::string& text);

/// Where and how often the sums are kept, so that an interrupted bake can go on.
struct Checkpoints {
  std::filesystem::path folder;  ///< empty: none
  double seconds = 60;           ///< between two; 0: after every step
  bool resume = false;           ///< go on from those in the folder, if there are any
};

/// The integral of one bake, cut into slabs of receivers (bounding memory) and blocks of directions (shards,
/// checkpoints). Because sums of blocks are exact, no cut changes a bit of the result.
class Integration {
 public:
  /// Chooses the backend, the receivers that need integrating at all, and the number of directions. Keeps references to
  /// `receivers`' lists and `occluders`. `slab_receivers` are held at a time.
  Integration(const Receivers& receivers, const Occluders& occluders, const BakeSettings& settings, int seed,
              int threads, const ProgressFunction& progress, std::size_t slab_receivers = 1u << 20);

  std::size_t slabs() const;

  /// Sums one slab over the shard's directions, from the checkpoint where that is asked for. Throws Interrupted after
  /// it has left a checkpoint; BadInput for a checkpoint of something else.
  SumsFile sum(std::size_t slab, const Shard& shard, const Checkpoints& checkpoints, const ProgressFunction& progress);

  /// From now on sum() keeps which rays it finds blocked, as far as `memory` has room, which must outlive it.
  void keep_blocked(RayMemory& memory) { memory_ = &memory; }

  /// Slab after slab its receivers, in packets, and what sum() kept of them, which is then no longer here.
  std::vector<TracedReceivers> take_traced();

  /// Puts a complete slab's transfer in its place. Throws std::logic_error if it is not complete.
  void put(std::size_t slab, const TransferSums& sums, TransferVectors& transfer) const;

  /// The analytic transfer of the receivers that nothing can shadow.
  void put_unoccluded(TransferVectors& transfer) const;

  /// What the sums of a shard that `renderer` integrates depend on.
  Json key(const Shard& shard, const std::string& renderer) const;

  BakeBackend backend() const { return backend_; }
  /// Made when first asked for. Throws MachineLacks where the backend cannot run.
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
  /// Made with the engine, for an automatic size of depth maps.
  const std::optional<ShadowSizeChoice>& shadow_choice() const { return shadow_choice_; }

 private:
  struct Slab {
    std::size_t first = 0;
    std::vector<Eigen::Vector3f> positions, normals;
  };
  Slab gather(std::size_t slab) const;

  Receivers receivers_;
  const Occluders& occluders_;
  BakeSettings settings_;
  int seed_;
  int threads_;
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

/// Where a slab's sums are within a folder of checkpoints or of a shard.
std::string slab_name(std::size_t slab);

}  // namespace kiln
