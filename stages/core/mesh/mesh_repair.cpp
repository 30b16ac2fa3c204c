// SPDX-License-Identifier: GPL-3.0-or-later
// Orientation: CGAL, "Polygon Mesh Processing", orient_polygon_soup. Taking sheets apart: [Gueziec 2001], with local
// cuts and stitches.
#include "mesh/mesh_repair.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

#include "mesh/disjoint_sets.h"
#include "mesh/index_table.h"
#include "mesh/mesh_components.h"
#include "mesh/mesh_surgery.h"
#include "mesh/same_position.h"
#include "mesh/triangle_edges.h"

namespace kiln {

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
constexpr std::uint32_t none_yet = ~0u;

bool repeats_vertex(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// Merges vertices at the same position into the first of them. Returns how many others there were.
int merge_vertices(TriangleMesh& mesh) {
  for (Eigen::Vector3f& p : mesh.positions) p += Eigen::Vector3f::Zero();  // turns -0 into +0
  const std::vector<std::uint32_t> first = first_at_position(mesh.positions);
  int merged = 0;
  for (std::uint32_t i = 0; i < first.size(); ++i) merged += first[i] != i;
  if (merged > 0) mesh.triangles = renumbered(mesh.triangles, first);
  return merged;
}

/// Drops vertices that no triangle uses; the others keep their order. Returns how many.
int drop_unused(TriangleMesh& mesh) {
  std::vector<std::uint32_t> new_index(mesh.positions.size(), none_yet);
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) new_index[vertex] = 0;
  std::uint32_t used = 0;
  for (std::uint32_t i = 0; i < new_index.size(); ++i) {
    if (new_index[i] == none_yet) continue;
    mesh.positions[used] = mesh.positions[i];
    if (!mesh.colors.empty()) mesh.colors[used] = mesh.colors[i];
    new_index[i] = used++;
  }
  const int unused = static_cast<int>(mesh.positions.size() - used);
  mesh.positions.resize(used);
  if (!mesh.colors.empty()) mesh.colors.resize(used);
  if (unused > 0)
    for (Triangle& triangle : mesh.triangles)
      for (std::uint32_t& vertex : triangle) vertex = new_index[vertex];
  return unused;
}

/// Tells whether two triangles of the same vertices are wound alike.
bool is_wound_alike(const Triangle& a, const Triangle& b) {
  const auto k = static_cast<std::size_t>(std::find(b.begin(), b.end(), a[0]) - b.begin());
  return b[(k + 1) % 3] == a[1];
}

/// Drops triangles that repeat a vertex or another triangle; also backs of others, unless `keeps_backs`.
void drop_duplicates(TriangleMesh& mesh, TriangleOrigins& origins, bool keeps_backs, MeshRepairs& repairs) {
  IndexTable table(mesh.triangles.size());
  std::vector<Triangle> kept;
  TriangleOrigins kept_origins;
  kept.reserve(mesh.triangles.size());
  kept_origins.reserve(mesh.triangles.size());
  const auto sorted = [](Triangle triangle) {
    std::sort(triangle.begin(), triangle.end());
    return triangle;
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& triangle = mesh.triangles[i];
    if (repeats_vertex(triangle)) {
      ++repairs.degenerate_triangles;
      continue;
    }
    const Triangle key = sorted(triangle);
    const auto index = static_cast<std::uint32_t>(kept.size());
    const std::uint32_t found = table.find_or_add(key, index, [&](std::uint32_t other) {
      return sorted(kept[other]) == key && (!keeps_backs || is_wound_alike(kept[other], triangle));
    });
    if (found == index) {
      kept.push_back(triangle);
      kept_origins.push_back(origins[i]);
    } else {
      ++(is_wound_alike(kept[found], triangle) ? repairs.duplicate_triangles : repairs.dropped_backs);
    }
  }
  mesh.triangles = std::move(kept);
  origins = std::move(kept_origins);
}

/// Winds triangles like their neighbours across edges of two triangles; each connected part is wound as the greater
/// part of its area was. Returns how many were turned.
int orient(TriangleMesh& mesh) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  std::vector<Point> points;
  for (const Eigen::Vector3f& p : mesh.positions) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::vector<std::size_t>> polygons;
  polygons.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) polygons.push_back({t[0], t[1], t[2]});
  PMP::orient_polygon_soup(points, polygons);

  // CGAL's function also splits vertices, but opens whole chains of edges where sheets meet: take only the winding and
  // the connectivity from it. Corners keep their places in a triangle unless it is turned.
  std::vector<bool> turned(polygons.size());
  TriangleMesh parts;
  parts.positions.resize(points.size());
  parts.triangles.resize(polygons.size());
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    for (int k = 0; k < 3; ++k) parts.triangles[i][k] = static_cast<std::uint32_t>(polygons[i][k]);
    const auto corner = [&](int k) { return points[polygons[i][k % 3]]; };
    const auto& [a, b, c] = mesh.triangles[i];
    int first = 0;
    while (first < 2 && corner(first) != points[a]) ++first;
    turned[i] = corner(first + 1) != points[b];
  }

  const Components components = find_components(parts);
  std::vector<double> kept_area(components.count, 0);
  for (std::size_t i = 0; i < turned.size(); ++i)
    kept_area[components.of_triangle[i]] += (turned[i] ? -1 : 1) * area_normal(mesh, mesh.triangles[i]).norm();
  int reversed = 0;
  for (std::size_t i = 0; i < turned.size(); ++i) {
    if (turned[i] == (kept_area[components.of_triangle[i]] < 0)) continue;
    std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
    ++reversed;
  }
  return reversed;
}

