// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "bake/bake_reports.h"
#include "bake/scene/receiver_set.h"
#include "base/progress.h"
#include "mesh/triangle_mesh.h"
#include "scatter/subsurface_settings.h"
#include "sh/transfer.h"

namespace kiln {

/// Receivers, and the surface that they stand on.
struct SubsurfaceScene {
  const ReceiverSet& receivers;
  const TriangleMesh& mesh;  ///< the atlas; per vertex: the mesh whose vertices are receivers
  bool per_vertex = false;
  double high_area = 0;  ///< area of the high mesh, square object units; 0: the receivers stand on `mesh` itself
};

/// Scatters the light that arrives at the receivers, so that it leaves the surface around them (scatter_transfer):
/// `channels`, one or three, become one or three, by material. Throws WrongUsage for settings that do not go together.
SubsurfaceReport scatter_beneath(const SubsurfaceScene& scene, const SubsurfaceSettings& settings,
                                 std::vector<TransferVectors>& channels,
                                 const ProgressFunction& progress = no_progress);

}  // namespace kiln
