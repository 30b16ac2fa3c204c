#include "simplify/manifold_repair.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace kiln {

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Polygon = std::vector<std::size_t>;

std::vector<Polygon> to_polygons(const std::vector<Triangle>& triangles) {
  std::vector<Polygon> polygons;
  polygons.reserve(triangles.size());
  for (const Triangle& t : triangles) polygons.push_back({t[0], t[1], t[2]});
  return polygons;
}

double double_area(const TriangleMesh& mesh, const Triangle& triangle) {
  const Eigen::Vector3d a = mesh.positions[triangle[0]].cast<double>();
  const Eigen::Vector3d b = mesh.positions[triangle[1]].cast<double>();
  const Eigen::Vector3d c = mesh.positions[triangle[2]].cast<double>();
  return (b - a).cross(c - a).norm();
}

/// CGAL orients a component as its first triangle; turns back those components that thereby lost most of their area's
/// winding. Returns how many triangles stay reversed.
int restore_winding(TriangleMesh& mesh, std::vector<bool>& reversed) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t vertex) {
    while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
    return vertex;
  };
  for (const Triangle& t : mesh.triangles)
    for (int i = 1; i < 3; ++i) parent[root(t[i])] = root(t[0]);

  std::vector<double> kept_minus_reversed(mesh.positions.size(), 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    kept_minus_reversed[root(mesh.triangles[i][0])] += (reversed[i] ? -1 : 1) * double_area(mesh, mesh.triangles[i]);
  int still_reversed = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (kept_minus_reversed[root(mesh.triangles[i][0])] < 0) {
      std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
      reversed[i] = !reversed[i];
    }
    still_reversed += reversed[i];
  }
  return still_reversed;
}

}  // namespace

TriangleMesh to_manifold(const TriangleMesh& mesh, ManifoldRepairs& repairs) {
  repairs = {};
  TriangleMesh result;
  result.positions = mesh.positions;
  for (const Triangle& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
      ++repairs.dropped_triangles;
    else
      result.triangles.push_back(t);
  }
  if (is_manifold(result)) return result;

  std::vector<Point> points;
  for (const Eigen::Vector3f& p : mesh.positions) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<Polygon> polygons = to_polygons(result.triangles);
  PMP::orient_polygon_soup(points, polygons);
  repairs.split_vertices = static_cast<int>(points.size() - mesh.positions.size());
  for (std::size_t i = mesh.positions.size(); i < points.size(); ++i)
    result.positions.emplace_back(static_cast<float>(points[i].x()), static_cast<float>(points[i].y()),
                                  static_cast<float>(points[i].z()));

  // Splitting keeps the corners' places in a triangle unless it is reversed; compared by position, as indices may be
  // new.
  std::vector<bool> reversed(polygons.size());
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    const Triangle before = result.triangles[i];
    Triangle& after = result.triangles[i];
    for (int k = 0; k < 3; ++k) after[k] = static_cast<std::uint32_t>(polygons[i][k]);
    const auto at = [&](std::uint32_t vertex) -> const Eigen::Vector3f& { return result.positions[vertex]; };
    int first = 0;
    while (first < 2 && at(after[first]) != at(before[0])) ++first;
    reversed[i] = at(after[(first + 1) % 3]) != at(before[1]);
  }
  repairs.reversed_triangles = restore_winding(result, reversed);
  return result;
}

bool is_manifold(const TriangleMesh& mesh) { return PMP::is_polygon_soup_a_polygon_mesh(to_polygons(mesh.triangles)); }

}  // namespace kiln
