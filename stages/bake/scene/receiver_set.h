// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/scene/occluders.h"
#include "maps/detail_maps.h"
#include "mesh/triangle_mesh.h"
#include "sh/transfer.h"

namespace kiln {

/// Plan by which texels without a receiver are filled: each is the mean of texels that have one or were filled before.
struct FillPlan {
  struct Texel {
    std::uint32_t texel;
    std::uint32_t first_source, sources;  ///< range of FillPlan::sources
  };
  std::vector<Texel> texels;  ///< in the order of filling
  std::vector<std::uint32_t> sources;

  /// Fills a plane of one value per texel.
  void apply(std::span<float> plane) const;
};

/// Receivers of a bake, and the slots of the result that they are for: covered texels of an atlas, tile after tile, or
/// vertices of a mesh along a space-filling curve, so that neighbours in the list are neighbours on the surface.
struct ReceiverSet {
  int width = 0;   ///< texels; per vertex, the number of vertices
  int height = 0;  ///< texels; per vertex 1
  /// Slot of each receiver: its texel, as j * width + i with rows from the bottom, or its vertex.
  std::vector<std::uint32_t> slots;
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector3f> albedos = {};  ///< linear red, green and blue; empty if nothing needs them
  std::vector<std::uint32_t> buried = {};     ///< slots that receivers were taken from (set_aside_buried)
  FillPlan fills = {};                        ///< fills of the buried slots

  Receivers view() const { return {positions, normals}; }
  std::vector<std::uint8_t> covered() const;  ///< returns 1 for each slot that has a receiver, else 0
};

/// Returns receivers at the high mesh's points, with its normals.
ReceiverSet receivers_on_high(const DetailMaps& detail);

/// Returns receivers on the low mesh itself, with the high mesh's normals if `detail` is given (section 4.2.4 of
/// [Chapter 2010]), else with the low mesh's, interpolated.
ReceiverSet receivers_on_low(const TriangleMesh& atlas, int width, int height, const DetailMaps* detail);

/// Sets the receivers' albedos to those that `detail` has for their texels.
void take_albedos(ReceiverSet& receivers, const DetailMaps& detail);

/// Sets the receivers' albedos to those of the occluders' nearest points. `occluders` have albedos.
void take_albedos(ReceiverSet& receivers, const Occluders& occluders);

}  // namespace kiln
