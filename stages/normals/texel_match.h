// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "base/progress.h"
#include "image/image.h"
#include "maps/texel_way.h"
#include "material/surface_albedo.h"
#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"
#include "normals/high_parts.h"
#include "normals/point_matcher.h"

namespace kiln {

/// High mesh with normals, its parts and its albedo.
struct HighSurface {
  const TriangleMesh& mesh;
  const HighParts& parts;
  const SurfaceAlbedo& albedo;
};

/// Results of match_texels; rows from the bottom.
struct TexelMatches {
  Image<float> position;       ///< object-space point that a covered texel's centre stands for
  Image<float> normal_object;  ///< for texels that `known` covers, about unit length
  Image<float> albedo;         ///< linear, for the same texels; empty where the surface's albedo is constant
  UvRaster known;  ///< the atlas's raster, and in it the ring texels beside charts, at the charts' nearest points
  Image<std::uint8_t> way;   ///< a TexelWay per texel
  double mean_distance = 0;  ///< mean distance from the low points of covered texels, object units
  double largest_distance = 0;
};

/// Matches all texels of `raster`, that of the matcher's atlas, to the high mesh. Ring texels beside a chart, which
/// lookups at its edge see, get the high normal at the point where the low triangle's plane continues beyond the edge,
/// unless that point is buried in another part of the high mesh. With one sample and `fit_one`, texels hold what makes
/// bilinear lookups fit, a little sharper than the normals at their centres. With `samples` of 4, 16 or 64, that many
/// points of a regular grid in each texel are matched (those outside all charts are left out), and normals are those
/// whose bilinear lookups fit the points best (BilinearFit). Albedo is fitted likewise, and kept within the range of
/// the points around a texel, so that no halo lies beside a sharp edge.
TexelMatches match_texels(const HighSurface& high, const PointMatcher& matcher, const UvRaster& raster, int samples,
                          bool fit_one, const ProgressFunction& progress);

}  // namespace kiln
