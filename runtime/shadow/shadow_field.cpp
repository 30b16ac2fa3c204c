// SPDX-License-Identifier: MIT
#include "runtime/shadow/shadow_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "base/parallel.h"
#include "sh/basis.h"
#include "sh/lights.h"

namespace kiln {

namespace {

using std::numbers::pi;
constexpr double innermost = 1.02, outermost = 8;  // in radii of the ball

/// Shells are even steps of the logarithm of the distance to a ball of 0.9 radii: dense near the object.
constexpr double inner_ball = 0.9;
const double steps_of_all = std::log((outermost - inner_ball) / (innermost - inner_ball));

/// The radius of a shell, in radii of the ball.
double shell_radius(int shell, int shells) {
  return inner_ball + (innermost - inner_ball) * std::exp(steps_of_all * shell / (shells - 1));
}

}  // namespace

ShadowField::ShadowField(const RayOccluder& mesh, const BoundingBall& ball, double silhouette, int bands)
    : ball_(ball), silhouette_(silhouette), bands_(bands), coefficients_(coefficient_count(bands)) {
  constexpr int directions = 1024;
  const DirectionSet set = sphere_directions(directions, bands);
  values_.resize(static_cast<std::size_t>(shells * latitudes * azimuths * coefficients_));
  parallel_for(0, shells * latitudes * azimuths, [&](int index) {
    const int azimuth = index % azimuths, latitude = index / azimuths % latitudes,
              shell = index / (azimuths * latitudes);
    const double theta = pi * latitude / (latitudes - 1), phi = 2 * pi * azimuth / azimuths;
    const Eigen::Vector3d point = ball_.centre + ball_.radius * shell_radius(shell, shells) *
                                                     Eigen::Vector3d(std::sin(theta) * std::cos(phi), std::cos(theta),
                                                                     std::sin(theta) * std::sin(phi));
    std::vector<std::uint8_t> blocked(set.count(), 0);
    std::vector<std::uint32_t> tested;
    const ViewCone cone = cone_of(ball_, point);
    find_in_cone(set, cone.axis.cast<float>(), static_cast<float>(cone.half_angle), blocked, tested);
    mesh.block({}, point, set, tested, {}, blocked);
    std::vector<double> sum(static_cast<std::size_t>(coefficients_), 0.0);
    for (const std::uint32_t d : tested) {
      if (blocked[d] == 0) continue;
      const std::span<const float> row = set.row(d);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += static_cast<double>(row[i]);
    }
    float* values = values_.data() + static_cast<std::size_t>(index * coefficients_);
    for (std::size_t i = 0; i < sum.size(); ++i) values[i] = static_cast<float>(-4 * pi / directions * sum[i]);
    values[0] += static_cast<float>(std::sqrt(4 * pi));
  });
}

std::vector<float> ShadowField::visibility(const Eigen::Vector3d& point) const {
  std::vector<float> visibility(static_cast<std::size_t>(coefficients_), 0.f);
  const Eigen::Vector3d away = point - ball_.centre;
  const double distance = away.norm(), radii = distance / ball_.radius;
  if (radii >= outermost) {
    const double half_angle = std::asin(std::min(1.0, silhouette_ / distance)), sine = std::sin(half_angle);
    const std::vector<double> zonal = cone_bands(bands_, half_angle);  // of a radiance of 1 / sin^2
    const ShBasis basis(bands_);
    std::vector<double> values(visibility.size());
    basis.evaluate<double>(-away / distance, values);
    for (std::size_t i = 0; i < values.size(); ++i)
      visibility[i] =
          static_cast<float>((i == 0 ? std::sqrt(4 * pi) : 0) -
                             sine * sine * zonal[static_cast<std::size_t>(band_of(static_cast<int>(i)))] * values[i]);
    return visibility;
  }
  const double shell_place =
      std::log((std::max(radii, innermost) - inner_ball) / (innermost - inner_ball)) / steps_of_all * (shells - 1);
  const double latitude_place =
      (distance > 0 ? std::acos(std::clamp(away.y() / distance, -1.0, 1.0)) : 0) / pi * (latitudes - 1);
  double azimuth_place = std::atan2(away.z(), away.x()) / (2 * pi) * azimuths;
  if (azimuth_place < 0) azimuth_place += azimuths;
  const int shell = std::min(static_cast<int>(shell_place), shells - 2),
            latitude = std::min(static_cast<int>(latitude_place), latitudes - 2),
            azimuth = static_cast<int>(azimuth_place) % azimuths;
  const double s = shell_place - shell, t = latitude_place - latitude, u = azimuth_place - std::floor(azimuth_place);
  for (int corner = 0; corner < 8; ++corner) {
    const int a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
    const auto weight = static_cast<float>((a != 0 ? s : 1 - s) * (b != 0 ? t : 1 - t) * (c != 0 ? u : 1 - u));
    const float* values = at(shell + a, latitude + b, (azimuth + c) % azimuths);
    for (std::size_t i = 0; i < visibility.size(); ++i) visibility[i] += weight * values[i];
  }
  return visibility;
}

}  // namespace kiln
