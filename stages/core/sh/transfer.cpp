// SPDX-License-Identifier: MIT
#include "sh/transfer.h"

#include <cassert>
#include <cmath>

#include "sh/basis.h"
#include "sh/light_prior.h"

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

SampledError sampled_error(std::span<const TransferVectors> a, std::span<const TransferVectors> b,
                           const std::vector<double>& band_weights, std::size_t population) {
  const std::size_t count = b.front().receivers;
  std::vector<double> differences(count, 0.0), references(count, 0.0);  // squared lengths
  for (std::size_t channel = 0; channel < b.size(); ++channel)
    for (int i = 0; i < b[channel].coefficients; ++i) {
      const double weight = band_weights[band_of(i)];
      for (std::size_t r = 0; r < count; ++r) {
        const double t = b[channel].plane(i)[r], d = a[channel].plane(i)[r] - t;
        differences[r] += weight * d * d;
        references[r] += weight * t * t;
      }
    }
  SampledError error{weighted_error(a, b, band_weights), 0};
  if (count < 2 || population <= count || error.value == 0) return error;
  const double ratio = error.value * error.value;
  double squares = 0, reference = 0;
  for (std::size_t r = 0; r < count; ++r) {
    const double residual = differences[r] - ratio * references[r];
    squares += residual * residual;
    reference += references[r];
  }
  const auto n = static_cast<double>(count), all = static_cast<double>(population);
  const double deviation = std::sqrt(squares / (n - 1)) / (reference / n);  // of the ratio, one receiver
  error.uncertainty = 1.96 * deviation * std::sqrt((1 - n / all) / n) / (2 * error.value);
  return error;
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

SampledError sampled_relative_l2(std::span<const TransferVectors> a, std::span<const TransferVectors> b,
                                 std::size_t population) {
  return sampled_error(a, b, std::vector<double>(bands_of(b.front()), 1.0), population);
}

SampledError sampled_relighting_error(std::span<const TransferVectors> a, std::span<const TransferVectors> b,
                                      std::size_t population) {
  return sampled_error(a, b, lighting_prior(bands_of(b.front())), population);
}

}  // namespace kiln
