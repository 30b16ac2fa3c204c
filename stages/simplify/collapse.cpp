// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "mesh/nearest_surface.h"
#include "simplify/collapsing_mesh.h"
#include "simplify/lindstrom_turk.h"
#include "simplify/quick_collapse.h"
#include "simplify/thinnest_heights.h"
#include "simplify/triangle_shape.h"
#include "simplify/unit_frame.h"
#include "simplify/vertex_weight.h"

namespace kiln {

namespace {

using Vector = Eigen::Vector3d;
template <class T>
using Few = boost::container::small_vector<T, 32>;

/// Limits of a pass: how far a triangle may be from the surface that it stands for, and how slender. The cost does not
/// forbid a few needles that cut through the surface; refusing them makes the largest error half as large, at the same
/// mean. Where the limits leave nothing to collapse, the next pass has wider ones; past the last, what is left stays.
struct Limits {
  double distance;     ///< largest from a triangle's middle to the input's surface, in edges of a triangle of mean area
  double slenderness;  ///< smallest height over the longest edge; a triangle that was worse may stay as bad
  double feature;      ///< farthest that a vertex of the input's feature edges may be from them, in the same edges
  double facing;       ///< smallest cosine between a triangle's normal and that of the input where it is nearest
};
constexpr Limits passes[] = {{0.15, 0.05, 0.05, 0.1}, {0.15, 0.05, 0.15, 0.1}, {0.3, 0.02, 0.3, 0.1}, {0.6, 0, 0.6, 0}};
constexpr double close_distance = 0.15;  ///< distance of the passes that hurt nothing

/// Triangles of the surface that others are compared with, at most, or those where the comparison begins: a hierarchy
/// of a large input would take longer than the collapses.
constexpr int most_compared_faces = 60'000;

std::vector<VertexWeight> to_vertex_weights(const TriangleMesh& mesh, std::span<const double> weights) {
  if (weights.empty()) return {};
  if (weights.size() != mesh.positions.size())
    throw std::invalid_argument("collapse_edges: as many weights as vertices expected");
  std::vector<VertexWeight> result(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) result[i].sum = weights[i];
  return result;
}

double squared_distance_to_segment(const Vector& p, const Vector& a, const Vector& b) {
  const Vector along = b - a;
  const double squared = along.squaredNorm();
  const double at = squared > 0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0;
  return (p - a - at * along).squaredNorm();
}

/// State of one run of collapses by [Lindstrom 1998]. An edge is known by its ends a and b; collapse.h has the
/// picture.
class Collapser {
 public:
  Collapser(CollapseSequence& sequence, std::span<const VertexPair> features, std::vector<VertexWeight> weights,
            const CollapseSettings& settings, const TriangleMesh& compared, const ProgressFunction& progress)
      : sequence_(sequence),
        settings_(settings),
        progress_(progress),
        frame_(sequence.start),
        mesh_(sequence.start, features),
        weights_(std::move(weights)),
        compared_(compared),
        area_(surface_area(sequence.start) / (frame_.diagonal * frame_.diagonal)),
        start_faces_(mesh_.faces()) {
    const std::size_t vertices = sequence.start.positions.size();
    positions_.resize(vertices);
    planes_.resize(mesh_.triangles().size());
    parallel_for(std::size_t{0}, vertices,
                 [&](std::size_t i) { positions_[i] = frame_.from_object(sequence.start.positions[i]); });
    parallel_for(std::size_t{0}, planes_.size(), [&](std::size_t i) { update_plane(static_cast<std::uint32_t>(i)); });
    versions_.resize(vertices, 0);
    if (!features.empty()) feature_points_.resize(vertices);
    points_.resize(vertices);
    hints_.resize(vertices, 0);
    thinnest_ = thinnest_heights(sequence.start, frame_.diagonal);
  }

