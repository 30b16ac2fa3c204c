// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "spectrum/spectrum.h"

namespace kiln {

/// Standard observers.
enum class Observer { cie_1931, cie_1964 };

/// Lights, observers and reflectances of the CIE, read from the folder that Debian's package colord-data installs.
class StandardSpectra {
 public:
  static constexpr const char* installed_folder = "/usr/share/colord";

  /// Throws MachineLacks where the folder does not have the package's files.
  explicit StandardSpectra(std::filesystem::path folder = installed_folder);

  /// Returns a light by name, in any case of letters, scaled so that a perfect white under it has Y = 1 for the 1931
  /// observer:
  /// - an illuminant of the CIE: A, B, C, D50, D55, D65, D93, E, F1 to F12, as tabulated;
  /// - any other D and two digits (D75), the daylight of nominal temperature 7500 K, or D and four or five digits
  ///   (D5600), that of the correlated colour temperature: 4000 to 25000 K;
  /// - P and a temperature (P2856): a black body of 500 to 100000 K;
  /// - sun:ELEVATION, the sun's disc at 0 to 90 degrees above the horizon in clear air (sunlight), or the same of an
  ///   hour (parse_sun_hour);
  /// - else a file of one spectrum.
  /// Throws WrongUsage for a name that is none, BadInput for a file.
  NamedSpectrum light(const std::string& name) const;

  /// Returns reflectances by name: CIE-TCS, the test colour samples of the CIE's colour rendering index (TCS01 to 14,
  /// and TCS15), or the spectra of a file. Throws as light().
  std::vector<NamedSpectrum> reflectances(const std::string& name) const;

  /// Returns one reflectance: TCS01 to TCS15, a test colour sample of the CIE, or that of a file which holds one.
  /// Throws as light().
  NamedSpectrum reflectance(const std::string& name) const;

  /// Returns x, y and z of an observer in three columns.
  SpectrumMatrix observer(Observer observer) const;

  /// Returns daylight of a correlated colour temperature of 4000 to 25000 K, 1 at 560 nm [CIE 15, section 3.1].
  Spectrum daylight(double temperature_kelvin) const;

  /// Returns names of the lights that have tables.
  static const std::vector<std::string>& light_names();

 private:
  std::filesystem::path folder_;
};

/// Returns the radiance of a black body after Planck, 1 at 560 nm. Temperature in K, above 0; c2 is 1.4388e-2 m K.
Spectrum black_body(double temperature_kelvin);

/// Returns the light of the sun's disc at an elevation of 0 to 90 degrees, 1 at 560 nm above the air: a black body of
/// 5778 K, dimmed by molecules and by aerosols of a turbidity of 2 (a clear sky), after the appendix of [Preetham
/// 1999].
Spectrum sunlight(double elevation_degrees);

}  // namespace kiln
