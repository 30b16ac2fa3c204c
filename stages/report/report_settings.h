// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/framing_options.h"
#include "base/options.h"

namespace kiln {

/// Pictures of the report and its comparison.
struct ReportSettings {
  std::string lights = "45,30; -60,20; ambient:1";  ///< in the form of kiln-render, separated by semicolons
  double camera_azimuth_degrees = 20;               ///< where the camera stands: 0 is +Z, 90 is +X
  double camera_elevation_degrees = 12;
  int cameras = 2;  ///< evenly about the vertical; those beyond the first show the first light alone, turned with them
  FramingSettings framing;
  int picture_size = 512;        ///< pixels a side
  int directions = 512;          ///< of the reference's transfer integral
  std::optional<double> albedo;  ///< what the surface's own is multiplied by; nothing: auto

  /// Returns that factor; auto is 1 where the asset has an albedo of its own, else 0.8.
  double albedo_factor(bool asset_has_albedo) const;

  /// Returns `predicted` by name. Throws WrongUsage for what is no list of NAME=NUMBER.
  std::map<std::string, double> predictions() const;

  std::string gl_device = "auto";  ///< device that kiln-render draws on

  std::string error_lights = "measured";  ///< light that E expects: "measured", or lights like `lights`
  double error_pixels = 0;                ///< longest side of the asset as it is seen, pixels; 0: any size
  int error_samples = 4096;               ///< pixels that the error is measured at
  std::optional<int> error_bounces;       ///< bounces of light that E expects; nothing: as many as were baked
  bool error_others = false;              ///< whether to measure vertices in place of texels, and no shadows, too
  std::string predicted;                  ///< what a plan predicted: "total=0.008; geometry=0.004; ..."
};

OptionSet report_options(ReportSettings& settings);

/// Returns the entries of a list with semicolons, as `lights` is one, without blanks around them.
std::vector<std::string> list_of(const std::string& text);

}  // namespace kiln
