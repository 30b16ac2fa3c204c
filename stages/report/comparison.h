#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"
#include "image/compare.h"
#include "image/image.h"
#include "report/records.h"
#include "report/report_settings.h"

namespace kiln {

/// The asset and the high mesh under one light. Pictures are linear RGBA, premultiplied.
struct LightComparison {
  std::string light;
  Image<float> asset;
  Image<float> reference;
  ImageDifference difference;             ///< of the asset from the reference, over the pixels that both cover wholly
  Image<float> compressed;                ///< the asset as kiln-compress stored it; empty where there is none
  ImageDifference compressed_difference;  ///< of that from the asset, over the same pixels
};

struct Comparison {
  std::vector<LightComparison> lights;
  std::size_t compared_pixels = 0;   ///< covered wholly by both
  double silhouette_difference = 0;  ///< share of the pixels in either shape that lie (by half or more) in one alone
  std::string renderer;              ///< that drew the asset
  bool software_renderer = false;
  double render_seconds = 0;
  double reference_seconds = 0;
};

/// Where and how to work, other than what the settings say.
struct ComparisonRun {
  std::filesystem::path scratch;  ///< a folder for passing files
  int threads = 0;
  int seed = 1;
  ProgressFunction progress = no_progress;
};

/// Draws the asset by kiln-render, which lies beside this executable, and the mesh of `high_file` by rays, under each
/// light. Throws WrongUsage for lights that are none, MachineLacks and BadInput where kiln-render says so.
Comparison compare_with_reference(const AssetFolder& asset, const std::filesystem::path& high_file,
                                  const ReportSettings& settings, const ComparisonRun& run);

}  // namespace kiln
