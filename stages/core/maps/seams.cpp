// SPDX-License-Identifier: MIT
#include "maps/seams.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mesh/same_position.h"
#include "mesh/tangent_space.h"
#include "mesh/triangle_edges.h"

namespace kiln {

namespace {

/// Side of a triangle, from the end whose position comes first among the vertices to the other.
struct HalfEdge {
  std::uint32_t triangle = 0;
  std::array<std::uint8_t, 2> corners{};
  bool forwards = false;  ///< the triangle runs from the first end to the second
};

HalfEdge half_edge(std::span<const Triangle> welded, std::uint32_t side) {
  const auto corner = static_cast<std::uint8_t>(side % 3), next = static_cast<std::uint8_t>((corner + 1) % 3);
  if (vertex_at(welded, side) < vertex_at(welded, next_corner(side))) return {side / 3, {corner, next}, true};
  return {side / 3, {next, corner}, false};
}

std::uint32_t vertex_of(const TriangleMesh& mesh, const HalfEdge& half, int end) {
  return mesh.triangles[half.triangle][half.corners[static_cast<std::size_t>(end)]];
}

bool is_seam(const TriangleMesh& mesh, const HalfEdge& a, const HalfEdge& b) {
  for (int end = 0; end < 2; ++end)
    if (mesh.uvs[vertex_of(mesh, a, end)] != mesh.uvs[vertex_of(mesh, b, end)]) return true;
  return false;
}

/// Tells whether the normals of the two sides differ at either end, by more than a file's rounding.
bool is_hard(const TriangleMesh& mesh, const HalfEdge& a, const HalfEdge& b) {
  constexpr float least_cosine = 0.9994f;  // 2 degrees
  if (mesh.normals.empty()) return false;
  for (int end = 0; end < 2; ++end)
    if (mesh.normals[vertex_of(mesh, a, end)].dot(mesh.normals[vertex_of(mesh, b, end)]) < least_cosine) return true;
  return false;
}

/// Scores how well the normals of both sides agree at the edge's ends.
float agreement(const TriangleMesh& mesh, const HalfEdge& a, const HalfEdge& b) {
  if (mesh.normals.empty()) return 0;
  float sum = 0;
  for (int end = 0; end < 2; ++end)
    sum += mesh.normals[vertex_of(mesh, a, end)].dot(mesh.normals[vertex_of(mesh, b, end)]);
  return sum;
}

TexelSource source_at(const std::array<std::uint8_t, 2>& corners, std::uint32_t triangle, float along) {
  std::array<float, 3> weights{};
  weights[corners[0]] = 1 - along;
  weights[corners[1]] = along;
  return {triangle, weights[1], weights[2]};
}

}  // namespace

Footprint::Footprint(const Eigen::Vector2f& uv, int width, int height) {
  const float x = uv.x() * static_cast<float>(width) - 0.5f, y = uv.y() * static_cast<float>(height) - 0.5f;
  const float left = std::floor(x), bottom = std::floor(y);
  const float s = x - left, t = y - bottom;
  const auto column = [&](int offset) { return std::clamp(static_cast<int>(left) + offset, 0, width - 1); };
  const auto row = [&](int offset) { return std::clamp(static_cast<int>(bottom) + offset, 0, height - 1); };
  const auto texel = [&](int i, int j) {
    return static_cast<std::uint32_t>(j) * static_cast<std::uint32_t>(width) + static_cast<std::uint32_t>(i);
  };
  texels = {texel(column(0), row(0)), texel(column(1), row(0)), texel(column(0), row(1)), texel(column(1), row(1))};
  weights = {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
}

double Footprint::lookup(const Image<float>& image, int channel) const {
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k)
    sum += static_cast<double>(weights[k]) *
           image.values()[static_cast<std::size_t>(texels[k]) * static_cast<std::size_t>(image.channels()) +
                          static_cast<std::size_t>(channel)];
  return sum;
}

Seams::Seams(const TriangleMesh& atlas, int width, int height) : atlas_(&atlas), width_(width), height_(height) {
  if (atlas.uvs.size() != atlas.positions.size()) throw std::invalid_argument("Seams: a mesh with uvs is needed");
  const std::vector<Triangle> welded = renumbered(atlas.triangles, first_at_position(atlas.positions));
  const auto add = [&](const HalfEdge& a, const HalfEdge& b) {
    if (is_seam(atlas, a, b) && !is_hard(atlas, a, b))
      edges_.push_back({{a.triangle, b.triangle}, {a.corners, b.corners}});
  };
  TriangleEdges(welded).for_each([&](std::span<const std::uint32_t> sides) {
    const EdgeKey ends = edge_at(welded, sides[0]);
    if (ends.first == ends.second) return;
    std::vector<HalfEdge> halves;
    for (const std::uint32_t side : sides) halves.push_back(half_edge(welded, side));
    if (halves.size() == 2) return add(halves[0], halves[1]);
    // Where sheets touch in one edge, pair the sides that run against each other with the same normals: these continue
    // one another.
    for (const HalfEdge& a : halves) {
      if (!a.forwards) continue;
      const HalfEdge* best = nullptr;
      for (const HalfEdge& b : halves)
        if (!b.forwards && (best == nullptr || agreement(atlas, a, b) > agreement(atlas, a, *best))) best = &b;
      if (best != nullptr) add(a, *best);
    }
  });
}

std::vector<SeamPoint> Seams::points(double per_texel) const {
  std::vector<SeamPoint> points;
  const Eigen::Vector2f size(static_cast<float>(width_), static_cast<float>(height_));
  for (const Edge& edge : edges_) {
    std::array<std::array<Eigen::Vector2f, 2>, 2> uv;
    float length = 0;
    for (std::size_t side = 0; side < 2; ++side) {
      const Triangle& t = atlas_->triangles[edge.triangles[side]];
      for (std::size_t end = 0; end < 2; ++end) uv[side][end] = atlas_->uvs[t[edge.corners[side][end]]];
      length = std::max(length, (uv[side][1] - uv[side][0]).cwiseProduct(size).norm());
    }
    const int steps = std::max(1, static_cast<int>(std::ceil(length * per_texel)));
    for (int k = 0; k <= steps; ++k) {
      const float along = static_cast<float>(k) / static_cast<float>(steps);
      SeamPoint point;
      for (std::size_t side = 0; side < 2; ++side)
        point.sides[side] = {source_at(edge.corners[side], edge.triangles[side], along),
                             Footprint((1 - along) * uv[side][0] + along * uv[side][1], width_, height_)};
      point.length_texels = length / static_cast<float>(steps) * (k == 0 || k == steps ? 0.5f : 1.0f);
      points.push_back(point);
    }
  }
  return points;
}

void Seams::add_squared_differences(std::span<const SeamPoint> points, const Image<float>& image, int channel,
                                    std::span<double> sums) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& [a, b] = points[k].sides;
    const double difference = a.footprint.lookup(image, channel) - b.footprint.lookup(image, channel);
    sums[k] += difference * difference;
  }
}

