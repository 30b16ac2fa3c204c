// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "asset/prt_asset.h"
#include "base/json_fwd.h"
#include "base/progress.h"
#include "compress/compress_settings.h"

namespace kiln {

enum class CompressScheme {
  planes,         ///< a plane per coefficient, as baked or with 8 bits
  pca,            ///< one basis for all texels
  clustered_pca,  ///< a basis for each cluster of texels
};

/// Returns "planes", "pca" or "clustered-pca".
std::string scheme_name(CompressScheme scheme);

/// Bounds on the worst errors, whatever mean error is asked for (README.md, "The worst", tells how they were chosen).
inline constexpr double most_texel_error = 0.07;
inline constexpr double most_border_jump = 0.11;

/// Way to store an asset, and its costs.
struct CompressCandidate {
  CompressScheme scheme = CompressScheme::planes;
  int clusters = 1;
  int components = 0;          ///< planes to look up
  int bits = 8;                ///< largest number of bits of a plane
  double step = 0;             ///< step of the weights, in the weighted space of TransferSource; 0: planes
  double error = 0;            ///< expected relighting error against the input, over covered texels
  double texel_error = 0;      ///< bound that 999 of 1,000 covered texels stay under (ErrorSpread)
  double border_jump = 0;      ///< bound that 999 of 1,000 jumps across cluster borders stay under (ErrorSpread)
  std::uint64_t bytes = 0;     ///< size of all files except the mesh, the normal map and the records
  int lookups = 0;             ///< texture lookups per shaded sample, four planes to each (shaders/common_prt.glsl)
  int lookups_at_borders = 0;  ///< likewise where four neighbouring texels belong to several clusters
  bool feasible = true;        ///< the error is under the target, and the worst errors under their bounds

  Json to_json() const;
};

struct CompressResult {
  double seconds = 0;
  double target_error = 0;
  /// Planes of 8 bits, and their error against what they were rounded from; for an 8-bit input that is step^2 / 12.
  CompressCandidate plain;
  std::vector<CompressCandidate> tried;  ///< with sizes by PngEffort::quick
  CompressCandidate chosen;              ///< with its files' true size
  std::vector<std::string> warnings;     ///< bounds missed by settings that leave no choice
  double border_share = 0;  ///< share of covered texels whose neighbour above or to the right is in another cluster
  std::vector<std::pair<std::string, std::string>> files;  ///< names and bytes, the describing JSON last
};

/// Finds the cheapest way, in bytes, to store an asset within an error, and encodes its files. Throws WrongUsage where
/// the settings ask for the impossible, and BadInput for a compressed asset or transfer beyond 1e12.
CompressResult compress(const PrtAsset& asset, const CompressSettings& settings,
                        const ProgressFunction& progress = no_progress);

}  // namespace kiln
