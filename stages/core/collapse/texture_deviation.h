// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "base/extent.h"
#include "collapse/wedge_mesh.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// What a collapse would do to the surface points that texels stand for.
struct DeviationChange {
  bool allowed = false;  ///< false where a triangle would fold over or become too thin, in space or in the atlas
  double cost = 0;       ///< growth of the sum of cubed distances, times area
  /// Largest distance of the samples concerned afterwards, and of new edges from vanishing ones where they cross in the
  /// atlas; in units of the mesh.
  double worst = 0;
};

/// Sample of the first mesh's surface, and the place of its uv on what the collapse has left.
struct PlacedSample {
  Triangle wedges{};                ///< of the triangle that holds the uv, or is nearest to it
  std::array<double, 3> weights{};  ///< of the wedges at the place; they add up to 1
  Eigen::Vector3d position;         ///< on the first mesh
  Eigen::Vector3d normal;           ///< as that mesh is shaded, of any length
  double area = 0;                  ///< of the first mesh that it stands for
};

/// Distance between a mesh under collapse and the first one, at places of the same uv: how far what a texel shows has
/// moved. This bounds how far surfaces lie apart as well as how far textures slide over them, the texture deviation of
/// [Cohen 1998]. It is tracked at samples, the first mesh's vertices and the middles of its edges, each kept with the
/// triangle whose uvs hold it; where an outline has drawn back from it, with the nearest.
class TextureDeviation {
 public:
  TextureDeviation(const TriangleMesh& mesh, Extent size);

  /// Judges a collapse. One that costs `most_cost` or more is not allowed.
  DeviationChange judge(const WedgeMesh& wedges, const WedgeCollapse& collapse, double most_cost) const;

  /// Moves the samples to the triangles that they will be in. To be called before the collapse is applied.
  void apply(const WedgeMesh& wedges, const WedgeCollapse& collapse);

  /// Returns every sample where it is now.
  std::vector<PlacedSample> placed_samples(const WedgeMesh& wedges) const;

 private:
  struct Sample {
    Eigen::Vector2d uv;
    Eigen::Vector3d position;
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    double weight = 0;   ///< area
    double squared = 0;  ///< distance to the surface's point of this uv, squared
  };
  struct Move {
    std::uint32_t sample = 0, triangle = 0;
    double squared = 0;
  };
  struct NewTriangle {
    std::uint32_t triangle = 0;
    std::array<Eigen::Vector2d, 3> uvs;
    std::array<Eigen::Vector3d, 3> positions;
  };
  bool shape_is_kept(const NewTriangle& changed, const Triangle& wedges, const Triangle& before) const;
  bool make_triangles(const WedgeMesh& wedges, const WedgeCollapse& collapse, const WedgeCollapse::Sector& sector,
                      std::vector<NewTriangle>& made) const;
  double distance_at_crossings(const WedgeMesh& wedges, const WedgeCollapse::Sector& sector,
                               const std::vector<NewTriangle>& made) const;
  Move nearest(const Sample& sample, const std::vector<NewTriangle>& triangles) const;

  std::vector<Eigen::Vector2d> uvs_;                    ///< by wedge, texels
  std::vector<Eigen::Vector3d> positions_;              ///< by wedge
  std::vector<Eigen::Vector3d> normals_;                ///< by wedge
  std::vector<Sample> samples_;                         ///< those of the wedges first
  std::vector<std::vector<std::uint32_t>> samples_in_;  ///< by triangle; those of wedges that are gone, and of edges
  double least_height_ = 0;                             ///< of a triangle in space
};

}  // namespace kiln
