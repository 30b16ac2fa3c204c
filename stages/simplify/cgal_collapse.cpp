// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's loop is instantiated once, whatever the cost: CostPolicy stands between them.
#include "simplify/cgal_collapse.h"

// clang-format off
#include "simplify/halfedge_mesh.h"  // the graph traits, before CGAL's algorithms
// clang-format on

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_probabilistic_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_probabilistic_triangle_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_triangle_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "simplify/cgal_envelope.h"
#include "simplify/feature_graph.h"
#include "simplify/lindstrom_turk.h"
#include "simplify/thinnest_heights.h"
#include "simplify/triangle_shape.h"
#include "simplify/unit_frame.h"
#include "simplify/vertex_weight.h"

namespace kiln {

namespace {

namespace SMS = CGAL::Surface_mesh_simplification;

using Vector = Eigen::Vector3d;
using Kernel = HalfedgeKernel;
using Point = Kernel::Point_3;
using Placement = boost::optional<Point>;
using Cost = boost::optional<double>;
using Profile = SMS::Edge_profile<HalfedgeMesh, HalfedgePositions, Kernel>;
using VertexHandle = HalfedgeMesh::VertexHandle;
using HalfedgeHandle = HalfedgeMesh::HalfedgeHandle;

std::uint32_t index_of(VertexHandle vertex) { return static_cast<std::uint32_t>(vertex.idx()); }
Vector to_vector(const Point& p) { return {p.x(), p.y(), p.z()}; }

// Section: costs.

/// Interface to one of CGAL's costs and the placement that goes with it.
class CostPolicy {
 public:
  virtual ~CostPolicy() = default;
  virtual Placement placement(const Profile& edge) const = 0;
  virtual Cost cost(const Profile& edge, const Placement& placement) const = 0;
  /// Prepares quadrics, those of the features among them.
  virtual void initialize(const HalfedgeMesh& mesh, const HalfedgePositions& positions,
                          std::span<const VertexPair> features) const = 0;
  virtual void update(const Profile& edge, VertexHandle kept) const = 0;
};

/// Placement and cost of [Lindstrom 1998] by CGAL, which keeps borders by itself; other features cost what they cost in
/// Kiln's own engine.
class LindstromTurkPolicy final : public CostPolicy {
 public:
  explicit LindstromTurkPolicy(const FeatureGraph& features) : features_(features) {}

  Placement placement(const Profile& edge) const override { return placement_(edge); }
  Cost cost(const Profile& edge, const Placement& placement) const override {
    const Cost cost = cost_(edge, placement);
    if (!cost || !placement) return cost;
    std::vector<FeatureEdge> near;
    for (const auto& [end, p] : {std::pair(edge.v0(), edge.p0()), std::pair(edge.v1(), edge.p1())})
      for (const std::uint32_t other : features_.neighbours(index_of(end))) {
        const VertexHandle handle(static_cast<int>(other));
        if (end == edge.v1() && handle == edge.v0()) continue;  // the edge itself counts once
        const HalfedgeHandle halfedge = edge.surface_mesh().find_halfedge(end, handle);
        if (!edge.surface_mesh().is_boundary(edge.surface_mesh().edge_handle(halfedge)))
          near.push_back({to_vector(p), to_vector(get(edge.vertex_point_map(), handle))});
      }
    const double squared_length = (to_vector(edge.p1()) - to_vector(edge.p0())).squaredNorm();
    return *cost + lindstrom_turk_cost({{}, near, squared_length}, to_vector(*placement));
  }
  void initialize(const HalfedgeMesh&, const HalfedgePositions&, std::span<const VertexPair>) const override {}
  void update(const Profile&, VertexHandle) const override {}

 private:
  const FeatureGraph& features_;
  SMS::LindstromTurk_cost<HalfedgeMesh> cost_;
  SMS::LindstromTurk_placement<HalfedgeMesh> placement_;
};

/// Weight of the planes that keep a border in place, beside those of triangles: CGAL's own default.
constexpr double border_weight = 100;

/// One of CGAL's kinds of quadrics. Its planes that keep borders in place are put along all features.
template <class Quadrics>
class QuadricPolicy final : public CostPolicy {
 public:
  template <class... Arguments>
  explicit QuadricPolicy(Arguments&&... arguments) : quadrics_(std::forward<Arguments>(arguments)...) {}

