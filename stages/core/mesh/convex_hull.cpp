// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/convex_hull.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/convex_hull_3.h>
#include <algorithm>
#include <iterator>

namespace kiln {

std::vector<Eigen::Vector3f> hull_corners(const TriangleMesh& mesh) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  std::vector<Point> points, corners;
  for (const Triangle& triangle : mesh.triangles)
    for (std::uint32_t vertex : triangle) {
      const Eigen::Vector3f& p = mesh.positions[vertex];
      points.emplace_back(p.x(), p.y(), p.z());
    }
  CGAL::extreme_points_3(points, std::back_inserter(corners));
  std::sort(corners.begin(), corners.end());
  std::vector<Eigen::Vector3f> hull;
  for (const Point& p : corners) hull.emplace_back(p.x(), p.y(), p.z());
  return hull;
}

}  // namespace kiln