  void run() {
    for (const Limits& limits : passes) {
      limits_ = limits;
      // Give refused edges another chance as long as the others went far.
      for (int before = 0; mesh_.faces() > settings_.faces;) {
        before = mesh_.faces();
        run_pass();
        if (before - mesh_.faces() <= before / 100) break;
      }
      if (limits.distance <= close_distance) sequence_.close_count = sequence_.collapses.size();
    }
  }

 private:
  struct Candidate {
    double cost;
    std::uint32_t a, b;
    std::uint32_t version;  ///< versions of both ends together

    bool operator<(const Candidate& other) const {  // puts the least cost first: the heap has the greatest first
      return std::tie(cost, a, b) > std::tie(other.cost, other.a, other.b);
    }
  };
  struct Evaluation {
    double cost = std::numeric_limits<double>::infinity();
    Vector position = Vector::Zero();
  };

  void update_plane(std::uint32_t triangle) {
    const Triangle& t = mesh_.triangles()[triangle];
    planes_[triangle] = TrianglePlane(positions_[t[0]], positions_[t[1]], positions_[t[2]]);
  }

  /// Returns the edge of an equilateral triangle of mean area, in the frame.
  double mean_edge() const { return std::sqrt(area_ / mesh_.faces() * 4 / std::sqrt(3.0)); }

  /// Tells whether the edge between two vertices is a feature edge.
  bool is_feature(std::uint32_t a, std::uint32_t b) const {
    for (std::uint32_t triangle : mesh_.triangles_of(a)) {
      const Triangle& t = mesh_.triangles()[triangle];
      for (int k = 0; k < 3; ++k)
        if (mesh_.is_feature(triangle, k) && std::minmax(t[k], t[(k + 1) % 3]) == std::minmax(a, b)) return true;
    }
    return false;
  }

  /// Calls visit(triangle, corners, end) for the triangles that a collapse moves: those at one `end` but not on the
  /// edge.
  template <class Visit>
  void for_each_moved(std::uint32_t a, std::uint32_t b, const Visit& visit) const {
    for (const auto& [end, other] : {std::pair(a, b), std::pair(b, a)})
      for (std::uint32_t triangle : mesh_.triangles_of(end)) {
        const Triangle& t = mesh_.triangles()[triangle];
        if (t[0] != other && t[1] != other && t[2] != other) visit(triangle, t, end);
      }
  }

  // Section: where the edge's vertex would go, and the cost of it.

  Evaluation evaluate(std::uint32_t a, std::uint32_t b) const {
    const int features_a = mesh_.feature_count(a), features_b = mesh_.feature_count(b);
    const bool both = features_a > 0 && features_b > 0;
    if (both && ((features_a != 2 && features_b != 2) || !is_feature(a, b))) return {};

    Few<TrianglePlane> planes;
    for (std::uint32_t triangle : mesh_.triangles_of(a)) planes.push_back(planes_[triangle]);
    for (std::uint32_t triangle : mesh_.triangles_of(b)) {
      const Triangle& t = mesh_.triangles()[triangle];
      if (t[0] != a && t[1] != a && t[2] != a) planes.push_back(planes_[triangle]);
    }
    Few<FeatureEdge> features;
    if (both) collect_features(a, b, features);
    const Vector &pa = positions_[a], &pb = positions_[b];
    const EdgeSurroundings surroundings{
        {planes.data(), planes.size()}, {features.data(), features.size()}, (pb - pa).squaredNorm()};
    const double weight = weights_.empty() ? 1 : 0.5 * (weights_[a].mean() + weights_[b].mean());
    const auto at = [&](const Vector& position) {
      return Evaluation{weight * lindstrom_turk_cost(surroundings, position), position};
    };
    // Keep ends and branches of lines where they are; have edges from a line to elsewhere end on the line.
    if (features_a > 0 && (features_b == 0 || features_a != 2)) return at(pa);
    if (features_b > 0 && (features_a == 0 || features_b != 2)) return at(pb);

    const std::optional<Vector> placement =
        lindstrom_turk_placement(surroundings, [&] { return middle_of_link(a, b); });
    if (placement && is_near(a, b, *placement, surroundings.squared_length)) return at(*placement);
    // Try the ends and the middle instead of a wild solution of an ill-conditioned system.
    Evaluation best;
    for (const Vector& position : {pa, pb, Vector((pa + pb) / 2)}) {
      const Evaluation evaluation = at(position);
      if (evaluation.cost < best.cost) best = evaluation;
    }
    return best;
  }

