#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace kiln {

/// Points that receive light: texels of an atlas, vertices, pixels of a picture. Unit normals; one of each per point.
struct Receivers {
  std::span<const Eigen::Vector3f> positions;
  std::span<const Eigen::Vector3f> normals;

  std::size_t size() const { return positions.size(); }
};

/// Transfer vectors of many receivers (t_i of the numeric contract), plane after plane: value of coefficient i at
/// receiver r is values[i * receivers + r].
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

/// ||a - b|| / ||b|| over all receivers and coefficients; `b` is the reference. Sums in float64.
double relative_l2(const TransferVectors& a, const TransferVectors& b);

/// The same over all channels together.
double relative_l2(std::span<const TransferVectors> a, std::span<const TransferVectors> b);

/// Expected relighting error sqrt(sum d'Sd / sum t'St) with d = a - b, t = b, under lighting_prior.
double expected_relighting_error(const TransferVectors& a, const TransferVectors& b);

/// The same over all channels together.
double expected_relighting_error(std::span<const TransferVectors> a, std::span<const TransferVectors> b);

/// An error of many receivers, measured on some of them.
struct SampledError {
  double value = 0;
  /// With a confidence of 95 % all receivers' own is within this of it; 0 where all were measured. It is 1.96 standard
  /// errors of a ratio of means (Cochran, "Sampling techniques", 1977, 6.4), and needs a few hundred receivers whose
  /// errors are not those of a handful alone.
  double uncertainty = 0;
};

/// relative_l2 of `population` receivers, of which `a` and `b` have some that are spread evenly.
SampledError sampled_relative_l2(std::span<const TransferVectors> a, std::span<const TransferVectors> b,
                                 std::size_t population);

/// expected_relighting_error of them.
SampledError sampled_relighting_error(std::span<const TransferVectors> a, std::span<const TransferVectors> b,
                                      std::size_t population);

/// Diagonal of the second moment of lighting coefficients, by band: (l + 1)^-2. Photographed environments have power
/// spectra that fall about as the square of the frequency (Dror, Willsky and Adelson, "Statistical characterization of
/// real-world illumination", 2004, section 4); only the ratios between bands matter.
std::vector<double> lighting_prior(int bands);

}  // namespace kiln