// ---- Taking sheets apart.

using CornerPair = std::pair<std::uint32_t, std::uint32_t>;

/// Edge of several triangles, and the corners that the triangles' own edges start at.
struct SharedEdge {
  std::span<const std::uint32_t> corners;
  std::vector<CornerPair> pairs;  ///< pairs of triangles that stay together: edges of opposite direction
};

/// Pairs the triangles at an edge that continue each other best: flattest first; among equals the pair that forms a
/// convex edge, so that two solids that touch there stay two.
std::vector<CornerPair> pair_sheets(const TriangleMesh& mesh, std::span<const std::uint32_t> sides) {
  constexpr std::size_t most = 64;  // larger fans are no surface, and have too many pairs
  if (sides.size() > most) return {};
  struct Candidate {
    long bend;  ///< rounded, so that equal bends compare equal
    bool concave;
    CornerPair pair;
    auto order() const { return std::tie(bend, concave, pair); }
  };
  const auto unit_normal = [&](std::uint32_t corner) {
    return area_normal(mesh, mesh.triangles[corner / 3]).normalized().eval();
  };
  std::vector<Candidate> candidates;
  for (auto i = sides.begin(); i != sides.end(); ++i)
    for (auto j = i + 1; j != sides.end(); ++j) {
      if (!run_opposite(mesh.triangles, *i, *j)) continue;
      const std::uint32_t from = vertex_at(mesh.triangles, *i);
      const Eigen::Vector3d normal = unit_normal(*i);
      const std::uint32_t apex = vertex_at(mesh.triangles, next_corner(next_corner(*j)));
      const double height = normal.dot((mesh.positions[apex] - mesh.positions[from]).cast<double>());
      candidates.push_back({-std::lround(100 * normal.dot(unit_normal(*j))), height > 0, {*i, *j}});
    }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.order() < b.order(); });
  std::vector<CornerPair> pairs;
  std::vector<std::uint32_t> taken;
  const auto is_taken = [&](std::uint32_t c) { return std::find(taken.begin(), taken.end(), c) != taken.end(); };
  for (const Candidate& candidate : candidates) {
    if (is_taken(candidate.pair.first) || is_taken(candidate.pair.second)) continue;
    pairs.push_back(candidate.pair);
    taken.insert(taken.end(), {candidate.pair.first, candidate.pair.second});
  }
  return pairs;
}

/// Edges of two or more triangles, by what joins there.
struct SheetEdges {
  std::vector<CornerPair> plain;      ///< pairs at edges of two triangles
  std::vector<SharedEdge> contested;  ///< edges of more triangles
  std::vector<bool> at_cut;           ///< for each vertex, whether triangles come apart at an edge of it
};

/// Finds the triangles at each edge, and which of them stay together. Counts the edges where some come apart.
SheetEdges find_sheet_edges(const TriangleMesh& mesh, const TriangleEdges& edges, MeshRepairs& repairs) {
  const std::span<const Triangle> triangles = mesh.triangles;
  SheetEdges found;
  found.at_cut.resize(mesh.positions.size(), false);
  edges.for_each([&](std::span<const std::uint32_t> sides) {
    if (sides.size() == 1) return;
    if (sides.size() == 2 && run_opposite(triangles, sides[0], sides[1])) {
      found.plain.emplace_back(sides[0], sides[1]);
      return;
    }
    const auto [low, high] = edge_at(triangles, sides[0]);
    found.at_cut[low] = found.at_cut[high] = true;
    if (sides.size() == 2) {
      ++repairs.unorientable_edges;
    } else {
      ++repairs.nonmanifold_edges;
      found.contested.push_back({sides, pair_sheets(mesh, sides)});
    }
  });
  return found;
}

