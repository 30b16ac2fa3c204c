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
  const ProbeSet* probes = nullptr;  ///< objects at the origin that shadow the light on its way; null: none
  /// Light vectors [Peercy 1995] of `specs`, each of which is grey then: weights, per radiance, of the functions that
  /// light is a sum of. None: light is red, green and blue. Not beside an environment.
  std::vector<Eigen::VectorXf> vectors = {};

  /// Returns the number of channels of the light: functions, or three.
  std::size_t channels() const { return vectors.empty() ? 3 : static_cast<std::size_t>(vectors.front().size()); }

  /// Tests whether the light depends on the place.
  bool is_local() const;

  /// Returns the light vector of a light; null where light is red, green and blue.
  const Eigen::VectorXf* vector_of(std::size_t spec) const { return vectors.empty() ? nullptr : &vectors[spec]; }

  /// Computes the light that arrives at `viewpoint`, channels() of them, every light windowed (window_weights).
  LightCoefficients incident(int bands, const Eigen::Vector3d& viewpoint) const;
};

/// A light with a position or a direction, for shading without harmonics; object space.
struct DirectLight {
  Eigen::Vector3f place;  ///< centre of a ball, or unit vector towards a distant light
  float radius = 0;       ///< of a ball, object units; 0 if distant
  /// Radiance of a ball itself, or of a white surface that faces a distant light.
  std::vector<float> radiance = {};  ///< by channel
};

/// Tests whether a light has a position or a direction, and so becomes a DirectLight.
bool is_direct(const LightSpec& spec);

/// Lights of a scene as one asset receives them at its place, in its object space.
struct AssetLight {
  std::vector<LightCoefficients> samples;  ///< light at each incident-light sample
  std::vector<DirectLight> direct;         ///< directional lights, cones of up to 90 degrees, and balls
  LightCoefficients rest;                  ///< all other lights, three bands, no window
};

/// Computes an asset's light; `points` are its incident-light samples in its object space.
AssetLight light_asset(const SceneLights& lights, int bands, const Placement& placement,
                       std::span<const Eigen::Vector3f> points);

}  // namespace kiln
