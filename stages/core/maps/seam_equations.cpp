// SPDX-License-Identifier: MIT
#include "maps/seam_equations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "mesh/tangent_space.h"

namespace kiln {

namespace {

/// Place of a gutter texel across its nearest seam.
struct Across {
  float distance_texels = std::numeric_limits<float>::infinity();
  std::uint32_t edge = 0;
  int side = 0;
};

/// Edge of a seam in one chart, in texels.
struct Segment {
  Eigen::Vector2f from, along;
  Eigen::Vector2f outwards;  ///< perpendicular to `along`, as long, away from its triangle

  Segment(const Seams& seams, const Seams::Edge& edge, int side) {
    const TriangleMesh& mesh = seams.atlas();
    const Eigen::Vector2f size(static_cast<float>(seams.width()), static_cast<float>(seams.height()));
    const auto corner = [&](int k) -> Eigen::Vector2f {
      return mesh.uvs[mesh.triangles[edge.triangles[static_cast<std::size_t>(side)]][static_cast<std::size_t>(k)]]
          .cwiseProduct(size);
    };
    const auto& corners = edge.corners[static_cast<std::size_t>(side)];
    from = corner(corners[0]);
    along = corner(corners[1]) - from;
    outwards = {-along.y(), along.x()};
    if (outwards.dot(corner(3 - corners[0] - corners[1]) - from) > 0) outwards = -outwards;
  }

  /// Returns coordinates of a point (texels) relative to the edge, in lengths of the edge: along it (0 to 1) and
  /// outwards.
  Eigen::Vector2f coordinates(const Eigen::Vector2f& point) const {
    const float squared = along.squaredNorm();
    if (!(squared > 0)) return {0, std::numeric_limits<float>::infinity()};
    return Eigen::Vector2f(along.dot(point - from), outwards.dot(point - from)) / squared;
  }

