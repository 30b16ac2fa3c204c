// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "base/json_fwd.h"
#include "base/progress.h"
#include "maps/detail_maps.h"
#include "material/scene_mesh.h"
#include "report/error_samples.h"

namespace kiln {

/// Squares of E by band: that of `n` bands is the sum of the first n.
using BandSquares = std::vector<double>;

/// One cause of an asset's error, and what it contributes to E (sh/transfer.h).
struct ErrorCause {
  std::string name;
  double error = 0;
  BandSquares squares;  ///< of the asset's bands, over the square of the transfer seen in them
};

/// E of an asset against the high mesh as it is seen, and its causes. Their squares add up to that of the whole as far
/// as they are unrelated.
struct ErrorSplit {
  double total = 0;
  double uncertainty = 0;  ///< half-width of its 95 % confidence interval, for the pixels it was measured at
  std::vector<ErrorCause> causes;
  BandSquares squares;      ///< of all causes but bands together, as those of one cause
  BandSquares seen;         ///< squares of the transfer seen, in the reference's bands, over that in the asset's bands
  std::size_t samples = 0;  ///< pixels
  int directions = 0;       ///< of the reference
  int bands = 0;            ///< of the reference

  /// Returns the root of the sum of the causes' squares.
  double root_sum() const;
};

/// What error_causes compares.
struct SplitInput {
  const TriangleMesh& high;                      ///< with normals, in the frame of the low mesh
  const TriangleMesh& low;                       ///< with normals and uvs
  const SceneMesh& scene;                        ///< the high mesh and what surrounds it: what casts shadows, and what
                                                 ///< light bounces off
  const PrtAsset& asset;                         ///< of kiln-bake, with textures
  const PrtAsset* compressed = nullptr;          ///< the same by kiln-compress; null: none
  const DetailMaps& detail;                      ///< maps that the bake read
  std::vector<Eigen::Vector3f> bake_directions;  ///< directions of the bake
  int bounces = 0;                               ///< how often light bounces; the scene has albedos then
  std::vector<double> prior = {};                ///< moments of light by band, as many as of the reference; empty:
                                                 ///< lighting_prior
  ErrorSampling sampling = {};                   ///< half of its pixels where they have a size or paths
};

/// Measures E at points spread evenly over the low mesh, each seen from a direction of its own, by changing one thing
/// after another between what a viewer should see and what the asset has there:
/// - `geometry`: transfer at the point of the high mesh that the viewer's ray meets, or at that which the low mesh's
///   point stands for;
/// - `directions`: there by the reference's directions, or by the bake's;
/// - `texels`: at that point, or looked up bilinearly between the texels' points;
/// - `bits`: as computed, or rounded to the planes' ranges;
/// - `visibility`: by rays, or as stored; where light bounces it is called `bounces`, and paths add that light to the
///   rays';
/// - `seams`: in place of the last three, from the point to what is stored, where texels at the border of a chart are
/// looked up;
/// - `compression`: as baked, or as compressed;
/// - `bands`: what bands beyond the asset's would add, up to those of the result.
/// Where pixels have a size, differences are those of pixels' means. Rays are Embree's. Paths are two sets of their
/// own, whose products have no noise in the mean. Throws BadInput where a texture of the asset cannot be looked up.
ErrorSplit error_causes(const SplitInput& input, const ProgressFunction& progress = no_progress);

/// Returns bands of the reference for an asset of so many.
int reference_bands(int asset_bands);

Json to_json(const ErrorSplit& split);

}  // namespace kiln