  Placement placement(const Profile& edge) const override { return quadrics_(edge); }
  Cost cost(const Profile& edge, const Placement& placement) const override { return quadrics_(edge, placement); }
  void initialize(const HalfedgeMesh& mesh, const HalfedgePositions& positions,
                  std::span<const VertexPair> features) const override {
    quadrics_.initialize(mesh, positions, Kernel());
    for (const auto& [a, b] : features) {
      const VertexHandle from(static_cast<int>(a)), to(static_cast<int>(b));
      const HalfedgeHandle halfedge = mesh.find_halfedge(from, to);
      if (mesh.is_boundary(mesh.edge_handle(halfedge))) continue;  // CGAL's own
      for (const HalfedgeHandle side : {halfedge, mesh.opposite_halfedge_handle(halfedge)}) {
        const auto quadric = (border_weight * quadrics_.construct_quadric(side, mesh, positions, Kernel())).eval();
        for (const VertexHandle end : {from, to})
          put(quadrics_.vcm(), end, (get(quadrics_.vcm(), end) + quadric).eval());
      }
    }
  }
  void update(const Profile& edge, VertexHandle kept) const override { quadrics_.update_after_collapse(edge, kept); }

 private:
  Quadrics quadrics_;
};

/// Returns the mean length of the edges, in the frame.
double mean_edge(const HalfedgeMesh& mesh) {
  double sum = 0;
  for (const auto edge : mesh.edges()) sum += mesh.calc_edge_length(edge);
  return sum / static_cast<double>(mesh.n_edges());
}

/// Share of a mean edge that CGAL supposes as the variance of probabilistic quadrics. Its own estimate
/// (internal::estimate_variances) is for its own mesh type alone.
constexpr double variance_unit = 0.05;

std::unique_ptr<CostPolicy> make_policy(CollapseCost cost, HalfedgeMesh& mesh, const FeatureGraph& features) {
  using Face = HalfedgeMesh::FaceHandle;
  switch (cost) {
    case CollapseCost::plane:
      return std::make_unique<QuadricPolicy<SMS::GarlandHeckbert_plane_policies<HalfedgeMesh, Kernel>>>(mesh);
    case CollapseCost::triangle:
      return std::make_unique<QuadricPolicy<SMS::GarlandHeckbert_triangle_policies<HalfedgeMesh, Kernel>>>(mesh);
    case CollapseCost::probabilistic_plane: {
      using Policies = SMS::GarlandHeckbert_probabilistic_plane_policies<HalfedgeMesh, Kernel>;
      const double variance = variance_unit * mean_edge(mesh);  // of normals; a tenth of it for positions
      const CGAL::Constant_property_map<Face, std::pair<double, double>> map({variance, 0.1 * variance});
      return std::make_unique<QuadricPolicy<Policies>>(mesh, border_weight, map);
    }
    case CollapseCost::probabilistic_triangle: {
      using Policies = SMS::GarlandHeckbert_probabilistic_triangle_policies<HalfedgeMesh, Kernel>;
      // CGAL has a length where a squared length is meant, which is right where the mean edge is 1: so it is here.
      const CGAL::Constant_property_map<Face, double> map(variance_unit * std::pow(mean_edge(mesh), 2));
      return std::make_unique<QuadricPolicy<Policies>>(mesh, border_weight, map);
    }
    case CollapseCost::lindstrom_turk:
      break;
  }
  return std::make_unique<LindstromTurkPolicy>(features);
}

// Section: the collapse.

/// State of one run, which CGAL's functors share by pointer, as CGAL copies them.
class CgalCollapser {
 public:
  CgalCollapser(CollapseSequence& sequence, std::span<const VertexPair> features, const CollapseSettings& settings,
                const CgalSettings& cgal, const ProgressFunction& progress)
      : sequence_(sequence),
        settings_(settings),
        progress_(progress),
        frame_(sequence.start),
        features_(sequence.start.positions.size(), features),
        feature_edges_(features),
        thinnest_(thinnest_heights(sequence.start, frame_.diagonal)),
        smallest_cosine_(std::cos(cgal.max_normal_change * std::numbers::pi / 180)),
        faces_(static_cast<int>(sequence.start.triangles.size())),
        start_faces_(faces_) {
    for (const double weight : settings.vertex_weights) weights_.push_back({weight, 1});
    std::vector<Vector> positions;
    for (const Eigen::Vector3f& p : sequence.start.positions) positions.push_back(frame_.from_object(p));
    mesh_ = to_halfedges(positions, sequence.start.triangles);
    policy_ = make_policy(cgal.cost, mesh_, features_);
    if (cgal.envelope > 0) envelope_.emplace(sequence.start, frame_, cgal.envelope - rounding_of_file(sequence.start));
    hints_.resize(positions.size(), 0);
  }
  CgalCollapser(const CgalCollapser&) = delete;  // the functors point here