  void collect_features(std::uint32_t a, std::uint32_t b, Few<FeatureEdge>& features) const {
    std::vector<std::uint32_t> neighbours;
    features.push_back({positions_[a], positions_[b]});
    for (const auto& [end, other] : {std::pair(a, b), std::pair(b, a)}) {
      mesh_.feature_neighbours(end, neighbours);
      // Run along the line, from whichever end; what matters is that the directions agree.
      for (std::uint32_t next : neighbours)
        if (next != other)
          features.push_back(end == a ? FeatureEdge{positions_[next], positions_[a]}
                                      : FeatureEdge{positions_[b], positions_[next]});
    }
  }

  Vector middle_of_link(std::uint32_t a, std::uint32_t b) const {
    Few<std::uint32_t> link;
    for (const std::uint32_t end : {a, b})
      for (std::uint32_t triangle : mesh_.triangles_of(end))
        for (std::uint32_t vertex : mesh_.triangles()[triangle])
          if (vertex != a && vertex != b && std::find(link.begin(), link.end(), vertex) == link.end())
            link.push_back(vertex);
    Vector sum = Vector::Zero();
    for (std::uint32_t vertex : link) sum += positions_[vertex];
    return sum / static_cast<double>(link.size());
  }

  /// Tells whether a position is within twice the radius of the edge's neighbourhood. A NaN is not.
  bool is_near(std::uint32_t a, std::uint32_t b, const Vector& position, double squared_length) const {
    const Vector middle = (positions_[a] + positions_[b]) / 2;
    const double squared = (position - middle).squaredNorm();
    if (squared < squared_length) return true;
    double radius_squared = 0;
    for_each_moved(a, b, [&](std::uint32_t, const Triangle& t, std::uint32_t) {
      for (std::uint32_t vertex : t)
        radius_squared = std::max(radius_squared, (positions_[vertex] - middle).squaredNorm());
    });
    return squared < 4 * radius_squared;
  }

  // Section: whether a collapse may be.

  /// Tells whether a collapse moves the surface by next to nothing, a thousandth of a mean edge over a mean triangle:
  /// needles do no harm in a plane, and without them hard surfaces lose their chamfers first.
  bool is_flat(double cost) const {
    const double volume = 1e-3 * mean_edge() * area_ / mesh_.faces() / 3;
    return cost <= 0.5 * volume * volume;
  }

  bool is_allowed(std::uint32_t a, std::uint32_t b, const Evaluation& to) {
    const Vector& position = to.position;
    const ShapeLimits limits{is_flat(to.cost) ? 0 : limits_.slenderness, thinnest_[a]};
    bool kept = true;
    for_each_moved(a, b, [&](std::uint32_t, const Triangle& t, std::uint32_t moving) {
      if (!kept) return;
      std::array<Vector, 3> before, after;
      for (int k = 0; k < 3; ++k) {
        before[k] = positions_[t[k]];
        after[k] = t[k] == moving ? position : before[k];
      }
      kept = keeps_shape({before[0], before[1], before[2]}, {after[0], after[1], after[2]}, limits,
                         [&] { return normal_around(a, b); });
    });
    if (!kept) return false;
    const CollapsingMesh::Edge edge = mesh_.edge(a, b);
    if (!edge.keeps_topology) return false;
    if (edge.feature && !keeps_feature(a, b, position)) return false;
    if (!surface_) return true;
    if (!is_close(position, a) || (is_folded(a, b) && !keeps_points(a, b, position))) return false;
    for_each_moved(a, b, [&](std::uint32_t, const Triangle& t, std::uint32_t moving) {
      if (!kept) return;
      std::array<Vector, 3> after;
      for (int k = 0; k < 3; ++k) after[k] = t[k] == moving ? position : positions_[t[k]];
      kept = keeps_place(after, moving);
    });
    return kept;
  }

