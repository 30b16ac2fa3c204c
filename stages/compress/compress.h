#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "asset/prt_asset.h"
#include "base/options.h"
#include "base/progress.h"
#include "compress/compress_settings.h"

namespace kiln {

enum class CompressScheme {
  planes,         ///< a plane per coefficient, as baked or with 8 bits
  pca,            ///< one basis for all texels
  clustered_pca,  ///< a basis for each cluster of texels
};

/// "planes", "pca", "clustered-pca".
std::string scheme_name(CompressScheme scheme);

/// Bounds of the worst, whatever error is asked for (README.md, "The worst", says how they were chosen).
inline constexpr double most_texel_error = 0.05;
inline constexpr double most_border_jump = 0.08;

/// One way to store an asset, and what it costs.
struct CompressCandidate {
  CompressScheme scheme = CompressScheme::planes;
  int clusters = 1;
  int components = 0;          ///< planes to look up
  int bits = 8;                ///< the most that a plane has
  double step = 0;             ///< of weights, in the weighted space of TransferSource; 0: planes
  double error = 0;            ///< expected relighting error against the input, over covered texels
  double texel_error = 0;      ///< which 999 of 1,000 covered texels stay under (ErrorSpread)
  double border_jump = 0;      ///< which 999 of 1,000 jumps across cluster borders stay under (ErrorSpread)
  std::uint64_t bytes = 0;     ///< of all files but the mesh, the normal map and the records
  int lookups = 0;             ///< texture lookups per shaded sample, four planes to each (shaders/common_prt*.glsl)
  int lookups_at_borders = 0;  ///< where four neighbouring texels are of several clusters
  bool feasible = true;        ///< error is under the target, and the worst under their bounds

  Json to_json() const;
};

struct CompressResult {
  double seconds = 0;
  double target_error = 0;
  CompressCandidate plain;  ///< planes of 8 bits; its error against what they are rounded from: of an 8-bit input
                            ///< step^2 / 12
  std::vector<CompressCandidate> tried;  ///< sizes by PngEffort::quick
  CompressCandidate chosen;              ///< with its files' true size
  std::vector<std::string> warnings;     ///< of bounds that settings miss which leave no choice
  double border_share = 0;  ///< of covered texels, those with a neighbour above or right in another cluster
  std::vector<std::pair<std::string, std::string>> files;  ///< name and bytes, the describing JSON last
};

/// Finds the cheapest way, in bytes, to store an asset within an error, and encodes its files. Throws WrongUsage where
/// the settings ask for what cannot be.
CompressResult compress(const PrtAsset& asset, const CompressSettings& settings,
                        const ProgressFunction& progress = no_progress);

}  // namespace kiln
