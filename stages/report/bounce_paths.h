// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "material/scene_mesh.h"
#include "raycast/ray_scene.h"
#include "report/path_walker.h"
#include "sh/transfer.h"

namespace kiln {

/// Light that arrives at receivers after bounces off a scene's diffuse surfaces, by paths that end in the sky
/// ([Kajiya 1986]): what the bake computes at points of the surface and interpolates, without such points.
class BouncePaths {
 public:
  /// Keeps references to both. `scene` is the surface's hierarchy; `surface` has albedos. Light bounces at most
  /// `bounces` times.
  BouncePaths(const RayScene& scene, const SceneMesh& surface, int bounces, float ray_offset,
              const std::vector<int>& wavelengths_nm = {});

  /// Adds the bounced transfer of the receivers to `channels`, red, green and blue or the wavelengths: a path starts
  /// along each of `directions`, which stand for the whole sphere, and goes on in a random direction, by the cosine,
  /// from every front that it hits. `first` numbers the receivers among all of the picture, whose paths differ; the
  /// same number gives the same paths.
  void add(const Receivers& receivers, std::span<const Eigen::Vector3f> directions, std::uint64_t first,
           std::vector<TransferVectors>& channels) const;

 private:
  PathWalker walker_;
};

}  // namespace kiln
