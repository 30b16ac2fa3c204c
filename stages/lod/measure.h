// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "base/extent.h"
#include "lod/lod_settings.h"
#include "mesh/mesh_distance.h"
#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"

namespace kiln {

/// Where the texels of an atlas lie on a level, and where on the atlas mesh; lengths in units of the mesh.
struct TexelDisplacement {
  double mean = 0;  ///< over the texels that the level covers
  double largest = 0;
  std::int64_t texels = 0;
  std::int64_t overhanging = 0;  ///< covered by the level, not by the atlas: they show what the gutter holds
  std::int64_t deserted = 0;     ///< covered by the atlas, not by the level
  std::int64_t overlapping = 0;  ///< in more than one triangle of the level
};

/// Measures at every texel how far the surface point that it is shown at lies from the one that it was made for. An
/// overhanging texel counts as the nearest covered one, whose values the gutter continues.
class TexelDisplacementMeter {
 public:
  TexelDisplacementMeter(const TriangleMesh& atlas, Extent size);
  TexelDisplacement measure(const TriangleMesh& level) const;

 private:
  const TriangleMesh& atlas_;
  Extent size_;
  UvRaster raster_;
  std::vector<std::uint32_t> content_;  ///< by texel: the covered texel that its values come from
};

/// Returns the distance from the camera to the centre of a sphere of `radius` about the asset at which `error`,
/// wherever it is in the sphere, is at most `pixels` in the picture.
double switching_distance(double error, double radius, double pixels, const ReferencePictureSize& view);

/// Returns the length that `pixels` have on an object of `radius` whose sphere fills the picture's height.
double length_of_pixels(double pixels, double radius, const ReferencePictureSize& view);

}  // namespace kiln