  float distance(const Eigen::Vector2f& point) const {
    const float squared = along.squaredNorm();
    const float s = squared > 0 ? std::clamp(along.dot(point - from) / squared, 0.0f, 1.0f) : 0.0f;
    return (from + s * along - point).norm();
  }
};

/// Finds the nearest seam of every unknown texel that is not covered.
std::vector<Across> nearest_seams(const Seams& seams, std::span<const std::uint8_t> covered,
                                  const SeamUnknowns& unknowns) {
  const std::span<const std::uint32_t> number = unknowns.number;
  std::vector<Across> nearest(unknowns.texels.size());
  for (std::uint32_t e = 0; e < seams.edges().size(); ++e)
    for (int side = 0; side < 2; ++side) {
      const Segment segment(seams, seams.edges()[e], side);
      // Walk over the texels about the edge along its longer direction.
      const int steps = std::max(1, static_cast<int>(std::ceil(segment.along.norm())));
      for (int k = 0; k <= steps; ++k) {
        const Eigen::Vector2f at = segment.from + static_cast<float>(k) / static_cast<float>(steps) * segment.along;
        const int column = static_cast<int>(std::floor(at.x())), row = static_cast<int>(std::floor(at.y()));
        for (int j = std::max(0, row - 2); j <= std::min(seams.height() - 1, row + 2); ++j)
          for (int i = std::max(0, column - 2); i <= std::min(seams.width() - 1, column + 2); ++i) {
            const std::size_t texel =
                static_cast<std::size_t>(j) * static_cast<std::size_t>(seams.width()) + static_cast<std::size_t>(i);
            if (number[texel] == SeamUnknowns::none || covered[texel] != 0) continue;
            const float distance = segment.distance({static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f});
            Across& best = nearest[number[texel]];
            if (distance < best.distance_texels) best = {distance, e, side};
          }
      }
    }
  return nearest;
}

/// Sets `frame` to the tangent frame at a point of a seam's edge, `along` from its first end (0) to its second (1).
void set_frame_at_edge(const Seams& seams, std::span<const TangentFrame> frames, const Seams::Edge& edge, int side,
                       float along, Eigen::Matrix3d& frame) {
  const Triangle& t = seams.atlas().triangles[edge.triangles[static_cast<std::size_t>(side)]];
  const auto& corners = edge.corners[static_cast<std::size_t>(side)];
  const Eigen::Vector3f normal =
      (1 - along) * seams.atlas().normals[t[corners[0]]] + along * seams.atlas().normals[t[corners[1]]];
  const TangentFrame at_edge{(1 - along) * frames[t[corners[0]]].tangent + along * frames[t[corners[1]]].tangent,
                             frames[t[corners[0]]].sign};
  for (int axis = 0; axis < 3; ++axis)
    frame.col(axis) = to_object_space(Eigen::Vector3f::Unit(axis), normal, at_edge).cast<double>();
}

/// Makes the equation of one gutter texel; nothing where its nearest edge has no length.
std::optional<SeamEquation> gutter_equation(const Seams& seams, std::span<const TangentFrame> frames,
                                            std::uint32_t texel, const Across& nearest, double weight) {
  const Seams::Edge& edge = seams.edges()[nearest.edge];
  const int side = nearest.side, other = 1 - side;
  const Segment here(seams, edge, side), there(seams, edge, other);
  const auto width = static_cast<std::uint32_t>(seams.width());
  const auto column = static_cast<float>(texel % width), row = static_cast<float>(texel / width);
  const Eigen::Vector2f place = here.coordinates({column + 0.5f, row + 0.5f});
  if (!place.allFinite()) return std::nullopt;
  const Eigen::Vector2f at = there.from + place.x() * there.along - place.y() * there.outwards;
  const Eigen::Vector2f size(static_cast<float>(seams.width()), static_cast<float>(seams.height()));
  const Footprint footprint(at.cwiseQuotient(size), seams.width(), seams.height());
  SeamEquation equation;
  equation.weight = weight;
  equation.terms.push_back({texel, 1, 0});
  for (std::size_t n = 0; n < 4; ++n)
    if (footprint.weights[n] > 0) equation.terms.push_back({footprint.texels[n], -footprint.weights[n], 1});
  // Take both frames at the edge: beyond it there are none.
  for (int s = 0; s < 2; ++s) {
    Eigen::Matrix3d& frame = equation.frames[static_cast<std::size_t>(s)];
    frame.setIdentity();
    if (!frames.empty())
      set_frame_at_edge(seams, frames, edge, s == 0 ? side : other, std::clamp(place.x(), 0.0f, 1.0f), frame);
  }
  return equation;
}

}  // namespace

std::vector<SeamEquation> point_equations(const Seams& seams, std::span<const SeamPoint> points, NormalSpace space) {
  const TriangleMesh& mesh = seams.atlas();
  const std::vector<TangentFrame> frames =
      space == NormalSpace::tangent ? tangent_frames(mesh) : std::vector<TangentFrame>{};
  std::vector<SeamEquation> equations;
  for (const SeamPoint& point : points) {
    SeamEquation equation;
    equation.weight = static_cast<double>(point.length_texels);
    for (int side = 0; side < 2; ++side) {
      const SeamSide& at = point.sides[static_cast<std::size_t>(side)];
      Eigen::Matrix3d& frame = equation.frames[static_cast<std::size_t>(side)];
      frame.setIdentity();
      if (space == NormalSpace::tangent)
        for (int axis = 0; axis < 3; ++axis)
          frame.col(axis) = to_object_space(Eigen::Vector3f::Unit(axis), interpolate(mesh, mesh.normals, at.source),
                                            interpolate(mesh, frames, at.source))
                                .cast<double>();
      for (std::size_t k = 0; k < 4; ++k)
        if (at.footprint.weights[k] > 0)
          equation.terms.push_back(
              {at.footprint.texels[k], (side == 0 ? 1.0 : -1.0) * static_cast<double>(at.footprint.weights[k]), side});
    }
    equations.push_back(std::move(equation));
  }
  return equations;
}

SeamUnknowns::SeamUnknowns(std::span<const SeamEquation> equations, std::size_t count) : number(count, none) {
  for (const SeamEquation& equation : equations)
    for (const SeamEquation::Term& term : equation.terms) number[term.texel] = 0;
  for (std::uint32_t texel = 0; texel < number.size(); ++texel)
    if (number[texel] == 0) {
      number[texel] = static_cast<std::uint32_t>(texels.size());
      texels.push_back(texel);
    }
}

std::vector<SeamEquation> gutter_equations(const Seams& seams, std::span<const std::uint8_t> covered,
                                           const SeamUnknowns& unknowns, NormalSpace space, double weight) {
  const std::vector<Across> nearest = nearest_seams(seams, covered, unknowns);
  const std::vector<TangentFrame> frames =
      space == NormalSpace::tangent ? tangent_frames(seams.atlas()) : std::vector<TangentFrame>{};
  std::vector<SeamEquation> equations;
  for (std::size_t k = 0; k < unknowns.texels.size(); ++k) {
    if (!std::isfinite(nearest[k].distance_texels)) continue;
    std::optional<SeamEquation> equation = gutter_equation(seams, frames, unknowns.texels[k], nearest[k], weight);
    if (equation) equations.push_back(std::move(*equation));
  }
  return equations;
}

}  // namespace kiln
