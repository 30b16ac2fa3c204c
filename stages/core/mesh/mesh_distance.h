// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Distances between two surfaces, as fractions of the first one's bounding box diagonal.
struct MeshDistance {
  double hausdorff = 0;              ///< the largest distance found, over both directions
  double rms = 0;                    ///< root mean square over the surface, the worse of both directions
  double hausdorff_from_first = 0;   ///< from points of the first mesh to the second
  double hausdorff_from_second = 0;  ///< from points of the second mesh to the first
  double rms_from_first = 0;
  double rms_from_second = 0;
};

/// Sampling density: this many points per mesh, spread by area, besides every vertex.
struct MeshDistanceSettings {
  int samples = 200'000;
  std::uint64_t seed = 1;
};

/// Measures symmetric distances of two meshes by dense sampling of both ([Cignoni 1998], [Aspert 2002]);
/// point-to-triangle distances are exact, from a bounding volume hierarchy. Independent of the thread count.
MeshDistance mesh_distance(const TriangleMesh& first, const TriangleMesh& second,
                           const MeshDistanceSettings& settings = {});

}  // namespace kiln
