// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/direct_light.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/parallel.h"
#include "sh/directions.h"

namespace kiln {

namespace {

/// Cap of sky that a light fills, with its radiance; of a directional light the radiance of a white surface that faces
/// it.
struct LightCap {
  Eigen::Vector3d axis;
  double half_angle = 0;  ///< radians; 0: directional
  double radiance = 1;    ///< of the colour 1
};

/// Returns the radiance of a cap of colour 1 (cone_light).
double radiance_of_cap(double half_angle) {
  const double sine = half_angle < std::numbers::pi / 2 ? std::sin(half_angle) : 1;
  return 1 / (sine * sine);
}

LightCap cap_of(const LightSpec& light, const Eigen::Vector3d& viewpoint) {
  if (light.kind == LightSpec::Kind::sphere) {
    const Eigen::Vector3d centre = Eigen::Vector3d::Map(light.position.data()), to_light = centre - viewpoint;
    const auto angle = [&](double distance) {
      return distance <= light.radius ? std::numbers::pi : std::asin(light.radius / distance);
    };
    return {to_light.stableNormalized(), angle(to_light.norm()), radiance_of_cap(angle(centre.norm()))};
  }
  const Eigen::Vector3d axis = direction_from_angles(light.azimuth_degrees, light.elevation_degrees).cast<double>();
  if (light.kind == LightSpec::Kind::directional || light.half_angle_degrees == 0) return {axis, 0, 1};
  const double half_angle = light.half_angle_degrees * std::numbers::pi / 180;
  return {axis, half_angle, radiance_of_cap(half_angle)};
}

}  // namespace

bool has_few_bands(const LightSpec& light) {
  return light.kind == LightSpec::Kind::ambient || light.kind == LightSpec::Kind::hemisphere;
}

std::vector<Eigen::Vector3f> direct_radiance(const RayScene& scene, const Receivers& receivers, const LightSpec& light,
                                             float ray_offset, std::uint64_t first, int most_places) {
  constexpr double golden_angle = 2.399963229728653;
  std::vector<Eigen::Vector3f> radiance(receivers.size());
  parallel_for(std::size_t{0}, receivers.size(), 256, [&](std::size_t r) {
    const LightCap cap = cap_of(light, receivers.positions[r].cast<double>());
    const Eigen::Vector3d across = cap.axis.unitOrthogonal(), along = cap.axis.cross(across);
    const Eigen::Vector3f origin = receivers.positions[r] + ray_offset * receivers.normals[r];
    const int places = cap.half_angle == 0 ? 1 : most_places;
    // Numbers of a low discrepancy, so that neighbours' places differ.
    const double number = static_cast<double>((first + r) % 65536), turn = number * golden_angle,
                 shift = std::fmod(number * std::numbers::phi, 1.0);
    double sum = 0;
    for (int k = 0; k < places; ++k) {
      const double cosine = 1 - (1 - std::cos(cap.half_angle)) * (k + shift) / places;
      const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)), azimuth = turn + golden_angle * k;
      const Eigen::Vector3d direction =
          cosine * cap.axis + sine * (std::cos(azimuth) * across + std::sin(azimuth) * along);
      const double facing = receivers.normals[r].cast<double>().dot(direction);
      if (facing <= 0) continue;
      const Eigen::Vector3f towards = direction.cast<float>();
      if (!scene.first_hit(origin, towards, 0, std::numeric_limits<float>::infinity()).found()) sum += facing;
    }
    // A white surface sends out the irradiance over pi; a cap has 2 pi (1 - cos) steradians.
    const double share = cap.half_angle == 0 ? 1 : 2 * (1 - std::cos(cap.half_angle)) * cap.radiance;
    for (int c = 0; c < 3; ++c)
      radiance[r][c] = static_cast<float>(share * sum / places) * light.color[static_cast<std::size_t>(c)];
  });
  return radiance;
}

}  // namespace kiln
