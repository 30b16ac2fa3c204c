// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/cut_pattern.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace kiln {

namespace {

/// Distance, in texels, by which an outline may be simplified.
constexpr double tolerance = 0.1;

/// Least distance of an outline from a texel's centre, in texels: a value that equals the cutoff would join outlines
/// there.
constexpr float least_share_of_edge = 1e-3f;

/// Distance, in texels, from a triangle's side at which a point is on it.
constexpr double side_width = 1e-6;

using Point = Eigen::Vector2d;  // in texels; texels' centres are at whole numbers
using Corners = std::array<Point, 3>;

double cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }

Corners corners_of(const SurfaceShare::Material& material, const std::array<Eigen::Vector2f, 3>& uvs) {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2d uv = (material.texture_transform * uvs[k].homogeneous()).cast<double>();
    corners[k] = {uv.x() * material.texture->width() - 0.5, uv.y() * material.texture->height() - 0.5};
  }
  // Move triangles far outside the picture near it, by whole periods.
  constexpr double far = 1 << 20;
  const auto move = [&](int axis, int texels, ChannelTexture::Wrap wrap) {
    const double lowest = std::min({corners[0][axis], corners[1][axis], corners[2][axis]});
    if (std::abs(lowest) < far || wrap == ChannelTexture::Wrap::clamp) return;
    const double periods = 2.0 * texels * std::floor(lowest / (2.0 * texels));
    for (Point& corner : corners) corner[axis] -= periods;
  };
  move(0, material.texture->width(), material.wrap_u);
  move(1, material.texture->height(), material.wrap_v);
  return corners;
}

/// Box of a triangle in whole texels: its texels' centres reach beyond it on all sides.
struct TexelBox {
  Eigen::Vector2i first, last;

  explicit TexelBox(const Corners& corners) {
    const Point low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Point high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    first = low.array().floor().cast<int>();
    last = high.array().floor().cast<int>() + 1;
  }
};

/// Shares at the texels' centres of a box.
class Shares {
 public:
  Shares(const SurfaceShare::Material& material, const TexelBox& box)
      : first_(box.first), width_(box.last.x() - box.first.x() + 1), height_(box.last.y() - box.first.y() + 1) {
    values_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (int j = 0; j < height_; ++j)
      for (int i = 0; i < width_; ++i)
        values_.push_back(material.factor *
                          material.texture->texel(first_.x() + i, first_.y() + j, material.wrap_u, material.wrap_v));
  }

  int width() const { return width_; }
  int height() const { return height_; }
  const Eigen::Vector2i& first() const { return first_; }
  const std::vector<float>& all() const { return values_; }
  float at(int i, int j) const {
    return values_[static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(i)];
  }

  /// Interpolates bilinearly.
  double between(const Point& point) const {
    const Point within = point - first_.cast<double>();
    const int i = std::clamp(static_cast<int>(std::floor(within.x())), 0, width_ - 2);
    const int j = std::clamp(static_cast<int>(std::floor(within.y())), 0, height_ - 2);
    const double x = within.x() - i, y = within.y() - j;
    return (1 - y) * ((1 - x) * at(i, j) + x * at(i + 1, j)) + y * ((1 - x) * at(i, j + 1) + x * at(i + 1, j + 1));
  }

 private:
  Eigen::Vector2i first_;
  int width_, height_;
  std::vector<float> values_;
};

/// Edge k of a triangle, from corner k to the next, told from its end that comes first by coordinates, so that it is
/// the same edge in the triangle beyond.
struct Side {
  Point from, along;
  std::size_t first, second;  ///< corners
  double sign;                ///< of distances inside

  Side(const Corners& corners, std::size_t k, double orientation) : first(k), second((k + 1) % 3), sign(orientation) {
    const auto key = [&](std::size_t corner) { return std::pair(corners[corner].x(), corners[corner].y()); };
    if (key(second) < key(first)) {
      std::swap(first, second);
      sign = -sign;
    }
    from = corners[first];
    along = corners[second] - from;
  }

