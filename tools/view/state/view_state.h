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
  difference,  ///< the technique's picture minus that of full textured PRT, signed
};

/// Lights that are on besides the environment.
enum class LightPreset {
  given,        ///< lights of the command line
  directional,  ///< a distant light
  ball,         ///< a glowing ball near the asset: a local light
  hemisphere,   ///< a sky and a ground
  ambient,      ///< the same radiance from everywhere: a furnace
};

/// Choice of lights, independent of the asset.
struct LightChoice {
  LightPreset preset = LightPreset::given;
  double azimuth_degrees = 45;  ///< of the main light
  double elevation_degrees = 30;
  bool environment = false;
  LightWindow window = LightWindow::hann;
  int lamp = 0;               ///< of those given, by spectra
  double sun_hours = 0;       ///< after the hours that the suns were given at
  bool other_sensor = false;  ///< whether the CIE's observer sees, in place of the camera

  bool operator==(const LightChoice&) const = default;
};

/// Everything that the person at the window chose.
struct ViewState {
  Orbit orbit;
  Technique technique = Technique::textured_prt;
  Shading shading = Shading::forward;
  LightChoice light;
  int bands = 1;  ///< number of the light's bands that are used
  Show show = Show::picture;
  int coefficient = 0;  ///< the one shown: channel * bands^2 + l (l + 1) + m
  double difference_gain = 8;
  double exposure_stops = 0;
  bool mesh = false;    ///< whether the edges of the triangles are drawn over everything
  bool readout = true;  ///< whether the panel of what is shown is on
  bool help = false;    ///< whether the panel of keys is on
};

/// What an asset allows.
struct ViewLimits {
  std::vector<Technique> techniques;
  int bands = 1;
  int channels = 1;
  bool has_reference = false;  ///< whether there is a form to compare others with
  bool has_charts = false;
  bool has_environment = false;
  int lamps = 0;  ///< number of lamps to choose among; 0: by RGB
  bool has_suns = false;
  bool has_camera = false;

  int coefficients() const { return channels * bands * bands; }
  bool allows(Technique technique) const;
};

/// Brings a state within limits, which a reload may have changed.
void limit(ViewState& state, const ViewLimits& limits);

/// Tests whether a technique supports deferred shading.
bool can_defer(Technique technique);

/// What the pointer's buttons drag.
enum class Drag { orbit, pan, light };

/// Drags by pixels, in a picture of width x height pixels of a shape.
void drag(ViewState& state, Drag what, double right_pixels, double down_pixels, std::span<const Eigen::Vector3f> shape,
          int width, int height);

}  // namespace kiln
