// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "bake/scene/occluders.h"
#include "bake/scene/receiver_set.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Result of set_aside_buried.
struct BuriedReport {
  std::size_t buried = 0;   ///< receivers that no one can see, set aside
  std::size_t moved = 0;    ///< receivers that moved within their texel to a place that is not buried
  bool everything = false;  ///< whether all are buried, in which case none was set aside
};

/// Takes out receivers that stand inside a part of the occluders (BuriedTest): black for everyone, they would bleed
/// over the line where the parts meet into what is seen. Receivers must stand on the surface of the occluders. Of a
/// texel whose centre is buried other places are tried, and if one is not the receiver moves there. Texels that stay
/// buried get a plan to fill them from others of their chart, from the line inwards; those of charts that are buried as
/// a whole get none. `ray_offset` in object units, as the engines have it; `atlas` is what the texels belong to.
BuriedReport set_aside_buried(ReceiverSet& receivers, const TriangleMesh& atlas, const Occluders& occluders,
                              float ray_offset);

/// Does the same for the vertices of `mesh`, which are not moved, and filled along its edges.
BuriedReport set_aside_buried_vertices(ReceiverSet& receivers, const TriangleMesh& mesh, const Occluders& occluders,
                                       float ray_offset);

}  // namespace kiln
