#pragma once

#include <cstdint>
#include <vector>

#include "base/progress.h"
#include "detail/texel_way.h"
#include "image/image.h"
#include "material/surface_albedo.h"
#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"
#include "normals/surface_match.h"
#include "raycast/buried_test.h"
#include "raycast/ray_scene.h"

namespace kiln {

/// The high mesh, with normals, its rays, what it reflects, and which of its points are inside it.
struct HighSurface {
  const TriangleMesh& mesh;
  const RayScene& scene;
  const SurfaceAlbedo& albedo;
  const BuriedTest& is_buried;
};

/// What match_texels found out; rows from the bottom.
struct TexelMatches {
  Image<float> position;       ///< object space, of the point that a covered texel's centre stands for
  Image<float> normal_object;  ///< of texels that `known` covers, about unit length
  Image<float> albedo;         ///< linear, of the same texels as normals; empty where the surface's is constant
  UvRaster known;              ///< the atlas' raster, and in it the texels beside charts, at the charts' nearest points
  Image<std::uint8_t> way;     ///< a TexelWay per texel
  double mean_distance = 0;    ///< from the low point of covered texels, object units
  double largest_distance = 0;
};

/// The high mesh's points for all texels of `raster`, that of `atlas`; texels beside a chart, which lookups at its edge
/// see, have the normal of the high mesh where the low mesh's triangle continues beyond the edge, unless that place is
/// buried in another part of the high mesh. With `fit_one` and
/// one sample texels hold what makes bilinear lookups fit, a little sharper than the normals at their centres. With
/// `samples` of 4, 16 or 64, that many points of a regular grid in each texel are matched, those outside all charts
/// left out, and normals are those whose bilinear lookups fit the points' best (BilinearFit); albedo the same, kept
/// within what the points around a texel have, so that no halo lies beside a sharp edge.
TexelMatches match_texels(const HighSurface& high, const TriangleMesh& atlas, const UvRaster& raster,
                          const MatchLimits& limits, int samples, bool fit_one, const ProgressFunction& progress);

}  // namespace kiln
