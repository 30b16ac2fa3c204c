// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "spectrum/spectral_error.h"

namespace kiln {

/// A few wavelengths that stand for all: each is a channel of its own through any number of reflections, since a
/// surface reflects each by itself. What is left at the end is read by a matrix for each lamp.
struct WavelengthSet {
  std::vector<int> wavelengths_nm = {};       ///< rising
  std::vector<Eigen::MatrixXd> readers = {};  ///< per light of the scene, 3 x m: X, Y and Z from what comes back, of 1
};

/// Chooses `size` wavelengths, 1 to 16, of 400 to 700 nm in steps of 5 for a scene's lights and surfaces, one after
/// another and then by exchanges, so that X, Y and Z after one to three reflections are read best: least squares of
/// L*, a* and b*'s slopes beside the lamp's white, dark colours weighted as the eye does. White under each lamp is read
/// exactly.
WavelengthSet find_wavelengths(const SpectralScene& scene, int size);

/// Measures such a set.
ColorErrors wavelength_errors(const SpectralScene& scene, const WavelengthSet& set,
                              const std::vector<ReflectionChain>& chains);

}  // namespace kiln
