// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/options.h"

namespace kiln {

/// Encoding of a file's colours: sRGB, or proportional to light.
enum class ColorEncoding { srgb, linear };

/// Source of the opacity of a mesh's surface: its file, or nothing, as if it were opaque.
enum class OpacitySource { file, none };

/// Source of the reflectance and the opacity of a mesh's surface.
struct MaterialSettings {
  std::optional<std::array<float, 3>> albedo = {};  ///< linear, 0 to 1; nothing: what the mesh file says
  std::string texture = {};  ///< a picture looked up with the mesh's uvs, in place of its own materials
  std::string reflectance =
      {};  ///< a measured spectrum for all of the surface, in its place: a file, or TCS01 to TCS15
  std::string reflectance_of = {};               ///< the same of materials by their names: "oak=oak.csv,label=TCS05"
  ColorEncoding encoding = ColorEncoding::srgb;  ///< of vertex colours, Kd and pictures of integers
  OpacitySource opacity = OpacitySource::file;
  std::string opacity_texture = {};           ///< a picture looked up with the mesh's uvs, in place of its file's
  std::optional<double> opacity_cutoff = {};  ///< opacity below which nothing is there; nothing: the file's, or 0.5
};

/// Tells whether a reflectance is the name of a test colour sample of the CIE, TCS01 to TCS15, and no file.
bool is_test_sample(const std::string& reflectance);

/// Reads `reflectance_of`: names of materials, each with a file or TCS01 to TCS15. Throws WrongUsage.
std::vector<std::pair<std::string, std::string>> reflectances_of_materials(const std::string& text);

/// Adds the options of albedo and opacity to a stage's options.
void add_material_options(OptionSet& options, MaterialSettings& settings);

/// Returns the pairs of these options that exclude each other, and then a stage's `own` pairs.
std::vector<std::pair<std::string, std::string>> material_rivals(
    const std::vector<std::pair<std::string, std::string>>& own = {});

}  // namespace kiln