  /// Sums the normals of the triangles around both ends, each as long as twice its area.
  Vector normal_around(std::uint32_t a, std::uint32_t b) const {
    Vector sum = Vector::Zero();
    for (const std::uint32_t end : {a, b})
      for (std::uint32_t triangle : mesh_.triangles_of(end)) sum += planes_[triangle].normal;
    return sum;
  }

  /// Tells whether the vertices that a line of feature edges once had stay close to it, from the edge before the one
  /// that is collapsed to the edge after it.
  bool keeps_feature(std::uint32_t a, std::uint32_t b, const Vector& position) const {
    std::vector<std::uint32_t> neighbours;
    const auto next_of = [&](std::uint32_t vertex, std::uint32_t from) {
      if (mesh_.feature_count(vertex) != 2) return vertex;
      mesh_.feature_neighbours(vertex, neighbours);
      for (std::uint32_t next : neighbours)
        if (next != from) return next;
      return vertex;
    };
    const std::uint32_t before = next_of(a, b), after = next_of(b, a);
    const std::array<Vector, 5> now = {positions_[next_of(before, a)], positions_[before], position, positions_[after],
                                       positions_[next_of(after, b)]};
    const double limit = std::pow(limits_.feature * mean_edge(), 2);
    const auto is_kept = [&](const Vector& once) {
      for (std::size_t i = 0; i + 1 < now.size(); ++i)
        if (squared_distance_to_segment(once, now[i], now[i + 1]) <= limit) return true;
      return false;
    };
    for (std::uint32_t vertex : {before, a, b, after}) {
      if (mesh_.feature_count(vertex) != 2) continue;
      const std::vector<Vector>& points = feature_points_[vertex];
      if (!is_kept(positions_[vertex]) || !std::all_of(points.begin(), points.end(), is_kept)) return false;
    }
    return true;
  }

  /// Tells whether the surface around an edge goes about a rim or a tip, which may wear off.
  bool is_folded(std::uint32_t a, std::uint32_t b) const {
    const Vector around = normal_around(a, b);
    const auto faces_elsewhere = [&](std::uint32_t triangle) {
      const Vector& normal = planes_[triangle].normal;
      return normal.dot(around) <= smallest_turn_cosine * normal.norm() * around.norm();
    };
    const auto at_a = mesh_.triangles_of(a), at_b = mesh_.triangles_of(b);
    return std::any_of(at_a.begin(), at_a.end(), faces_elsewhere) ||
           std::any_of(at_b.begin(), at_b.end(), faces_elsewhere);
  }

