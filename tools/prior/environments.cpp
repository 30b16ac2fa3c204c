// SPDX-License-Identifier: GPL-3.0-or-later
#include "prior/environments.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "sh/basis.h"
#include "sh/quadrature.h"

namespace kiln {

namespace {

constexpr double pi = std::numbers::pi, degree = pi / 180;
constexpr double sun_half_angle = 0.2665 * degree;
constexpr std::array<float, 1> white = {1};

/// Unit vector towards azimuth and elevation, in degrees (ARCHITECTURE.md, "Contracts").
Eigen::Vector3d direction_of(double azimuth, double elevation) {
  return {std::cos(elevation * degree) * std::sin(azimuth * degree), std::sin(elevation * degree),
          std::cos(elevation * degree) * std::cos(azimuth * degree)};
}

/// Returns the luminance of a direction above the horizon, up to a factor.
double relative_luminance(const Sky& sky, const Eigen::Vector3d& direction, const Eigen::Vector3d& sun) {
  const double from_sun = std::acos(std::clamp(direction.dot(sun), -1.0, 1.0));
  const double cosine = std::cos(from_sun);
  return (1 + sky.a * std::exp(sky.b / direction.y())) *
         (1 + sky.c * (std::exp(sky.d * from_sun) - std::exp(sky.d * pi / 2)) + sky.e * cosine * cosine);
}

/// Returns the share of sunlight that the air lets through: the optical air mass is 1 / sin of the elevation.
double transmitted(double extinction, double sine) { return std::exp(-extinction / sine); }

constexpr double sunlight = 127.5;  // klx, outside the air

/// Returns a round lamp that gives a white surface that faces it the radiance `level`.
LightCoefficients lamp_light(int bands, double azimuth, double elevation, double half_angle, double level) {
  const std::array<float, 1> colour = {static_cast<float>(level)};
  return cone_light(bands, direction_of(azimuth, elevation).cast<float>(), half_angle * degree, colour);
}

/// Returns the radiance of walls and of the floor.
LightCoefficients room(int bands, float above, float below) {
  return hemisphere_light(bands, Eigen::Vector3f::UnitY(), std::array{above}, std::array{below});
}

constexpr std::array<double, 3> key_azimuths = {30, 45, 60}, rim_azimuths = {135, 155, 175};

/// Returns the arrangements of a key light, a fill light as far on the other side of the camera and a rim light, each
/// of the three made by a function of its azimuth.
template <class Key, class Fill, class Rim>
std::vector<LightCoefficients> three_point_lights(const LightCoefficients& room, Key key, Fill fill, Rim rim) {
  std::vector<LightCoefficients> lights;
  for (const double front : key_azimuths) {
    const LightCoefficients before = add_lights(room, add_lights(key(front), fill(-front)));
    for (const double back : rim_azimuths) lights.push_back(add_lights(before, rim(back)));
  }
  return lights;
}

std::vector<LightCoefficients> soft_boxes(int bands) {
  const auto box = [bands](const SoftBox& it) { return soft_box_light(bands, it); };
  return three_point_lights(
      room(bands, 0.05f, 0.05f),
      [&](double azimuth) {
        return box({azimuth, 40, 1.5, 1.2, 0.9, 1});
      },
      [&](double azimuth) {
        return box({azimuth, 15, 2, 1.5, 1.5, 0.4});
      },
      [&](double azimuth) {
        return box({azimuth, 45, 1.5, 0.3, 1.2, 0.8});
      });
}

std::vector<LightCoefficients> hard_lamps(int bands) {
  constexpr double half_angle = 3;
  return three_point_lights(
      room(bands, 0.02f, 0.02f), [&](double azimuth) { return lamp_light(bands, azimuth, 45, half_angle, 1); },
      [&](double azimuth) { return lamp_light(bands, azimuth, 20, half_angle, 0.25); },
      [&](double azimuth) { return lamp_light(bands, azimuth, 50, half_angle, 1); });
}

std::vector<LightCoefficients> product_table(int bands) {
  const LightCoefficients overhead = add_lights(room(bands, 0.1f, 0.4f), soft_box_light(bands, {0, 80, 1.2, 2, 2, 1}));
  std::vector<LightCoefficients> lights;
  for (const double azimuth : {60, 80, 100}) {
    const auto strip = [&](double side) { return soft_box_light(bands, {side * azimuth, 10, 1.2, 0.3, 1.5, 0.5}); };
    lights.push_back(add_lights(overhead, add_lights(strip(1), strip(-1))));
  }
  return lights;
}

}  // namespace

Sky clear_sky(double sun_elevation) {
  const double sine = std::sin(sun_elevation * degree);
  return {.a = -1,
          .b = -0.32,
          .c = 10,
          .d = -3,
          .e = 0.45,
          .sun_elevation = sun_elevation,
          .sky_illuminance = 0.8 + 15.5 * std::sqrt(sine),
          .sun_illuminance = sunlight * transmitted(0.21, sine)};
}

Sky partly_cloudy_sky(double sun_elevation) {
  const double sine = std::sin(sun_elevation * degree);
  return {.a = 0,
          .b = -1,
          .c = 10,
          .d = -3,
          .e = 0.45,
          .sun_elevation = sun_elevation,
          .sky_illuminance = 0.3 + 45 * sine,
          .sun_illuminance = sunlight * transmitted(0.8, sine)};
}

Sky overcast_sky(double sun_elevation) {
  return {.a = 4,
          .b = -0.7,
          .c = 0,
          .d = -1,
          .e = 0,
          .sun_elevation = sun_elevation,
          .sky_illuminance = 0.3 + 21 * std::sin(sun_elevation * degree),
          .sun_illuminance = 0};
}

LightCoefficients sky_light(int bands, const Sky& sky) {
  constexpr int width = 1024, height = 512;
  const Eigen::Vector3d sun = direction_of(0, sky.sun_elevation);
  std::vector<float> pixels(width * height);
  double illuminance = 0;  // of the ground by `pixels` above the horizon
  for (int j = height / 2; j < height; ++j) {
    const double elevation = pi * ((j + 0.5) / height - 0.5);
    const double lower = std::sin(pi * (static_cast<double>(j) / height - 0.5)),
                 upper = std::sin(pi * ((j + 1.0) / height - 0.5));
    const double steradians = 2 * pi / width * (upper - lower);
    for (int i = 0; i < width; ++i) {
      const double azimuth = 2 * pi * ((i + 0.5) / width - 0.5);  // from +X towards +Z
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth), std::sin(elevation),
                                      std::cos(elevation) * std::sin(azimuth));
      const double luminance = relative_luminance(sky, direction, sun);
      pixels[static_cast<std::size_t>(j) * width + i] = static_cast<float>(luminance);
      illuminance += luminance * steradians * (lower + upper) / 2;
    }
  }
  for (float& pixel : pixels) pixel = static_cast<float>(pixel * sky.sky_illuminance / illuminance);
  const double level = sky.sky_illuminance + sky.sun_illuminance * std::sin(sky.sun_elevation * degree);
  std::fill_n(pixels.begin(), pixels.size() / 2, static_cast<float>(sky.ground_albedo * level / pi));
  const LightCoefficients above = latitude_longitude_light(bands, width, height, 1, pixels);
  const std::array<float, 1> colour = {static_cast<float>(sky.sun_illuminance / pi)};
  return add_lights(above, cone_light(bands, sun.cast<float>(), sun_half_angle, colour));
}

