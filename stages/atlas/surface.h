// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

inline constexpr std::uint32_t no_index = ~0u;

/// Triangle of the surface laid into the plane without distortion.
struct RestTriangle {
  std::array<Eigen::Vector2d, 3> corners;
  std::array<Eigen::Vector2d, 3> gradients;  ///< gradients of the hat function of each corner
  double area = 0;
};

/// Mesh as cutting and flattening use it. Half-edge 3f+k goes from corner k of face f to the next corner.
struct Surface {
  const TriangleMesh* mesh = nullptr;
  std::vector<std::uint32_t> twins;  ///< per half-edge; no_index at borders, non-manifold edges and degenerate faces
  std::vector<double> edge_lengths;  ///< per half-edge, object units
  std::vector<double> seam_costs;    ///< per half-edge: its length, or that weighted by its visibility
  std::vector<RestTriangle> rest;    ///< per face
  std::vector<Eigen::Vector3d> face_normals;
  std::vector<std::uint8_t> degenerate;  ///< per face: it has no usable area, and no place in any chart
  double area = 0;

  std::uint32_t face_count() const { return static_cast<std::uint32_t>(rest.size()); }
  std::uint32_t half_edge_count() const { return 3 * face_count(); }
  std::uint32_t origin(std::uint32_t h) const { return mesh->triangles[h / 3][h % 3]; }
  std::uint32_t target(std::uint32_t h) const { return mesh->triangles[h / 3][(h % 3 + 1) % 3]; }
};

/// Prepares a mesh, which must outlive the surface. A face is degenerate where a corner repeats or its height is below
/// a millionth of its longest side. Neighbouring faces of opposite orientation do not become twins.
Surface analyse_surface(const TriangleMesh& mesh);

/// Raises the cost of seams where they are visible, so that cuts go to occluded places. `openness` is the share of open
/// sky, 0 to 1, at each vertex. Costs keep the lengths as their mean.
void weigh_seams(Surface& surface, const std::vector<float>& openness);

}  // namespace kiln
