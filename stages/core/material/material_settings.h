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
  std::optional<std::array<float, 3>> albedo = {};  ///< linear, 0 to 1; nothing: what the mesh file says
  std::string texture = {};  ///< a picture looked up with the mesh's uvs, in place of its own materials
  ColorEncoding encoding = ColorEncoding::srgb;  ///< of vertex colours, Kd and pictures of integers
};

/// Adds `albedo`, `albedo-texture` and `albedo-encoding` to a stage's options.
void add_material_options(OptionSet& options, MaterialSettings& settings);

}  // namespace kiln
