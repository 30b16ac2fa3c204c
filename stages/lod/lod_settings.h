// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/extent.h"
#include "base/options.h"

namespace kiln {

/// Picture in which errors are given in pixels: so many lines, and the angle that they span.
struct ReferencePictureSize {
  int lines = 1080;
  double vertical_fov_degrees = 45;
};

struct LodSettings {
  std::string levels = "0.5, 0.25, 0.1";  ///< shares of the atlas mesh's triangles, falling
  std::string pixels;                     ///< in place of levels: errors in pixels, rising; empty: by levels
  double switch_pixels = 1;               ///< error in pixels at the distance that a level is proposed for
  ReferencePictureSize view = {};
  /// Texels that a chart may hang over its outline; nothing: half of the gap between charts, less half a texel, which
  /// bilinear lookups take.
  std::optional<double> overhang_texels = {};
  Extent size = 0;  ///< of the atlas, texels; 0: as atlas.json beside it says

  /// Returns the shares below 1: 1 stands for the atlas mesh itself.
  std::vector<double> shares() const;

  /// Returns the errors in pixels; none where levels are given by shares.
  std::vector<double> pixel_errors() const;
};

OptionSet lod_options(LodSettings& settings);

}  // namespace kiln
