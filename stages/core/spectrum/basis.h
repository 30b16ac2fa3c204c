// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "spectrum/spectrum.h"

namespace kiln {

/// Generalised linear colour [Peercy 1995]: light is a sum of m functions, described by its m weights, the light
/// vector; a surface is an m x m matrix from light that arrives to light that leaves; a sensor of k channels is a k x m
/// matrix that reads the light.
struct SpectralBasis {
  std::string kind = {};          ///< "characteristic", "lights" or "points"
  SpectrumMatrix functions = {};  ///< a column per function
  SpectrumMatrix duals = {};      ///< a column per function: the weights of any light are its dot products with these

  int size() const { return static_cast<int>(functions.cols()); }
};

/// What a basis is made for: lights, reflectances, and the observer's functions (columns X, Y and Z), which weigh what
/// of their light matters.
struct SpectralScene {
  std::vector<NamedSpectrum> lights = {};
  std::vector<NamedSpectrum> reflectances = {};
  SpectrumMatrix observer = {};
};

/// Finds bases for a scene. At least one light and one reflectance.
///
/// Characteristic vectors are those of the light {L, L r, L r r'} for all lights L and reflectances r and r', weighted
/// by what of it is seen at last: {c, c r, c r r'} for the slopes c of L*, a* and b* beside the lamp's white. Both are
/// moment matrices over wavelengths, and as sets of products they are (sum of L L') times 1 + G + G^2 entry by entry,
/// with G the moment of the reflectances; so any number of reflectances costs no more than their sum. The functions are
/// the directions of light that is both strong and seen (balanced truncation [Moore 1981]).
///
/// The weights of a light are those that come closest, in what is seen, among all that keep its X, Y and Z exactly. So
/// white under every lamp, and whatever a surface sends out, keeps its colour when it is projected; only what becomes
/// of it at the next reflection is approximate. Where a basis has fewer than three functions, they keep it as well as
/// they can.
class BasisFinder {
 public:
  explicit BasisFinder(const SpectralScene& scene);

  /// Returns the number of characteristic vectors that a scene has, beyond which they are rounding.
  int rank() const { return rank_; }

  /// Returns the first `size` characteristic vectors, 1 to rank().
  SpectralBasis characteristic(int size) const;

  /// Returns the lights themselves as functions, those that are no sum of others before them.
  SpectralBasis lights() const;

  /// Returns hat functions around `size` wavelengths, evenly from 400 to 700 nm, at least 2: light is sampled there,
  /// and surface matrices are diagonal.
  SpectralBasis points(int size) const;

 private:
  SpectralBasis with_duals(std::string kind, SpectrumMatrix functions) const;

  SpectralScene scene_;
  SpectrumMatrix seen_;        ///< columns whose dot products with light are what is seen of it
  SpectrumMatrix directions_;  ///< characteristic vectors, strongest first
  int rank_ = 0;
};

/// Returns the weights of a light: its projection, and, where that moves X, Y and Z (as with points), the smallest
/// change that restores them.
Eigen::VectorXd light_vector(const SpectralBasis& basis, const Spectrum& light, const SpectrumMatrix& observer);

/// Returns the matrix of a surface that reflects each wavelength by itself.
Eigen::MatrixXd surface_matrix(const SpectralBasis& basis, const Spectrum& reflectance);

/// Returns the matrix of a surface that also shifts light between wavelengths: entry (o, i) of `reradiation` is the
/// light that leaves at wavelength o per light that arrives at wavelength i.
Eigen::MatrixXd surface_matrix(const SpectralBasis& basis, const SpectrumMatrix& reradiation);

/// Returns the matrix of a sensor, from weights to its channels' values. `responses` has a column per channel.
Eigen::MatrixXd sensor_matrix(const SpectralBasis& basis, const SpectrumMatrix& responses);

}  // namespace kiln
