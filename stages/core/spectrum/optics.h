// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>

#include "spectrum/spectrum.h"

namespace kiln {

/// Light that a smooth interface reflects, by polarisation.
struct PolarisedReflectance {
  double perpendicular = 0;  ///< s: the electric field is perpendicular to the plane of incidence
  double parallel = 0;       ///< p

  /// Returns the share of light without polarisation.
  double mean() const { return (perpendicular + parallel) / 2; }
};

/// Returns Fresnel's reflectance of an interface for light that arrives in air (or in any medium without loss, for
/// indices relative to its own): `index` is n + i k of the medium behind, k = 0 or more; `cosine`, of the angle to the
/// normal, is 0 to 1 [Born 1999, sections 1.5 and 14.2].
PolarisedReflectance fresnel_reflectance(double cosine, std::complex<double> index);

/// Layer of constant thickness upon a base, in air.
struct ThinFilm {
  double index = 1.33;                       ///< of the film, above 0, without loss
  std::complex<double> base_index = {1, 0};  ///< of what it lies on; 1 for a bubble
  double thickness_nm = 300;                 ///< 0 or more
};

/// Returns the share of light that a film reflects, all reflections inside it summed after Airy [Born 1999, section
/// 7.6]; `cosine` is that of the angle in air.
PolarisedReflectance film_reflectance(const ThinFilm& film, double cosine, double wavelength_nm);

/// Returns a film's reflectance of light without polarisation at the room's wavelengths.
Spectrum film_spectrum(const ThinFilm& film, double cosine);

/// Surface that fluoresces: it absorbs light and sends a part of its photons out at longer wavelengths.
struct FluorescentSurface {
  Spectrum reflectance = {};  ///< of light whose wavelength stays
  Spectrum absorption = {};   ///< share of the photons that excite it; with the reflectance at most 1
  Spectrum emission = {};     ///< photons sent out by wavelength, in any unit
  double yield = 1;           ///< photons sent out per photon absorbed, 0 to 1
};

/// Returns the matrix from light that arrives (columns) to light that leaves (rows) [Donaldson 1954]. A photon of
/// wavelength i that leaves at o keeps i / o of its energy; none leaves at a shorter wavelength than it came with, so
/// that no energy is made. A photon that would have to is not sent out.
SpectrumMatrix reradiation_matrix(const FluorescentSurface& surface);

}  // namespace kiln