  /// Tells whether the places of the vertices that became these two stay as close to the surface as it does to the
  /// input. A surface that lies on the input may still leave much of it bare: the rim of a thin wall wears off at next
  /// to no cost.
  bool keeps_points(std::uint32_t a, std::uint32_t b, const Vector& position) const {
    Few<std::array<Vector, 3>> fan;
    Few<std::uint32_t> ring;
    for_each_moved(a, b, [&](std::uint32_t, const Triangle& t, std::uint32_t moving) {
      std::array<Vector, 3>& corners = fan.emplace_back();
      for (int k = 0; k < 3; ++k) {
        corners[k] = t[k] == moving ? position : positions_[t[k]];
        if (t[k] != moving) ring.push_back(t[k]);
      }
    });
    const double limit = std::pow(limits_.distance * mean_edge(), 2);
    const auto is_near = [&](const Vector& p, const Vector& q0, const Vector& q1, const Vector& q2) {
      return (nearest_on_triangle(p, q0, q1, q2) - p).squaredNorm() <= limit;
    };
    const auto is_kept = [&](const Vector& point) {
      for (const auto& [q0, q1, q2] : fan)
        if (is_near(point, q0, q1, q2)) return true;
      // Try the neighbours' triangles, which may be near by now.
      for (std::uint32_t neighbour : ring)
        for (std::uint32_t triangle : mesh_.triangles_of(neighbour)) {
          const Triangle& t = mesh_.triangles()[triangle];
          const bool moves = std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return v == a || v == b; });
          if (!moves && is_near(point, positions_[t[0]], positions_[t[1]], positions_[t[2]])) return true;
        }
      return false;
    };
    for (std::uint32_t end : {a, b})
      if (!is_kept(positions_[end]) || !std::all_of(points_[end].begin(), points_[end].end(), is_kept)) return false;
    return true;
  }

  /// Notes the places of the vertices that become `kept`; of many, those that are farthest from where it goes.
  void keep_points(std::uint32_t removed, std::uint32_t kept, const Vector& position) {
    std::vector<Vector>&points = points_[kept], &more = points_[removed];
    points.insert(points.end(), more.begin(), more.end());
    points.push_back(positions_[kept]);
    points.push_back(positions_[removed]);
    more = {};
    constexpr std::size_t most_points = 32;
    if (points.size() <= 2 * most_points) return;
    std::stable_sort(points.begin(), points.end(), [&](const Vector& l, const Vector& r) {
      return (l - position).squaredNorm() > (r - position).squaredNorm();
    });
    points.resize(most_points);
  }

  /// Tells whether a triangle is close to a part of the input that faces as it does. On a thin wall the other side is
  /// as close, or closer.
  bool keeps_place(const std::array<Vector, 3>& corners, std::uint32_t moving) {
    const Vector normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const ShapeLimits thin{0, thinnest_[moving]};
    if (is_thin({corners[0], corners[1], corners[2]}, thin)) return true;
    const auto is_kept = [&](const Vector& point) {
      const Vector at = frame_.to_object(point);
      const NearestSurface::Hit hit = surface_->nearest(at, hints_[moving]);
      hints_[moving] = hit.hint;
      if (!is_close(hit)) return false;
      if (surface_->normal(hit).dot(normal) >= smallest_facing() * normal.norm()) return true;
      return surface_->nearest_facing(at, {normal, smallest_facing(), distance_limit()}, hit.hint).has_value();
    };
    if (!is_kept((corners[0] + corners[1] + corners[2]) / 3)) return false;
    if (limits_.distance <= close_distance) return true;
    // Ask at the edges, too, where much is allowed: a middle says too little of a triangle then.
    for (int k = 0; k < 3; ++k)
      if (!is_kept((corners[k] + corners[(k + 1) % 3]) / 2)) return false;
    return true;
  }
  /// Returns the smallest cosine allowed between normals: larger where the surface compared with is simplified itself,
  /// and faces a little elsewhere than the input.
  double smallest_facing() const { return &compared_ == &sequence_.start ? limits_.facing : limits_.facing + 0.25; }
  double distance_limit() const { return limits_.distance * mean_edge() * frame_.diagonal; }
  bool is_close(const Vector& position, std::uint32_t moving) {
    return is_close(surface_->nearest(frame_.to_object(position), hints_[moving]));
  }
  bool is_close(const NearestSurface::Hit& hit) const { return hit.squared_distance <= std::pow(distance_limit(), 2); }

  // Section: passes.

