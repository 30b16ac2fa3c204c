// SPDX-License-Identifier: MIT
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "sh/basis.h"
#include "sh/lights.h"
#include "sh/quadrature.h"
#include "sh/rotation.h"

namespace kiln {

namespace {

constexpr double pi = std::numbers::pi;

/// Integrates cos(m a) (the next function sin(m a)) over azimuths a from `first` to `last`.
double integral_of_cosine(int m, double first, double last) {
  return m == 0 ? last - first : (std::sin(m * last) - std::sin(m * first)) / m;
}
double integral_of_sine(int m, double first, double last) { return (std::cos(m * first) - std::cos(m * last)) / m; }

/// Returns, in row i, the integrals over the azimuths of column i: of cos(m a) in column m >= 0, of sin(m a) in column
/// bands - 1 + m.
Eigen::MatrixXd azimuth_integrals(int bands, int width) {
  Eigen::MatrixXd integrals(width, 2 * bands - 1);
  for (int i = 0; i < width; ++i) {
    const double first = 2 * pi * (static_cast<double>(i) / width - 0.5),
                 last = 2 * pi * (static_cast<double>(i + 1) / width - 0.5);
    for (int m = 0; m < bands; ++m) integrals(i, m) = integral_of_cosine(m, first, last);
    for (int m = 1; m < bands; ++m) integrals(i, bands - 1 + m) = integral_of_sine(m, first, last);
  }
  return integrals;
}

/// Integrates the elevation-dependent factor of Y_lm over a band of elevations, by coefficient_index(l, m), m >= 0.
std::vector<double> elevation_integrals(const ShBasis& basis, double lower, double upper) {
  // A polynomial of sines and cosines of degree l + 1: error falls faster than any power once a node stands for a
  // radian of its argument.
  const int nodes = static_cast<int>(std::ceil((basis.bands() + 1) * (upper - lower) / 2)) + 8;
  std::vector<double> sums(basis.size(), 0.0), values(basis.size());
  for (const LineNode& node : gauss_legendre(nodes)) {
    const double elevation = lower + (upper - lower) * (node.place + 1) / 2;
    // At azimuth 0 all of the cosines are 1.
    basis.evaluate<double>({std::cos(elevation), 0, std::sin(elevation)}, values);
    const double weight = node.weight * (upper - lower) / 2 * std::cos(elevation);
    for (int i = 0; i < basis.size(); ++i) sums[i] += weight * values[i];
  }
  return sums;
}

}  // namespace

LightCoefficients latitude_longitude_light(int bands, int width, int height, int channels,
                                           std::span<const float> pixels) {
  assert(pixels.size() == static_cast<std::size_t>(width) * height * channels);
  const ShBasis basis(bands);
  const Eigen::MatrixXd azimuths = azimuth_integrals(bands, width);
  LightCoefficients light{bands, {}};
  std::vector<std::vector<double>> sums(channels, std::vector<double>(basis.size(), 0.0));
  using Row = Eigen::Map<const Eigen::RowVectorXf, 0, Eigen::InnerStride<>>;
  // The picture's pole is +Y, the basis' is +Z: integrate where they are one, with x along +X, y along -Z and z along
  // +Y, so that azimuths run the other way there than in the picture.
  for (int j = 0; j < height; ++j) {
    const std::vector<double> elevations = elevation_integrals(basis, pi * (static_cast<double>(j) / height - 0.5),
                                                               pi * (static_cast<double>(j + 1) / height - 0.5));
    for (int c = 0; c < channels; ++c) {
      const Row row(pixels.data() + static_cast<std::size_t>(j) * width * channels + c, width,
                    Eigen::InnerStride<>(channels));
      const Eigen::RowVectorXd waves = row.cast<double>() * azimuths;
      for (int l = 0; l < bands; ++l)
        for (int m = 0; m <= l; ++m) {
          const double elevation = elevations[coefficient_index(l, m)];
          sums[c][coefficient_index(l, m)] += elevation * waves[m];
          if (m > 0) sums[c][coefficient_index(l, -m)] -= elevation * waves[bands - 1 + m];
        }
    }
  }
  for (const std::vector<double>& sum : sums) light.channels.emplace_back(sum.begin(), sum.end());
  Eigen::Matrix3d into_object;  // columns: where x, y and z of there lie
  into_object << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return ShRotation(bands, into_object)(light);
}

LightCoefficients cube_map_light(int bands, int size, int channels, std::span<const std::span<const float>, 6> faces) {
  // Direction of a face's centre, and of growing s and t.
  struct FaceAxes {
    Eigen::Vector3d centre, s, t;
  };
  static const std::array<FaceAxes, 6> axes = {{{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                                {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                                {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                                {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                                                {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},
                                                {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}}};
  const ShBasis basis(bands);
  // The distance has its nearest zero at s = i, so that n nodes leave (size + sqrt(size^2 + 1))^-2n, here 1e-7; a wave
  // of the basis takes more.
  const int nodes = static_cast<int>(std::ceil(8.06 / std::asinh(size) + 1.2 * bands / size));
  const std::vector<LineNode> line = gauss_legendre(nodes);
  std::vector<double> values(basis.size()), texel(basis.size());
  std::vector<std::vector<double>> sums(channels, std::vector<double>(basis.size(), 0.0));
  for (std::size_t face = 0; face < faces.size(); ++face) {
    assert(faces[face].size() == static_cast<std::size_t>(size) * size * channels);
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) {
        std::fill(texel.begin(), texel.end(), 0.0);
        for (const LineNode& across : line)
          for (const LineNode& down : line) {
            const double s = (2 * i + 1 + across.place) / size - 1, t = (2 * j + 1 + down.place) / size - 1;
            const Eigen::Vector3d place = axes[face].centre + s * axes[face].s + t * axes[face].t;
            const double distance = place.norm();
            // Solid angle is area times the cosine 1 / distance over the square of the distance.
            const double weight =
                across.weight * down.weight / (static_cast<double>(size) * size) / (distance * distance * distance);
            basis.evaluate<double>(place / distance, values);
            for (int k = 0; k < basis.size(); ++k) texel[k] += weight * values[k];
          }
        for (int channel = 0; channel < channels; ++channel) {
          const double radiance = faces[face][(static_cast<std::size_t>(j) * size + i) * channels + channel];
          for (int k = 0; k < basis.size(); ++k) sums[channel][k] += radiance * texel[k];
        }
      }
  }
  LightCoefficients light{bands, {}};
  for (const std::vector<double>& sum : sums) light.channels.emplace_back(sum.begin(), sum.end());
  return light;
}

}  // namespace kiln
