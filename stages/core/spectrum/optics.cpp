// SPDX-License-Identifier: GPL-3.0-or-later
// The examples of [Peercy 1995]: smooth interfaces, thin films and fluorescence, each by its closed form.

#include "spectrum/optics.h"

#include <cmath>
#include <numbers>

namespace kiln {

namespace {

using Complex = std::complex<double>;

/// Amplitudes that an interface reflects, from a medium of index `before` to one of index `behind`, with the cosines of
/// the light's angles in them.
struct Amplitudes {
  Complex perpendicular;
  Complex parallel;
};

Amplitudes amplitudes(Complex before, Complex cosine_before, Complex behind, Complex cosine_behind) {
  return {(before * cosine_before - behind * cosine_behind) / (before * cosine_before + behind * cosine_behind),
          (behind * cosine_before - before * cosine_behind) / (behind * cosine_before + before * cosine_behind)};
}

/// Returns the cosine inside a medium by Snell's law. Light decays away from the interface: the root with a positive
/// imaginary part.
Complex cosine_inside(double cosine_in_air, Complex index) {
  const Complex cosine = std::sqrt(1.0 - (1 - cosine_in_air * cosine_in_air) / (index * index));
  return (index * cosine).imag() < 0 ? -cosine : cosine;
}

PolarisedReflectance shares(const Amplitudes& reflected) {
  return {std::norm(reflected.perpendicular), std::norm(reflected.parallel)};
}

}  // namespace

PolarisedReflectance fresnel_reflectance(double cosine, Complex index) {
  if (cosine == 0) return {1, 1};
  return shares(amplitudes(1, cosine, index, cosine_inside(cosine, index)));
}

PolarisedReflectance film_reflectance(const ThinFilm& film, double cosine, double wavelength_nm) {
  if (cosine == 0) return {1, 1};
  const Complex in_film = cosine_inside(cosine, film.index), in_base = cosine_inside(cosine, film.base_index);
  const Amplitudes top = amplitudes(1, cosine, film.index, in_film);
  const Amplitudes bottom = amplitudes(film.index, in_film, film.base_index, in_base);
  // Light is late by this phase after it has crossed the film twice.
  const Complex phase = 4 * std::numbers::pi * film.index * film.thickness_nm * in_film / wavelength_nm;
  const Complex turn = std::exp(Complex(0, 1) * phase);
  const auto sum = [&](Complex first, Complex second) {
    return (first + second * turn) / (1.0 + first * second * turn);
  };
  return shares({sum(top.perpendicular, bottom.perpendicular), sum(top.parallel, bottom.parallel)});
}

Spectrum film_spectrum(const ThinFilm& film, double cosine) {
  Spectrum spectrum(wavelength_count);
  for (int i = 0; i < wavelength_count; ++i) spectrum(i) = film_reflectance(film, cosine, wavelength_nm(i)).mean();
  return spectrum;
}

SpectrumMatrix reradiation_matrix(const FluorescentSurface& surface) {
  SpectrumMatrix matrix = surface.reflectance.matrix().asDiagonal();
  const double photons = surface.emission.sum();
  for (int in = 0; in < wavelength_count; ++in)
    for (int out = in + 1; out < wavelength_count; ++out)
      matrix(out, in) += surface.yield * surface.absorption(in) * surface.emission(out) / photons * wavelength_nm(in) /
                         wavelength_nm(out);
  return matrix;
}

}  // namespace kiln
