// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace kiln {

/// Wavelengths at which every spectrum is held: 360 to 830 nm, the range of the CIE's observers, 1 nm apart. Sums over
/// them are integrals by the rule that Argyll uses, so that spectra tabulated every 5 nm and lamps with lines alike are
/// integrated in steps of 1 nm.
inline constexpr int first_wavelength_nm = 360;
inline constexpr int wavelength_count = 471;
constexpr double wavelength_nm(int index) { return first_wavelength_nm + index; }

/// Spectrum at these wavelengths: `wavelength_count` values. Power of light per nm in any unit, or a reflectance, or a
/// sensor's response.
using Spectrum = Eigen::ArrayXd;

/// Spectra side by side: a row per wavelength.
using SpectrumMatrix = Eigen::MatrixXd;

/// Spectrum as measured: values at rising wavelengths in nm.
struct SampledSpectrum {
  std::string name = {};
  std::vector<double> wavelengths_nm = {};
  std::vector<double> values = {};
};

/// Spectrum with a name.
struct NamedSpectrum {
  std::string name = {};
  Spectrum values = {};
};

/// Samples a measured spectrum at the room's wavelengths: linear between its samples, and beyond its ends as at them
/// [CIE 15]. At least one sample; wavelengths rise.
Spectrum resample(const SampledSpectrum& sampled);

/// Returns the spectrum whose values are all `value`.
Spectrum flat_spectrum(double value);

}  // namespace kiln
