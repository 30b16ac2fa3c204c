// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/opacity_map.h"

#include <algorithm>
#include <cmath>

#include "base/json.h"
#include "image/gutter.h"
#include "maps/detail_maps.h"
#include "maps/seam_solver.h"

namespace kiln {

OpacityMap make_opacity_map(const SurfaceOpacity& opacity, const TexelMeans& means, const UvRaster& raster,
                            const Seams& seams, SeamChoice choice) {
  Image<float> map = means.of(1, [&](const SurfacePoint& point) {
    return Eigen::Vector3f(opacity.at(point.triangle, point.u, point.v), 0, 0);
  });
  fill_gutters(map, means.known());
  const std::vector<std::uint8_t> covered = coverage_of(raster);
  if (choice == SeamChoice::equalise && !seams.edges().empty()) SeamSolver(seams, covered).equalise(map, 0.f, 1.f);

  OpacityMap result;
  result.picture = Image<std::uint8_t>(map.width(), map.height(), 1);
  std::int64_t there = 0;
  for (std::size_t texel = 0; texel < covered.size(); ++texel) {
    const float value = std::clamp(map.values()[texel], 0.f, 1.f);
    // 127.5 is the cutoff: what is there is stored as 128 at least.
    const auto stored = static_cast<std::uint8_t>(std::lround(value * 255));
    result.picture.values()[texel] = stored;
    there += covered[texel] != 0 && stored >= 128;
  }
  result.share_there =
      static_cast<double>(there) / static_cast<double>(std::max<std::int64_t>(1, raster.covered_texels));
  return result;
}

Json OpacityMap::to_json() const {
  return {{"width", picture.width()}, {"height", picture.height()}, {"share_there", share_there}};
}

}  // namespace kiln
