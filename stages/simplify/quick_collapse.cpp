// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/quick_collapse.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/parallel.h"
#include "base/parallel_sort.h"
#include "base/progress.h"
#include "simplify/thinnest_heights.h"
#include "simplify/triangle_shape.h"
#include "simplify/unit_frame.h"

namespace kiln {

namespace {

using Vector = Eigen::Vector3d;
template <class T>
using Fan = boost::container::small_vector<T, 24>;

/// Quadric v'Av + 2b'v + c: the sum of squared distances to planes times triangles' areas; A has xx, yy, zz, xy, xz,
/// yz.
struct Quadric {
  std::array<double, 6> a = {};
  Vector b = Vector::Zero();
  double c = 0;

  void add_plane(const Vector& normal, double offset, double weight) {
    const Vector n = weight * normal;
    a[0] += n.x() * normal.x();
    a[1] += n.y() * normal.y();
    a[2] += n.z() * normal.z();
    a[3] += n.x() * normal.y();
    a[4] += n.x() * normal.z();
    a[5] += n.y() * normal.z();
    b -= offset * n;
    c += weight * offset * offset;
  }
  Quadric operator+(const Quadric& other) const {
    Quadric sum = *this;
    for (int i = 0; i < 6; ++i) sum.a[i] += other.a[i];
    sum.b += other.b;
    sum.c += other.c;
    return sum;
  }
  Vector times(const Vector& v) const {
    return {a[0] * v.x() + a[3] * v.y() + a[4] * v.z(), a[3] * v.x() + a[1] * v.y() + a[5] * v.z(),
            a[4] * v.x() + a[5] * v.y() + a[2] * v.z()};
  }
  /// Returns the mean of the squared distances, of which `sum` is the sum.
  double mean_square(double sum) const { return sum / std::max(a[0] + a[1] + a[2], 1e-300); }
  double operator()(const Vector& v) const { return v.dot(times(v)) + 2 * b.dot(v) + c; }

  /// Finds where the quadric is smallest; false where its planes are nearly parallel.
  bool minimum(Vector& v) const {
    const Vector row0(a[0], a[3], a[4]), row1(a[3], a[1], a[5]), row2(a[4], a[5], a[2]);
    const Vector across = row1.cross(row2);
    const double determinant = row0.dot(across), trace = a[0] + a[1] + a[2];
    if (!(determinant > 1e-4 * trace * trace * trace)) return false;
    v = -(b.x() * across + b.y() * row2.cross(row0) + b.z() * row0.cross(row1)) / determinant;
    return true;
  }
};

struct Placement {
  double cost = std::numeric_limits<double>::infinity();
  Vector position = Vector::Zero();
};

/// Edge of a round. Its cost is rounded to a float, so that few bytes are sorted.
struct Candidate {
  float cost;
  std::uint32_t a, b;

  bool operator<(const Candidate& other) const {
    return cost != other.cost ? cost < other.cost : a != other.a ? a < other.a : b < other.b;
  }
};

class QuickCollapser {
 public:
  QuickCollapser(CollapseSequence& sequence, std::span<const VertexPair> features, std::vector<VertexWeight>& weights)
      : sequence_(sequence),
        weights_(weights),
        frame_(sequence.start),
        triangles_(sequence.start.triangles),
        faces_(static_cast<int>(triangles_.size())),
        area_(surface_area(sequence.start) / (frame_.diagonal * frame_.diagonal)),
        thinnest_(thinnest_heights(sequence.start, frame_.diagonal)) {
    const std::size_t vertices = sequence.start.positions.size();
    positions_.resize(vertices);
    parallel_for(std::size_t{0}, vertices,
                 [&](std::size_t i) { positions_[i] = frame_.from_object(sequence.start.positions[i]); });
    is_fixed_.resize(vertices, 0);
    for (const auto& [a, b] : features) is_fixed_[a] = is_fixed_[b] = 1;
    became_.resize(vertices);
    for (std::uint32_t i = 0; i < vertices; ++i) became_[i] = i;
    list_triangles_around();
    quadrics_.resize(vertices);
    parallel_for(std::size_t{0}, vertices,
                 [&](std::size_t i) { quadrics_[i] = quadric_of(static_cast<std::uint32_t>(i)); });
  }

