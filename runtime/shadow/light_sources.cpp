// SPDX-License-Identifier: MIT
#include "runtime/shadow/light_sources.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sh/basis.h"
#include "sh/directions.h"

namespace kiln {

namespace {

using Kind = LightSpec::Kind;

/// Returns the light with exactly `bands` bands.
LightCoefficients with_bands(const LightCoefficients& light, int bands) {
  LightCoefficients cut{bands, light.channels};
  for (std::vector<float>& channel : cut.channels) channel.resize(static_cast<std::size_t>(coefficient_count(bands)));
  return cut;
}

/// Makes a cone of light around an axis, without its window. Sums over its directions stand for the integral of a
/// radiance of colour / sin^2(half_angle), or of colour beyond 90 degrees. `is_summed`: with harmonics of all
/// directions and what their sum lacks; else that is left out, a thousandth of the light.
ConeLight cone_around(const LightSpec& spec, const Eigen::Vector3d& axis, double half_angle, int bands,
                      const DiscPattern& pattern, bool is_summed) {
  ConeLight cone;
  cone.spec = spec;
  cone.axis = axis;
  cone.half_angle = half_angle;
  const ShBasis basis(bands);
  cone.zonal.resize(static_cast<std::size_t>(basis.size()));
  basis.evaluate<double>(axis, cone.zonal);
  const std::vector<double> bands_of_cone = cone_bands(bands, half_angle);
  for (std::size_t i = 0; i < cone.zonal.size(); ++i)
    cone.zonal[i] *= bands_of_cone[static_cast<std::size_t>(band_of(static_cast<int>(i)))];
  if (is_single_direction(half_angle)) {
    cone.half_angle = 0;
    return cone;
  }
  if (!is_summed) {
    cone.directions = cone_directions(pattern, axis, half_angle, 0);
    cone.closing.assign(cone.zonal.size(), 0.0);
    return cone;
  }
  cone.directions = cone_directions(pattern, axis, half_angle, bands);
  cone.sums = DirectionSums(cone.directions.basis, cone.zonal.size());
  // The mean over directions stands for z_0 / Y_00, the radiance times the solid angle.
  const double share = bands_of_cone[0] / cone.directions.count();
  cone.closing = cone.zonal;
  for (std::uint32_t d = 0; d < cone.directions.count(); ++d) {
    const std::span<const float> row = cone.directions.row(d);
    for (std::size_t i = 0; i < row.size(); ++i) cone.closing[i] -= share * static_cast<double>(row[i]);
  }
  return cone;
}

SkyLight sky_of(LightCoefficients light, std::vector<double> window, int bands, const DirectionSet& sky) {
  SkyLight made;
  made.window = std::move(window);
  const double solid_angle = 4 * std::numbers::pi / sky.count();
  // Radiance has all bands that it is given in; of what it sums up to, the transfer takes the first.
  const ShBasis basis(light.bands);
  std::vector<double> values(static_cast<std::size_t>(basis.size()));
  for (std::vector<float>& radiance : made.radiance) radiance.resize(sky.count());
  for (std::uint32_t d = 0; d < sky.count(); ++d) {
    basis.evaluate<double>(sky.direction(d).cast<double>(), values);
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (std::size_t i = 0; i < values.size(); ++i) sum += values[i] * static_cast<double>(light.channels[c][i]);
      made.radiance[c][d] = static_cast<float>(sum * solid_angle);
    }
  }
  made.light = with_bands(light, bands);
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double>& closing = made.closing[c];
    closing.assign(made.light.channels[c].begin(), made.light.channels[c].end());
    for (std::uint32_t d = 0; d < sky.count(); ++d) {
      const std::span<const float> row = sky.row(d);
      for (std::size_t i = 0; i < closing.size(); ++i)
        closing[i] -= static_cast<double>(made.radiance[c][d]) * static_cast<double>(row[i]);
    }
  }
  return made;
}

/// Adds up skies for LightSources; there is one at least.
SkySums sums_of(std::span<const SkyLight> skies, const DirectionSet& sky) {
  SkySums all;
  const auto coefficients = static_cast<std::size_t>(sky.coefficients);
  for (std::size_t c = 0; c < 3; ++c) {
    all.whole[c].assign(coefficients, 0.0);
    all.closing[c].assign(coefficients, 0.0);
  }
  all.is_grey = std::all_of(skies.begin(), skies.end(), [](const SkyLight& one) {
    return one.radiance[0] == one.radiance[1] && one.radiance[0] == one.radiance[2] &&
           one.light.channels[0] == one.light.channels[1] && one.light.channels[0] == one.light.channels[2];
  });
  const std::size_t channels = all.is_grey ? 1 : 3;
  std::vector<float> rows(sky.count() * channels * coefficients, 0.f);
  for (const SkyLight& one : skies)
    for (std::size_t i = 0; i < coefficients; ++i) {
      const double window = one.window[static_cast<std::size_t>(band_of(static_cast<int>(i)))];
      for (std::size_t c = 0; c < 3; ++c) {
        all.whole[c][i] += window * static_cast<double>(one.light.channels[c][i]);
        all.closing[c][i] += window * one.closing[c][i];
      }
      for (std::size_t c = 0; c < channels; ++c)
        for (std::uint32_t d = 0; d < sky.count(); ++d)
          rows[(d * channels + c) * coefficients + i] +=
              static_cast<float>(window * static_cast<double>(one.radiance[c][d]) * static_cast<double>(sky.row(d)[i]));
    }
  all.sums = DirectionSums(rows, channels * coefficients);
  return all;
}

}  // namespace

