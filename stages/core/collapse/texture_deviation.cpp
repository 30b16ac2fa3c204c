// SPDX-License-Identifier: GPL-3.0-or-later
// J. Cohen, M. Olano, D. Manocha: Appearance-Preserving Simplification. SIGGRAPH 1998. Their bound is over all points
// of the overlay of both meshes in the plane; ours is sampled, and the levels are measured at every texel afterwards.
#include "collapse/texture_deviation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/triangle_edges.h"

namespace kiln {

namespace {

constexpr double least_cosine = 0.2;               // between a triangle's normals before and after a collapse
constexpr double least_texture_height = 1 / 16.0;  // of a triangle in the atlas, texels

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

template <class Vector>
double longest_side(const std::array<Vector, 3>& corners) {
  return std::sqrt(std::max({(corners[1] - corners[0]).squaredNorm(), (corners[2] - corners[1]).squaredNorm(),
                             (corners[0] - corners[2]).squaredNorm()}));
}

double twice_area(const std::array<Eigen::Vector2d, 3>& corners) {
  return cross(corners[1] - corners[0], corners[2] - corners[0]);
}

Eigen::Vector3d normal_of(const std::array<Eigen::Vector3d, 3>& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]);
}

/// Finds the weights of the corners at the point of a triangle that is nearest to another in the plane.
std::array<double, 3> nearest_weights(const Eigen::Vector2d& point, const std::array<Eigen::Vector2d, 3>& corners,
                                      double& squared_distance) {
  const double area = twice_area(corners);
  std::array<double, 3> weights{};
  bool inside = area != 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2d &a = corners[(k + 1) % 3], &b = corners[(k + 2) % 3];
    weights[k] = area == 0 ? 0 : cross(b - a, point - a) / area;
    inside = inside && weights[k] >= 0;
  }
  squared_distance = 0;
  if (inside) return weights;
  squared_distance = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2d &a = corners[k], &b = corners[(k + 1) % 3], along = b - a;
    const double length = along.squaredNorm();
    const double place = length > 0 ? std::clamp((point - a).dot(along) / length, 0.0, 1.0) : 0;
    const double squared = (a + place * along - point).squaredNorm();
    if (squared >= squared_distance) continue;
    squared_distance = squared;
    weights = {};
    weights[k] = 1 - place;
    weights[(k + 1) % 3] = place;
  }
  return weights;
}

/// Edge in the atlas and in space.
struct Edge {
  Eigen::Vector2d from_uv, to_uv;
  Eigen::Vector3d from, to;
};

/// Returns the squared distance in space of two edges at the uv where they cross; 0 where they do not.
double squared_distance_at_crossing(const Edge& a, const Edge& b) {
  const Eigen::Vector2d along_a = a.to_uv - a.from_uv, along_b = b.to_uv - b.from_uv, between = b.from_uv - a.from_uv;
  const double turn = cross(along_a, along_b);
  if (turn == 0) return 0;
  const double place_a = cross(between, along_b) / turn, place_b = cross(between, along_a) / turn;
  if (!(place_a >= 0 && place_a <= 1 && place_b >= 0 && place_b <= 1)) return 0;
  return (a.from + place_a * (a.to - a.from) - b.from - place_b * (b.to - b.from)).squaredNorm();
}

}  // namespace

TextureDeviation::TextureDeviation(const TriangleMesh& mesh, Extent size) : samples_in_(mesh.triangles.size()) {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    uvs_.emplace_back(mesh.uvs[v].x() * size.width, mesh.uvs[v].y() * size.height);
    positions_.emplace_back(mesh.positions[v].cast<double>());
    normals_.emplace_back(mesh.normals.empty() ? Eigen::Vector3d::Zero().eval() : mesh.normals[v].cast<double>());
    samples_.push_back({uvs_.back(), positions_.back(), normals_.back().cast<float>(), 0, 0});
  }
  const BoundingBox box = bounding_box(mesh);
  least_height_ = 2 * box.sides().maxCoeff() / 65'535.0;  // two steps of the file

  // Give each triangle's area to its vertices and the middles of its sides. Two triangles have one sample of their edge
  // where it lies on no seam; two, at the same place, where it does.
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t wedge : triangle) samples_[wedge].weight += area_normal(mesh, triangle).norm() / 12;
  TriangleEdges(mesh.triangles).for_each([&](std::span<const std::uint32_t> sides) {
    const std::uint32_t a = vertex_at(mesh.triangles, sides[0]), b = vertex_at(mesh.triangles, next_corner(sides[0]));
    Sample sample{(uvs_[a] + uvs_[b]) / 2, (positions_[a] + positions_[b]) / 2,
                  (normals_[a] + normals_[b]).cast<float>(), 0, 0};
    for (const std::uint32_t side : sides) sample.weight += area_normal(mesh, mesh.triangles[side / 3]).norm() / 12;
    samples_in_[sides[0] / 3].push_back(static_cast<std::uint32_t>(samples_.size()));
    samples_.push_back(sample);
  });
}

