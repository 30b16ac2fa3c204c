// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/draw/technique.h"
#include "sh/windows.h"
#include "view/state/orbit.h"

namespace kiln {

/// What the window shows of the asset.
enum class Show {
  picture,      ///< lit, by the technique
  coefficient,  ///< one transfer coefficient as the technique decodes it, signed
  normals,
  charts,
  difference,  ///< the technique's picture less that of full textured PRT, signed
};

/// Which lights are on besides the environment.
enum class LightPreset {
  given,        ///< those of the command line
  directional,  ///< a distant one
  ball,         ///< a glowing ball near the asset: a local light
  hemisphere,   ///< a sky and a ground
  ambient,      ///< the same from everywhere: a furnace
};

/// What can be told of the lights without the asset.
struct LightChoice {
  LightPreset preset = LightPreset::given;
  double azimuth_degrees = 45;  ///< of the main light
  double elevation_degrees = 30;
  bool environment = false;
  LightWindow window = LightWindow::hann;

  bool operator==(const LightChoice&) const = default;
};

/// All that the person at the window chose.
struct ViewState {
  Orbit orbit;
  Technique technique = Technique::textured_prt;
  Shading shading = Shading::forward;
  LightChoice light;
  int bands = 1;  ///< of the light that are used
  Show show = Show::picture;
  int coefficient = 0;  ///< shown: channel * bands^2 + l (l + 1) + m
  double difference_gain = 8;
  double exposure_stops = 0;
  bool mesh = false;    ///< the edges of the triangles over it all
  bool readout = true;  ///< the panel of what is shown
  bool help = false;    ///< the panel of keys
};

/// What an asset allows.
struct ViewLimits {
  std::vector<Technique> techniques;
  int bands = 1;
  int channels = 1;
  bool has_reference = false;  ///< there is a form to hold others against
  bool has_charts = false;
  bool has_environment = false;

  int coefficients() const { return channels * bands * bands; }
  bool allows(Technique technique) const;
};

/// Brings a state within limits, which a reload may have changed.
void limit(ViewState& state, const ViewLimits& limits);

/// Whether the technique is one whose shading may be deferred.
bool can_defer(Technique technique);

/// What the pointer's buttons drag.
enum class Drag { orbit, pan, light };

/// Drags by pixels of a picture of width x height pixels of a shape.
void drag(ViewState& state, Drag what, double right_pixels, double down_pixels, std::span<const Eigen::Vector3f> shape,
          int width, int height);

}  // namespace kiln
