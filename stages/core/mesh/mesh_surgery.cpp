// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mesh_surgery.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <queue>
#include <stdexcept>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "mesh/disjoint_sets.h"
#include "mesh/mesh_components.h"

namespace kiln {

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using SurfaceMesh = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;
using Vertex = SurfaceMesh::Vertex_index;
using Halfedge = SurfaceMesh::Halfedge_index;
using Face = SurfaceMesh::Face_index;

/// Converts a mesh; vertices and faces keep their numbers.
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

/// Returns the first face beside `face` that is older than a patch, else `otherwise`.
Face neighbour_of(const SurfaceMesh& surface, Face face, std::uint32_t old_faces, Face otherwise) {
  for (const Halfedge edge : surface.halfedges_around_face(surface.halfedge(face))) {
    const Face beside = surface.face(surface.opposite(edge));
    if (beside != SurfaceMesh::null_face() && beside < Face(old_faces)) return beside;
  }
  return otherwise;
}

/// Removes triangles whose corners lie on one line. Such a triangle's longest edge, which its third corner lies on, is
/// flipped into the triangle beyond, which is cut in two by that. The triangle with the longest edge comes first: the
/// one beyond it has an area or is no longer, so edges only get shorter and the loop ends.
class FlatTriangles {
 public:
  FlatTriangles(TriangleMesh& mesh, TriangleOrigins& origins)
      : mesh_(mesh), origins_(origins), is_removed_(mesh.triangles.size(), false) {}

  /// Removes the flat triangles; returns how many there were.
  int remove() {
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) push_if_flat(t);
    const auto count = static_cast<int>(queue_.size());
    if (count == 0) return 0;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) enter(t);
    while (!queue_.empty()) {
      const Flat flat = queue_.top();
      queue_.pop();
      // Skip entries that a flip has outdated: the triangle is in the queue again.
      if (is_removed_[flat.triangle] || mesh_.triangles[flat.triangle] != flat.corners) continue;
      if (!flip_longest_edge(flat.triangle)) take_out(flat.triangle);
    }
    compact();
    return count;
  }

 private:
  struct Flat {
    double longest_edge;
    std::uint32_t triangle;
    Triangle corners;
    bool operator<(const Flat& other) const {  // the queue takes the greatest first
      return std::tie(longest_edge, other.triangle) < std::tie(other.longest_edge, triangle);
    }
  };

  static std::uint64_t key(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; }

  double squared_length(std::uint32_t a, std::uint32_t b) const {
    return (mesh_.positions[a].cast<double>() - mesh_.positions[b].cast<double>()).squaredNorm();
  }

  /// Returns the corner that the longest edge starts at.
  std::size_t longest_edge_of(const Triangle& t) const {
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (squared_length(t[k], t[(k + 1) % 3]) > squared_length(t[longest], t[(longest + 1) % 3])) longest = k;
    return longest;
  }

  void push_if_flat(std::uint32_t triangle) {
    const Triangle& t = mesh_.triangles[triangle];
    if (!is_flat(mesh_, t)) return;
    const std::size_t k = longest_edge_of(t);
    queue_.push({squared_length(t[k], t[(k + 1) % 3]), triangle, t});
  }

  void enter(std::uint32_t triangle) {
    const Triangle& t = mesh_.triangles[triangle];
    for (std::size_t k = 0; k < 3; ++k) triangle_at_[key(t[k], t[(k + 1) % 3])] = triangle;
  }

  void leave(std::uint32_t triangle) {
    const Triangle& t = mesh_.triangles[triangle];
    for (std::size_t k = 0; k < 3; ++k) triangle_at_.erase(key(t[k], t[(k + 1) % 3]));
  }

  void take_out(std::uint32_t triangle) {
    leave(triangle);
    is_removed_[triangle] = true;
  }

  /// Flips the longest edge; false where no triangle lies beyond it, or the new edge already exists or has no length.
  bool flip_longest_edge(std::uint32_t triangle) {
    const Triangle t = mesh_.triangles[triangle];
    const std::size_t k = longest_edge_of(t);
    const std::uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
    const auto found = triangle_at_.find(key(b, a));
    if (found == triangle_at_.end()) return false;
    const std::uint32_t beyond = found->second;
    const Triangle& o = mesh_.triangles[beyond];
    const std::uint32_t d = o[0] != a && o[0] != b ? o[0] : o[1] != a && o[1] != b ? o[1] : o[2];
    if (mesh_.positions[c] == mesh_.positions[d] || triangle_at_.contains(key(c, d)) ||
        triangle_at_.contains(key(d, c)))
      return false;
    leave(triangle);
    leave(beyond);
    mesh_.triangles[triangle] = {a, d, c};
    mesh_.triangles[beyond] = {d, b, c};
    origins_[triangle] = origins_[beyond];
    enter(triangle);
    enter(beyond);
    push_if_flat(triangle);
    push_if_flat(beyond);
    return true;
  }

  void compact() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < is_removed_.size(); ++i) {
      if (is_removed_[i]) continue;
      mesh_.triangles[kept] = mesh_.triangles[i];
      origins_[kept++] = origins_[i];
    }
    mesh_.triangles.resize(kept);
    origins_.resize(kept);
  }

  TriangleMesh& mesh_;
  TriangleOrigins& origins_;
  std::vector<bool> is_removed_;
  std::priority_queue<Flat> queue_;
  std::unordered_map<std::uint64_t, std::uint32_t> triangle_at_;  ///< by directed edge
};

}  // namespace

int remove_flat_triangles(TriangleMesh& mesh, TriangleOrigins& origins) {
  return FlatTriangles(mesh, origins).remove();
}

int count_border_loops(const TriangleMesh& mesh) {
  // At an inner vertex, the vertices after it in its triangles are the same set as those before it; at a border one of
  // each differs. Compare the sums of their numbers, so that a closed surface needs no search.
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
  // A loop is a connected part of the border: each of its vertices has one border edge in and one out.
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

int fill_holes(TriangleMesh& mesh, TriangleOrigins& origins, int most_edges) {
  const Components components = find_components(mesh);
  std::vector<double> component_area(components.count, 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    component_area[components.of_triangle[i]] += area_normal(mesh, mesh.triangles[i]).norm();
  SurfaceMesh surface = to_surface(mesh);
  const auto old_faces = static_cast<std::uint32_t>(mesh.triangles.size());
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
    for (const Face face : patch) patch_area += area_normal(mesh, triangle_of(surface, face)).norm();
    if (patch.empty() || patch_area > 0.6 * component_area[component]) continue;
    for (const Face face : patch) {
      mesh.triangles.push_back(triangle_of(surface, face));
      origins.push_back(origins[neighbour_of(surface, face, old_faces, surface.face(surface.opposite(loop)))]);
    }
    ++filled;
  }
  return filled;
}

}  // namespace kiln
