// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/json_fwd.h"
#include "image/image.h"
#include "maps/seam_choice.h"
#include "maps/seams.h"
#include "material/surface_opacity.h"
#include "mesh/triangle_mesh.h"
#include "mesh/uv_raster.h"
#include "normals/texel_means.h"

namespace kiln {

/// The high mesh's opacity in the texels of an atlas.
struct OpacityMap {
  Image<std::uint8_t> picture;  ///< content of opacity.png: 1 channel, 128 and more where the surface is there
  double share_there = 1;       ///< share of the covered texels that are there

  Json to_json() const;
};

/// Makes the map of opacity, of the size of `means`: gutters are filled, and both sides of seams made equal.
OpacityMap make_opacity_map(const SurfaceOpacity& opacity, const TexelMeans& means, const UvRaster& raster,
                            const Seams& seams, SeamChoice choice);

}  // namespace kiln
