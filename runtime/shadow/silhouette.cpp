// SPDX-License-Identifier: MIT
#include "runtime/shadow/silhouette.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sh/directions.h"

namespace kiln {

SilhouetteRays cast_silhouettes(const RayOccluder& mesh, const BoundingBall& ball) {
  constexpr int sides = 32, places = 128;
  SilhouetteRays all;
  if (ball.radius <= 0) return all;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (const Eigen::Vector3f& side : sample_directions(Sampling::fibonacci, sides, 1)) {
    const Eigen::Vector3d direction = side.cast<double>().normalized(), across = direction.unitOrthogonal(),
                          up = direction.cross(across);
    for (int k = 0; k < places; ++k) {
      const double radius = ball.radius * std::sqrt((k + 0.5) / places);
      const Eigen::Vector3d origin = ball.centre - 2 * ball.radius * direction +
                                     radius * (std::cos(golden * k) * across + std::sin(golden * k) * up);
      all.rays.push_back({origin, direction});
      all.meets.push_back(mesh.blocks({}, origin, direction, std::numeric_limits<float>::infinity()) ? 1 : 0);
    }
  }
  return all;
}

double silhouette_radius(const SilhouetteRays& rays, const BoundingBall& ball) {
  if (rays.rays.empty()) return 0;
  const auto met = static_cast<double>(std::count(rays.meets.begin(), rays.meets.end(), 1));
  return ball.radius * std::sqrt(met / static_cast<double>(rays.rays.size()));
}

}  // namespace kiln