  void run(int target, const ProgressFunction& progress) {
    candidates_.reserve(triangles_.size() * 3 / 2);  // the edges of a closed mesh
    sequence_.collapses.reserve(sequence_.collapses.size() +
                                static_cast<std::size_t>(std::max(0, faces_ - target)) / 2);
    for (const int start = faces_; faces_ > target;) {
      const int before = faces_;
      run_round(target);
      progress(static_cast<double>(start - faces_) / std::max(1, start - target));
      if (before - faces_ <= before / 200) break;
    }
  }

 private:
  TriangleShape shape_of(const Triangle& t) const { return {positions_[t[0]], positions_[t[1]], positions_[t[2]]}; }

  Quadric quadric_of(std::uint32_t vertex) const {
    Quadric quadric;
    boost::container::small_vector<Vector, 16> normals;
    Vector sum = Vector::Zero();
    for (std::uint32_t triangle : around(vertex)) {
      const Triangle& t = triangles_[triangle];
      Vector normal = (positions_[t[1]] - positions_[t[0]]).cross(positions_[t[2]] - positions_[t[0]]);
      const double length = normal.norm();
      if (length > 0) normal /= length;
      if (length > 0) quadric.add_plane(normal, normal.dot(positions_[t[0]]), length / 2);
      // Leave out a needle's or a cap's normal, which is noise.
      if (is_thin(shape_of(t), {0, thinnest_[vertex]})) normal = Vector::Zero();
      normals.push_back(normal);
      sum += normal;
    }
    // Look for sharp edges, unless all triangles face much the same way.
    const double sharpest = 0.9 * sum.norm();
    if (std::any_of(normals.begin(), normals.end(), [&](const Vector& n) { return n.dot(sum) < sharpest; }))
      add_sharp_edges(vertex, {normals.data(), normals.size()}, quadric);
    return quadric;
  }

  /// Adds planes through the sharp edges at a vertex, upright on either triangle: the rim of a thin wall is so little
  /// surface that its own planes would let it wear off. At a right angle they are those of the triangles themselves.
  void add_sharp_edges(std::uint32_t vertex, std::span<const Vector> normals, Quadric& quadric) const {
    constexpr double sharp_cosine = 0.5, weight = 0.1;
    const std::span<const std::uint32_t> triangles = around(vertex);
    for (std::size_t i = 0; i < triangles.size(); ++i)
      for (std::size_t j = 0; j < triangles.size(); ++j) {
        if (i == j || normals[i].isZero() || normals[j].isZero()) continue;
        if (normals[i].dot(normals[j]) > sharp_cosine) continue;
        for (const std::uint32_t other : triangles_[triangles[i]]) {
          const Triangle& t = triangles_[triangles[j]];
          if (other == vertex || (t[0] != other && t[1] != other && t[2] != other)) continue;
          const Vector edge = positions_[other] - positions_[vertex];
          const Vector upright = edge.cross(normals[i]).normalized();
          quadric.add_plane(upright, upright.dot(positions_[vertex]), weight * edge.squaredNorm());
        }
      }
  }

  std::span<const std::uint32_t> around(std::uint32_t vertex) const {
    return {around_.data() + around_begin_[vertex], around_begin_[vertex + 1] - around_begin_[vertex]};
  }

  void list_triangles_around() {
    around_begin_.assign(positions_.size() + 1, 0);
    for (const Triangle& t : triangles_)
      for (std::uint32_t vertex : t) ++around_begin_[vertex + 1];
    size_.resize(positions_.size());
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      size_[i] = around_begin_[i + 1];
      around_begin_[i + 1] += around_begin_[i];
    }
    around_.resize(around_begin_.back());
    next_.assign(around_begin_.begin(), around_begin_.end() - 1);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i)
      for (std::uint32_t vertex : triangles_[i]) around_[next_[vertex]++] = i;
  }

