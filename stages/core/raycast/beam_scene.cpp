// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/beam_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "base/parallel.h"
#include "mesh/disjoint_sets.h"
#include "mesh/same_position.h"
#include "mesh/triangle_edges.h"
#include "raycast/exact_side.h"

namespace kiln {

namespace {

constexpr std::uint32_t no_neighbour = std::numeric_limits<std::uint32_t>::max();

using EdgeVertices = std::array<std::uint32_t, 2>;

struct Neighbours {
  /// Neighbours across the three sides of each triangle, corner 0 to 1 first; none if the side does not have exactly
  /// two triangles, of opposite orientation.
  std::vector<std::array<std::uint32_t, 3>> across;
  /// Sides, from vertex to vertex, that are used more often in this direction than in the other, once for each surplus
  /// use.
  std::vector<EdgeVertices> borders;
};

Neighbours neighbours_of(std::span<const Triangle> triangles, std::span<const Triangle> welded) {
  Neighbours neighbours;
  neighbours.across.assign(triangles.size(), {no_neighbour, no_neighbour, no_neighbour});
  TriangleEdges(welded).for_each([&](std::span<const std::uint32_t> sides) {
    const EdgeKey edge = edge_at(welded, sides[0]);
    if (edge.first == edge.second) return;
    const auto is_forwards = [&](std::uint32_t side) { return vertex_at(welded, side) == edge.first; };
    std::int64_t surplus = 0;
    for (const std::uint32_t side : sides) surplus += is_forwards(side) ? 1 : -1;
    if (surplus != 0) {
      EdgeVertices border = {vertex_at(triangles, sides[0]), vertex_at(triangles, next_corner(sides[0]))};
      if (is_forwards(sides[0]) != (surplus > 0)) std::swap(border[0], border[1]);
      neighbours.borders.insert(neighbours.borders.end(), static_cast<std::size_t>(std::abs(surplus)), border);
    }
    if (surplus != 0 || sides.size() != 2) return;
    neighbours.across[sides[0] / 3][sides[0] % 3] = sides[1] / 3;
    neighbours.across[sides[1] / 3][sides[1] % 3] = sides[0] / 3;
  });
  return neighbours;
}

/// Lids: triangles that close a surface.
struct Lids {
  std::vector<Eigen::Vector3f> positions;  ///< the surface's positions, then the middle of each border
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Makes a fan from the middle of each connected border. A cone over a cycle of edges closes it, whatever its shape.
Lids lids_over(std::span<const Eigen::Vector3f> positions, std::span<const std::uint32_t> place,
               std::span<const EdgeVertices> borders) {
  Lids lids{{positions.begin(), positions.end()}, {}};
  DisjointSets sets(positions.size());
  for (const auto& [from, to] : borders) sets.join(place[from], place[to]);
  struct Middle {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::size_t count = 0;
    std::uint32_t vertex = 0;
  };
  std::map<std::uint32_t, Middle> middles;
  for (const auto& [from, to] : borders) {
    Middle& middle = middles[sets.root(place[from])];
    middle.sum += (positions[from].cast<double>() + positions[to].cast<double>()) / 2;
    ++middle.count;
  }
  for (auto& [set, middle] : middles) {
    middle.vertex = static_cast<std::uint32_t>(lids.positions.size());
    lids.positions.emplace_back((middle.sum / static_cast<double>(middle.count)).cast<float>());
  }
  for (const auto& [from, to] : borders) lids.triangles.push_back({to, from, middles[sets.root(place[from])].vertex});
  return lids;
}

/// Builds a tree from the top: ranges of triangles are halved, at whole clusters, until a node has 16 children.
/// `across` are the triangles' neighbours.
class Builder {
 public:
  Builder(BeamScene& scene, std::span<const Eigen::Vector3f> positions,
          std::span<const std::array<std::uint32_t, 3>> triangles, std::span<const std::array<std::uint32_t, 3>> across)
      : scene_(scene),
        positions_(positions),
        triangles_(triangles),
        across_(across),
        order_(triangles.size()),
        centres_(triangles.size()),
        normals_(triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t k) {
      const auto& t = triangles[k];
      centres_[k] = (positions[t[0]] + positions[t[1]] + positions[t[2]]) / 3;
      const Eigen::Vector3d a = positions[t[0]].cast<double>();
      const Eigen::Vector3d normal = (positions[t[1]].cast<double>() - a).cross(positions[t[2]].cast<double>() - a);
      normals_[k] = normal.squaredNorm() > 0 ? Eigen::Vector3f(normal.normalized().cast<float>())
                                             : Eigen::Vector3f(Eigen::Vector3f::Zero());
    });
  }

  /// Builds the tree and returns the index of its root.
  std::uint32_t build() { return triangles_.empty() ? BeamScene::no_node : node({0, triangles_.size()}); }

 private:
  struct Range {
    std::size_t first, last;
    std::size_t size() const { return last - first; }
  };

  /// Halves `range` across the longest side of the box of its triangles' centres. The halves depend only on the
  /// centres, with the index to break ties.
  std::array<Range, 2> halves(const Range& range) {
    BoundingBox box;
    for (std::size_t k = range.first; k < range.last; ++k) box.extend(centres_[order_[k]]);
    int axis = 0;
    box.sides().maxCoeff(&axis);
    const std::size_t clusters = (range.size() + beam_lanes - 1) / beam_lanes;
    const std::size_t middle = range.first + (clusters + 1) / 2 * beam_lanes;
    std::nth_element(order_.begin() + range.first, order_.begin() + middle, order_.begin() + range.last,
                     [&](std::uint32_t a, std::uint32_t b) {
                       const float at_a = centres_[a][axis], at_b = centres_[b][axis];
                       return at_a != at_b ? at_a < at_b : a < b;
                     });
    return {Range{range.first, middle}, Range{middle, range.last}};
  }

