#include "simplify/collapse.h"

// clang-format off: CGAL's policies use names that the adapter's headers must have declared first.
#include "mesh/openmesh_adapter.h"
// clang-format on
#include <CGAL/Surface_mesh_simplification/Edge_collapse_visitor_base.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_probabilistic_triangle_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/property_map.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mesh/nearest_surface.h"

namespace kiln {

namespace {

namespace SMS = CGAL::Surface_mesh_simplification;
using Point = HalfedgeKernel::Point_3;
using Vector = HalfedgeKernel::Vector_3;
using Vertex = HalfedgeMesh::VertexHandle;
using Profile = SMS::Edge_profile<HalfedgeMesh, HalfedgePositions, HalfedgeKernel>;
using Placement = boost::optional<Point>;

/// Collapses are computed in a frame where the bounding box is centred on the origin with a diagonal of 1: quadrics of
/// far away or tiny objects lose their digits, and tolerances get a meaning.
struct Frame {
  Eigen::Vector3d centre;
  double diagonal;

  explicit Frame(const TriangleMesh& mesh) {
    const BoundingBox box = bounding_box(mesh);
    centre = box.centre().cast<double>();
    diagonal = (box.highest - box.lowest).cast<double>().norm();
  }
  Eigen::Vector3d to_object(const Point& p) const { return centre + diagonal * Eigen::Vector3d(p.x(), p.y(), p.z()); }
  HalfedgeMesh::Point from_object(const HalfedgeMesh::Point& p) const {
    return (p - HalfedgeMesh::Point(centre.x(), centre.y(), centre.z())) / diagonal;
  }
};

/// How far from the surface that it stands for a triangle may be, and how slender. Neither cost forbids a few needles
/// that cut through the surface; refusing them makes the largest error half as large, at the same mean. Where the
/// limits leave nothing to collapse, the next pass has wider ones.
struct Limits {
  double distance;     ///< from a triangle's middle to the input's surface, in edges of a triangle of mean area
  double slenderness;  ///< height over the longest edge; a triangle that was worse may stay as bad
  double border;       ///< farthest that a vertex of the input's border may be from it, in the same edges
  double facing;       ///< smallest cosine between a triangle's normal and that of the input where it is nearest
};
constexpr double unlimited = 1e30;
constexpr Limits passes[] = {{0.15, 0.05, 0.05, 0.1}, {0.15, 0.05, 0.15, 0.1},      {0.3, 0.02, 0.3, 0.1},
                             {0.6, 0, 0.6, 0},        {unlimited, 0, unlimited, 0}, {unlimited, 0, unlimited, -1}};

/// A collapse may turn a triangle by 78 degrees at most: far from folding it over, and what it takes to cut a corner.
constexpr double smallest_turn_cosine = 0.2;

/// Positions in the file are rounded by half of 1/65,535 of the box's longest side in each axis, in the worst case
/// sqrt(3) / 2 of that in one direction. A triangle whose heights are this many steps keeps its winding whatever is
/// rounded.
constexpr double smallest_height_steps = 4;
constexpr double smallest_height = smallest_height_steps / 65535;  // of the diagonal, which is longer than any side

/// What is noted and known while CGAL collapses; its policies are copied, so they refer to it.
struct State {
  std::vector<Collapse>& collapses;
  const Frame& frame;
  const NearestSurface& input;
  const ProgressFunction& progress;
  double area;  ///< of the input, in the frame
  int start_faces;
  int target_faces;
  int faces;
  std::vector<std::vector<Point>> border_points;  ///< by vertex on the border: those of the border that became it
  Limits limits = passes[0];
  int events = 0;

  /// Collecting the edges takes about a fifth of the time.
  void report(double fraction) {
    if (++events % 1024 == 0) progress(fraction);
  }
  /// The edge of an equilateral triangle of mean area, in the frame.
  double mean_edge() const { return std::sqrt(area / faces * 4 / std::sqrt(3.0)); }
};

Vector normal_of(const Point& a, const Point& b, const Point& c) { return CGAL::cross_product(b - a, c - a); }

double longest_squared_edge(const Point& a, const Point& b, const Point& c) {
  return std::max({CGAL::squared_distance(a, b), CGAL::squared_distance(b, c), CGAL::squared_distance(c, a)});
}

/// Refuses a collapse where one of the triangles that it moves would fold over, or exceed the limits.
struct KeepsTriangles {
  const State* state;