bool TextureDeviation::shape_is_kept(const NewTriangle& changed, const Triangle& wedges, const Triangle& before) const {
  // In the atlas: of the same side up, and not too thin.
  const std::array<Eigen::Vector2d, 3> old_uvs = {uvs_[before[0]], uvs_[before[1]], uvs_[before[2]]};
  const double old_area = twice_area(old_uvs), area = twice_area(changed.uvs);
  if (old_area * area < 0 || area == 0) return false;
  const double least = std::min(least_texture_height, 0.5 * std::abs(old_area) / longest_side(old_uvs));
  if (std::abs(area) < least * longest_side(changed.uvs)) return false;

  // In space: turned neither from how it was nor from what it is shaded by, and not too thin.
  const std::array<Eigen::Vector3d, 3> old_positions = {positions_[before[0]], positions_[before[1]],
                                                        positions_[before[2]]};
  const Eigen::Vector3d old_normal = normal_of(old_positions), normal = normal_of(changed.positions);
  if (normal.dot(old_normal) < least_cosine * normal.norm() * old_normal.norm()) return false;
  const auto shading = [&](const Triangle& t) { return (normals_[t[0]] + normals_[t[1]] + normals_[t[2]]).eval(); };
  if (normal.dot(shading(wedges)) < 0 && old_normal.dot(shading(before)) >= 0) return false;
  const double old_height = old_normal.norm() / longest_side(old_positions);
  return normal.norm() >= std::min(least_height_, 0.5 * old_height) * longest_side(changed.positions);
}

TextureDeviation::Move TextureDeviation::nearest(const Sample& sample,
                                                 const std::vector<NewTriangle>& triangles) const {
  Move best;
  double least = std::numeric_limits<double>::infinity();
  for (const NewTriangle& candidate : triangles) {
    double squared = 0;
    const std::array<double, 3> weights = nearest_weights(sample.uv, candidate.uvs, squared);
    if (squared >= least) continue;
    least = squared;
    const Eigen::Vector3d place =
        weights[0] * candidate.positions[0] + weights[1] * candidate.positions[1] + weights[2] * candidate.positions[2];
    best.triangle = candidate.triangle;
    best.squared = (place - sample.position).squaredNorm();
    if (squared == 0) break;
  }
  return best;
}

/// Lists the triangles of a sector as the collapse leaves them. Returns false where it may not.
bool TextureDeviation::make_triangles(const WedgeMesh& wedges, const WedgeCollapse& collapse,
                                      const WedgeCollapse::Sector& sector, std::vector<NewTriangle>& made) const {
  made.clear();
  for (const std::uint32_t t : sector.triangles) {
    const Triangle& before = wedges.wedges(t);
    if (wedges.point_of(before[0]) == collapse.to || wedges.point_of(before[1]) == collapse.to ||
        wedges.point_of(before[2]) == collapse.to)
      continue;
    Triangle after = before;
    after[wedges.corner_at(t, collapse.from)] = sector.to_wedge;
    NewTriangle& triangle = made.emplace_back();
    triangle.triangle = t;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.uvs[k] = uvs_[after[k]];
      triangle.positions[k] = positions_[after[k]];
    }
    if (!shape_is_kept(triangle, after, before)) return false;
  }
  return !made.empty();
}

