#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "atlas/atlas.h"

namespace kiln {

/// What keeps uvs from being an atlas; all zero where nothing does.
struct UvDefects {
  int outside = 0;               ///< triangles with a corner outside the unit square
  int mirrored_triangles = 0;    ///< of negative area in the atlas
  int mirrored_charts = 0;       ///< that have such a triangle
  int collapsed = 0;             ///< triangles that have an area, and none in the atlas
  std::int64_t overlapping = 0;  ///< texels that more than one triangle covers
  int gap_texels = 0;            ///< the smallest between two charts, or to the border
  bool gap_too_small = false;

  bool any() const {
    return outside > 0 || mirrored_triangles > 0 || collapsed > 0 || overlapping > 0 || gap_too_small;
  }
  /// "3 triangles outside the unit square, ..."
  std::string text(const AtlasSettings& settings) const;
};

/// `mesh` has normals and uvs.
UvDefects find_uv_defects(const TriangleMesh& mesh, const AtlasSettings& settings);

/// An atlas of the uvs that a mesh (load_uv_mesh) has already. Throws BadInput, which tells every defect, where they
/// are none.
AtlasResult keep_uvs(const TriangleMesh& mesh, const AtlasSettings& settings, const std::string& name = "the mesh");

}  // namespace kiln
