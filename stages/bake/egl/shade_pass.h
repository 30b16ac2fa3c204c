// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bake/egl/receiver_groups.h"
#include "bake/egl/shadow_maps.h"
#include "bake/engines/shadow_rays.h"
#include "bake/engines/transfer_engine.h"
#include "gpu/gl_objects.h"

namespace kiln {

/// Compares all receivers with the depth maps: one program weighs a batch (cosine times visibility), another projects a
/// block of directions onto the basis and adds it to the totals.
class ShadePass {
 public:
  /// Uploads the receivers. weigh() will take `maps`. Both `receivers` and `rays` outlive the pass.
  ShadePass(const Receivers& receivers, int coefficients, const ShadowMapSettings& settings, const ShadowMaps& maps,
            const ShadowRays& rays);

  /// Starts a block of at most block_directions: `rows` has the basis functions at its directions, coefficients values
  /// each. Counts the pairs in `work`.
  void begin_block(std::span<const Eigen::Vector3f> directions, std::span<const float> rows, TransferWork& work);

  /// Weighs the part of the block that `maps` now has: directions first, first + 1, ...
  void weigh(const ShadowMaps& maps, int first, int directions);

  /// Decides ambiguous pairs (settings.refine), and adds the block's sums to the totals. Counts in `work`.
  void end_block(TransferWork& work);

  /// Reads the totals back.
  void read(TransferSums& sums) const;

 private:
  struct Group : ReceiverGroup {
    using ReceiverGroup::ReceiverGroup;
    GlBuffer weights;  // weights of the block
    GlBuffer corners;  // only with settings.triangle_ids
    GlBuffer bounds;   // only with settings.regions
  };

  void add_group(std::size_t first, std::size_t count);
  void find_corners(const ShadowMaps& maps);
  void resolve(const Group& group, TransferWork& work) const;

  ShadowMapSettings settings_;
  Receivers receivers_;
  const ShadowRays& rays_;
  std::vector<Eigen::Vector3f> block_;
  int coefficients_;
  int chunk_;
  int chunks_;
  std::vector<Group> groups_;
  std::vector<GlBuffer> rows_;  // one per chunk
  GlBuffer tile_counts_;        // pairs of the block in skipped tiles: behind, lit, shadowed
  GlProgram weigh_program_;
  GlProgram sum_program_;
};

}  // namespace kiln
