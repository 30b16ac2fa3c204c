// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "material/surface_albedo.h"
#include "material/surface_opacity.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Mesh whose triangles end where its opacity falls below the cutoff.
struct CutOut {
  TriangleMesh mesh;  ///< positions, normals, corner normals and uvs
  /// By triangle, the one of the whole mesh that it lies in, and the weights of that one's corners in its own.
  std::vector<std::uint32_t> origins;
  std::vector<std::array<std::array<float, 3>, 3>> weights;

  bool has_cuts = false;  ///< whether anything was cut away
};

/// Cuts away what is below the cutoff of its opacity, so that rays, beams, depth maps and light that bounces meet only
/// what is there, and none of them needs to know of opacity. The outline is that of the bilinear lookup: straight in
/// each cell between four texels' centres, then simplified by at most a tenth of a texel. Triangles of equal texture
/// coordinates are cut alike, which is done once; edges that triangles share stay closed. Throws BadInput, with `name`,
/// for a mesh that would be cut away wholly, and for a triangle with more than 2^28 texels of a picture that repeats.
CutOut cut_out(const TriangleMesh& mesh, const SurfaceOpacity& opacity, const std::string& name);

/// Cuts an occluder, and its albedo with it, where that is of the whole mesh; both stay as they are where nothing is
/// cut away. Returns 1 for each triangle that is now of a sheet (SurfaceOpacity::is_sheet), else 0; empty where none
/// is.
std::vector<std::uint8_t> cut_occluder(TriangleMesh& mesh, SurfaceAlbedo& albedo, const SurfaceOpacity& opacity,
                                       const std::string& name);

}  // namespace kiln
