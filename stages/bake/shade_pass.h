#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bake/receiver_tiles.h"
#include "bake/shadow_maps.h"
#include "bake/transfer_engine.h"
#include "gpu/gl_objects.h"

namespace kiln {

/// All receivers against the depth maps: one program weighs a batch (cosine times visibility), another projects a block
/// of directions onto the basis and adds it to the totals.
class ShadePass {
 public:
  ShadePass(const Receivers& receivers, int coefficients, const ShadowMapSettings& settings);

  /// A new block of at most block_directions: `rows` has the basis functions at its directions, coefficients values
  /// each. Counts the pairs in `work`.
  void begin_block(std::span<const Eigen::Vector3f> directions, std::span<const float> rows, TransferWork& work);

  /// The part of the block that `maps` now has: directions first, first + 1, ...
  void weigh(const ShadowMaps& maps, int first, int directions);

  /// Adds the block's sums to the totals.
  void end_block();

  /// Reads the totals back.
  void read(TransferSums& sums) const;

 private:
  /// As many receivers as fit one storage buffer, and their totals.
  struct Group {
    std::size_t first = 0;
    std::size_t count = 0;
    std::vector<NormalCone> cones;
    GlBuffer receivers;
    GlBuffer weights;  // of the block
    GlBuffer totals;
    GlBuffer tiles;
    GLuint facing = 0;  // tiles of the block that `tiles` now names
  };

  void add_group(const Receivers& receivers, std::size_t first, std::size_t count);

  ShadowMapSettings settings_;
  int coefficients_;
  int chunk_;
  int chunks_;
  std::vector<Group> groups_;
  std::vector<GlBuffer> rows_;  // one per chunk
  GlProgram weigh_program_;
  GlProgram sum_program_;
};

}  // namespace kiln