/// Groups the corners that are connected across pairs; returns the group of each. A fan that comes back to a contested
/// edge would put too many triangles on it: no pairs stay together there.
std::vector<std::uint32_t> connect_corners(SheetEdges& edges, std::uint32_t corners) {
  std::vector<std::uint32_t> group;
  for (bool again = true; again;) {
    DisjointSets sets(corners);
    const auto join = [&](const CornerPair& pair) {
      sets.join(pair.first, next_corner(pair.second));
      sets.join(next_corner(pair.first), pair.second);
    };
    for (const CornerPair& pair : edges.plain) join(pair);
    for (const SharedEdge& edge : edges.contested)
      for (const CornerPair& pair : edge.pairs) join(pair);
    group = sets.roots();
    again = false;
    for (SharedEdge& edge : edges.contested) {
      std::vector<std::pair<std::uint32_t, std::uint32_t>> directed;
      for (const std::uint32_t corner : edge.corners) directed.emplace_back(group[corner], group[next_corner(corner)]);
      std::sort(directed.begin(), directed.end());
      if (edge.pairs.empty() || std::adjacent_find(directed.begin(), directed.end()) == directed.end()) continue;
      edge.pairs.clear();
      again = true;
    }
  }
  return group;
}

/// Gives every fan of connected triangles a vertex of its own: the first group of a vertex keeps it, the others get
/// copies.
void split_sheets(TriangleMesh& mesh, MeshRepairs& repairs) {
  const auto corners = static_cast<std::uint32_t>(3 * mesh.triangles.size());
  const TriangleEdges all_edges(mesh.triangles);
  SheetEdges edges = find_sheet_edges(mesh, all_edges, repairs);
  const std::vector<std::uint32_t> group = connect_corners(edges, corners);
  std::vector<std::uint32_t> vertex_of_group(corners, none_yet), kept_by(mesh.positions.size(), none_yet);
  std::vector<bool> was_split(mesh.positions.size(), false);
  for (std::uint32_t corner = 0; corner < corners; ++corner) {
    std::uint32_t& vertex = mesh.triangles[corner / 3][corner % 3];
    std::uint32_t& assigned = vertex_of_group[group[corner]];
    if (assigned == none_yet && kept_by[vertex] == none_yet) {
      kept_by[vertex] = group[corner];
      assigned = vertex;
    } else if (assigned == none_yet) {
      assigned = static_cast<std::uint32_t>(mesh.positions.size());
      mesh.positions.push_back(mesh.positions[vertex]);
      if (!mesh.colors.empty()) mesh.colors.push_back(mesh.colors[vertex]);
      if (!was_split[vertex] && !edges.at_cut[vertex]) ++repairs.nonmanifold_vertices;
      was_split[vertex] = true;
    }
    vertex = assigned;
  }
}

/// Restores a manifold after triangles were removed or added: drops edges that now appear twice, and splits fans that
/// came apart.
void make_manifold_again(TriangleMesh& mesh, TriangleOrigins& origins, bool keeps_backs) {
  MeshRepairs own;
  drop_duplicates(mesh, origins, keeps_backs, own);
  if (!is_manifold(mesh)) split_sheets(mesh, own);
}

}  // namespace

const std::array<std::pair<const char*, int MeshRepairs::*>, 14>& MeshRepairs::kinds() {
  static const std::array<std::pair<const char*, int MeshRepairs::*>, 14> all = {
      {{"merged_vertices", &MeshRepairs::merged_vertices},
       {"welded_vertices", &MeshRepairs::welded_vertices},
       {"unused_vertices", &MeshRepairs::unused_vertices},
       {"triangulated_polygons", &MeshRepairs::triangulated_polygons},
       {"degenerate_triangles", &MeshRepairs::degenerate_triangles},
       {"duplicate_triangles", &MeshRepairs::duplicate_triangles},
       {"dropped_backs", &MeshRepairs::dropped_backs},
       {"reversed_triangles", &MeshRepairs::reversed_triangles},
       {"nonmanifold_edges", &MeshRepairs::nonmanifold_edges},
       {"nonmanifold_vertices", &MeshRepairs::nonmanifold_vertices},
       {"unorientable_edges", &MeshRepairs::unorientable_edges},
       {"inside_out_components", &MeshRepairs::inside_out_components},
       {"clamped_colors", &MeshRepairs::clamped_colors},
       {"filled_holes", &MeshRepairs::filled_holes}}};
  return all;
}

