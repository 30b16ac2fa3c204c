// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/function_ref.h"
#include "spectrum/basis.h"
#include "spectrum/colorimetry.h"
#include "spectrum/rgb_lift.h"

namespace kiln {

/// Colour differences of one way to compute from the truth in steps of 1 nm, CIEDE2000 beside each lamp's white, over
/// all lights and all combinations of reflectances.
struct ColorErrors {
  double mean = 0;
  double worst = 0;
  std::string worst_at = {};  ///< "F11, TCS09 TCS12"
};

/// Surfaces in turn that light meets, by index.
using ReflectionChain = std::vector<std::size_t>;

/// Returns the combinations of `reflections` of `surfaces` surfaces, which may repeat; where they are more than `most`,
/// so many that are spread evenly, and each surface with itself among them.
std::vector<ReflectionChain> reflection_chains(std::size_t surfaces, int reflections, std::size_t most = 20000);

/// Compares what `computed` returns for a light and a chain, X, Y and Z, with the truth.
ColorErrors color_errors(const SpectralScene& scene, const std::vector<ReflectionChain>& chains,
                         FunctionRef<Xyz(std::size_t light, const ReflectionChain& chain)> computed);

/// Measures a basis: light vectors, surface matrices and a matrix that reads X, Y and Z.
ColorErrors basis_errors(const SpectralScene& scene, const SpectralBasis& basis,
                         const std::vector<ReflectionChain>& chains);

/// Measures red, green and blue: albedos under D65, clamped to 0 to 1 as textures are, times the light's colour.
ColorErrors rgb_errors(const SpectralScene& scene, const RgbLift& lift, const std::vector<ReflectionChain>& chains);

/// Measures albedos lifted to smooth reflectances and then computed in full: the error that is left where an artist
/// knows the lights' spectra but only the surfaces' colours.
ColorErrors lifted_errors(const SpectralScene& scene, const RgbLift& lift, const std::vector<ReflectionChain>& chains);

}  // namespace kiln
