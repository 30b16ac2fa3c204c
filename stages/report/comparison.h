// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/progress.h"
#include "image/image.h"
#include "report/error_causes.h"
#include "report/level_comparison.h"
#include "report/picture_difference.h"
#include "report/records.h"
#include "report/report_settings.h"

namespace kiln {

/// The asset and the high mesh under one light, from one camera. Pictures are linear RGBA, premultiplied.
struct LightComparison {
  std::string light;
  double camera_azimuth_degrees = 0;
  Image<float> asset;
  Image<float> reference;
  PictureDifference difference;             ///< asset minus reference, over the pixels that both cover wholly
  Image<float> reference_in_full;           ///< under the light itself, not cut to the asset's bands
  PictureDifference difference_in_full;     ///< asset minus that
  Image<float> compressed;                  ///< the asset as kiln-compress stored it; empty where there is none
  PictureDifference compressed_difference;  ///< compressed minus plain asset, over the same pixels
};

struct Comparison {
  std::vector<LightComparison> lights;  ///< of the settings' camera first
  std::string lamp;                     ///< whose spectrum all lights have; empty: they are red, green and blue
  std::size_t compared_pixels = 0;      ///< number of pixels covered wholly by both, of the first
  double silhouette_difference =
      0;  ///< share of the pixels in either silhouette that lie (by half or more) in only one
  std::vector<LevelComparison> levels;     ///< levels of detail, the finest first
  std::string renderer;                    ///< renderer that drew the asset
  std::uint64_t gpu_bytes = 0;             ///< that the asset takes there: mesh, textures and light
  std::uint64_t compressed_gpu_bytes = 0;  ///< that its compressed form takes; 0 where there is none
  bool software_renderer = false;
  double render_seconds = 0;
  double reference_seconds = 0;
  ErrorSplit error;                         ///< E of what is seen, and its causes
  std::map<std::string, double> predicted;  ///< what a plan predicted, by name
};

/// Draws the asset by kiln-render, which lies beside this executable, and the mesh of `high_file` by rays, under each
/// light. Throws WrongUsage for invalid lights; MachineLacks and BadInput where kiln-render reports them.
Comparison compare_with_reference(const AssetFolder& asset, const std::filesystem::path& high_file,
                                  const ReportSettings& settings, const ComparisonRun& run);

}  // namespace kiln
