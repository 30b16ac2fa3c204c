// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "runtime/light/scene_lights.h"
#include "runtime/shadow/direction_set.h"
#include "runtime/shadow/direction_sums.h"
#include "sh/light_spec.h"
#include "sh/lights.h"

namespace kiln {

/// Three channels of coefficients, float64: channels[c][i].
using LightSum = std::array<std::vector<double>, 3>;

/// Tests whether light of a half-angle (radians) is so narrow that it counts as a single direction, as in cone_bands.
inline bool is_single_direction(double half_angle) { return half_angle < 1e-3; }

/// A light that covers a cone of directions, or a single one; scene's space.
struct ConeLight {
  LightSpec spec;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit vector towards a distant light
  double half_angle = 0;                            ///< radians; 0: a single direction
  std::vector<double> zonal;                        ///< coefficients z_l Y_lm(axis) for the colour 1, no window
  std::vector<double> window;                       ///< by band
  DirectionSet directions;                          ///< empty for a single direction
  DirectionSums sums;                               ///< of their harmonics; empty if they have none
  std::vector<double> closing;                      ///< closed form less the sum over `directions`, for the colour 1
};

/// Radiance from all directions, by directions; scene's space.
struct SkyLight {
  LightCoefficients light;                     ///< that arrives, no window
  std::vector<double> window;                  ///< by band
  std::array<std::vector<float>, 3> radiance;  ///< by direction, times the solid angle of one
  LightSum closing;                            ///< `light` less the sum over all directions
};

/// All skies together, each under its window: what directions take of them.
struct SkySums {
  DirectionSums sums;       ///< harmonics times radiance, of each channel one after the other, or of all alike
  bool is_grey = false;     ///< whether all channels are alike
  LightSum whole, closing;  ///< all that arrives; what the sum over all directions lacks of it

  /// Returns what the blocked directions (1, not 0; `count` of them) take.
  LightSum taken(std::span<const std::uint8_t> blocked, std::uint32_t count) const;
};

/// The lights of a scene as directions. Those that a place changes (balls, and all of them with probes) are made at
/// each point, the others once.
struct LightSources {
  std::vector<ConeLight> cones;  ///< distant ones
  std::vector<LightSpec> balls;
  std::vector<SkyLight> skies;  ///< hemispheres, ambient light and environments
  SkySums sky_sums;             ///< of them
  DiscPattern pattern;          ///< of cones
  bool has_probes = false;      ///< then `cones`, `balls` and `skies` are empty

  bool has_sky() const { return !skies.empty() || has_probes; }
};

/// Returns the sources of `lights`; `sky` are the directions of skies. Light is computed in `bands` bands, and the
/// directions of each cone are as many as of the sky.
LightSources light_sources(const SceneLights& lights, int bands, const DirectionSet& sky);

/// Returns a ball as a cone of light as it arrives at `point`; a half-angle of pi if the point is inside. Its radiance
/// is such that a white surface that faces it at the origin has the colour, whatever its place.
ConeLight ball_at(const LightSpec& ball, int bands, LightWindow window, const Eigen::Vector3d& point,
                  const DiscPattern& pattern);

/// A light as it arrives at a point before its window, and that window.
struct WindowedLight {
  LightCoefficients light;
  std::vector<double> window;  ///< by band
};

/// Returns every light as it arrives at `point`, past the probes of `lights` if there are any, in `light_bands` bands,
/// with its window of `bands` bands, 0 for bands that probes do not carry: in `bands` bands they make up
/// SceneLights::incident.
std::vector<WindowedLight> windowed_lights(const SceneLights& lights, int light_bands, int bands,
                                           const Eigen::Vector3d& point);

/// Returns all light as skies, as it arrives at `point` past the probes of `lights`.
std::vector<SkyLight> probed_skies(const SceneLights& lights, int bands, const DirectionSet& sky,
                                   const Eigen::Vector3d& point);

}  // namespace kiln
