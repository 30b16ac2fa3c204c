// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/surface_cache.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "mesh/surface_point.h"
#include "mesh/triangle_edges.h"

namespace kiln {

namespace {

constexpr float crease_cosine = 0.70710678f;  // cosine of 45 degrees
/// Least cosine between two normals of a vertex that are taken as one.
constexpr float shared_normal_cosine = 0.999f;
constexpr float inset = 0.1f;  // fraction of the way to the triangle's centre, for points at creases and borders

/// A triangle of the cut surface: its corners, and their places in the triangle that it was cut from.
struct Piece {
  std::array<std::uint32_t, 3> corners;
  std::uint32_t source = 0;
  std::array<Eigen::Vector2f, 3> places;  // weights of the source triangle's second and third corner
};

/// Halves edges until none is longer than `longest`.
void cut_long_edges(std::vector<Eigen::Vector3f>& positions, std::vector<Piece>& pieces, float longest) {
  const float most = longest * longest;
  for (bool any = true; any;) {
    any = false;
    std::map<EdgeKey, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(positions.size()));
      if (fresh) positions.emplace_back(0.5f * (positions[a] + positions[b]));
      return found->second;
    };
    std::vector<Piece> finer;
    for (const Piece& piece : pieces) {
      // Step 1: turn the triangle so that a single cut edge comes first, or, of two, the uncut edge is the third.
      std::array<bool, 3> is_long{};
      int count = 0;
      for (int k = 0; k < 3; ++k) {
        is_long[k] = (positions[piece.corners[k]] - positions[piece.corners[(k + 1) % 3]]).squaredNorm() > most;
        count += is_long[k] ? 1 : 0;
      }
      if (count == 0) {
        finer.push_back(piece);
        continue;
      }
      any = true;
      int first = 0;
      while (count < 3 && !(is_long[first] && (count == 1 || is_long[(first + 1) % 3]))) ++first;
      // Step 2: number the corners 0 to 2, and the middles of the edges 0-1, 1-2 and 2-0 as 3 to 5.
      std::array<std::uint32_t, 6> vertex{};
      std::array<Eigen::Vector2f, 6> place;
      for (int k = 0; k < 3; ++k) {
        vertex[k] = piece.corners[(first + k) % 3];
        place[k] = piece.places[(first + k) % 3];
      }
      for (int k = 0; k < count; ++k) {
        vertex[3 + k] = middle(vertex[k], vertex[(k + 1) % 3]);
        place[3 + k] = 0.5f * (place[k] + place[(k + 1) % 3]);
      }
      const auto add = [&](int a, int b, int c) {
        finer.push_back({{vertex[a], vertex[b], vertex[c]}, piece.source, {place[a], place[b], place[c]}});
      };
      if (count == 1) {
        add(0, 3, 2);
        add(3, 1, 2);
      } else if (count == 2) {
        add(3, 1, 4);
        add(0, 3, 4);
        add(0, 4, 2);
      } else {
        add(0, 3, 5);
        add(3, 1, 4);
        add(5, 4, 2);
        add(3, 4, 5);
      }
    }
    pieces = std::move(finer);
  }
}

/// Makes points for the corners of pieces.
class PointMaker {
 public:
  /// Keeps references; `mesh` is what the pieces were cut from.
  PointMaker(const TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& positions, const std::vector<Piece>& pieces)
      : mesh_(mesh), positions_(positions), pieces_(pieces), on_border_(positions.size(), 0) {
    std::vector<Triangle> triangles;
    triangles.reserve(pieces.size());
    for (const Piece& piece : pieces) {
      const auto& [a, b, c] = triangles.emplace_back(piece.corners);
      normals_.push_back((positions[b] - positions[a]).cross(positions[c] - positions[a]));
    }
    TriangleEdges(triangles).for_each([&](std::span<const std::uint32_t> sides) {
      const auto [low, high] = edge_at(triangles, sides[0]);
      if (sides.size() != 2) on_border_[low] = on_border_[high] = 1;
    });
  }

  /// Fills the cache's points; albedos are still zero.
  void make(SurfaceCache& cache) const {
    // Step 1: list the corners of each vertex, in the order of triangles.
    std::vector<std::uint32_t> first(positions_.size() + 1, 0), corners(3 * pieces_.size());
    for (const Piece& piece : pieces_)
      for (std::uint32_t vertex : piece.corners) ++first[vertex + 1];
    for (std::size_t v = 0; v < positions_.size(); ++v) first[v + 1] += first[v];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t corner = 0; corner < corners.size(); ++corner)
      corners[next[pieces_[corner / 3].corners[corner % 3]]++] = corner;

