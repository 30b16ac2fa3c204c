// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/options.h"
#include "scatter/profile.h"

namespace kiln {

enum class SubsurfaceModel { dipole, diffusion };

/// Quantity for red, green and blue, or nothing where the command line does not give it.
using GivenColors = std::optional<std::array<double, 3>>;

struct SubsurfaceSettings {
  std::string material = "none";  ///< none, custom or the name of a measured material
  SubsurfaceModel model = SubsurfaceModel::dipole;
  GivenColors scattering = {};      ///< custom, dipole: sigma_s', 1/mm
  GivenColors absorption = {};      ///< custom, dipole: sigma_a, 1/mm
  double eta = 1.3;                 ///< custom, dipole
  GivenColors albedo = {};          ///< custom, diffusion: albedo of the surface, 0 to 1
  GivenColors mean_free_path = {};  ///< custom, diffusion: mm
  double mm_per_unit = 1000;        ///< millimetres to an object unit; the default is for metres
  double solid_angle = 0.05;        ///< as in ScatteringSettings

  bool wanted() const { return material != "none"; }
};

/// Adds `subsurface` and `subsurface-...` to the bake's options.
void add_subsurface_options(OptionSet& options, SubsurfaceSettings& settings);

/// Returns one profile where all colours have the same, else those of red, green and blue; none where nothing is
/// wanted. A measured material as diffusion has the dipole's total reflectance as surface albedo and the mean free path
/// 1 / sigma_t'. Throws WrongUsage for settings that do not go together.
std::vector<ScatterProfile> subsurface_profiles(const SubsurfaceSettings& settings);

}  // namespace kiln
