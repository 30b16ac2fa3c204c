#pragma once

#include <array>
#include <span>
#include <string_view>

namespace kiln {

/// What light meets beneath a surface, for red, green and blue.
struct ScatterMaterial {
  std::string_view name;
  std::array<double, 3> scattering_per_mm;  ///< reduced scattering coefficient sigma_s'
  std::array<double, 3> absorption_per_mm;  ///< sigma_a
  double eta = 1.3;                         ///< index of refraction over that of air
};

/// The materials measured by Jensen, Marschner, Levoy and Hanrahan, "A practical model for subsurface light transport"
/// (SIGGRAPH 2001), figure 5.
std::span<const ScatterMaterial> measured_materials();

}  // namespace kiln