  Placement placement(std::uint32_t a, std::uint32_t b) const {
    const Quadric both = quadrics_[a] + quadrics_[b];
    const double weight = weights_.empty() ? 1 : 0.5 * (weights_[a].mean() + weights_[b].mean());
    const auto at = [&](const Vector& position) { return Placement{weight * std::max(0.0, both(position)), position}; };
    if (is_fixed_[a]) return at(positions_[a]);
    if (is_fixed_[b]) return at(positions_[b]);
    const Vector &pa = positions_[a], &pb = positions_[b];
    const Vector middle = (pa + pb) / 2;
    Vector position;
    if (both.minimum(position) && (position - middle).squaredNorm() < (pb - pa).squaredNorm()) return at(position);
    // Go from the middle to the planes, which are nearly one.
    const Vector slope = both.times(middle) + both.b;
    const double bend = slope.dot(both.times(slope));
    Placement best = at(bend > 0 ? Vector(middle - slope.squaredNorm() / bend * slope) : middle);
    for (const Vector& end : {pa, pb}) {
      const Placement other = at(end);
      if (other.cost < best.cost) best = other;
    }
    return best;
  }

  void run_round(int target) {
    const double squared_edge = area_ / faces_ * 4 / std::sqrt(3.0);
    largest_mean_square_ = largest_distance * largest_distance * squared_edge;
    // List the edges with their costs.
    candidates_.clear();
    for (const Triangle& t : triangles_)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        if (a < b && !(is_fixed_[a] && is_fixed_[b])) candidates_.push_back({0, a, b});
      }
    constexpr std::size_t chunk = 4096;
    parallel_for(std::size_t{0}, (candidates_.size() + chunk - 1) / chunk, [&](std::size_t c) {
      for (std::size_t i = c * chunk; i < std::min(candidates_.size(), (c + 1) * chunk); ++i)
        candidates_[i].cost = static_cast<float>(1e20 * placement(candidates_[i].a, candidates_[i].b).cost);
    });

    // Sort the cheapest; none that costs much more than would be needed if no edges had an end in common.
    const std::size_t wanted = static_cast<std::size_t>(faces_ - target + 1) / 2;
    std::size_t considered = candidates_.size();
    if (wanted < candidates_.size()) {
      const auto middle = candidates_.begin() + static_cast<std::ptrdiff_t>(wanted);
      std::nth_element(candidates_.begin(), middle, candidates_.end());
      const float largest = 1.5f * middle->cost;
      considered = static_cast<std::size_t>(
          std::partition(middle, candidates_.end(), [&](const Candidate& c) { return c.cost <= largest; }) -
          candidates_.begin());
    }
    parallel_sort(candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(considered));

    is_touched_.assign(positions_.size(), 0);
    for (std::size_t i = 0; i < considered && faces_ > target; ++i) try_collapse(candidates_[i].a, candidates_[i].b);

