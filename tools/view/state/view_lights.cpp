// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/state/view_lights.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/rotation.h"

namespace kiln {

namespace {

constexpr double degree = std::numbers::pi / 180;

bool has_direction(const LightSpec& spec) { return spec.kind != LightSpec::Kind::ambient; }

Eigen::Vector3d from_centre(const LightSpec& ball, const BoundingBox& box) {
  return Eigen::Vector3d(ball.position.data()) - box.centre().cast<double>();
}

/// Moves a light to an azimuth and an elevation; a ball moves around the box's centre.
void move_light(LightSpec& spec, double azimuth_degrees, double elevation_degrees, const BoundingBox& box) {
  spec.azimuth_degrees = azimuth_degrees;
  spec.elevation_degrees = elevation_degrees;
  if (spec.kind != LightSpec::Kind::sphere) return;
  const Eigen::Vector3d centre = box.centre().cast<double>();
  // Keeps the ball's own radiance: `colour` is the radiance of a white surface at the origin, which is now nearer or
  // farther.
  const double before = Eigen::Vector3d(spec.position.data()).norm();
  const Eigen::Vector3d place =
      centre + from_centre(spec, box).norm() * direction_from_angles(azimuth_degrees, elevation_degrees).cast<double>();
  const double reach = std::max(spec.radius, before), now = std::max(spec.radius, place.norm());
  for (float& value : spec.color) value = static_cast<float>(value * reach * reach / (now * now));
  spec.position = {place.x(), place.y(), place.z()};
}

/// Makes a light of the viewer's own. Each gives a white surface that faces it a radiance of about 1.
LightSpec preset_light(const LightChoice& choice, const BoundingBox& box) {
  LightSpec spec;
  spec.azimuth_degrees = choice.azimuth_degrees;
  spec.elevation_degrees = choice.elevation_degrees;
  switch (choice.preset) {
    case LightPreset::ball: {
      spec.kind = LightSpec::Kind::sphere;
      const double distance = 0.8 * static_cast<double>(box.diagonal());
      const Eigen::Vector3d place =
          box.centre().cast<double>() +
          distance * direction_from_angles(choice.azimuth_degrees, choice.elevation_degrees).cast<double>();
      spec.position = {place.x(), place.y(), place.z()};
      spec.radius = 0.1 * distance;
      // Radiance 1 at the box's centre, while `colour` is that at the origin.
      const double at_origin = std::max(spec.radius, place.norm());
      spec.color.fill(static_cast<float>(distance * distance / (at_origin * at_origin)));
      break;
    }
    case LightPreset::hemisphere:
      spec.kind = LightSpec::Kind::hemisphere;
      spec.color = {0.75f, 0.9f, 1.1f};
      spec.ground = {0.3f, 0.22f, 0.15f};
      break;
    case LightPreset::ambient:
      spec.kind = LightSpec::Kind::ambient;
      break;
    default:
      break;
  }
  return spec;
}

std::vector<LightSpec>::const_iterator main_light(const std::vector<LightSpec>& specs) {
  return std::find_if(specs.begin(), specs.end(), has_direction);
}

SunHour moved(SunHour hour, double hours) {
  hour.day += hours / 24;
  return hour;
}

/// Puts a sun where it stands at its hour.
void place_sun(LightSpec& spec, const SunHour& hour) {
  const SunPosition sun = sun_position(hour);
  spec.azimuth_degrees = scene_azimuth(hour, sun);
  spec.elevation_degrees = sun.elevation_degrees;
  if (sun.elevation_degrees < 0) spec.color.fill(0);
}

void make_grey(std::array<float, 3>& color) { color.fill((color[0] + color[1] + color[2]) / 3); }

std::string light_name(const LightSpec& spec) {
  switch (spec.kind) {
    case LightSpec::Kind::cone:
      return "cone";
    case LightSpec::Kind::sphere:
      return "ball";
    case LightSpec::Kind::hemisphere:
      return "hemisphere";
    case LightSpec::Kind::ambient:
      return "ambient";
    default:
      return "directional";
  }
}

}  // namespace

LightChoice given_choice(const GivenLights& given, LightWindow window) {
  LightChoice choice;
  choice.window = window;
  choice.environment = given.environment.has_value();
  const auto light = main_light(given.specs);
  if (light == given.specs.end()) return choice;
  if (light->kind == LightSpec::Kind::sphere) {
    const Eigen::Vector3d place = from_centre(*light, given.box);
    choice.azimuth_degrees = std::atan2(place.x(), place.z()) / degree;
    choice.elevation_degrees = std::atan2(place.y(), std::hypot(place.x(), place.z())) / degree;
  } else {
    choice.azimuth_degrees = light->azimuth_degrees;
    choice.elevation_degrees = light->elevation_degrees;
  }
  return choice;
}

double environment_turn_degrees(const LightChoice& choice, const GivenLights& given) {
  const bool is_main = choice.preset == LightPreset::given && main_light(given.specs) == given.specs.end();
  return is_main ? std::remainder(choice.azimuth_degrees - LightChoice().azimuth_degrees, 360) : 0;
}

SceneLights lights_of(const LightChoice& choice, const GivenLights& given) {
  SceneLights lights;
  lights.window = choice.window;
  if (choice.preset == LightPreset::given)
    lights.specs = given.specs;
  else
    lights.specs = {preset_light(choice, given.box)};
  if (choice.environment) lights.environment = given.environment;
  if (!given.lamps.empty() && choice.preset != LightPreset::given) {
    make_grey(lights.specs.front().color);
    make_grey(lights.specs.front().ground);
  }
  for (std::size_t k = 0; choice.preset == LightPreset::given && choice.sun_hours != 0 && k < given.suns.size(); ++k)
    if (given.suns[k]) place_sun(lights.specs[k], moved(*given.suns[k], choice.sun_hours));
  // Without a drag nothing moves, not even by rounding.
  const LightChoice still = given_choice(given, choice.window);
  if (choice.preset != LightPreset::given ||
      (choice.azimuth_degrees == still.azimuth_degrees && choice.elevation_degrees == still.elevation_degrees))
    return lights;
  const auto light = main_light(given.specs);
  if (light != given.specs.end()) {
    move_light(lights.specs[static_cast<std::size_t>(light - given.specs.begin())], choice.azimuth_degrees,
               choice.elevation_degrees, given.box);
  } else if (lights.environment) {
    const Eigen::AngleAxisd turn(environment_turn_degrees(choice, given) * degree, Eigen::Vector3d::UnitY());
    lights.environment = ShRotation(lights.environment->bands, turn.toRotationMatrix())(*lights.environment);
  }
  return lights;
}

std::vector<std::string> spectra_of(const LightChoice& choice, const GivenLights& given) {
  const std::size_t count = choice.preset == LightPreset::given ? given.specs.size() : 1;
  std::vector<std::string> names(count, given.lamps[static_cast<std::size_t>(choice.lamp)]);
  for (std::size_t k = 0; choice.preset == LightPreset::given && k < given.suns.size(); ++k) {
    if (!given.suns[k]) continue;
    const SunHour hour = moved(*given.suns[k], choice.sun_hours);
    // At night there is no light to have a spectrum.
    if (sun_position(hour).elevation_degrees >= 0) names[k] = to_text(hour);
  }
  return names;
}

std::string describe_sun(const LightChoice& choice, const GivenLights& given) {
  const auto sun = std::ranges::find_if(given.suns, [](const auto& one) { return one.has_value(); });
  if (sun == given.suns.end()) return "";
  const SunHour hour = moved(**sun, choice.sun_hours);
  std::string text = to_text(hour).substr(4, 16);
  text[10] = ' ';
  const double elevation = sun_position(hour).elevation_degrees;
  return text +
         fmt::format(" UTC, {:.0f} degrees {} the horizon", std::abs(elevation), elevation < 0 ? "below" : "above");
}

AssetLight light_for_asset(const SceneLights& lights, int bands, const PrtAsset& asset,
                           const IncidentSamples& samples) {
  AssetLight light = light_asset(lights, bands, {}, samples.points);
  for (LightCoefficients& sample : light.samples) {
    sample.bands = asset.bands;
    for (std::vector<float>& channel : sample.channels) channel.resize(coefficient_count(asset.bands), 0.f);
  }
  return light;
}

AssetLight light_of_coefficient(int coefficient, const PrtAsset& asset, const IncidentSamples& samples) {
  const int count = coefficient_count(asset.bands);
  LightCoefficients one{asset.bands, {3, std::vector<float>(static_cast<std::size_t>(count), 0.f)}};
  for (int color = 0; color < 3; ++color)
    if (asset.channels == 1 || color == coefficient / count)
      one.channels[static_cast<std::size_t>(color)][static_cast<std::size_t>(coefficient % count)] = 1;
  AssetLight light;
  light.samples.assign(samples.points.size(), one);
  light.rest = {3, {3, std::vector<float>(9, 0.f)}};
  return light;
}

std::string describe(const LightChoice& choice, const GivenLights& given) {
  const std::vector<LightSpec> specs = lights_of(choice, given).specs;
  const auto light = main_light(specs);
  std::string text = specs.empty() ? "none" : light_name(light == specs.end() ? specs.front() : *light);
  if (light != specs.end()) {
    const bool has_moved = choice.sun_hours != 0 && light->kind != LightSpec::Kind::sphere;
    text += fmt::format(" {:.0f}, {:.0f}", has_moved ? light->azimuth_degrees : choice.azimuth_degrees,
                        has_moved ? light->elevation_degrees : choice.elevation_degrees);
  }
  if (specs.size() > 1) text += fmt::format(" and {} more", specs.size() - 1);
  return text;
}

}  // namespace kiln