bool MeshRepairs::is_clean() const {
  return std::all_of(kinds().begin(), kinds().end(), [&](const auto& kind) {
    return kind.second == &MeshRepairs::filled_holes || this->*kind.second == 0;
  });
}

std::string MeshRepairs::text() const {
  std::string words;
  for (const auto& [name, count] : kinds()) {
    if (this->*count == 0) continue;
    std::string plain = name;
    std::replace(plain.begin(), plain.end(), '_', ' ');
    words += (words.empty() ? "" : ", ") + std::to_string(this->*count) + " " + plain;
  }
  return words;
}

MeshRepairs repair_mesh(TriangleMesh& mesh, const MeshRepairSettings& settings, TriangleOrigins* origins_out) {
  MeshRepairs repairs;
  mesh.normals.clear();
  mesh.corner_normals.clear();
  mesh.uvs.clear();
  TriangleOrigins origins(mesh.triangles.size());
  std::iota(origins.begin(), origins.end(), 0u);

  // Repair vertices and triangles one by one.
  repairs.merged_vertices = merge_vertices(mesh);
  repairs.unused_vertices = drop_unused(mesh) - repairs.merged_vertices;
  drop_duplicates(mesh, origins, settings.keeps_backs, repairs);

  // Repair the surface that they form.
  if (!is_manifold(mesh)) {
    repairs.reversed_triangles = orient(mesh);
    split_sheets(mesh, repairs);
  }
  if (std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) { return is_flat(mesh, t); })) {
    repairs.degenerate_triangles += remove_flat_triangles(mesh, origins);
    make_manifold_again(mesh, origins, settings.keeps_backs);
  }
  repairs.border_loops = count_border_loops(mesh);
  if (settings.fill_hole_edges > 0 && repairs.border_loops > 0) {
    repairs.filled_holes = fill_holes(mesh, origins, settings.fill_hole_edges);
    make_manifold_again(mesh, origins, settings.keeps_backs);
    repairs.border_loops = count_border_loops(mesh);
  }
  drop_unused(mesh);
  if (settings.keeps_orientation)
    repairs.components = static_cast<int>(find_components(mesh).count);
  else
    repairs.inside_out_components = turn_inside_out_components(mesh, repairs.components);
  if (origins_out != nullptr) *origins_out = std::move(origins);
  return repairs;
}

bool is_manifold(const TriangleMesh& mesh) {
  // Triangles at each vertex, as the vertices after and before it.
  struct Wedge {
    std::uint32_t after, before;
    bool operator<(const Wedge& other) const { return after < other.after; }
  };
  std::vector<std::uint32_t> begin(mesh.positions.size() + 1, 0);
  for (const Triangle& triangle : mesh.triangles) {
    if (repeats_vertex(triangle)) return false;
    for (const std::uint32_t vertex : triangle) ++begin[vertex + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Wedge> wedges(begin.back());
  std::vector<std::uint32_t> filled(begin.begin(), begin.end() - 1);
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) wedges[filled[t[k]]++] = {t[(k + 1) % 3], t[(k + 2) % 3]};

  for (std::size_t vertex = 0; vertex + 1 < begin.size(); ++vertex) {
    const auto first = wedges.begin() + begin[vertex], last = wedges.begin() + begin[vertex + 1];
    if (first == last) continue;
    std::sort(first, last);
    if (std::adjacent_find(first, last, [](const Wedge& a, const Wedge& b) { return a.after == b.after; }) != last)
      return false;
    const auto starting_at = [&](std::uint32_t neighbour) {
      const auto found = std::lower_bound(first, last, Wedge{neighbour, 0});
      return found != last && found->after == neighbour ? found : last;
    };
    // Check that there is one fan: from the wedge that nothing precedes, or from any in a closed fan, all others are
    // reached.
    std::vector<bool> is_followed(static_cast<std::size_t>(last - first), false);
    for (auto wedge = first; wedge != last; ++wedge) {
      const auto following = starting_at(wedge->before);
      if (following == last) continue;
      if (is_followed[static_cast<std::size_t>(following - first)]) return false;  // two wedges precede it
      is_followed[static_cast<std::size_t>(following - first)] = true;
    }
    const auto start = first + (std::find(is_followed.begin(), is_followed.end(), false) - is_followed.begin());
    std::ptrdiff_t reached = 1;
    const auto head = start == last ? first : start;
    for (auto wedge = starting_at(head->before); wedge != last && wedge != head; wedge = starting_at(wedge->before))
      ++reached;
    if (reached != last - first) return false;
  }
  return true;
}

}  // namespace kiln
