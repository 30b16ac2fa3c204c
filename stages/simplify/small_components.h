// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "simplify/simplify_settings.h"

namespace kiln {

/// Components that were left out of an input.
struct DroppedComponents {
  int components = 0;
  int triangles = 0;
  double area_share = 0;    ///< fraction of the input's surface
  double largest_size = 0;  ///< diagonal of the largest one's box, in object units

  /// Says it in a sentence: "dropped 40 components of 160 triangles, 0.0037 % of the surface, none larger than 0.0139".
  std::string text() const;
};

/// Leaves out what settings.drop_components says of the components of `mesh`; vertices stay.
/// - A number: those whose box's diagonal is at most that fraction of the mesh's.
/// - "auto", to a number of triangles: where it takes more than a tenth of them to keep what is too small to see, all
///   of that: smaller than a tenth of an edge of the result (an equilateral triangle of mean area), or of less surface
///   than a hundredth of a texel in an atlas of 512 x 512.
/// Neither leaves out a component with a hundredth of the surface or more, nor, together, more than a hundredth
/// ("auto") or a half: what is most of a mesh is no speck in it.
DroppedComponents drop_small_components(TriangleMesh& mesh, const SimplifySettings& settings);

/// Says the true reason why `low` has more than `faces` triangles, with what would help: "40 components of 4 triangles
/// each cannot vanish; --drop-components 0.01 drops 40 of them". `high` is the input.
std::string why_no_fewer(const TriangleMesh& low, int faces, const TriangleMesh& high);

}  // namespace kiln