  void run_pass() {
    std::vector<Candidate> heap;
    for (std::uint32_t i = 0; i < mesh_.triangles().size(); ++i) {
      const Triangle& t = mesh_.triangles()[i];
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;  // gone with an edge
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        if (a < b || mesh_.is_feature(i, k)) heap.push_back({0, std::min(a, b), std::max(a, b), 0});
      }
    }
    constexpr std::size_t chunk = 4096;
    for (std::size_t begin = 0; begin < heap.size(); begin += 64 * chunk) {
      const std::size_t end = std::min(heap.size(), begin + 64 * chunk);
      parallel_for(std::size_t{0}, (end - begin + chunk - 1) / chunk, [&](std::size_t c) {
        for (std::size_t i = begin + c * chunk; i < std::min(end, begin + (c + 1) * chunk); ++i)
          heap[i] = candidate(heap[i].a, heap[i].b);
      });
      report();
    }
    std::erase_if(heap, [](const Candidate& c) { return !(c.cost < std::numeric_limits<double>::infinity()); });
    std::make_heap(heap.begin(), heap.end());

    const auto push = [&](const Candidate& c) {
      if (!(c.cost < std::numeric_limits<double>::infinity())) return;
      heap.push_back(c);
      std::push_heap(heap.begin(), heap.end());
    };
    Few<std::uint32_t> neighbours;
    while (!heap.empty() && mesh_.faces() > settings_.faces) {
      std::pop_heap(heap.begin(), heap.end());
      const Candidate next = heap.back();
      heap.pop_back();
      if (mesh_.is_removed(next.a) || mesh_.is_removed(next.b) || next.version != version(next.a, next.b)) continue;
      // Evaluate again: its surroundings may have changed since.
      const Evaluation now = evaluate(next.a, next.b);
      if (now.cost > next.cost * (1 + 1e-9) && !heap.empty() && now.cost > heap.front().cost) {
        push({now.cost, next.a, next.b, next.version});
        continue;
      }
      compare_from_here();
      if (!is_allowed(next.a, next.b, now)) continue;
      const std::uint32_t kept = collapse(next.a, next.b, now.position);
      neighbours.clear();
      for (std::uint32_t triangle : mesh_.triangles_of(kept))
        for (std::uint32_t vertex : mesh_.triangles()[triangle])
          if (vertex != kept && std::find(neighbours.begin(), neighbours.end(), vertex) == neighbours.end())
            neighbours.push_back(vertex);
      for (std::uint32_t vertex : neighbours) push(candidate(std::min(kept, vertex), std::max(kept, vertex)));
    }
  }

  std::uint32_t version(std::uint32_t a, std::uint32_t b) const { return versions_[a] + versions_[b]; }
  Candidate candidate(std::uint32_t a, std::uint32_t b) const { return {evaluate(a, b).cost, a, b, version(a, b)}; }

  std::uint32_t collapse(std::uint32_t a, std::uint32_t b, const Vector& position) {
    // Keep the end with more triangles, as that moves less; an end or branch of a line stays anyway.
    const int features_a = mesh_.feature_count(a), features_b = mesh_.feature_count(b);
    const bool keep_a = features_a != features_b && (features_a > 0) != (features_b > 0) ? features_a > 0
                        : (features_a > 0 && features_a != features_b)
                            ? features_a != 2
                            : mesh_.triangles_of(a).size() >= mesh_.triangles_of(b).size();
    const std::uint32_t kept = keep_a ? a : b, removed = keep_a ? b : a;
    if (features_a > 0 && features_b > 0) {
      std::vector<Vector>&points = feature_points_[kept], &more = feature_points_[removed];
      points.insert(points.end(), more.begin(), more.end());
      points.push_back(positions_[a]);
      points.push_back(positions_[b]);
      more = {};
    }
    if (is_folded(removed, kept)) keep_points(removed, kept, position);
    mesh_.collapse(removed, kept);
    positions_[kept] = position;
    ++versions_[kept];
    for (std::uint32_t triangle : mesh_.triangles_of(kept)) update_plane(triangle);
    if (!weights_.empty()) weights_[kept] += weights_[removed];
    sequence_.collapses.push_back({removed, kept, mesh_.faces(), frame_.to_object(position).cast<float>()});
    if (++events_ % 1024 == 0) report();
    return kept;
  }

  void report() { progress_(0.2 + 0.8 * (start_faces_ - mesh_.faces()) / std::max(1, start_faces_ - settings_.faces)); }

  void compare_from_here() {
    if (!surface_ && mesh_.faces() <= settings_.compared_faces) surface_.emplace(compared_);
  }

  CollapseSequence& sequence_;
  const CollapseSettings& settings_;
  const ProgressFunction& progress_;
  UnitFrame frame_;
  CollapsingMesh mesh_;
  std::vector<VertexWeight> weights_;
  const TriangleMesh& compared_;  ///< the input, or what it was simplified to quickly
  double area_;                   ///< of the start's surface, in the frame
  int start_faces_;
  std::vector<Vector> positions_;  ///< in the frame
  std::vector<TrianglePlane> planes_;
  std::vector<std::uint32_t> versions_;
  std::vector<std::vector<Vector>> points_;          ///< by vertex of a fold: places of the vertices that became it
  std::vector<std::vector<Vector>> feature_points_;  ///< by vertex of a line: places of the vertices that became it
  std::vector<std::uint32_t> hints_;
  std::vector<float> thinnest_;  ///< by vertex (thinnest_heights)
  std::optional<NearestSurface> surface_;
  Limits limits_ = passes[0];
  int events_ = 0;
};

}  // namespace

