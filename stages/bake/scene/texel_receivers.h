// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/scene/occluders.h"
#include "detail/detail_maps.h"
#include "mesh/triangle_mesh.h"
#include "sh/transfer.h"

namespace kiln {

/// Values of texels that have no receiver of their own: each is the mean of some that have one, or were filled before.
struct FillPlan {
  struct Texel {
    std::uint32_t texel;
    std::uint32_t first_source, sources;  ///< of `sources`
  };
  std::vector<Texel> texels;  ///< in the order to fill them in
  std::vector<std::uint32_t> sources;

  /// Fills a plane, a value per texel.
  void apply(std::span<float> plane) const;
};

/// The covered texels of an atlas as receivers, tile after tile, so that neighbours in the list are neighbours on the
/// surface.
struct TexelReceivers {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> texels;  ///< j * width + i, rows from the bottom
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector3f> albedos = {};  ///< linear red, green and blue; none where nothing was asked for
  std::vector<std::uint32_t> buried = {};     ///< covered texels that are not among `texels` (set_aside_buried)
  FillPlan fills = {};                        ///< of the buried ones that are filled

  Receivers view() const { return {positions, normals}; }
  std::vector<std::uint8_t> covered() const;  ///< 1 or 0 per texel: whether it has a receiver
};

/// Texels stand at the high mesh's points, with its normals.
TexelReceivers receivers_on_high(const DetailMaps& detail);

/// Texels stand on the low mesh itself; with the high mesh's normals where `detail` is given (the thesis's
/// variant, 4.2.4), else with the low mesh's, interpolated.
TexelReceivers receivers_on_low(const TriangleMesh& atlas, int width, int height, const DetailMaps* detail);

/// Gives the receivers the albedos that `detail` has of their texels.
void take_albedos(TexelReceivers& receivers, const DetailMaps& detail);

/// Gives them those of the occluders' nearest points. `occluders` have albedos.
void take_albedos(TexelReceivers& receivers, const Occluders& occluders);

}  // namespace kiln
