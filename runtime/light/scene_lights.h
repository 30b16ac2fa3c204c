// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "asset/probe_set.h"
#include "mesh/placement.h"
#include "sh/light_spec.h"
#include "sh/lights.h"
#include "sh/windows.h"

namespace kiln {

/// All lights of a scene, in the scene's space; they add up.
struct SceneLights {
  std::vector<LightSpec> specs;
  std::optional<LightCoefficients> environment;  ///< distant light of any number of bands
  LightWindow window = LightWindow::hann;
  const ProbeSet* probes = nullptr;  ///< what stands at the origin and shadows the light on its way; none: nothing

  /// Whether the light depends on the place.
  bool is_local() const;

  /// What comes in at `viewpoint`, three channels, every light windowed (window_weights).
  LightCoefficients incident(int bands, const Eigen::Vector3d& viewpoint) const;
};

/// A light with a position or a direction, for shading without harmonics; object space.
struct DirectLight {
  Eigen::Vector3f place;               ///< of a ball its centre, of a distant light the unit vector towards it
  float radius = 0;                    ///< of a ball, object units; 0: distant
  std::array<float, 3> radiance = {};  ///< of a ball its own; distant: of a white surface that faces it
};

/// What the lights of a scene are to one asset at its place, in its object space.
struct AssetLight {
  std::vector<LightCoefficients> samples;  ///< at every incident-light sample point
  std::vector<DirectLight> direct;         ///< directional lights, cones of up to 90 degrees, and balls
  LightCoefficients rest;                  ///< all others, three bands, no window
};

/// `points` are the asset's incident-light sample points in its object space.
AssetLight light_asset(const SceneLights& lights, int bands, const Placement& placement,
                       std::span<const Eigen::Vector3f> points);

}  // namespace kiln
