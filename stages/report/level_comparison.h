// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "asset/prt_asset.h"
#include "base/json_fwd.h"
#include "image/image.h"
#include "report/records.h"
#include "report/render_asset.h"
#include "report/report_settings.h"

namespace kiln {

/// Level of detail beside the asset's own mesh, from the report's camera, and beside the level before it at the
/// distance where both change places.
struct LevelComparison {
  int level = 0;
  PrtLevel described;                ///< as ranges.json has it
  double relative_l2 = 0;            ///< against the own mesh, over pixels that both cover wholly, worst light
  double silhouette_difference = 0;  ///< from the own mesh's
  double popping = 0;                ///< largest change of a pixel's radiance, any colour and light, before black
  double popping_inside = 0;         ///< the same of pixels that both levels cover wholly
  int popping_size = 0;              ///< side of the picture that it was measured in, pixels
  Image<float> picture;              ///< from the report's camera, under its first light
};

/// Draws every level of detail by kiln-render. At the switching distance the camera is the one that kiln-lod proposed
/// distances for, and pictures are cut to what the asset fills, so that a pixel is what a viewer sees. Throws what
/// render_asset does.
std::vector<LevelComparison> compare_levels(const AssetFolder& asset, double albedo, const ReportSettings& settings,
                                            const ComparisonRun& run);

Json to_json(const std::vector<LevelComparison>& levels);

}  // namespace kiln