  Placement operator()(const Profile& profile, const Placement& placement) const {
    if (!placement || !is_close(*placement) || !keeps_border(profile, *placement)) return {};
    const auto& triangles = profile.triangles();
    const std::size_t vanishing = std::size_t{profile.left_face_exists()} + std::size_t{profile.right_face_exists()};
    for (std::size_t i = vanishing; i < triangles.size(); ++i) {
      const auto point = [&](Vertex vertex) { return get(profile.vertex_point_map(), vertex); };
      // The second corner is the one that moves.
      const Point a = point(triangles[i].v0), b = point(triangles[i].v1), c = point(triangles[i].v2);
      if (!keeps_shape(a, b, *placement, c) || !keeps_place(a, *placement, c)) return {};
    }
    return placement;
  }

 private:
  /// Triangle a, b, c against a, moved, c.
  bool keeps_shape(const Point& a, const Point& b, const Point& moved, const Point& c) const {
    const Vector before = normal_of(a, b, c), after = normal_of(a, moved, c);
    const double before_squared = before.squared_length(), after_squared = after.squared_length();
    const double cosine_part = before * after;
    const double smallest = smallest_turn_cosine * smallest_turn_cosine * before_squared * after_squared;
    if (!(cosine_part > 0) || cosine_part * cosine_part < smallest) return false;

    // A scan's triangles may be thinner from the start; then it is enough not to get worse.
    const double before_edge = longest_squared_edge(a, b, c), after_edge = longest_squared_edge(a, moved, c);
    const double before_height = before_squared / before_edge, after_height = after_squared / after_edge;
    if (after_height < std::min(smallest_height * smallest_height, before_height)) return false;
    const double slenderness = state->limits.slenderness;
    return after_height / after_edge >= std::min(slenderness * slenderness, before_height / before_edge);
  }

  /// Whether the vertices that the border once had stay close to it, from the edge before the one that is collapsed to
  /// the edge after it.
  bool keeps_border(const Profile& profile, const Point& placement) const {
    if (!profile.is_v0_v1_a_border() && !profile.is_v1_v0_a_border()) return true;
    const HalfedgeMesh& mesh = profile.surface_mesh();
    const HalfedgeMesh::HalfedgeHandle edge = profile.is_v0_v1_a_border() ? profile.v0_v1() : profile.v1_v0();
    const HalfedgeMesh::HalfedgeHandle before = mesh.prev_halfedge_handle(edge),
                                       after = mesh.next_halfedge_handle(edge);
    const std::array<Vertex, 4> corners = {mesh.from_vertex_handle(before), mesh.from_vertex_handle(edge),
                                           mesh.to_vertex_handle(edge), mesh.to_vertex_handle(after)};
    const auto point = [&](Vertex vertex) { return get(profile.vertex_point_map(), vertex); };
    const std::array<Point, 5> now = {point(mesh.from_vertex_handle(mesh.prev_halfedge_handle(before))),
                                      point(corners[0]), placement, point(corners[3]),
                                      point(mesh.to_vertex_handle(mesh.next_halfedge_handle(after)))};
    const double limit = std::pow(state->limits.border * state->mean_edge(), 2);
    const auto is_kept = [&](const Point& once) {
      for (std::size_t i = 0; i + 1 < now.size(); ++i)
        if (CGAL::squared_distance(once, HalfedgeKernel::Segment_3(now[i], now[i + 1])) <= limit) return true;
      return false;
    };
    if (!is_kept(profile.p0()) || !is_kept(profile.p1())) return false;
    return std::all_of(corners.begin(), corners.end(), [&](Vertex corner) {
      const std::vector<Point>& points = state->border_points[corner.idx()];
      return std::all_of(points.begin(), points.end(), is_kept);
    });
  }

  /// Triangle a, b, c against the input.
  bool keeps_place(const Point& a, const Point& b, const Point& c) const {
    const Point middle = CGAL::centroid(a, b, c);
    const NearestSurface::Hit hit = state->input.nearest(state->frame.to_object(middle));
    const Vector normal = normal_of(a, b, c);
    const double cosine =
        state->input.normal(hit).dot(Eigen::Vector3d(normal.x(), normal.y(), normal.z()).normalized());
    if (cosine < state->limits.facing) return false;
    return is_close(middle, hit);
  }

  bool is_close(const Point& point) const {
    return is_close(point, state->input.nearest(state->frame.to_object(point)));
  }
  bool is_close(const Point& point, const NearestSurface::Hit& hit) const {
    const double distance = (state->frame.to_object(point) - hit.point).norm() / state->frame.diagonal;
    return distance <= state->limits.distance * state->mean_edge();
  }
};

/// Placement by `Policy`, except that borders stay where they are and that wild solutions of ill-conditioned systems
/// are replaced by the best point of the edge.
template <class GetPlacement, class GetCost>
struct TamePlacement {
  GetPlacement get_placement;
  GetCost get_cost;

