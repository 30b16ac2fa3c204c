// SPDX-License-Identifier: MIT
#include "runtime/shadow/placed_nodes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kiln {

BoundingBall bounding_ball(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> points;
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) points.push_back(mesh.positions[vertex].cast<double>());
  if (points.empty()) return {};
  Eigen::Vector3d centre = bounding_box(mesh).centre().cast<double>();
  const auto farthest = [&] {
    return *std::max_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
      return (a - centre).squaredNorm() < (b - centre).squaredNorm();
    });
  };
  BoundingBall best{centre, (farthest() - centre).norm()};
  constexpr int steps = 64;
  for (int step = 1; step <= steps; ++step) {
    centre += (farthest() - centre) / (step + 1);
    const double radius = (farthest() - centre).norm();
    if (radius < best.radius) best = {centre, radius};
  }
  best.radius *= 1 + 1e-6;  // for what float32 rounds off places
  return best;
}

BoundingBall bounding_ball(std::span<const BoundingBall> balls) {
  BoundingBall all;
  for (const BoundingBall& ball : balls) {
    if (ball.radius < 0) continue;
    const Eigen::Vector3d away = ball.centre - all.centre;
    const double distance = away.norm();
    if (all.radius < 0 || distance + all.radius <= ball.radius) {
      all = ball;
    } else if (distance + ball.radius > all.radius) {
      const double radius = 0.5 * (distance + all.radius + ball.radius);
      all = {all.centre + (radius - all.radius) / distance * away, radius};
    }
  }
  return all;
}

ViewCone cone_of(const BoundingBall& ball, const Eigen::Vector3d& point) {
  const Eigen::Vector3d away = ball.centre - point;
  const double distance = away.norm();
  if (distance <= ball.radius) return {Eigen::Vector3d::UnitZ(), std::numbers::pi, distance};
  return {away / distance, std::asin(ball.radius / distance), distance};
}

std::vector<PlacedNode> place_nodes(const SceneTree& tree, std::span<const BoundingBall> balls,
                                    std::span<const double> silhouettes, const ScenePoses& poses) {
  std::vector<PlacedNode> placed(tree.nodes.size());
  // Children stand behind their parents.
  for (std::size_t k = tree.nodes.size(); k-- > 0;) {
    const SceneNode& node = tree.nodes[k];
    placed[k].has_static = node.is_static;
    if (node.asset >= 0) {
      const auto asset = static_cast<std::size_t>(node.asset);
      placed[k].ball = {poses[k].to_scene(balls[asset].centre), poses[k].scale * balls[asset].radius};
      placed[k].silhouette = poses[k].scale * silhouettes[asset];
      continue;
    }
    std::vector<BoundingBall> inner;
    double areas = 0;
    for (const int child : node.children) {
      const PlacedNode& under = placed[static_cast<std::size_t>(child)];
      inner.push_back(under.ball);
      areas += under.silhouette * under.silhouette;
      placed[k].has_static |= under.has_static;
    }
    placed[k].ball = bounding_ball(inner);
    placed[k].silhouette = std::min(std::sqrt(areas), std::max(0.0, placed[k].ball.radius));
  }
  return placed;
}

bool is_under(const SceneTree& tree, int node, int other) {
  while (node >= 0 && node != other) node = tree.nodes[static_cast<std::size_t>(node)].parent;
  return node >= 0;
}

std::vector<int> meshes_under(const SceneTree& tree, int node) {
  const SceneNode& top = tree.nodes[static_cast<std::size_t>(node)];
  if (top.asset >= 0) return {node};
  std::vector<int> meshes;
  for (const int child : top.children) {
    const std::vector<int> under = meshes_under(tree, child);
    meshes.insert(meshes.end(), under.begin(), under.end());
  }
  return meshes;
}

}  // namespace kiln
