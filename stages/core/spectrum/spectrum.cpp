// SPDX-License-Identifier: GPL-3.0-or-later
#include "spectrum/spectrum.h"

#include <algorithm>

namespace kiln {

Spectrum resample(const SampledSpectrum& sampled) {
  const std::vector<double>& at = sampled.wavelengths_nm;
  const std::vector<double>& values = sampled.values;
  Spectrum spectrum(wavelength_count);
  for (int i = 0; i < wavelength_count; ++i) {
    const double wavelength = wavelength_nm(i);
    const auto above = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), wavelength) - at.begin());
    if (above == 0 || above == at.size()) {
      spectrum(i) = above == 0 ? values.front() : values.back();
      continue;
    }
    const double share = (wavelength - at[above - 1]) / (at[above] - at[above - 1]);
    spectrum(i) = values[above - 1] + share * (values[above] - values[above - 1]);
  }
  return spectrum;
}

Spectrum flat_spectrum(double value) { return Spectrum::Constant(wavelength_count, value); }

}  // namespace kiln
