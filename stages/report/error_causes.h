// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "base/json_fwd.h"
#include "base/progress.h"
#include "maps/detail_maps.h"
#include "material/scene_mesh.h"
#include "material/surface_albedo.h"
#include "report/error_samples.h"
#include "report/pixel_sums.h"
#include "scatter/profile.h"

namespace kiln {

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
  std::optional<ErrorCause> at_vertices = {};  ///< what lookups between the low mesh's vertices would contribute, in
                                               ///< place of those between texels
  std::optional<ErrorCause> unshadowed = {};   ///< what transfer without shadows would contribute, in place of that
                                               ///< over the bake's directions
  BandSquares squares;                         ///< of all causes but bands together, as those of one cause
  BandSquares seen;         ///< squares of the transfer seen, in the reference's bands, over that in the asset's bands
  std::size_t samples = 0;  ///< pixels
  int directions = 0;       ///< of the reference; where light scatters lines about a point, of each of two sets
  int bands = 0;            ///< of the reference

  /// Returns the root of the sum of the causes' squares.
  double root_sum() const;
};

/// What a bake with receivers on the low mesh differs in.
struct LowReceivers {
  const SceneMesh& shadows;            ///< what casts shadows in it
  const DetailMaps* detail = nullptr;  ///< its texels' points; null where vertices are baked
};

/// What error_causes compares.
struct SplitInput {
  const TriangleMesh& high;              ///< with normals, in the frame of the low mesh
  const TriangleMesh& low;               ///< with normals, and with uvs where the asset has textures
  const SceneMesh& scene;                ///< the high mesh and what surrounds it: what casts shadows, and what
                                         ///< light bounces off
  const PrtAsset& asset;                 ///< of kiln-bake
  const PrtAsset* compressed = nullptr;  ///< the same by kiln-compress; null: none
  const DetailMaps* detail = nullptr;    ///< the points of the high mesh that texels stand for; null: vertices were
                                         ///< baked, and `low` is its mesh
  std::vector<Eigen::Vector3f> bake_directions;  ///< directions of the bake; none: it has no shadows
  int bounces = 0;                               ///< how often light bounces; the scene has albedos then
  const LowReceivers* on_low = nullptr;          ///< null: the bake's receivers are on the high mesh
  std::vector<ScatterProfile> scattering = {};   ///< of light beneath the surface, for one colour or three; none: empty
  double mm_per_unit = 1000;                     ///< millimetres to an object unit
  const SurfaceAlbedo* albedo = nullptr;         ///< of the high mesh, where the asset has an albedo within or a map of
                                                 ///< it; null: none
  bool albedo_within = false;                    ///< whether that is within the asset's transfer
  bool map_albedo = true;                        ///< whether it is that of `detail` then, else the high mesh's
  std::vector<double> prior = {};                ///< moments of light by band, as many as of the reference; empty:
                                                 ///< lighting_prior
  ErrorSampling sampling = {};                   ///< half of its pixels where they have a size or light
                                                 ///< bounces, a quarter where it scatters
  bool try_others = false;                       ///< whether to measure `at_vertices`, of textures without albedo in
                                                 ///< them, and `unshadowed`; neither of light beneath the surface
};

/// Measures E at points spread evenly over the low mesh, each seen from a direction of its own, by changing one thing
/// after another between what a viewer should see and what the asset has there:
/// - `geometry`: transfer at the point of the high mesh that the viewer's ray meets, or at that which the low mesh's
///   point stands for;
/// - `directions`: there by the reference's directions, or by the bake's;
/// - `texels`: at that point, or looked up bilinearly between the texels' points; of an asset baked per vertex called
///   `vertices`, looked up between a triangle's corners;
/// - `receivers`: looked up of texels that stand on the high mesh, or on the low one, in the shadows there, where the
///   bake's receivers do;
/// - `albedo`: the surface's own, or that which the asset has within its transfer, or in a map; 0 where it has neither;
/// - `bits`: as computed, or rounded to the planes' ranges;
/// - `visibility`: by rays, or as stored; where light bounces it is called `bounces`, and paths add that light to the
///   rays';
/// - `shadows`: with those that the bake leaves out, or without; `directions` are the reference's then, of no error;
/// - `seams`: in place of the last ones from `texels` on, from the point to what is stored, where texels at the border
/// of a chart are
///   looked up;
/// - `compression`: as baked, or as compressed;
/// - `bands`: what bands beyond the asset's would add, up to those of the result.
/// Where light scatters beneath the surface, all stations before the stored one are by paths, which know no
/// directions: `subsurface` has what directions, visibility, bounces and the bake's sum over texels contribute.
/// Where pixels have a size, differences are those of pixels' means. Rays are Embree's. Paths are two sets of their
/// own, whose products have no noise in the mean. Throws BadInput where a texture of the asset cannot be looked up.
ErrorSplit error_causes(const SplitInput& input, const ProgressFunction& progress = no_progress);

/// Returns bands of the reference for an asset of so many.
int reference_bands(int asset_bands);

Json to_json(const ErrorSplit& split);

}  // namespace kiln
