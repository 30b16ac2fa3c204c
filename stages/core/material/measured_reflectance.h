// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "material/material_settings.h"
#include "spectrum/spectrum.h"

namespace kiln {

/// Measured reflectance of a surface that is the same everywhere, and what it is to renderers of red, green and blue.
struct MeasuredReflectance {
  NamedSpectrum spectrum = {};
  Eigen::Vector3f albedo = Eigen::Vector3f::Ones();  ///< its linear sRGB colour under D65, clamped to 0 to 1
  bool is_clamped = false;                           ///< whether that colour lies outside of sRGB
  std::vector<std::filesystem::path> files = {};     ///< the file that was read, if it is one
};

/// Loads what a reflectance of the settings names. Throws WrongUsage, BadInput and MachineLacks as StandardSpectra
/// does.
MeasuredReflectance load_reflectance(const std::string& reflectance);

/// Loads those of materials, by name. Throws as load_reflectance, and WrongUsage for a text that is none.
std::map<std::string, MeasuredReflectance> load_reflectances_of(const MaterialSettings& settings);

/// Returns the albedo that the settings give for all of a surface, by a colour or by a reflectance; else nothing.
std::optional<Eigen::Vector3f> constant_albedo(const MaterialSettings& settings);

}  // namespace kiln