  void set_cones(const Range& range, int i, BeamBoxes& boxes) const {
    boxes.cone_sine[i] = boxes.sheet_sine[i] = 2;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = range.first; k < range.last; ++k) sum += normals_[order_[k]].cast<double>();
    if (!(sum.squaredNorm() > 0)) return;
    const Eigen::Vector3f axis = sum.normalized().cast<float>();
    float least_cosine = 1, least_around = 1;
    for (std::size_t k = range.first; k < range.last; ++k) {
      const Eigen::Vector3f& normal = normals_[order_[k]];
      const bool flat = normal.isZero(0);  // no ray hits a triangle without area
      const float cosine = flat ? 1 : normal.dot(axis);
      least_cosine = std::min(least_cosine, cosine);
      least_around = std::min(least_around, flat ? -1 : cosine);
      for (std::uint32_t neighbour : across_[order_[k]])
        least_around =
            std::min(least_around,
                     neighbour == no_neighbour || normals_[neighbour].isZero(0) ? -1 : normals_[neighbour].dot(axis));
    }
    if (least_cosine <= 0) return;
    for (int k = 0; k < 3; ++k) boxes.cone_axis[k][i] = axis[k];
    constexpr float rounding = 1e-4f;  // margin for corners that the tracer moves by a rounding
    const auto sine_of = [&](float cosine) { return std::sqrt(std::max(0.f, 1 - cosine * cosine)) + rounding; };
    boxes.cone_sine[i] = sine_of(least_cosine);
    if (least_around > 0) boxes.sheet_sine[i] = sine_of(least_around);
  }

  std::uint32_t cluster(const Range& range) {
    BeamScene::Cluster cluster{};
    cluster.count = static_cast<int>(range.size());
    for (int i = 0; i < beam_lanes; ++i) {
      const auto& triangle = triangles_[order_[std::min(range.first + i, range.last - 1)]];
      for (int k = 0; k < 3; ++k)
        for (int axis = 0; axis < 3; ++axis) cluster.corner[k][axis][i] = positions_[triangle[k]][axis];
    }
    scene_.clusters.push_back(cluster);
    return static_cast<std::uint32_t>(scene_.clusters.size() - 1);
  }

  std::uint32_t node(const Range& range) {
    // Step 1: cut into at most 16 parts, always the largest.
    std::vector<Range> parts{range};
    while (parts.size() < beam_lanes) {
      const auto largest = std::max_element(parts.begin(), parts.end(),
                                            [](const Range& a, const Range& b) { return a.size() < b.size(); });
      if (largest->size() <= beam_lanes) break;
      const std::array<Range, 2> two = halves(*largest);
      *largest = two[0];
      parts.push_back(two[1]);
    }

    // Step 2: make boxes and children.
    const auto index = static_cast<std::uint32_t>(scene_.nodes.size());
    scene_.nodes.emplace_back();
    BeamScene::Node made{};
    made.count = static_cast<int>(parts.size());
    for (int i = 0; i < beam_lanes; ++i) {
      BoundingBox box;
      if (i < made.count) {
        for (std::size_t k = parts[i].first; k < parts[i].last; ++k)
          for (std::uint32_t vertex : triangles_[order_[k]]) box.extend(positions_[vertex]);
        if (parts[i].size() <= beam_lanes) {
          made.is_cluster |= 1u << i;
          made.child[i] = cluster(parts[i]);
        } else {
          made.child[i] = node(parts[i]);
        }
      } else {
        box.extend(Eigen::Vector3f::Zero());
      }
      if (i < made.count) set_cones(parts[i], i, made.boxes);
      for (int axis = 0; axis < 3; ++axis) {
        made.boxes.lower[axis][i] = box.lowest[axis];
        made.boxes.upper[axis][i] = box.highest[axis];
      }
    }
    scene_.nodes[index] = made;
    return index;
  }

  BeamScene& scene_;
  std::span<const Eigen::Vector3f> positions_;
  std::span<const std::array<std::uint32_t, 3>> triangles_;
  std::span<const std::array<std::uint32_t, 3>> across_;
  std::vector<std::uint32_t> order_;
  std::vector<Eigen::Vector3f> centres_, normals_;
};

}  // namespace

BeamScene::BeamScene(std::span<const Eigen::Vector3f> positions,
                     std::span<const std::array<std::uint32_t, 3>> triangles) {
  const std::vector<std::uint32_t> place = first_at_position(positions);
  const Neighbours neighbours = neighbours_of(triangles, renumbered(triangles, place));
  root = Builder(*this, positions, triangles, neighbours.across).build();
  if (!neighbours.borders.empty()) {
    const Lids made = lids_over(positions, place, neighbours.borders);
    const std::vector<std::array<std::uint32_t, 3>> alone(made.triangles.size(),
                                                          {no_neighbour, no_neighbour, no_neighbour});
    lids = Builder(*this, made.positions, made.triangles, alone).build();
  }
  float largest = 0;
  BoundingBox box;
  for (const auto& triangle : triangles)
    for (std::uint32_t vertex : triangle) {
      largest = std::max(largest, positions[vertex].cwiseAbs().maxCoeff());
      box.extend(positions[vertex]);
    }
  if (!triangles.empty()) doubtful = doubtful_share * box.diagonal();
  slack = 8 * std::numeric_limits<float>::epsilon() * largest;
}

}  // namespace kiln