    // Step 2: group them.
    cache.points.resize(pieces_.size());
    for (std::uint32_t vertex = 0; vertex < positions_.size(); ++vertex) {
      std::vector<Group> groups;
      for (std::uint32_t k = first[vertex]; k < first[vertex + 1]; ++k) add_corner(groups, corners[k]);
      for (const Group& group : groups) {
        for (std::uint32_t corner : group.corners)
          cache.points[corner / 3][corner % 3] = static_cast<std::uint32_t>(cache.point_positions.size());
        const Piece& largest = pieces_[group.largest];
        Eigen::Vector3f at = positions_[vertex];
        if (groups.size() > 1 || on_border_[vertex] != 0) {
          const Eigen::Vector3f centre =
              (positions_[largest.corners[0]] + positions_[largest.corners[1]] + positions_[largest.corners[2]]) / 3;
          at += inset * (centre - at);
        }
        cache.point_positions.push_back(at);
        const float length = group.normal.norm();
        cache.point_normals.push_back(length > 0 ? Eigen::Vector3f(group.normal / length) : Eigen::Vector3f::UnitY());
      }
    }
  }

  /// Returns twice the triangle's area.
  float double_area(std::size_t piece) const { return normals_[piece].norm(); }

 private:
  struct Group {
    std::vector<std::uint32_t> corners;
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // sum, weighted by the angles at the vertex
    std::uint32_t largest = 0;                         // largest of its triangles
  };

  void add_corner(std::vector<Group>& groups, std::uint32_t corner) const {
    const std::uint32_t piece = corner / 3;
    const Eigen::Vector3f& normal = normals_[piece];
    const float length = normal.norm();
    const auto& vertices = pieces_[piece].corners;
    const Eigen::Vector3f& at = positions_[vertices[corner % 3]];
    const Eigen::Vector3f a = positions_[vertices[(corner + 1) % 3]] - at,
                          b = positions_[vertices[(corner + 2) % 3]] - at;
    // Hard edges of the mesh separate groups; without any, edges that bend by more than 45 degrees do.
    const bool has_hard_edges = !mesh_.corner_normals.empty();
    const Eigen::Vector2f& place = pieces_[piece].places[corner % 3];
    const Eigen::Vector3f shading =
        has_hard_edges ? normal_at(mesh_, {pieces_[piece].source, place.x(), place.y(), 0}) : Eigen::Vector3f();
    const auto fits = [&](const Group& group) {
      if (has_hard_edges) return group.normal.dot(shading) > shared_normal_cosine * group.normal.norm();
      // Triangles without area fit any group, and a group of such triangles fits any triangle.
      return length == 0 || group.normal.isZero(0) ||
             group.normal.dot(normal) > crease_cosine * length * group.normal.norm();
    };
    auto group = std::find_if(groups.begin(), groups.end(), fits);
    if (group == groups.end()) group = groups.insert(group, Group{{}, Eigen::Vector3f::Zero(), piece});
    if (length > normals_[group->largest].norm()) group->largest = piece;
    if (has_hard_edges)
      group->normal += std::max(std::atan2(length, a.dot(b)), 1e-6f) * shading;
    else if (length > 0)
      group->normal += std::atan2(length, a.dot(b)) / length * normal;
    group->corners.push_back(corner);
  }

  const TriangleMesh& mesh_;
  const std::vector<Eigen::Vector3f>& positions_;
  const std::vector<Piece>& pieces_;
  std::vector<Eigen::Vector3f> normals_;  // their length is twice the area
  std::vector<std::uint8_t> on_border_;
};

/// Averages `albedo` over the triangles at each point, weighted by the point's share in interpolation: 16 samples of
/// each triangle, at the centres of a regular subdivision.
std::vector<Eigen::Vector3f> mean_albedos(const SurfaceCache& cache, const std::vector<Piece>& pieces,
                                          const PointMaker& maker, const AlbedoAt& albedo_at) {
  constexpr int rows = 4;
  std::vector<Eigen::Vector3f> sums(cache.size(), Eigen::Vector3f::Zero());
  std::vector<float> weights(cache.size(), 0.f);
  for (std::size_t t = 0; t < pieces.size(); ++t) {
    const Piece& piece = pieces[t];
    // A triangle without area counts only if the point has no other.
    const float area = std::max(maker.double_area(t), 1e-30f);
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < 2 * (rows - i) - 1; ++j) {
        const bool turned = j % 2 != 0;
        const float u = (static_cast<float>(i) + (turned ? 2.f : 1.f) / 3) / rows,
                    v = (static_cast<float>(j / 2) + (turned ? 2.f : 1.f) / 3) / rows;
        const float hats[3] = {1 - u - v, u, v};
        const Eigen::Vector2f place = hats[0] * piece.places[0] + u * piece.places[1] + v * piece.places[2];
        const Eigen::Vector3f albedo = albedo_at(piece.source, place.x(), place.y());
        for (int k = 0; k < 3; ++k) {
          sums[cache.points[t][k]] += hats[k] * area * albedo;
          weights[cache.points[t][k]] += hats[k] * area;
        }
      }
  }
  for (std::size_t p = 0; p < sums.size(); ++p) sums[p] /= weights[p];
  return sums;
}

}  // namespace

SurfaceCache make_surface_cache(const TriangleMesh& mesh, const AlbedoAt& albedo_at, bool grey, double longest_edge) {
  SurfaceCache cache;

  // Step 1: cut the triangles.
  cache.positions = mesh.positions;
  std::vector<Piece> pieces;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    pieces.push_back({mesh.triangles[t], t, {Eigen::Vector2f(0, 0), {1, 0}, {0, 1}}});
  cut_long_edges(cache.positions, pieces, static_cast<float>(longest_edge) * bounding_box(mesh).diagonal());
  for (const Piece& piece : pieces) cache.triangles.push_back(piece.corners);

  // Step 2: make the points.
  const PointMaker maker(mesh, cache.positions, pieces);
  maker.make(cache);
  cache.point_albedos = mean_albedos(cache, pieces, maker, albedo_at);
  cache.grey = grey;
  return cache;
}

}  // namespace kiln