LightSum SkySums::taken(std::span<const std::uint8_t> blocked, std::uint32_t count) const {
  if (count == blocked.size()) return whole;
  LightSum taken = closing;
  const double share = static_cast<double>(count) / static_cast<double>(blocked.size());
  thread_local std::vector<float> sum;
  sum.resize(sums.width());
  sums.add_up(blocked, sum);
  const std::size_t coefficients = closing[0].size();
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < coefficients; ++i)
      taken[c][i] = share * closing[c][i] + static_cast<double>(sum[(is_grey ? 0 : c * coefficients) + i]);
  return taken;
}

LightSources light_sources(const SceneLights& lights, int bands, const DirectionSet& sky) {
  LightSources sources;
  sources.has_probes = lights.probes != nullptr;
  if (sources.has_probes) return sources;
  sources.pattern = disc_pattern(static_cast<int>(sky.count()));
  for (const LightSpec& spec : lights.specs) {
    if (spec.kind == Kind::sphere) {
      sources.balls.push_back(spec);
    } else if (spec.kind == Kind::directional || spec.kind == Kind::cone) {
      const Eigen::Vector3d axis =
          direction_from_angles(spec.azimuth_degrees, spec.elevation_degrees).cast<double>().normalized();
      const double half_angle = spec.kind == Kind::cone ? spec.half_angle_degrees * std::numbers::pi / 180 : 0;
      ConeLight& cone = sources.cones.emplace_back(cone_around(spec, axis, half_angle, bands, sources.pattern, true));
      cone.window = window_weights(spec, bands, lights.window);
    } else {
      sources.skies.push_back(
          sky_of(light_coefficients(spec, bands), window_weights(spec, bands, lights.window), bands, sky));
    }
  }
  if (lights.environment)
    sources.skies.push_back(
        sky_of(*lights.environment, window_weights(with_bands(*lights.environment, bands), lights.window), bands, sky));
  if (!sources.skies.empty()) sources.sky_sums = sums_of(sources.skies, sky);
  return sources;
}

ConeLight ball_at(const LightSpec& ball, int bands, LightWindow window, const Eigen::Vector3d& point,
                  const DiscPattern& pattern) {
  const Eigen::Vector3d position(ball.position.data()), away = position - point;
  const double distance = away.norm();
  const bool inside = distance <= ball.radius;
  const double half_angle = inside ? std::numbers::pi : std::asin(ball.radius / distance);
  // light_coefficients scales the light of a ball in the same way: by the squares of the sines here and at the origin.
  const double sine = inside ? 1 : ball.radius / distance;
  const double sine_at_origin = std::min(1.0, ball.radius / position.norm());
  LightSpec scaled = ball;
  const double ratio = sine / sine_at_origin;
  for (float& level : scaled.color) level = static_cast<float>(static_cast<double>(level) * ratio * ratio);
  ConeLight cone = cone_around(scaled, inside ? Eigen::Vector3d::UnitZ() : (away / distance).eval(), half_angle, bands,
                               pattern, false);
  cone.window = window_weights(ball, bands, window, point);
  return cone;
}

std::vector<WindowedLight> windowed_lights(const SceneLights& lights, int light_bands, int bands,
                                           const Eigen::Vector3d& point) {
  const ProbeSet* probes = lights.probes;
  const int source_bands = probes != nullptr ? std::max(light_bands, probes->bands) : light_bands,
            carried = probes != nullptr ? std::min(bands, probes->bands) : bands;
  std::vector<WindowedLight> parts;
  const auto add = [&](const LightCoefficients& light, std::vector<double> window) {
    window.resize(static_cast<std::size_t>(bands), 0.0);
    const LightCoefficients arriving = probes != nullptr ? light_at(*probes, point.cast<float>(), light) : light;
    parts.push_back({with_bands(arriving, light_bands), std::move(window)});
  };
  for (const LightSpec& spec : lights.specs)
    add(light_coefficients(spec, source_bands, point), window_weights(spec, carried, lights.window, point));
  if (lights.environment)
    add(with_bands(*lights.environment, source_bands),
        window_weights(with_bands(*lights.environment, carried), lights.window));
  return parts;
}

std::vector<SkyLight> probed_skies(const SceneLights& lights, int bands, const DirectionSet& sky,
                                   const Eigen::Vector3d& point) {
  std::vector<SkyLight> skies;
  for (WindowedLight& part : windowed_lights(lights, std::max(bands, lights.probes->bands), bands, point))
    skies.push_back(sky_of(part.light, std::move(part.window), bands, sky));
  return skies;
}

}  // namespace kiln