/// Returns the largest squared distance of new edges from vanishing ones where they cross in the atlas: there a
/// collapse alone moves the surface most ([Cohen 1998], section 4).
double TextureDeviation::distance_at_crossings(const WedgeMesh& wedges, const WedgeCollapse::Sector& sector,
                                               const std::vector<NewTriangle>& made) const {
  double worst = 0;
  for (const std::uint32_t t : sector.triangles)
    for (const std::uint32_t wedge : wedges.wedges(t)) {
      const Edge gone{uvs_[sector.from_wedge], uvs_[wedge], positions_[sector.from_wedge], positions_[wedge]};
      for (const NewTriangle& triangle : made)
        for (std::size_t k = 0; k < 3; ++k)
          worst =
              std::max(worst, squared_distance_at_crossing(gone, {uvs_[sector.to_wedge], triangle.uvs[k],
                                                                  positions_[sector.to_wedge], triangle.positions[k]}));
    }
  return worst;
}

DeviationChange TextureDeviation::judge(const WedgeMesh& wedges, const WedgeCollapse& collapse,
                                        double most_cost) const {
  const auto cubed = [](double squared) { return squared * std::sqrt(squared); };
  DeviationChange change;
  std::vector<std::vector<NewTriangle>> made(collapse.sectors.size());
  for (std::size_t s = 0; s < made.size(); ++s)
    if (!make_triangles(wedges, collapse, collapse.sectors[s], made[s])) return change;

  // The cost ends at what all samples take from it where each is as near as can be; stop where that is too much.
  for (const WedgeCollapse::Sector& sector : collapse.sectors) {
    for (const std::uint32_t t : sector.triangles)
      for (const std::uint32_t index : samples_in_[t])
        change.cost -= samples_[index].weight * cubed(samples_[index].squared);
    change.cost -= samples_[sector.from_wedge].weight * cubed(samples_[sector.from_wedge].squared);
  }
  double worst = 0;
  for (std::size_t s = 0; s < made.size(); ++s) {
    const WedgeCollapse::Sector& sector = collapse.sectors[s];
    const auto add = [&](std::uint32_t index) {
      const Move move = nearest(samples_[index], made[s]);
      change.cost += samples_[index].weight * cubed(move.squared);
      worst = std::max(worst, move.squared);
      return change.cost < most_cost;
    };
    if (!add(sector.from_wedge)) return change;
    for (const std::uint32_t t : sector.triangles)
      for (const std::uint32_t index : samples_in_[t])
        if (!add(index)) return change;
  }
  for (std::size_t s = 0; s < made.size(); ++s)
    worst = std::max(worst, distance_at_crossings(wedges, collapse.sectors[s], made[s]));
  change.allowed = true;
  change.worst = std::sqrt(worst);
  return change;
}

void TextureDeviation::apply(const WedgeMesh& wedges, const WedgeCollapse& collapse) {
  std::vector<Move> moves;
  std::vector<NewTriangle> made;
  for (const WedgeCollapse::Sector& sector : collapse.sectors) {
    make_triangles(wedges, collapse, sector, made);
    const auto move_one = [&](std::uint32_t index) {
      moves.push_back(nearest(samples_[index], made));
      moves.back().sample = index;
    };
    for (const std::uint32_t t : sector.triangles) {
      for (const std::uint32_t index : samples_in_[t]) move_one(index);
      samples_in_[t].clear();
    }
    move_one(sector.from_wedge);
  }
  for (const Move& move : moves) {
    samples_in_[move.triangle].push_back(move.sample);
    samples_[move.sample].squared = move.squared;
  }
}

std::vector<PlacedSample> TextureDeviation::placed_samples(const WedgeMesh& wedges) const {
  std::vector<PlacedSample> placed;
  placed.reserve(samples_.size());
  const auto place = [&](std::uint32_t index, const Triangle& triangle, const std::array<double, 3>& weights) {
    const Sample& sample = samples_[index];
    placed.push_back({triangle, weights, sample.position, sample.normal.cast<double>(), sample.weight});
  };
  std::vector<std::uint8_t> is_placed(uvs_.size(), 0);
  for (std::uint32_t t = 0; t < samples_in_.size(); ++t) {
    if (!wedges.is_there(t)) continue;
    const Triangle& triangle = wedges.wedges(t);
    for (std::size_t k = 0; k < 3; ++k) {
      if (is_placed[triangle[k]]++ != 0) continue;
      std::array<double, 3> own{};
      own[k] = 1;
      place(triangle[k], triangle, own);
    }
    for (const std::uint32_t index : samples_in_[t]) {
      double squared = 0;
      place(index, triangle,
            nearest_weights(samples_[index].uv, {uvs_[triangle[0]], uvs_[triangle[1]], uvs_[triangle[2]]}, squared));
    }
  }
  return placed;
}

}  // namespace kiln
