// SPDX-License-Identifier: MIT
#include "sh/product.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <mutex>

#include "sh/basis.h"
#include "sh/quadrature.h"

namespace kiln {

namespace {

constexpr int most_bands = 19;  // twice ten, less one: all bands of a product of ten

/// Tells whether the product of three basis functions can differ from zero: their bands form a triangle of even
/// circumference, one of their orders equals the others' sum or difference, and an even number of them are sines.
bool may_differ_from_zero(int i, int j, int k) {
  const std::array<int, 3> bands = {band_of(i), band_of(j), band_of(k)};
  const std::array<int, 3> orders = {i - coefficient_index(bands[0], 0), j - coefficient_index(bands[1], 0),
                                     k - coefficient_index(bands[2], 0)};
  if ((bands[0] + bands[1] + bands[2]) % 2 != 0 || bands[2] > bands[0] + bands[1] ||
      bands[2] < std::abs(bands[0] - bands[1]))
    return false;
  const int sines = (orders[0] < 0) + (orders[1] < 0) + (orders[2] < 0);
  const int a = std::abs(orders[0]), b = std::abs(orders[1]), c = std::abs(orders[2]);
  return sines % 2 == 0 && (c == a + b || c == std::abs(a - b));
}

}  // namespace

ShProduct::ShProduct(int bands, int result_bands) : bands_(bands), result_bands_(result_bands) {
  assert(bands >= 1 && bands <= most_bands && result_bands >= 1 && result_bands <= bands);
  const ShBasis basis(bands);
  const SphereQuadrature quadrature = exact_quadrature(3 * (bands - 1));
  const std::size_t places = quadrature.directions.size();
  std::vector<std::vector<double>> values(basis.size(), std::vector<double>(places));  // by function, then place
  std::vector<double> there(basis.size());
  for (std::size_t s = 0; s < places; ++s) {
    basis.evaluate<double>(quadrature.directions[s], there);
    for (int i = 0; i < basis.size(); ++i) values[i][s] = there[i];
  }
  std::vector<double> pair(places);
  for (int i = 0; i < coefficient_count(result_bands); ++i)
    for (int j = i; j < basis.size(); ++j) {
      for (std::size_t s = 0; s < places; ++s) pair[s] = quadrature.weights[s] * values[i][s] * values[j][s];
      for (int k = j; k < basis.size(); ++k) {
        if (!may_differ_from_zero(i, j, k)) continue;
        double sum = 0;
        for (std::size_t s = 0; s < places; ++s) sum += pair[s] * values[k][s];
        // Products that vanish all the same come out at some 1e-15.
        if (std::abs(sum) > 1e-10)
          entries_.push_back(
              {static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(j), static_cast<std::uint16_t>(k), sum});
      }
    }
}

const ShProduct& ShProduct::of_bands(int bands, int result_bands) {
  assert(bands >= 1 && bands <= most_bands && result_bands >= 1 && result_bands <= bands);
  constexpr std::size_t side = most_bands + 1;
  static std::array<std::once_flag, side * side> once;
  static std::array<std::unique_ptr<const ShProduct>, side * side> products;
  const std::size_t slot = static_cast<std::size_t>(bands) * side + static_cast<std::size_t>(result_bands);
  std::call_once(once[slot], [&] { products[slot] = std::make_unique<const ShProduct>(bands, result_bands); });
  return *products[slot];
}

std::vector<float> ShProduct::operator()(std::span<const float> f, std::span<const float> g) const {
  assert(static_cast<int>(f.size()) == coefficient_count(bands_) && f.size() == g.size());
  std::vector<double> sums(f.size(), 0.0);
  for (const auto& [i, j, k, value] : entries_) {
    // Add each order of the three indices once.
    if (i == j && j == k) {
      sums[k] += value * f[i] * g[i];
    } else if (i == j) {
      sums[k] += value * f[i] * g[i];
      sums[i] += value * (f[i] * g[k] + f[k] * g[i]);
    } else if (j == k) {
      sums[i] += value * f[j] * g[j];
      sums[j] += value * (f[i] * g[j] + f[j] * g[i]);
    } else {
      sums[k] += value * (f[i] * g[j] + f[j] * g[i]);
      sums[j] += value * (f[i] * g[k] + f[k] * g[i]);
      sums[i] += value * (f[j] * g[k] + f[k] * g[j]);
    }
  }
  return {sums.begin(), sums.begin() + coefficient_count(result_bands_)};
}

double ShProduct::triple(int i, int j, int k) const {
  std::array<int, 3> sorted = {i, j, k};
  std::sort(sorted.begin(), sorted.end());
  const auto found =
      std::lower_bound(entries_.begin(), entries_.end(), sorted, [](const Entry& entry, const auto& key) {
        return std::array<int, 3>{entry.i, entry.j, entry.k} < key;
      });
  const bool is_there =
      found != entries_.end() && found->i == sorted[0] && found->j == sorted[1] && found->k == sorted[2];
  return is_there ? found->value : 0;
}

}  // namespace kiln
