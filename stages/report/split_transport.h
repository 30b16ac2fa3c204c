// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "material/scene_mesh.h"
#include "raycast/ray_scene.h"
#include "report/bounce_paths.h"
#include "report/scatter_paths.h"
#include "report/transfer_rows.h"

namespace kiln {

/// How light reaches points of a scene, as the split of an error follows it.
struct SplitLight {
  int bounces = 0;                                  ///< how often light bounces; the scene has albedos then
  std::span<const ScatterProfile> scattering = {};  ///< of light beneath the surface; none: empty
  double mm_per_unit = 1000;                        ///< millimetres to an object unit
  int lines = 512;                                  ///< about every point, of each set, where light scatters
  int channels = 1;                                 ///< of the asset
  std::vector<int> wavelengths_nm = {};             ///< that the channels are of; none: colours
  std::uint64_t seed = 1;
};

/// Computes transfer at points of a scene, by Embree's rays and, of light that bounces or scatters, by paths: two
/// independent sets of them, so that products of both have no noise in the mean.
class SplitTransport {
 public:
  /// Keeps references to `scene`, whose first mesh light scatters beneath, and to what `light` spans. `surface` is that
  /// mesh, with normals.
  SplitTransport(const SceneMesh& scene, const TriangleMesh& surface, const SplitLight& light);

  /// Returns direct transfer, one channel.
  TransferRows direct(const Receivers& receivers, int bands, std::span<const Eigen::Vector3f> directions) const;

  /// Returns the transfer of bounced light alone, in the asset's channels; zeros where light does not bounce.
  Station bounced(const Receivers& receivers, int bands) const;

  /// Returns the transfer of all light that leaves the surface after it has scattered beneath it, in the asset's
  /// channels. `numbers` choose the paths, one for each receiver: receivers close together that have the same share
  /// most of their noise, which is not in their difference then.
  Station beneath(const Receivers& receivers, int bands, const std::vector<std::uint64_t>& numbers) const;

 private:
  TransferRows bounced_by(const Receivers& receivers, int bands, std::uint64_t set) const;
  TransferRows beneath_by(const Receivers& receivers, int bands, const std::vector<std::uint64_t>& numbers,
                          std::uint64_t set) const;

  const SceneMesh& scene_;
  const SplitLight light_;
  const RayScene rays_;
  const float offset_;
  std::unique_ptr<const ScatterPaths> scatter_;
  std::unique_ptr<const BouncePaths> paths_;
};

}  // namespace kiln
