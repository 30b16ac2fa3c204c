// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "material/scene_mesh.h"
#include "raycast/ray_scene.h"
#include "report/path_albedo.h"

namespace kiln {

/// Random numbers of one receiver: SplitMix64 [Steele 2014], so that neighbouring numbers of receivers give unlike
/// sequences, and the same number the same.
class PathRandom {
 public:
  explicit PathRandom(std::uint64_t receiver);

  /// Returns a number of 0 up to, not including, 1.
  float uniform();

 private:
  std::uint64_t state_;
};

/// Returns a direction about a unit normal, of density cosine / pi for even numbers of 0 to 1: the squared sine of its
/// angle with the normal, and its turn about it.
Eigen::Vector3f cosine_direction(const Eigen::Vector3f& normal, float squared_sine, float turn);

/// End of a path: the direction in which it leaves the scene, how often it bounced, and the share of each colour or
/// wavelength that it carries.
struct Escape {
  Eigen::Vector3f direction;
  PathShares throughput;
  int bounces = 0;
};

/// Follows paths of light backwards, off a scene's diffuse surfaces into the sky ([Kajiya 1986]).
class PathWalker {
 public:
  /// Keeps references to both. `scene` is the surface's hierarchy; `surface` has albedos where `bounces`, the most that
  /// a path makes, is more than 0. Paths carry red, green and blue, or these wavelengths. Throws as PathAlbedo does.
  PathWalker(const RayScene& scene, const SceneMesh& surface, int bounces, float ray_offset,
             const std::vector<int>& wavelengths_nm = {});

  /// Follows a path that leaves `origin` along `direction`, and goes on in a random direction, by the cosine, from
  /// every front that it hits. Nothing where it meets a back, or the surface more often than light bounces.
  std::optional<Escape> walk(Eigen::Vector3f origin, Eigen::Vector3f direction, PathRandom& random) const;

  float ray_offset() const { return ray_offset_; }

  /// Returns how many shares a path carries.
  int channels() const { return albedo_.channels(); }

 private:
  const RayScene& scene_;
  const SceneMesh& surface_;
  PathAlbedo albedo_;
  int bounces_;
  float ray_offset_;
};

}  // namespace kiln
