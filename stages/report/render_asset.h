// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/framing_options.h"
#include "base/json.h"
#include "base/progress.h"
#include "image/image.h"
#include "report/records.h"

namespace kiln {

/// Context of a comparison beyond the settings.
struct ComparisonRun {
  std::filesystem::path scratch;  ///< folder for temporary files
  int threads = 0;
  int seed = 1;
  ProgressFunction progress = no_progress;
};

/// Samples per pixel along each axis of the pictures that render_asset draws.
inline constexpr int drawn_supersample = 2;

/// Camera and look of pictures of an asset.
struct RenderedView {
  double azimuth_degrees = 0, elevation_degrees = 0;
  FramingSettings framing = {};
  double field_of_view_degrees = 30;
  int size = 512;  ///< pixels a side
  double albedo = 1;
  std::string gl_device = "auto";
  int level = 0;            ///< of detail
  bool compressed = false;  ///< the compressed form as well
};

/// Pictures of assets under each light.
struct Rendered {
  Json said;                           ///< result of kiln-render for the first picture
  std::vector<Image<float>> pictures;  ///< asset after asset, light after light
};

/// Draws the asset and, if asked for, its compressed form under each light by kiln-render, which lies beside this
/// executable. All in one run of it, because starting takes longer than drawing. Throws MachineLacks, BadInput and
/// WrongUsage where kiln-render reports them.
Rendered render_asset(const AssetFolder& asset, const RenderedView& view, const std::vector<std::string>& lights,
                      const ComparisonRun& run);

}  // namespace kiln
