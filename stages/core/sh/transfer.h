// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace kiln {

/// Points that receive light (texels of an atlas, vertices, pixels of a picture) and their unit normals, one per point.
struct Receivers {
  std::span<const Eigen::Vector3f> positions;
  std::span<const Eigen::Vector3f> normals;

  std::size_t size() const { return positions.size(); }
};

/// Transfer vectors of many receivers, plane after plane: coefficient i of receiver r is values[i * receivers + r].
/// ARCHITECTURE.md, "Contracts", defines the coefficients t_i.
struct TransferVectors {
  std::size_t receivers = 0;
  int coefficients = 0;
  std::vector<float> values;

  TransferVectors() = default;
  TransferVectors(std::size_t receiver_count, int coefficient_count)
      : receivers(receiver_count), coefficients(coefficient_count), values(receiver_count * coefficient_count, 0.f) {}

  std::span<float> plane(int coefficient) { return {values.data() + coefficient * receivers, receivers}; }
  std::span<const float> plane(int coefficient) const { return {values.data() + coefficient * receivers, receivers}; }
};

/// Returns ||a - b|| / ||b|| over all receivers and coefficients; `b` is the reference. Sums in float64.
double relative_l2(const TransferVectors& a, const TransferVectors& b);

/// Returns relative_l2 over all channels together.
double relative_l2(std::span<const TransferVectors> a, std::span<const TransferVectors> b);

/// Returns E, the expected relighting error sqrt(sum d'Sd / sum t'St) with d = a - b, t = b and S = lighting_prior
/// (sh/light_prior.h; docs/error.md says what it predicts).
double expected_relighting_error(const TransferVectors& a, const TransferVectors& b);

/// Returns expected_relighting_error over all channels together.
double expected_relighting_error(std::span<const TransferVectors> a, std::span<const TransferVectors> b);

/// Error of a population of receivers, estimated from a sample of them.
struct SampledError {
  double value = 0;
  /// Half-width of the 95 % confidence interval of `value`; 0 where all receivers were measured. It is 1.96 standard
  /// errors of a ratio of means ([Cochran 1977], section 6.4), and needs a few hundred receivers, no handful of which
  /// dominates the error.
  double uncertainty = 0;
};

/// Estimates relative_l2 of `population` receivers from an evenly spread sample of them, `a` and `b`.
SampledError sampled_relative_l2(std::span<const TransferVectors> a, std::span<const TransferVectors> b,
                                 std::size_t population);

/// Estimates expected_relighting_error of `population` receivers likewise.
SampledError sampled_relighting_error(std::span<const TransferVectors> a, std::span<const TransferVectors> b,
                                      std::size_t population);

}  // namespace kiln
