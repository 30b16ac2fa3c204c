#include "sh/transfer.h"

#include <cassert>
#include <cmath>

#include "sh/basis.h"

namespace kiln {

namespace {

double weighted_error(std::span<const TransferVectors> a, std::span<const TransferVectors> b,
                      const std::vector<double>& band_weights) {
  assert(a.size() == b.size());
  double difference = 0, reference = 0;
  for (std::size_t channel = 0; channel < b.size(); ++channel) {
    const TransferVectors &one = a[channel], &other = b[channel];
    assert(one.receivers == other.receivers && one.coefficients == other.coefficients);
    for (int i = 0; i < other.coefficients; ++i) {
      double plane_difference = 0, plane_reference = 0;
      for (std::size_t r = 0; r < other.receivers; ++r) {
        const double t = other.plane(i)[r], d = one.plane(i)[r] - t;
        plane_difference += d * d;
        plane_reference += t * t;
      }
      const double weight = band_weights[band_of(i)];
      difference += weight * plane_difference;
      reference += weight * plane_reference;
    }
  }
  if (difference == 0) return 0;
  return std::sqrt(difference / reference);
}

int bands_of(const TransferVectors& transfer) { return band_of(transfer.coefficients - 1) + 1; }

}  // namespace

double relative_l2(const TransferVectors& a, const TransferVectors& b) {
  return relative_l2(std::span(&a, 1), std::span(&b, 1));
}

double relative_l2(std::span<const TransferVectors> a, std::span<const TransferVectors> b) {
  return weighted_error(a, b, std::vector<double>(bands_of(b.front()), 1.0));
}

double expected_relighting_error(const TransferVectors& a, const TransferVectors& b) {
  return expected_relighting_error(std::span(&a, 1), std::span(&b, 1));
}

double expected_relighting_error(std::span<const TransferVectors> a, std::span<const TransferVectors> b) {
  return weighted_error(a, b, lighting_prior(bands_of(b.front())));
}

std::vector<double> lighting_prior(int bands) {
  std::vector<double> prior(bands);
  for (int l = 0; l < bands; ++l) prior[l] = 1.0 / ((l + 1.0) * (l + 1.0));
  return prior;
}

}  // namespace kiln