SeamMismatch Seams::summarise(std::span<const SeamPoint> points, std::span<const double> differences) {
  SeamMismatch mismatch;
  double length = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    mismatch.mean += static_cast<double>(points[k].length_texels) * differences[k];
    mismatch.largest = std::max(mismatch.largest, differences[k]);
    length += static_cast<double>(points[k].length_texels);
  }
  mismatch.mean = length > 0 ? mismatch.mean / length : 0;
  return mismatch;
}

SeamMismatch Seams::mismatch(const Image<float>& image) const {
  const std::vector<SeamPoint> all = measuring_points();
  std::vector<double> differences(all.size(), 0);
  for (int channel = 0; channel < image.channels(); ++channel)
    add_squared_differences(all, image, channel, differences);
  for (double& difference : differences) difference = std::sqrt(difference);
  return summarise(all, differences);
}

SeamMismatch Seams::mismatch_degrees(const Image<float>& map, NormalSpace space) const {
  const std::vector<SeamPoint> all = measuring_points();
  return summarise(all, degrees_at(all, map, space));
}

std::vector<double> Seams::degrees_at(std::span<const SeamPoint> points, const Image<float>& map,
                                      NormalSpace space) const {
  if (map.channels() != 3) throw std::invalid_argument("Seams: a normal map of three channels is needed");
  const std::vector<TangentFrame> frames =
      space == NormalSpace::tangent ? tangent_frames(*atlas_) : std::vector<TangentFrame>{};
  std::vector<double> degrees(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    std::array<Eigen::Vector3d, 2> normals;
    for (std::size_t side = 0; side < 2; ++side) {
      const SeamSide& at = points[k].sides[side];
      for (int channel = 0; channel < 3; ++channel) normals[side][channel] = at.footprint.lookup(map, channel);
      if (space == NormalSpace::tangent)
        normals[side] = to_object_space(normals[side].cast<float>(), interpolate(*atlas_, atlas_->normals, at.source),
                                        interpolate(*atlas_, frames, at.source))
                            .cast<double>();
    }
    degrees[k] = std::atan2(normals[0].cross(normals[1]).norm(), normals[0].dot(normals[1])) * 180 / std::acos(-1.0);
  }
  return degrees;
}

}  // namespace kiln
