// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace kiln {

/// Scattering properties of a material, for red, green and blue.
struct ScatterMaterial {
  std::string_view name;
  std::array<double, 3> scattering_per_mm;  ///< reduced scattering coefficient sigma_s'
  std::array<double, 3> absorption_per_mm;  ///< sigma_a
  double eta = 1.3;                         ///< index of refraction over that of air
};

/// Returns the materials that [Jensen 2001] measured (figure 5).
std::span<const ScatterMaterial> measured_materials();

}  // namespace kiln
