// SPDX-License-Identifier: MIT
#include "sh/product.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <memory>
#include <mutex>

#include "sh/basis.h"
#include "sh/quadrature.h"

namespace kiln {

namespace {

constexpr int most_bands = 6;

}  // namespace

ShProduct::ShProduct(int bands) : bands_(bands) {
  assert(bands >= 1 && bands <= most_bands);
  const ShBasis basis(bands);
  const SphereQuadrature quadrature = exact_quadrature(3 * (bands - 1));
  std::vector<std::vector<double>> values(quadrature.directions.size(), std::vector<double>(basis.size()));
  for (std::size_t s = 0; s < values.size(); ++s) basis.evaluate<double>(quadrature.directions[s], values[s]);
  for (int i = 0; i < basis.size(); ++i)
    for (int j = i; j < basis.size(); ++j)
      for (int k = j; k < basis.size(); ++k) {
        double sum = 0;
        for (std::size_t s = 0; s < values.size(); ++s)
          sum += quadrature.weights[s] * values[s][i] * values[s][j] * values[s][k];
        // Products that vanish by symmetry come out at some 1e-16; the least of the others is above 0.005.
        if (std::abs(sum) > 1e-10)
          entries_.push_back(
              {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j), static_cast<std::uint8_t>(k), sum});
      }
}

const ShProduct& ShProduct::of_bands(int bands) {
  assert(bands >= 1 && bands <= most_bands);
  static std::array<std::once_flag, most_bands + 1> once;
  static std::array<std::unique_ptr<const ShProduct>, most_bands + 1> products;
  std::call_once(once[bands], [&] { products[bands] = std::make_unique<const ShProduct>(bands); });
  return *products[bands];
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
  return {sums.begin(), sums.end()};
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
