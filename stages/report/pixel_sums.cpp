// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/pixel_sums.h"

#include <cmath>

#include "sh/basis.h"

namespace kiln {

namespace {

Eigen::ArrayXd as_array(const TransferRows& vectors, std::size_t point) {
  const std::span<const float> values = vectors.of(point);
  return Eigen::Map<const Eigen::ArrayXf>(values.data(), static_cast<Eigen::Index>(values.size())).cast<double>();
}

}  // namespace

double uncertainty_of_root(const WeightedSquares& a, const WeightedSquares& b, double more) {
  const double norm = b.total(), ratio = a.total() / norm;
  double sum = 0;
  for (std::size_t k = 0; k < a.by_pixel.size(); ++k) {
    const double residual = a.by_pixel[k] - ratio * b.by_pixel[k];
    sum += residual * residual;
  }
  return 1.96 * std::sqrt(sum) / norm / (2 * std::sqrt(ratio + more));
}

WeightedSquares PixelSums::of_step(const CauseStep& step, int bands) const {
  return sum(bands, step.points, step.from.first.length,
             [&](std::size_t point, Eigen::ArrayXd& first, Eigen::ArrayXd& second) {
               first += as_array(step.to.first, point) - as_array(step.from.first, point);
               second += as_array(step.to.second, point) - as_array(step.from.second, point);
             });
}

WeightedSquares PixelSums::of_vectors(const Station& vectors, int bands) const {
  return sum(bands, StepPoints::all, vectors.first.length,
             [&](std::size_t point, Eigen::ArrayXd& first, Eigen::ArrayXd& second) {
               first += as_array(vectors.first, point);
               second += as_array(vectors.second, point);
             });
}

WeightedSquares PixelSums::sum(int bands, StepPoints points, std::size_t length, const AddPoint& add_point) const {
  WeightedSquares squares{BandSquares(static_cast<std::size_t>(bands)), {}};
  const auto coefficients = static_cast<std::size_t>(coefficient_count(bands));
  Eigen::ArrayXd first(length), second(length);
  std::size_t begin = 0;
  for (std::size_t pixel = 0; pixel < samples_.pixels(); ++pixel) {
    const std::size_t end = samples_.pixel_ends[pixel];
    first.setZero();
    second.setZero();
    for (std::size_t point = begin; point < end; ++point)
      if (counts(point, points)) add_point(point, first, second);
    const double share = 1 / static_cast<double>(end - begin);
    const double weight = samples_.pixel_weights[pixel] * share * share;
    double of_pixel = 0;
    for (std::size_t i = 0; i < length; ++i) {
      const auto band = static_cast<std::size_t>(band_of(static_cast<int>(i % coefficients)));
      const auto at = static_cast<Eigen::Index>(i);
      const double square = weight * prior_[band] * first[at] * second[at];
      squares.by_band[band] += square;
      of_pixel += square;
    }
    squares.by_pixel.push_back(of_pixel);
    begin = end;
  }
  return squares;
}

}  // namespace kiln
