// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kiln {

/// Multiplies functions on the sphere given in spherical harmonics: coefficient k of f g is the sum over i and j of
/// f_i g_j times the triple product of Y_i, Y_j and Y_k (real Gaunt coefficients). The product of two functions of n
/// bands has 2n - 1; what is above the bands of the result is cut off, as in D3DXSHMultiply [D3DX].
///
/// Band l of a product takes band j of one factor with bands |l - j| to l + j of the other. So the first r bands of a
/// product are exact if one factor has m bands, and as many of the other's are given as the smaller of all that it has
/// and r + m - 1.
class ShProduct {
 public:
  /// Both factors have `bands` bands, 1 to 19, and the result `result_bands`, 1 to `bands`. The triple products are
  /// computed once, by quadrature that is exact for them.
  explicit ShProduct(int bands) : ShProduct(bands, bands) {}
  ShProduct(int bands, int result_bands);

  /// Returns such a product, made at its first use; safe to call from several threads.
  static const ShProduct& of_bands(int bands) { return of_bands(bands, bands); }
  static const ShProduct& of_bands(int bands, int result_bands);

  int bands() const { return bands_; }
  int result_bands() const { return result_bands_; }

  /// Multiplies `f` and `g`, both of bands^2 coefficients; the result has result_bands^2.
  std::vector<float> operator()(std::span<const float> f, std::span<const float> g) const;

  /// Returns the integral of Y_i Y_j Y_k; indices below bands^2, in any order, one of them below result_bands^2.
  double triple(int i, int j, int k) const;

  /// Counts the triples i <= j <= k, i below result_bands^2, whose product is not zero.
  std::size_t nonzero_triples() const { return entries_.size(); }

 private:
  struct Entry {
    std::uint16_t i, j, k;  ///< ascending
    double value;
  };
  int bands_, result_bands_;
  std::vector<Entry> entries_;  ///< sorted by i, j, k
};

}  // namespace kiln