CollapseSequence collapse_edges(TriangleMesh mesh, const CollapseSettings& settings, const ProgressFunction& progress) {
  return collapse_edges_in_two_steps(std::move(mesh), std::numeric_limits<int>::max(), settings, progress);
}

CollapseSequence collapse_edges_in_two_steps(TriangleMesh mesh, int quick_faces, const CollapseSettings& settings,
                                             const ProgressFunction& progress) {
  CollapseSequence first;
  first.start = std::move(mesh);
  if (first.faces_after(0) <= settings.faces) return first;
  std::vector<VertexPair> features = find_feature_edges(first.start, settings.crease_degrees, settings.feature_edges);
  std::vector<VertexWeight> weights = to_vertex_weights(first.start, settings.vertex_weights);
  collapse_quickly(first, features, weights, quick_faces, part_of(progress, 0, 0.2));
  first.close_count = first.collapses.size();
  if (first.collapses.empty()) {
    Collapser(first, features, std::move(weights), settings, first.start, progress).run();
    return first;
  }

  // Renumber: the second step's vertices are some of the first's, and feature edges are still where they were.
  CollapseSequence second;
  std::vector<std::uint32_t> origins;
  second.start = first.after(first.collapses.size(), &origins);
  if (second.faces_after(0) <= settings.faces) return first;
  std::vector<std::uint32_t> index(first.start.positions.size());
  for (std::uint32_t i = 0; i < origins.size(); ++i) index[origins[i]] = i;
  for (auto& [a, b] : features) {
    a = index[a];
    b = index[b];
  }
  if (!weights.empty()) {
    for (std::uint32_t i = 0; i < origins.size(); ++i) weights[i] = weights[origins[i]];
    weights.resize(origins.size());
  }
  const bool compares = settings.compared_faces > 0;
  const int compared_from = std::min(settings.compared_faces, second.faces_after(0));
  const TriangleMesh compared =
      compares ? first.after(first.count_for(std::max(compared_from, most_compared_faces))) : TriangleMesh();
  Collapser(second, features, std::move(weights), settings, compared, progress).run();
  first.close_count = first.collapses.size() + second.close_count;
  for (Collapse collapse : second.collapses) {
    collapse.removed = origins[collapse.removed];
    collapse.kept = origins[collapse.kept];
    first.collapses.push_back(collapse);
  }
  return first;
}

}  // namespace kiln