  void run() {
    SMS::edge_collapse(mesh_, Stop{this},
                       CGAL::parameters::vertex_point_map(HalfedgePositions{&mesh_})
                           .get_cost(GetCost{this})
                           .get_placement(GetPlacement{this})
                           .filter(Filter{this})
                           .visitor(Visitor{this}));
  }

 private:
  struct Stop {
    const CgalCollapser* run;
    bool operator()(double, const Profile&, std::size_t, std::size_t) const {
      return run->faces_ <= run->settings_.faces;
    }
  };
  struct GetCost {
    using Update_tag = CGAL::Tag_true;  ///< has CGAL call the two functions below
    const CgalCollapser* run;
    Cost operator()(const Profile& edge, const Placement& placement) const { return run->cost(edge, placement); }
    void initialize(const HalfedgeMesh& mesh, const HalfedgePositions& positions, const Kernel&) const {
      run->policy_->initialize(mesh, positions, run->feature_edges_);
    }
    void update_after_collapse(const Profile& edge, VertexHandle kept) const { run->policy_->update(edge, kept); }
  };
  struct GetPlacement {
    const CgalCollapser* run;
    Placement operator()(const Profile& edge) const { return run->placement(edge); }
  };
  struct Filter {
    CgalCollapser* run;
    Placement operator()(const Profile& edge, const Placement& placement) const {
      return run->is_allowed(edge, placement) ? placement : Placement();
    }
  };
  struct Visitor : SMS::internal::Dummy_visitor {
    explicit Visitor(CgalCollapser* state) : run(state) {}
    CgalCollapser* run;
    void OnCollapsed(const Profile& edge, VertexHandle kept) const { run->note(edge, kept); }
  };

  /// Returns where the edge's vertex goes: to a feature where one end is on it, to an end or branch of features, else
  /// where CGAL has it. Nothing where that would join features, or shorten one that ends.
  Placement placement(const Profile& edge) const {
    const std::uint32_t a = index_of(edge.v0()), b = index_of(edge.v1());
    const std::size_t at_a = features_.neighbours(a).size(), at_b = features_.neighbours(b).size();
    if (at_a > 0 && at_b > 0) {
      if ((at_a != 2 && at_b != 2) || !features_.contains(a, b)) return {};
      for (const VertexHandle opposite : {edge.vL(), edge.vR()})
        if (opposite.is_valid() && features_.contains(a, index_of(opposite)) &&
            features_.contains(b, index_of(opposite)))
          return {};
    }
    if (at_a > 0 && (at_b == 0 || at_a != 2)) return edge.p0();
    if (at_b > 0 && (at_a == 0 || at_b != 2)) return edge.p1();
    const Placement placement = policy_->placement(edge);
    if (placement && !(to_vector(*placement).allFinite())) return {};
    return placement;
  }

  Cost cost(const Profile& edge, const Placement& placement) const {
    const Cost cost = policy_->cost(edge, placement);
    if (!cost || weights_.empty()) return cost;
    return 0.5 * (weights_[index_of(edge.v0())].mean() + weights_[index_of(edge.v1())].mean()) * *cost;
  }

  /// Calls visit(before, after, triangle) for each triangle that stays, with its corners; false stops.
  template <class Visit>
  bool for_each_moved(const Profile& edge, const Point& position, const Visit& visit) const {
    const auto on_edge = static_cast<std::size_t>(edge.left_face_exists()) + edge.right_face_exists();
    const auto& triangles = edge.triangles();  // those on the edge come first; v1 of the others is the end that moves
    for (std::size_t i = on_edge; i < triangles.size(); ++i) {
      const auto at = [&](VertexHandle vertex) { return get(edge.vertex_point_map(), vertex); };
      const Point p = at(triangles[i].v0), q = at(triangles[i].v1), r = at(triangles[i].v2);
      if (!visit(std::array{p, q, r}, std::array{p, position, r}, triangles[i])) return false;
    }
    return true;
  }

  bool is_allowed(const Profile& edge, const Placement& placement) {
    if (!SMS::Bounded_normal_change_filter<>()(edge, placement)) return false;
    const auto keeps_shape = [&](const auto& before, const auto& after, const auto& triangle) {
      const TriangleShape was(to_vector(before[0]), to_vector(before[1]), to_vector(before[2]));
      const TriangleShape is(to_vector(after[0]), to_vector(after[1]), to_vector(after[2]));
      const ShapeLimits limits{0, thinnest_[index_of(triangle.v1)]};
      if (is_thin(is, limits) && !is_thin(was, limits)) return false;
      return was.normal.dot(is.normal) >= smallest_cosine_ * was.normal.norm() * is.normal.norm();
    };
    if (!for_each_moved(edge, *placement, keeps_shape)) return false;
    return !envelope_ || is_in_envelope(edge, *placement);
  }

