// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string>

#include "base/options.h"

namespace kiln {

/// Encoding of a file's colours: sRGB, or proportional to light.
enum class ColorEncoding { srgb, linear };

/// Source of the reflectance of a mesh's surface.
struct MaterialSettings {
  std::string albedo = "auto";  ///< auto: from the mesh file; else one number or R,G,B, linear, 0 to 1
  std::string texture = {};     ///< a picture looked up with the mesh's uvs, instead of its own materials
  ColorEncoding encoding = ColorEncoding::srgb;  ///< encoding of vertex colours, Kd and integer pictures

  /// Returns the linear colour that `albedo` gives; nothing for auto. Throws WrongUsage for other text.
  std::optional<std::array<float, 3>> constant() const;
};

/// Adds `albedo`, `albedo-texture` and `albedo-encoding` to a stage's options.
void add_material_options(OptionSet& options, MaterialSettings& settings);

}  // namespace kiln