    std::size_t left = 0;
    for (const Triangle& t : triangles_) {
      const Triangle now = {became_[t[0]], became_[t[1]], became_[t[2]]};
      if (now[0] != now[1] && now[1] != now[2] && now[2] != now[0]) triangles_[left++] = now;
    }
    triangles_.resize(left);
    list_triangles_around();
  }

  /// Calls visit(triangle) for the triangles left around a vertex that was not touched in this round.
  template <class Visit>
  void for_each_around(std::uint32_t vertex, const Visit& visit) const {
    for (std::uint32_t triangle : around(vertex)) {
      const Triangle& t = triangles_[triangle];
      const Triangle now = {became_[t[0]], became_[t[1]], became_[t[2]]};
      if (now[0] != now[1] && now[1] != now[2] && now[2] != now[0]) visit(now);
    }
  }

  void try_collapse(std::uint32_t a, std::uint32_t b) {
    if (is_touched_[a] || is_touched_[b]) return;
    const Placement place = placement(a, b);
    const Quadric both = quadrics_[a] + quadrics_[b];
    if (both.mean_square(both(place.position)) > largest_mean_square_) return;

    Fan<Triangle> at_a, at_b;
    for_each_around(a, [&](const Triangle& t) { at_a.push_back(t); });
    for_each_around(b, [&](const Triangle& t) { at_b.push_back(t); });
    std::uint32_t opposite[2] = {};
    if (!keeps_topology(a, b, {at_a.data(), at_a.size()}, {at_b.data(), at_b.size()}, opposite)) return;
    // Refuse a collapse that turns a triangle over or makes it thin.
    for (const auto& [end, other, fan] : {std::tuple(a, b, &at_a), std::tuple(b, a, &at_b)})
      for (const Triangle& t : *fan) {
        if (t[0] == other || t[1] == other || t[2] == other) continue;
        const int k = t[0] == end ? 0 : t[1] == end ? 1 : 2;
        const Vector &first = positions_[t[(k + 1) % 3]], &second = positions_[t[(k + 2) % 3]];
        if (!keeps_shape({positions_[end], first, second}, {place.position, first, second},
                         {smallest_slenderness, thinnest_[a]}, [&] { return normal_around(a, b); }))
          return;
      }

    const std::uint32_t kept = is_fixed_[b] ? b : a, removed = is_fixed_[b] ? a : b;
    became_[removed] = kept;
    positions_[kept] = place.position;
    quadrics_[kept] = quadrics_[a] + quadrics_[b];
    if (!weights_.empty()) weights_[kept] += weights_[removed];
    size_[kept] = size_[a] + size_[b] - 4;
    for (std::uint32_t vertex : opposite) --size_[vertex];
    is_touched_[a] = is_touched_[b] = 1;
    faces_ -= 2;
    sequence_.collapses.push_back({removed, kept, faces_, frame_.to_object(place.position).cast<float>()});
  }

  /// Tests the link condition on the triangles left around both ends: two are on the edge, and the ends have no
  /// neighbours in common but the `opposite` corners of these. A vertex of three triangles may not lose one.
  bool keeps_topology(std::uint32_t a, std::uint32_t b, std::span<const Triangle> at_a, std::span<const Triangle> at_b,
                      std::uint32_t (&opposite)[2]) const {
    int on_edge = 0;
    for (const Triangle& t : at_a) {
      if (t[0] != b && t[1] != b && t[2] != b) continue;
      if (on_edge == 2) return false;
      opposite[on_edge++] = t[0] + t[1] + t[2] - a - b;
    }
    if (on_edge != 2 || size_[opposite[0]] <= 3 || size_[opposite[1]] <= 3) return false;
    // Look through the neighbours: they are so few that marking them takes longer.
    Fan<std::uint32_t> neighbours;
    for (const Triangle& t : at_a)
      for (const std::uint32_t vertex : t)
        if (vertex != opposite[0] && vertex != opposite[1] && vertex != a && vertex != b) neighbours.push_back(vertex);
    for (const Triangle& t : at_b)
      for (const std::uint32_t vertex : t)
        if (std::find(neighbours.begin(), neighbours.end(), vertex) != neighbours.end()) return false;
    return opposite[0] != opposite[1];
  }

  /// Sums the normals of the triangles around both ends, each as long as twice its area.
  Vector normal_around(std::uint32_t a, std::uint32_t b) const {
    Vector sum = Vector::Zero();
    for (const std::uint32_t end : {a, b})
      for_each_around(end, [&](const Triangle& t) {
        sum += (positions_[t[1]] - positions_[t[0]]).cross(positions_[t[2]] - positions_[t[0]]);
      });
    return sum;
  }

  static constexpr double smallest_slenderness = 0.02;
  /// Distance of a vertex from the planes of the triangles that it stands for, in edges of a triangle of mean area:
  /// what collapse.cpp's first pass allows.
  static constexpr double largest_distance = 0.15;

  CollapseSequence& sequence_;
  std::vector<VertexWeight>& weights_;
  UnitFrame frame_;
  std::vector<Triangle> triangles_;  ///< at the start of the round
  int faces_;
  double area_;                  ///< of the start's surface, in the frame
  std::vector<float> thinnest_;  ///< by vertex (thinnest_heights)
  double largest_mean_square_ = 0;
  std::vector<Vector> positions_;  ///< in the frame
  std::vector<Quadric> quadrics_;
  std::vector<std::uint8_t> is_fixed_, is_touched_;
  std::vector<std::uint32_t> became_;
  std::vector<std::uint32_t> around_begin_, around_, next_;
  std::vector<std::uint32_t> size_;  ///< triangles around each vertex, kept up within a round
  std::vector<Candidate> candidates_;
};

}  // namespace

void collapse_quickly(CollapseSequence& sequence, std::span<const VertexPair> features,
                      std::vector<VertexWeight>& weights, int faces, const ProgressFunction& progress) {
  if (sequence.faces_after(0) > faces) QuickCollapser(sequence, features, weights).run(faces, progress);
}

}  // namespace kiln
