#include "mesh/mesh_surgery.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "mesh/mesh_components.h"

namespace kiln {

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using SurfaceMesh = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;
using Vertex = SurfaceMesh::Vertex_index;
using Halfedge = SurfaceMesh::Halfedge_index;
using Face = SurfaceMesh::Face_index;

double double_area(const TriangleMesh& mesh, const Triangle& triangle) {
  const Eigen::Vector3d a = mesh.positions[triangle[0]].cast<double>();
  const Eigen::Vector3d b = mesh.positions[triangle[1]].cast<double>();
  const Eigen::Vector3d c = mesh.positions[triangle[2]].cast<double>();
  return (b - a).cross(c - a).norm();
}

bool is_flat(const TriangleMesh& mesh, const Triangle& triangle) { return !(double_area(mesh, triangle) > 0); }

/// Vertices and faces have the same numbers.
SurfaceMesh to_surface(const TriangleMesh& mesh) {
  SurfaceMesh surface;
  surface.reserve(mesh.positions.size(), mesh.triangles.size() * 3 / 2, mesh.triangles.size());
  for (const Eigen::Vector3f& p : mesh.positions) surface.add_vertex({p.x(), p.y(), p.z()});
  for (const Triangle& t : mesh.triangles)
    if (surface.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2])) == SurfaceMesh::null_face())
      throw std::logic_error("a triangle does not fit an oriented manifold");
  return surface;
}

Triangle triangle_of(const SurfaceMesh& surface, Face face) {
  const Halfedge first = surface.halfedge(face);
  return {surface.source(first), surface.target(first), surface.target(surface.next(first))};
}

std::vector<Triangle> triangles_of(const SurfaceMesh& surface) {
  std::vector<Triangle> triangles;
  for (const Face face : surface.faces()) triangles.push_back(triangle_of(surface, face));
  return triangles;
}

}  // namespace

int remove_flat_triangles(TriangleMesh& mesh) {
  const auto flat = [&](const Triangle& triangle) { return is_flat(mesh, triangle); };
  const auto count = static_cast<int>(std::count_if(mesh.triangles.begin(), mesh.triangles.end(), flat));
  if (count == 0) return 0;
  SurfaceMesh surface = to_surface(mesh);
  // It makes no vertex, so that positions stay as they are.
  PMP::remove_degenerate_faces(surface);
  if (surface.num_vertices() == mesh.positions.size()) mesh.triangles = triangles_of(surface);
  mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), flat), mesh.triangles.end());
  return count;
}

int count_border_loops(const TriangleMesh& mesh) {
  // Over the triangles at an inner vertex, the vertices after it are those before it; on a border one of each differs.
  // Their sums tell, so that a closed surface needs no search.
  std::vector<std::uint64_t> after_less_before(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) after_less_before[t[k]] += std::uint64_t{t[(k + 1) % 3]} - t[(k + 2) % 3];
  std::vector<std::pair<std::uint32_t, std::uint32_t>> directed;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k], to = t[(k + 1) % 3];
      if (after_less_before[from] != 0 && after_less_before[to] != 0) directed.emplace_back(from, to);
    }
  std::sort(directed.begin(), directed.end());
  // A loop is a connected part of the border: a vertex has one edge of it that comes and one that goes.
  DisjointSets sets(mesh.positions.size());
  std::vector<std::uint32_t> on_border;
  for (const auto& [from, to] : directed) {
    if (std::binary_search(directed.begin(), directed.end(), std::make_pair(to, from))) continue;
    sets.join(from, to);
    on_border.push_back(from);
  }
  std::vector<std::uint32_t> loops;
  for (const std::uint32_t vertex : on_border) loops.push_back(sets.root(vertex));
  std::sort(loops.begin(), loops.end());
  return static_cast<int>(std::unique(loops.begin(), loops.end()) - loops.begin());
}

int fill_holes(TriangleMesh& mesh, int most_edges) {
  const Components components = find_components(mesh);
  std::vector<double> component_area(components.count, 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    component_area[components.of_triangle[i]] += double_area(mesh, mesh.triangles[i]);
  SurfaceMesh surface = to_surface(mesh);
  std::vector<Halfedge> loops;
  PMP::extract_boundary_cycles(surface, std::back_inserter(loops));
  int filled = 0;
  for (const Halfedge loop : loops) {
    int edges = 0;
    for (Halfedge edge = loop; edges <= most_edges && (edge != loop || edges == 0); edge = surface.next(edge)) ++edges;
    if (edges > most_edges) continue;
    const std::uint32_t component = components.of_triangle[surface.face(surface.opposite(loop))];
    std::vector<Face> patch;
    PMP::triangulate_hole(surface, loop, std::back_inserter(patch));
    double patch_area = 0;
    for (const Face face : patch) patch_area += double_area(mesh, triangle_of(surface, face));
    if (patch.empty() || patch_area > 0.6 * component_area[component]) continue;
    for (const Face face : patch) mesh.triangles.push_back(triangle_of(surface, face));
    ++filled;
  }
  return filled;
}

}  // namespace kiln
