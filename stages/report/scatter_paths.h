// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "raycast/ray_scene.h"
#include "report/path_walker.h"
#include "scatter/profile.h"
#include "sh/transfer.h"

namespace kiln {

/// Points of a surface at which light enters that leaves it at receivers.
struct ScatterEntries {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector3f> weights;  ///< red, green and blue that leave, over the transfer that arrives here
  std::vector<std::size_t> ends = {};    ///< by receiver, the end of its entries; they begin where those before end

  std::size_t begin(std::size_t receiver) const { return receiver == 0 ? 0 : ends[receiver - 1]; }
};

/// Light beneath a surface, by chance: what the bake sums over texels, t'(p) = integral of R(|p - q|) t(q) dq, without
/// texels or hierarchy. Points q are where lines through a disc about p meet the surface, their distance from its axis
/// chosen by R; the axis is the normal or one of two tangents, weighed by multiple importance sampling over axes and
/// colours ([King 2013], [Veach 1995]). R is cut where 0.1 % of a plane's light comes from farther away, and is a
/// point where that is no farther than floats can tell. Points that
/// would send out more than they get are not scaled down, as the bake does.
class ScatterPaths {
 public:
  /// Keeps a reference to `mesh`, which has normals. One profile serves for all colours, or there are three.
  ScatterPaths(const TriangleMesh& mesh, std::span<const ScatterProfile> profiles, double mm_per_unit);

  /// Casts `lines` lines about every receiver. Receivers of different `numbers`, one for each, have different lines;
  /// the same number gives the same lines.
  ScatterEntries entries(const Receivers& receivers, int lines, std::span<const std::uint64_t> numbers) const;

 private:
  /// A colour's distances from the axis: bins of equal probability between `radii` (object units), even within each.
  struct Radii {
    ScatterProfile profile;
    std::vector<float> bounds;  ///< empty where nothing leaves the surface

    float sample(float number) const;
    /// Returns the density by area of the disc.
    float density(float radius) const;
  };
  static Radii radii_of(const ScatterProfile& profile, double mm_per_unit);

  void enter(const Eigen::Vector3f& position, const Eigen::Vector3f& normal, int lines, PathRandom& random,
             ScatterEntries& entries) const;

  const TriangleMesh& mesh_;
  RayScene own_;
  float diameter_;
  float rounding_;  ///< shorter distances between points are noise
  double mm_per_unit_;
  std::array<Radii, 3> colors_;
  std::vector<std::size_t> sampled_colors_;               ///< those that scatter far enough for lines
  Eigen::Vector3f total_here_ = Eigen::Vector3f::Zero();  ///< of the others: what leaves where it arrives
};

/// Adds to `channels`, three of them, the transfer at receivers of light that enters at `entries`: by one path from
/// each into the sky, which starts by the cosine; to `direct` that of paths that do not bounce. `numbers` are those of
/// the receivers.
void add_scattered(const ScatterEntries& entries, const PathWalker& walker, std::span<const std::uint64_t> numbers,
                   std::vector<TransferVectors>& channels, std::vector<TransferVectors>& direct);

}  // namespace kiln