LightCoefficients soft_box_light(int bands, const SoftBox& box) {
  const Eigen::Vector3d towards = direction_of(box.azimuth, box.elevation);
  const Eigen::Vector3d across = direction_of(box.azimuth + 90, 0), up = towards.cross(across);
  const ShBasis basis(bands);
  std::vector<double> values(basis.size()), sums(basis.size(), 0.0);
  double facing = 0;  // radiance of a white surface that faces it, lit by radiance 1
  // A function of degree l has about l / pi half-waves to a radian; the rules take one node for each and then some.
  const auto rule = [&](double extent) {
    return gauss_legendre(static_cast<int>(std::ceil(bands * std::atan(extent / 2 / box.distance))) + 16);
  };
  for (const LineNode& column : rule(box.width))
    for (const LineNode& row : rule(box.height)) {
      const Eigen::Vector3d place =
          box.distance * towards + column.place * box.width / 2 * across + row.place * box.height / 2 * up;
      const double length = place.norm(), cosine = box.distance / length;
      const double steradians = column.weight * row.weight * box.width * box.height / 4 * cosine / (length * length);
      basis.evaluate<double>(place / length, values);
      for (int i = 0; i < basis.size(); ++i) sums[i] += steradians * values[i];
      facing += steradians * cosine / pi;
    }
  LightCoefficients light{bands, {std::vector<float>(sums.begin(), sums.end())}};
  return scale_light(light, box.level / facing);
}

std::vector<Environment> generated_environments(int bands) {
  const std::string outdoors = "sun and sky", studio = "studio";
  return {{"clear 60°", outdoors, {sky_light(bands, clear_sky(60))}},
          {"clear 20°", outdoors, {sky_light(bands, clear_sky(20))}},
          {"partly cloudy 40°", outdoors, {sky_light(bands, partly_cloudy_sky(40))}},
          {"overcast", outdoors, {sky_light(bands, overcast_sky(40))}},
          {"soft boxes", studio, soft_boxes(bands)},
          {"product table", studio, product_table(bands)},
          {"hard lamps", studio, hard_lamps(bands)}};
}

}  // namespace kiln