  Placement operator()(const Profile& profile) const {
    const HalfedgeMesh& mesh = profile.surface_mesh();
    const bool on_border = profile.is_v0_v1_a_border() || profile.is_v1_v0_a_border();
    if (!on_border && !profile.border_edges().empty()) {
      // An edge that leads from the border inwards: its end on the border stays.
      if (mesh.is_boundary(profile.v0())) return profile.p0();
      if (mesh.is_boundary(profile.v1())) return profile.p1();
    }
    const Placement placement = get_placement(profile);
    if (placement && is_near(profile, *placement)) return placement;
    return best_on_edge(profile);
  }

 private:
  /// Within twice the radius of the neighbourhood; a NaN is near nothing.
  static bool is_near(const Profile& profile, const Point& placement) {
    const Point middle = CGAL::midpoint(profile.p0(), profile.p1());
    double radius_squared = 0;
    for (Vertex vertex : profile.link())
      radius_squared =
          std::max(radius_squared, CGAL::squared_distance(middle, get(profile.vertex_point_map(), vertex)));
    return CGAL::squared_distance(middle, placement) < 4 * radius_squared;
  }

  Placement best_on_edge(const Profile& profile) const {
    Placement best;
    double best_cost = std::numeric_limits<double>::infinity();
    for (const Point& candidate : {profile.p0(), profile.p1(), CGAL::midpoint(profile.p0(), profile.p1())}) {
      const boost::optional<double> cost = get_cost(profile, Placement(candidate));
      if (cost && *cost < best_cost) {
        best = candidate;
        best_cost = *cost;
      }
    }
    return best;
  }
};

struct EnoughCollapsed {
  State* state;
  template <class... Ignored>
  bool operator()(const Ignored&...) const {
    return state->faces <= state->target_faces;
  }
};

struct LoggingVisitor : SMS::Edge_collapse_visitor_base<HalfedgeMesh, HalfedgePositions, HalfedgeKernel> {
  using Profile = kiln::Profile;
  State* state;
  explicit LoggingVisitor(State* noted) : state(noted) {}

  template <class Cost>
  void OnCollected(const Profile&, const Cost&) const {
    state->report(0.2 * std::min(1.0, state->events / (1.5 * state->start_faces)));
  }
  template <class Cost, class Size>
  void OnSelected(const Profile&, const Cost&, Size, Size) const {
    state->report(0.2 +
                  0.8 * (state->start_faces - state->faces) / std::max(1, state->start_faces - state->target_faces));
  }
  void OnCollapsed(const Profile& profile, Vertex kept) const {
    note_border(profile, kept);
    state->faces -= int{profile.left_face_exists()} + int{profile.right_face_exists()};
    const Vertex removed = kept == profile.v0() ? profile.v1() : profile.v0();
    state->collapses.push_back({static_cast<std::uint32_t>(removed.idx()), static_cast<std::uint32_t>(kept.idx()),
                                state->faces,
                                state->frame.to_object(get(profile.vertex_point_map(), kept)).cast<float>()});
  }

