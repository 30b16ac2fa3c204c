// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kiln {

/// Multiplies functions on the sphere given in spherical harmonics: coefficient k of f g is the sum over i and j of
/// f_i g_j times the triple product of Y_i, Y_j and Y_k (real Gaunt coefficients). The product of two functions of n
/// bands has 2n - 1; what is above the first n is cut off, as in D3DXSHMultiply [D3DX].
class ShProduct {
 public:
  /// `bands` of 1 to 6. The triple products are computed once, by quadrature that is exact for them.
  explicit ShProduct(int bands);

  /// Returns the product of that many bands, made at its first use; safe to call from several threads.
  static const ShProduct& of_bands(int bands);

  int bands() const { return bands_; }

  /// Multiplies `f` and `g`; both and the result have bands^2 coefficients.
  std::vector<float> operator()(std::span<const float> f, std::span<const float> g) const;

  /// Returns the integral of Y_i Y_j Y_k; indices below bands^2, in any order.
  double triple(int i, int j, int k) const;

  /// Counts the triples i <= j <= k whose product is not zero.
  std::size_t nonzero_triples() const { return entries_.size(); }

 private:
  struct Entry {
    std::uint8_t i, j, k;  ///< ascending
    double value;
  };
  int bands_;
  std::vector<Entry> entries_;  ///< sorted by i, j, k
};

}  // namespace kiln
