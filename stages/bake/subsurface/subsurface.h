// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "bake/scene/texel_receivers.h"
#include "bake/subsurface/subsurface_settings.h"
#include "base/progress.h"
#include "mesh/triangle_mesh.h"
#include "sh/transfer.h"

namespace kiln {

/// What came of scattering, for the record.
struct SubsurfaceReport {
  std::vector<double> reflectance;  ///< by channel: of a half space, all light that leaves it over all that arrives
  std::vector<double> energy;       ///< the same of this object, lit from everywhere
  double hierarchy_error = 0;       ///< Scattering has these
  std::size_t error_points = 0;
  double largest_gain = 0;
  double capped_area = 0;
  double area_mm2 = 0;
  double area_correction = 1;  ///< what the areas of receivers were scaled with to sum to the high mesh's
  double spacing_mm = 0;       ///< of receivers, the root of their mean area
  double seconds = 0;
};

/// What the receivers stand on.
struct SubsurfaceScene {
  const TexelReceivers& receivers;
  const TriangleMesh& mesh;  ///< the atlas; per vertex: the mesh whose vertices are receivers
  bool per_vertex = false;
  double high_area = 0;  ///< of the high mesh, square object units; 0: the receivers stand on `mesh` itself
};

/// Has light that arrives at the receivers leave the surface around them (scatter_transfer): `channels`, one or three,
/// become one or three, by material. Throws WrongUsage for settings that do not go together.
SubsurfaceReport scatter_beneath(const SubsurfaceScene& scene, const SubsurfaceSettings& settings,
                                 std::vector<TransferVectors>& channels,
                                 const ProgressFunction& progress = no_progress);

}  // namespace kiln
