// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/options.h"
#include "spectrum/standards.h"

namespace kiln {

enum class BasisKind { characteristic, lights, points };

/// Settings of kiln-spectrum.
struct SpectrumSettings {
  std::string lights = "D65,A,F11";      ///< names between commas (StandardSpectra::light)
  std::string reflectances = "CIE-TCS";  ///< names between commas (StandardSpectra::reflectances)
  double error = 1;                      ///< CIEDE2000 that no combination of light and surfaces may exceed
  int reflections = 3;                   ///< of the second comparison, beside direct light
  int size = 0;                          ///< functions of the basis that is written; 0: the fewest within the error
  BasisKind basis = BasisKind::characteristic;
  Observer observer = Observer::cie_1931;
  std::string standards = StandardSpectra::installed_folder;
};

/// Returns the options, bound to the settings.
OptionSet spectrum_options(SpectrumSettings& settings);

}  // namespace kiln
