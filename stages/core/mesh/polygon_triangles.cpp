// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/polygon_triangles.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

namespace kiln {

std::vector<Triangle> triangulate_polygon(const std::vector<Eigen::Vector3d>& corners) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  // Work near the origin, so that no digits are lost far from it.
  std::vector<Point> points;
  for (const Eigen::Vector3d& corner : corners) {
    const Eigen::Vector3d p = corner - corners.front();
    points.emplace_back(p.x(), p.y(), p.z());
  }
  std::vector<CGAL::Triple<int, int, int>> faces;
  CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
      points, std::back_inserter(faces), CGAL::parameters::use_2d_constrained_delaunay_triangulation(true));
  std::vector<Triangle> triangles;
  for (const auto& face : faces)
    triangles.push_back({static_cast<std::uint32_t>(face.first), static_cast<std::uint32_t>(face.second),
                         static_cast<std::uint32_t>(face.third)});
  return triangles;
}

}  // namespace kiln