  /// Tells whether the triangles that a collapse moves stay in the envelope. As CGAL's Polyhedral_envelope_filter, but
  /// without the triangle that closes the ring of neighbours at a border, where there is none. CGAL asks for an edge
  /// again whenever something changed two edges away, so refusals are remembered until something changed here.
  bool is_in_envelope(const Profile& edge, const Point& position) {
    std::uint64_t surroundings = 0;
    const auto add = [&](const Point& p) {
      for (const double x : {p.x(), p.y(), p.z()})
        surroundings = (surroundings ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u ^ surroundings >> 29;
    };
    for_each_moved(edge, position, [&](const auto&, const auto& after, const auto&) {
      for (const Point& corner : after) add(corner);
      return true;
    });
    const int key = edge.surface_mesh().edge_handle(edge.v0_v1()).idx();
    const auto known = refused_.find(key);
    if (known != refused_.end() && known->second == surroundings) return false;
    const bool is_inside = for_each_moved(edge, position, [&](const auto&, const auto& after, const auto& triangle) {
      return envelope_->contains({to_vector(after[0]), to_vector(after[1]), to_vector(after[2])},
                                 hints_[index_of(triangle.v1)]);
    });
    if (is_inside) return true;
    refused_[key] = surroundings;
    sequence_.met_envelope = true;
    return false;
  }

  /// Notes a collapse that CGAL has done.
  void note(const Profile& edge, VertexHandle kept_vertex) {
    const std::uint32_t kept = index_of(kept_vertex);
    const std::uint32_t removed = index_of(kept_vertex == edge.v0() ? edge.v1() : edge.v0());
    faces_ -= int{edge.left_face_exists()} + int{edge.right_face_exists()};
    features_.collapse(removed, kept);
    if (!weights_.empty()) weights_[kept] += weights_[removed];
    const Vector position = to_vector(get(edge.vertex_point_map(), kept_vertex));
    sequence_.collapses.push_back({removed, kept, faces_, frame_.to_object(position).cast<float>()});
    if (sequence_.collapses.size() % 1024 == 0)
      progress_(static_cast<double>(start_faces_ - faces_) / std::max(1, start_faces_ - settings_.faces));
  }

  CollapseSequence& sequence_;
  const CollapseSettings& settings_;
  const ProgressFunction& progress_;
  UnitFrame frame_;
  FeatureGraph features_;
  std::span<const VertexPair> feature_edges_;  ///< of the start
  std::vector<float> thinnest_;                ///< by vertex (thinnest_heights)
  double smallest_cosine_;                     ///< between a triangle's normals before and after a collapse
  int faces_;
  int start_faces_;
  std::vector<VertexWeight> weights_;
  HalfedgeMesh mesh_;  ///< in the frame
  std::unique_ptr<CostPolicy> policy_;
  std::optional<CgalEnvelope> envelope_;
  std::vector<std::uint32_t> hints_;                ///< by vertex: where the envelope was asked for last
  std::unordered_map<int, std::uint64_t> refused_;  ///< by edge: its surroundings when the envelope refused it
};

}  // namespace

double rounding_of_file(const TriangleMesh& mesh) {
  const BoundingBox box = bounding_box(mesh);
  const Vector lowest = box.lowest.cast<double>(), highest = box.highest.cast<double>();
  const double step = (highest - lowest).maxCoeff() / 65'535;
  const double float_step = std::ldexp(std::max(lowest.cwiseAbs().maxCoeff(), highest.cwiseAbs().maxCoeff()), -23);
  // Half a step along each axis; what floats round, they round once here and once when the file is read.
  return std::sqrt(3.0) * (0.5 * step + float_step) / (highest - lowest).norm();
}

CollapseSequence collapse_by_cgal(TriangleMesh mesh, const CollapseSettings& settings, const CgalSettings& cgal,
                                  const ProgressFunction& progress) {
  CollapseSequence sequence;
  sequence.start = std::move(mesh);
  if (sequence.faces_after(0) <= settings.faces) return sequence;
  const std::vector<VertexPair> features =
      find_feature_edges(sequence.start, settings.crease_degrees, settings.feature_edges);
  CgalCollapser(sequence, features, settings, cgal, progress).run();
  sequence.close_count = sequence.collapses.size();
  return sequence;
}

}  // namespace kiln