 private:
  void note_border(const Profile& profile, Vertex kept) const {
    std::vector<Point>& points = state->border_points[kept.idx()];
    std::vector<Point>& removed = state->border_points[(kept == profile.v0() ? profile.v1() : profile.v0()).idx()];
    points.insert(points.end(), removed.begin(), removed.end());
    removed.clear();
    if (profile.is_v0_v1_a_border() || profile.is_v1_v0_a_border()) {
      points.push_back(profile.p0());
      points.push_back(profile.p1());
    }
  }
};

template <class GetCost, class GetPlacement>
void run(HalfedgeMesh& mesh, State& state, const GetCost& get_cost, const GetPlacement& get_placement) {
  SMS::edge_collapse(mesh, EnoughCollapsed{&state},
                     CGAL::parameters::vertex_point_map(HalfedgePositions{&mesh})
                         .geom_traits(HalfedgeKernel())
                         .get_cost(get_cost)
                         .get_placement(TamePlacement<GetPlacement, GetCost>{get_placement, get_cost})
                         .filter(KeepsTriangles{&state})
                         .visitor(LoggingVisitor(&state)));
}

struct MeanSizes {
  double edge = 0;
  double squared_double_area = 0;
};

MeanSizes mean_sizes(const HalfedgeMesh& mesh) {
  MeanSizes mean;
  for (const auto edge : mesh.edges()) mean.edge += mesh.calc_edge_length(edge);
  for (const auto face : mesh.faces()) mean.squared_double_area += 4 * std::pow(mesh.calc_face_area(face), 2);
  mean.edge /= static_cast<double>(mesh.n_edges());
  mean.squared_double_area /= static_cast<double>(mesh.n_faces());
  return mean;
}

void run(HalfedgeMesh& mesh, State& state, CollapseCost cost) {
  using LindstromTurkCost = SMS::LindstromTurk_cost<HalfedgeMesh>;
  using LindstromTurkPlacement = SMS::LindstromTurk_placement<HalfedgeMesh>;
  using PlanePolicies = SMS::GarlandHeckbert_plane_policies<HalfedgeMesh, HalfedgeKernel>;
  using TrianglePolicies = SMS::GarlandHeckbert_probabilistic_triangle_policies<HalfedgeMesh, HalfedgeKernel>;
  constexpr double border_weight = 100;  // CGAL's: of a border edge's plane against a face's
  switch (cost) {
    case CollapseCost::lindstrom_turk:
      return run(mesh, state, LindstromTurkCost(), LindstromTurkPlacement());
    case CollapseCost::plane: {
      const PlanePolicies policies(mesh, border_weight);
      return run(mesh, state, policies.get_cost(), policies.get_placement());
    }
    case CollapseCost::probabilistic_triangle: {
      // A triangle's quadric carries the square of twice its area, a border edge's does not. The corners' standard
      // deviation is 1 % of an edge: the paper's 5 % rounds a cube's corners off.
      const MeanSizes mean = mean_sizes(mesh);
      const double variance = std::pow(0.01 * mean.edge, 2);
      const CGAL::Constant_property_map<HalfedgeMesh::FaceHandle, double> variances(variance);
      const TrianglePolicies policies(mesh, border_weight * mean.squared_double_area, variances);
      return run(mesh, state, policies.get_cost(), policies.get_placement());
    }
  }
}

}  // namespace

// The vertices and triangles that are left keep their order.
TriangleMesh CollapseSequence::after(std::size_t count) const {
  std::vector<Eigen::Vector3f> positions = start.positions;
  std::vector<std::uint32_t> became(positions.size());
  for (std::uint32_t i = 0; i < became.size(); ++i) became[i] = i;
  for (std::size_t i = 0; i < count; ++i) {
    became[collapses[i].removed] = collapses[i].kept;
    positions[collapses[i].kept] = collapses[i].position;
  }
  // A vertex may have gone through several others.
  const auto now = [&](std::uint32_t vertex) {
    std::uint32_t last = vertex;
    while (became[last] != last) last = became[last];
    while (became[vertex] != last) vertex = std::exchange(became[vertex], last);
    return last;
  };
  TriangleMesh mesh;
  std::vector<std::uint32_t> new_index(positions.size(), 0);
  for (const Triangle& triangle : start.triangles) {
    const Triangle left = {now(triangle[0]), now(triangle[1]), now(triangle[2])};
    if (left[0] == left[1] || left[1] == left[2] || left[2] == left[0]) continue;
    for (std::uint32_t vertex : left) new_index[vertex] = 1;
    mesh.triangles.push_back(left);
  }
  for (std::uint32_t i = 0; i < new_index.size(); ++i) {
    if (new_index[i] == 0) continue;
    new_index[i] = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(positions[i]);
  }
  for (Triangle& triangle : mesh.triangles)
    for (std::uint32_t& vertex : triangle) vertex = new_index[vertex];
  return mesh;
}

CollapseSequence collapse_edges(TriangleMesh mesh, CollapseCost cost, int faces, const ProgressFunction& progress) {
  CollapseSequence sequence;
  sequence.start = std::move(mesh);
  const int start_faces = static_cast<int>(sequence.start.triangles.size());
  if (start_faces <= faces) return sequence;
  const Frame frame(sequence.start);
  HalfedgeMesh halfedges = to_halfedges(sequence.start);
  for (const auto vertex : halfedges.vertices())
    halfedges.set_point(vertex, frame.from_object(halfedges.point(vertex)));
  const NearestSurface input(sequence.start);
  const double area = surface_area(sequence.start) / (frame.diagonal * frame.diagonal);
  State state{sequence.collapses, frame, input, progress, area, start_faces, faces, start_faces, {}};
  state.border_points.resize(halfedges.n_vertices());
  for (const Limits& limits : passes) {
    state.limits = limits;
    if (state.faces > faces) run(halfedges, state, cost);
  }
  return sequence;
}

}  // namespace kiln