  /// Returns the distance from the side's line, positive inside.
  double inside(const Point& point) const { return sign * cross(along, point - from) / along.norm(); }
  double place_of(const Point& point) const {
    return std::clamp((point - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  }
};

/// Lines along which a share crosses the cutoff, within a triangle.
class Outlines {
 public:
  struct Node {
    Point point;
    int side = -1;     ///< side of the triangle that it lies on; -1: inside
    double place = 0;  ///< on that side, 0 to 1
    int beside[2] = {-1, -1};
  };

  Outlines(const Corners& corners, const Shares& shares, float cutoff) : shares_(shares), cutoff_(cutoff) {
    const double orientation = cross(corners[1] - corners[0], corners[2] - corners[0]) < 0 ? -1 : 1;
    for (std::size_t k = 0; k < 3; ++k) sides_.emplace_back(corners, k, orientation);
    for (int j = 0; j + 1 < shares.height(); ++j)
      for (int i = 0; i + 1 < shares.width(); ++i) trace_cell(i, j);
  }

  const std::vector<Side>& sides() const { return sides_; }
  const std::vector<Node>& nodes() const { return nodes_; }

  /// Returns the lines, simplified, as numbers of nodes; closed ones end with their first.
  std::vector<std::vector<int>> lines() const {
    std::vector<std::vector<int>> lines;
    std::vector<bool> done(nodes_.size(), false);
    const auto follow = [&](int start) {
      std::vector<int> line = {start};
      done[static_cast<std::size_t>(start)] = true;
      for (int before = -1, at = start;;) {
        const Node& node = nodes_[static_cast<std::size_t>(at)];
        const int next = node.beside[0] != before ? node.beside[0] : node.beside[1];
        if (next < 0) break;
        line.push_back(next);
        if (done[static_cast<std::size_t>(next)]) break;  // closed
        done[static_cast<std::size_t>(next)] = true;
        before = at;
        at = next;
      }
      if (line.size() > 1) lines.push_back(simplified(line));
    };
    for (const bool wants_ends : {true, false})
      for (int k = 0; k < static_cast<int>(nodes_.size()); ++k)
        if (!done[static_cast<std::size_t>(k)] && (!wants_ends || nodes_[static_cast<std::size_t>(k)].beside[1] < 0))
          follow(k);
    return lines;
  }

 private:
  /// Edge of a cell between two texels' centres: to the right, or upwards, of (i, j).
  struct CellEdge {
    int i, j;
    bool upwards;
  };

  /// Point at which lines cross a cell's edge, or a spoke from a corner to its middle, and a number of its own.
  struct CellPoint {
    Point point;
    std::uint64_t key;
  };

  void trace_cell(int i, int j) {
    const std::array<Eigen::Vector2i, 4> corners = {{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
    std::array<float, 4> value{};
    std::array<bool, 4> is_there{};
    int count = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      value[k] = shares_.at(corners[k].x(), corners[k].y());
      count += is_there[k] = value[k] >= cutoff_;
    }
    if (count == 0 || count == 4) return;
    const std::array<CellEdge, 4> edges = {{{i, j, false}, {i + 1, j, true}, {i, j + 1, false}, {i, j, true}}};
    // Walk around the cell; a line leaves it where what is there ends, and comes in where it begins.
    const float middle = (value[0] + value[1] + value[2] + value[3]) / 4;
    for (std::size_t k = 0; k < 4; ++k) {
      if (!is_there[k] || is_there[(k + 1) % 4]) continue;
      if (count == 2 && is_there[(k + 2) % 4]) {
        // A saddle: the line goes around the corner that differs from the middle, by way of the spoke to it.
        const bool around_next = middle >= cutoff_;
        const std::size_t corner = around_next ? (k + 1) % 4 : k;
        const CellPoint turn = on_spoke(corners[corner], {i, j}, corner, value[corner], middle);
        add(on_edge(edges[k]), turn);
        add(turn, on_edge(edges[around_next ? (k + 1) % 4 : (k + 3) % 4]));
        continue;
      }
      std::size_t other = (k + 1) % 4;
      while (is_there[other] || !is_there[(other + 1) % 4]) other = (other + 1) % 4;
      add(on_edge(edges[k]), on_edge(edges[other]));
    }
  }

  /// Returns the place between values a and b at which the cutoff is reached, 0 to 1, off the ends.
  double crossing(float a, float b) const {
    return std::clamp((cutoff_ - a) / (b - a), least_share_of_edge, 1 - least_share_of_edge);
  }

  std::uint64_t number_of_cell(int i, int j) const {
    return static_cast<std::uint64_t>(j) * static_cast<std::uint64_t>(shares_.width()) + static_cast<std::uint64_t>(i);
  }

  CellPoint on_edge(const CellEdge& edge) const {
    const double share = crossing(shares_.at(edge.i, edge.j),
                                  edge.upwards ? shares_.at(edge.i, edge.j + 1) : shares_.at(edge.i + 1, edge.j));
    const Point start(shares_.first().x() + edge.i, shares_.first().y() + edge.j);
    return {start + share * (edge.upwards ? Point(0, 1) : Point(1, 0)),
            8 * number_of_cell(edge.i, edge.j) + (edge.upwards ? 1 : 0)};
  }

  CellPoint on_spoke(const Eigen::Vector2i& corner, const Eigen::Vector2i& cell, std::size_t number, float value,
                     float middle) const {
    const Point from = (shares_.first() + corner).cast<double>();
    const Point to = (shares_.first() + cell).cast<double>() + Point(0.5, 0.5);
    return {from + crossing(value, middle) * (to - from), 8 * number_of_cell(cell.x(), cell.y()) + 4 + number};
  }

  /// Adds the part inside the triangle of a line between two points of a cell.
  void add(const CellPoint& from, const CellPoint& to) {
    const Point &a = from.point, &b = to.point;
    double begin = 0, end = 1;
    int begin_side = -1, end_side = -1;
    for (int k = 0; k < 3; ++k) {
      const double at_a = sides_[static_cast<std::size_t>(k)].inside(a),
                   at_b = sides_[static_cast<std::size_t>(k)].inside(b);
      if (at_a <= side_width && at_b <= side_width) return;
      // A point on the side ends a line there: beside it, regions would join through the gap.
      const double share = at_a / (at_a - at_b);
      const double entry = at_a < -side_width ? share : 0, exit = at_b < -side_width ? share : 1;
      if (at_a <= side_width && entry >= begin) {
        begin = entry;
        begin_side = k;
      }
      if (at_b <= side_width && exit <= end) {
        end = exit;
        end_side = k;
      }
    }
    if (begin >= end) return;
    const auto node_at = [&](const CellPoint& whole, double share, int side) {
      if (side < 0) return node_of(whole);
      const Point point = a + share * (b - a);
      nodes_.push_back({point, side, sides_[static_cast<std::size_t>(side)].place_of(point)});
      return static_cast<int>(nodes_.size() - 1);
    };
    const int first = node_at(from, begin, begin_side), second = node_at(to, end, end_side);
    join(first, second);
    join(second, first);
  }

  void join(int node, int other) {
    int(&beside)[2] = nodes_[static_cast<std::size_t>(node)].beside;
    beside[beside[0] < 0 ? 0 : 1] = other;
  }

  int node_of(const CellPoint& place) {
    const auto [found, is_new] = node_of_key_.try_emplace(place.key, static_cast<int>(nodes_.size()));
    if (is_new) nodes_.push_back({place.point});
    return found->second;
  }

  double distance(int node, int from, int to) const {
    const Point a = nodes_[static_cast<std::size_t>(from)].point, p = nodes_[static_cast<std::size_t>(node)].point - a,
                along = nodes_[static_cast<std::size_t>(to)].point - a;
    const double squared = along.squaredNorm();
    if (!(squared > 0)) return p.norm();
    return (p - std::clamp(p.dot(along) / squared, 0.0, 1.0) * along).norm();
  }

  /// Leaves out the nodes that lie within the tolerance of the line without them [Douglas 1973].
  std::vector<int> simplified(const std::vector<int>& line) const {
    std::vector<bool> is_kept(line.size(), false);
    is_kept.front() = is_kept.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> parts = {{0, line.size() - 1}};
    while (!parts.empty()) {
      const auto [first, last] = parts.back();
      parts.pop_back();
      double farthest = tolerance;
      std::size_t at = first;
      for (std::size_t k = first + 1; k < last; ++k)
        if (const double far = distance(line[k], line[first], line[last]); far > farthest) {
          farthest = far;
          at = k;
        }
      if (at == first) continue;
      is_kept[at] = true;
      parts.emplace_back(first, at);
      parts.emplace_back(at, last);
    }
    std::vector<int> kept;
    for (std::size_t k = 0; k < line.size(); ++k)
      if (is_kept[k]) kept.push_back(line[k]);
    return kept;
  }

  const Shares& shares_;
  float cutoff_;
  std::vector<Side> sides_;
  std::vector<Node> nodes_;
  std::unordered_map<std::uint64_t, int> node_of_key_;
};

/// Number of a vertex's place; -1 where it has none yet, as where two lines cross.
struct VertexInfo {
  int place = -1;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<VertexInfo, Kernel>;
using FaceBase =
    CGAL::Constrained_triangulation_face_base_2<Kernel, CGAL::Triangulation_face_base_with_info_2<int, Kernel>>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::Exact_predicates_tag>;

/// Triangulates a triangle along the lines in it, and takes the regions between lines that are there.
class Pieces {
 public:
  Pieces(const Corners& corners, const Shares& shares, float cutoff, const Outlines& outlines)
      : corners_(corners), shares_(shares), cutoff_(cutoff) {
    insert_sides(outlines);
    insert_lines(outlines);
    find_regions();
  }

  CutPattern pattern() const {
    CutPattern pattern;
    std::unordered_map<Triangulation::Vertex_handle, std::uint32_t> number;
    const bool turns = cross(corners_[1] - corners_[0], corners_[2] - corners_[0]) < 0;
    for (auto face = triangulation_.finite_faces_begin(); face != triangulation_.finite_faces_end(); ++face) {
      if (face->info() < 0 || !is_there_[static_cast<std::size_t>(face->info())]) continue;
      std::array<std::uint32_t, 3> triangle{};
      for (int k = 0; k < 3; ++k) {
        const auto vertex = face->vertex(k);
        const auto [found, is_new] = number.try_emplace(vertex, static_cast<std::uint32_t>(pattern.places.size()));
        if (is_new) pattern.places.push_back(place_of(vertex));
        triangle[static_cast<std::size_t>(k)] = found->second;
      }
      if (turns) std::swap(triangle[1], triangle[2]);
      pattern.triangles.push_back(triangle);
    }
    pattern.part = pattern.triangles.empty() ? CutPattern::Part::nothing : CutPattern::Part::pieces;
    return pattern;
  }

 private:
  static constexpr int outside = -1, unknown = -2;  // regions

  static CutPattern::Place corner_place(std::size_t k) {
    CutPattern::Place place{};
    place.weights[k] = 1;
    return place;
  }

  Triangulation::Vertex_handle insert(const Point& point, const CutPattern::Place& place) {
    const auto vertex = triangulation_.insert(Kernel::Point_2(point.x(), point.y()));
    vertex->info().place = static_cast<int>(places_.size());
    places_.push_back(place);
    return vertex;
  }

  void constrain(Triangulation::Vertex_handle a, Triangulation::Vertex_handle b) {
    if (a != b) triangulation_.insert_constraint(a, b);
  }

  void insert_sides(const Outlines& outlines) {
    vertices_.resize(outlines.nodes().size());
    std::array<Triangulation::Vertex_handle, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) corner[k] = insert(corners_[k], corner_place(k));
    for (int k = 0; k < 3; ++k) {
      const Side& side = outlines.sides()[static_cast<std::size_t>(k)];
      std::vector<std::pair<double, std::size_t>> nodes;
      for (std::size_t n = 0; n < outlines.nodes().size(); ++n)
        if (outlines.nodes()[n].side == k) nodes.emplace_back(outlines.nodes()[n].place, n);
      std::sort(nodes.begin(), nodes.end());
      Triangulation::Vertex_handle last = corner[side.first];
      for (const auto& [place, n] : nodes) {
        CutPattern::Place weights{};
        weights.weights[side.first] = static_cast<float>(1 - place);
        weights.weights[side.second] = static_cast<float>(place);
        vertices_[n] = insert(outlines.nodes()[n].point, weights);
        constrain(last, vertices_[n]);
        last = vertices_[n];
      }
      constrain(last, corner[side.second]);
    }
  }

  void insert_lines(const Outlines& outlines) {
    const auto vertex_of = [&](int n) {
      Triangulation::Vertex_handle& vertex = vertices_[static_cast<std::size_t>(n)];
      const Point& point = outlines.nodes()[static_cast<std::size_t>(n)].point;
      if (vertex == nullptr) vertex = triangulation_.insert(Kernel::Point_2(point.x(), point.y()));
      return vertex;
    };
    for (const std::vector<int>& line : outlines.lines())
      for (std::size_t k = 0; k + 1 < line.size(); ++k) constrain(vertex_of(line[k]), vertex_of(line[k + 1]));
  }

  /// Numbers the regions between constraints, from the outside in, and finds which of them are there.
  void find_regions() {
    for (auto face = triangulation_.all_faces_begin(); face != triangulation_.all_faces_end(); ++face)
      face->info() = unknown;
    flood(triangulation_.infinite_face(), outside);
    for (auto face = triangulation_.finite_faces_begin(); face != triangulation_.finite_faces_end(); ++face) {
      if (face->info() != unknown) continue;
      is_there_.push_back(flood(face, static_cast<int>(is_there_.size())) > 0);
    }
  }

  /// Gives a region's faces its number; returns by how much more of its area, in its faces' middles, is there than not.
  double flood(Triangulation::Face_handle start, int number) {
    double balance = 0;
    std::vector<Triangulation::Face_handle> front = {start};
    start->info() = number;
    while (!front.empty()) {
      const Triangulation::Face_handle face = front.back();
      front.pop_back();
      if (!triangulation_.is_infinite(face)) balance += signed_area(face);
      for (int k = 0; k < 3; ++k) {
        const Triangulation::Face_handle next = face->neighbor(k);
        if (face->is_constrained(k) || next->info() != unknown) continue;
        next->info() = number;
        front.push_back(next);
      }
    }
    return balance;
  }

  double signed_area(Triangulation::Face_handle face) const {
    std::array<Point, 3> p;
    for (int k = 0; k < 3; ++k)
      p[static_cast<std::size_t>(k)] = {face->vertex(k)->point().x(), face->vertex(k)->point().y()};
    const double area = cross(p[1] - p[0], p[2] - p[0]);
    return shares_.between((p[0] + p[1] + p[2]) / 3) >= static_cast<double>(cutoff_) ? area : -area;
  }

  CutPattern::Place place_of(Triangulation::Vertex_handle vertex) const {
    if (vertex->info().place >= 0) return places_[static_cast<std::size_t>(vertex->info().place)];
    const Point p = Point(vertex->point().x(), vertex->point().y()) - corners_[0];
    const Point b = corners_[1] - corners_[0], c = corners_[2] - corners_[0];
    const double whole = cross(b, c), u = cross(p, c) / whole, v = cross(b, p) / whole;
    return {{static_cast<float>(1 - u - v), static_cast<float>(u), static_cast<float>(v)}};
  }

  const Corners& corners_;
  const Shares& shares_;
  float cutoff_;
  Triangulation triangulation_;
  std::vector<CutPattern::Place> places_;
  std::vector<Triangulation::Vertex_handle> vertices_;  // by node, null where it has none yet
  std::vector<bool> is_there_;                          // by region
};

}  // namespace

double texels_under(const SurfaceShare::Material& material, const std::array<Eigen::Vector2f, 3>& uvs) {
  const Corners corners = corners_of(material, uvs);
  const Point sides = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]) -
                      corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]) + Point(2, 2);
  return sides.x() * sides.y();
}

CutPattern cut_pattern(const SurfaceShare::Material& material, float cutoff,
                       const std::array<Eigen::Vector2f, 3>& uvs) {
  using Part = CutPattern::Part;
  const Corners corners = corners_of(material, uvs);
  const Shares shares(material, TexelBox(corners));
  CutPattern pattern;
  const auto is_there = [&](float share) { return share >= cutoff; };
  if (std::ranges::all_of(shares.all(), is_there)) return pattern;
  pattern.part = Part::nothing;
  if (std::ranges::none_of(shares.all(), is_there)) return pattern;

  const Point middle = (corners[0] + corners[1] + corners[2]) / 3;
  const bool has_area = cross(corners[1] - corners[0], corners[2] - corners[0]) != 0;
  if (has_area) {
    const Outlines outlines(corners, shares, cutoff);
    if (!outlines.nodes().empty()) return Pieces(corners, shares, cutoff, outlines).pattern();
  }
  pattern.part = is_there(static_cast<float>(shares.between(middle))) ? Part::whole : Part::nothing;
  return pattern;
}

}  // namespace kiln
