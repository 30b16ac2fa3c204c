// SPDX-License-Identifier: MIT
#include "runtime/shadow/sphere_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mesh/winding.h"
#include "sh/basis.h"
#include "sh/exponential.h"

namespace kiln {

namespace {

using std::numbers::pi;

/// Returns points of a mesh's surface, evenly by area, and of a grid within it.
std::vector<Eigen::Vector3d> points_of(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> points;
  constexpr int surface_points = 2048;
  const double share = surface_area(mesh) / surface_points;
  double due = 0.5 * share;
  int places = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3d a = mesh.positions[triangle[0]].cast<double>(),
                          b = mesh.positions[triangle[1]].cast<double>(),
                          c = mesh.positions[triangle[2]].cast<double>();
    due += 0.5 * (b - a).cross(c - a).norm();
    for (; due > share && share > 0; due -= share) {
      // The additive recurrence of the plastic number spreads places over the triangle.
      ++places;
      double u = std::fmod(0.7548776662466927 * places, 1.0), v = std::fmod(0.5698402909980532 * places, 1.0);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      points.push_back(a + u * (b - a) + v * (c - a));
    }
  }
  const BoundingBox box = bounding_box(mesh);
  const double most_tests = 2e7;
  const int side = std::clamp(
      static_cast<int>(std::cbrt(most_tests / std::max(1.0, static_cast<double>(mesh.triangles.size())))), 6, 16);
  for (int k = 0; k < side * side * side; ++k) {
    const Eigen::Array3d place((k % side + 0.5) / side, (k / side % side + 0.5) / side,
                               (k / (side * side) + 0.5) / side);
    const Eigen::Vector3d point = box.lowest.cast<double>() + (place * box.sides().cast<double>().array()).matrix();
    if (winding_number(mesh, point) > 0.5) points.push_back(point);
  }
  return points;
}

/// Clusters points around `count` centres; the first are far from each other.
std::vector<std::vector<Eigen::Vector3d>> cluster(const std::vector<Eigen::Vector3d>& points, std::size_t count) {
  std::vector<Eigen::Vector3d> centres = {points.front()};
  std::vector<double> distances(points.size(), std::numeric_limits<double>::infinity());
  while (centres.size() < std::min(count, points.size())) {
    for (std::size_t k = 0; k < points.size(); ++k)
      distances[k] = std::min(distances[k], (points[k] - centres.back()).squaredNorm());
    centres.push_back(
        points[static_cast<std::size_t>(std::max_element(distances.begin(), distances.end()) - distances.begin())]);
  }
  std::vector<std::vector<Eigen::Vector3d>> clusters;
  constexpr int rounds = 12;
  for (int round = 0; round < rounds; ++round) {
    clusters.assign(centres.size(), {});
    for (const Eigen::Vector3d& point : points) {
      const auto nearest = std::min_element(centres.begin(), centres.end(), [&](const auto& a, const auto& b) {
        return (a - point).squaredNorm() < (b - point).squaredNorm();
      });
      clusters[static_cast<std::size_t>(nearest - centres.begin())].push_back(point);
    }
    for (std::size_t c = 0; c < centres.size(); ++c) {
      if (clusters[c].empty()) continue;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const Eigen::Vector3d& point : clusters[c]) sum += point;
      centres[c] = sum / static_cast<double>(clusters[c].size());
    }
  }
  return clusters;
}

bool meets(const SilhouetteRays::Ray& ray, const std::vector<BoundingBall>& balls, double factor) {
  return std::any_of(balls.begin(), balls.end(), [&](const BoundingBall& ball) {
    return (ball.centre - ray.origin).cross(ray.direction).squaredNorm() <= factor * factor * ball.radius * ball.radius;
  });
}

}  // namespace

SphereSet fit_spheres(const TriangleMesh& mesh, const SilhouetteRays& silhouettes, int count) {
  SphereSet best;
  const std::vector<Eigen::Vector3d> points = points_of(mesh);
  const auto met = static_cast<double>(std::count(silhouettes.meets.begin(), silhouettes.meets.end(), 1));
  if (points.empty() || met == 0) return best;
  best.mismatch = std::numeric_limits<double>::infinity();
  for (int clusters = count; clusters >= 1; clusters = clusters > 1 ? (clusters + 1) / 2 : 0) {
    std::vector<BoundingBall> balls;
    for (const std::vector<Eigen::Vector3d>& members : cluster(points, static_cast<std::size_t>(clusters))) {
      if (members.empty()) continue;
      BoundingBall ball{Eigen::Vector3d::Zero(), 0};
      for (const Eigen::Vector3d& point : members) ball.centre += point / static_cast<double>(members.size());
      for (const Eigen::Vector3d& point : members) ball.radius = std::max(ball.radius, (point - ball.centre).norm());
      balls.push_back(ball);
    }
    for (double factor = 0.5; factor < 1.2; factor += 0.05) {
      double differing = 0;
      for (std::size_t r = 0; r < silhouettes.rays.size(); ++r)
        differing += meets(silhouettes.rays[r], balls, factor) != (silhouettes.meets[r] != 0) ? 1 : 0;
      if (differing / met >= best.mismatch) continue;
      best = {balls, differing / met};
      for (BoundingBall& ball : best.balls) ball.radius *= factor;
    }
  }
  return best;
}

std::vector<float> log_visibility(std::span<const BoundingBall> balls, const Eigen::Vector3d& point, int bands) {
  const ShBasis basis(bands);
  const ShExponential& exponential = ShExponential::of_bands(bands);
  std::vector<double> values(static_cast<std::size_t>(basis.size())), sum(values.size(), 0.0);
  for (const BoundingBall& ball : balls) {
    const Eigen::Vector3d away = ball.centre - point;
    const double distance = away.norm();
    if (distance <= 0) continue;
    const double half_angle = distance > ball.radius ? std::asin(ball.radius / distance) : 0.5 * pi;
    const std::vector<double> zonal = exponential.ball_logarithm(half_angle);
    basis.evaluate<double>(away / distance, values);
    for (std::size_t i = 0; i < values.size(); ++i)
      sum[i] += zonal[static_cast<std::size_t>(band_of(static_cast<int>(i)))] * values[i];
  }
  return {sum.begin(), sum.end()};
}

}  // namespace kiln
