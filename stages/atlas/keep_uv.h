// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "atlas/atlas.h"

namespace kiln {

/// Defects that keep uvs from being an atlas; all zero where there is none.
struct UvDefects {
  int outside = 0;               ///< triangles with a corner outside the unit square
  int mirrored_triangles = 0;    ///< triangles of negative area in the atlas
  int mirrored_charts = 0;       ///< charts that have such a triangle
  int collapsed = 0;             ///< triangles with an area on the surface and none in the atlas
  std::int64_t overlapping = 0;  ///< texels covered by more than one triangle
  int gap_texels = 0;            ///< smallest gap between two charts, or to the border
  bool gap_too_small = false;

  bool any() const {
    return outside > 0 || mirrored_triangles > 0 || collapsed > 0 || overlapping > 0 || gap_too_small;
  }
  /// Describes the defects: "3 triangles outside the unit square, ...".
  std::string text(const AtlasSettings& settings) const;
};

/// Finds the defects of a mesh with normals and uvs.
UvDefects find_uv_defects(const TriangleMesh& mesh, const AtlasSettings& settings);

/// Decides whether the uvs of a mesh become the atlas, as settings.uv says. Where uvs are there and that is left to
/// Kiln, appends to `warnings` why they do not.
bool keeps_uvs(const TriangleMesh& mesh, const AtlasSettings& settings, const std::string& name,
               std::vector<std::string>& warnings);

/// Makes an atlas of the uvs that a mesh already has. Throws BadInput, which lists every defect, where they do not form
/// one.
AtlasResult keep_uvs(const TriangleMesh& mesh, const AtlasSettings& settings, const std::string& name = "the mesh");

}  // namespace kiln
