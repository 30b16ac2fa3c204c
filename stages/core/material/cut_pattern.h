// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "material/surface_share.h"

namespace kiln {

/// The part of a triangle that is there, as smaller triangles with its winding.
struct CutPattern {
  enum class Part { whole, nothing, pieces };

  /// Corner of pieces. On the triangle's outline the weights are the same in the triangle beyond, to the last bit, if
  /// its texture coordinates at the common edge are.
  struct Place {
    std::array<float, 3> weights;  ///< of the triangle's corners, together 1
  };

  Part part = Part::whole;
  std::vector<Place> places;                            ///< of pieces
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of places
};

/// Largest number of texels that a triangle may lie over.
inline constexpr double most_texels_of_triangle = 1 << 26;

/// Returns the number of texels that the box around a triangle's texture coordinates holds.
double texels_under(const SurfaceShare::Material& material, const std::array<Eigen::Vector2f, 3>& uvs);

/// Finds the part of a triangle where a material's share, which has a texture, is at least `cutoff` (cut_out.h). The
/// outline is traced through the cells between texels' centres [Lorensen 1987], whose saddles go by their middle,
/// the mean of their corners, and simplified [Douglas 1973].
CutPattern cut_pattern(const SurfaceShare::Material& material, float cutoff, const std::array<Eigen::Vector2f, 3>& uvs);

}  // namespace kiln
