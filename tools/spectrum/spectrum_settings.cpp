// SPDX-License-Identifier: GPL-3.0-or-later
#include "spectrum/spectrum_settings.h"

namespace kiln {

OptionSet spectrum_options(SpectrumSettings& settings) {
  OptionSet options;
  options
      .text("lights", settings.lights,
            "Lights of the scene between commas: A to E, F1 to F12, D65 or D5600 for daylight, P2856 for a black body, "
            "sun:20 for the sun, or files")
      .text("reflectances", settings.reflectances,
            "Reflectances of its surfaces between commas: CIE-TCS, or files of one or more")
      .number("error", settings.error, 0.01, 100, "Difference that no light and surfaces may exceed, CIEDE2000")
      .integer("reflections", settings.reflections, 1, 6, "Reflections of the comparison beside direct light")
      .integer_or_auto("size", settings.size, 1, 16,
                       "Functions of the basis that is written; auto: the fewest within the error")
      .choice(
          "basis", settings.basis,
          {{"characteristic", BasisKind::characteristic}, {"lights", BasisKind::lights}, {"points", BasisKind::points}},
          "Functions: characteristic vectors of the scene's light as it is seen, the lights themselves, or even "
          "wavelengths")
      .choice("observer", settings.observer, {{"1931", Observer::cie_1931}, {"1964", Observer::cie_1964}},
              "The CIE's standard observer: of 1931 (2 degrees) or of 1964 (10 degrees)")
      .text("standards", settings.standards, "Folder of the CIE's spectra, as the package colord-data installs it");
  return options;
}

}  // namespace kiln
