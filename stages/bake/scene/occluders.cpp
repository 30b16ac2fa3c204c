#include "bake/scene/occluders.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/convex_hull_3.h>
#include <algorithm>
#include <iterator>

namespace kiln {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

std::vector<Eigen::Vector3f> hull_corners(const TriangleMesh& mesh) {
  std::vector<Kernel::Point_3> points, corners;
  for (const Triangle& triangle : mesh.triangles)
    for (std::uint32_t vertex : triangle) {
      const Eigen::Vector3f& p = mesh.positions[vertex];
      points.emplace_back(p.x(), p.y(), p.z());
    }
  CGAL::extreme_points_3(points, std::back_inserter(corners));
  std::sort(corners.begin(), corners.end());
  std::vector<Eigen::Vector3f> hull;
  for (const Kernel::Point_3& p : corners) hull.emplace_back(p.x(), p.y(), p.z());
  return hull;
}

}  // namespace

Occluders join_occluders(const std::vector<TriangleMesh>& meshes) {
  Occluders joined;
  joined.closed = std::all_of(meshes.begin(), meshes.end(), is_closed);
  for (const TriangleMesh& mesh : meshes) {
    const auto first = static_cast<std::uint32_t>(joined.mesh.positions.size());
    joined.mesh.positions.insert(joined.mesh.positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const Triangle& t : mesh.triangles)
      joined.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  joined.hull = hull_corners(joined.mesh);
  return joined;
}

}  // namespace kiln
