// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "report/error_samples.h"
#include "report/transfer_rows.h"

namespace kiln {

/// Squares of E by band: that of `n` bands is the sum of the first n.
using BandSquares = std::vector<double>;

/// Points that count for a step.
enum class StepPoints { all, inside_charts, at_borders };

/// One thing that changes on the way from what is seen to what is stored.
struct CauseStep {
  std::string cause;
  const Station& from;
  const Station& to;
  StepPoints points = StepPoints::all;
  std::string without = {};  ///< earlier cause that this step has in it, whose squares are taken out
};

/// Squares, weighted by the prior over light.
struct WeightedSquares {
  BandSquares by_band;           ///< sums over pixels
  std::vector<double> by_pixel;  ///< sums over bands

  double total() const { return std::accumulate(by_band.begin(), by_band.end(), 0.0); }
};

/// Returns the half-width of the 95 % confidence interval of sqrt(a / b + more), for sums over pixels as they happened
/// to fall ([Cochran 1977], section 6.4).
double uncertainty_of_root(const WeightedSquares& a, const WeightedSquares& b, double more);

/// Sums squares over pixels.
class PixelSums {
 public:
  /// Keeps a reference to `samples`. `prior` has the moments of light by band.
  PixelSums(const ErrorSamples& samples, std::vector<double> prior) : samples_(samples), prior_(std::move(prior)) {}

  /// Returns d' S d by band, in the sum over pixels; d is a step's difference in the mean over a pixel's points, and
  /// the product is of its two estimates. Vectors hold `bands` bands of each channel.
  WeightedSquares of_step(const CauseStep& step, int bands) const;

  /// Returns t' S t by band, likewise.
  WeightedSquares of_vectors(const Station& vectors, int bands) const;

 private:
  bool counts(std::size_t point, StepPoints points) const {
    return points == StepPoints::all || samples_.lookups[point].at_border == (points == StepPoints::at_borders);
  }

  using AddPoint = std::function<void(std::size_t point, Eigen::ArrayXd& first, Eigen::ArrayXd& second)>;
  WeightedSquares sum(int bands, StepPoints points, std::size_t length, const AddPoint& add_point) const;

  const ErrorSamples& samples_;
  const std::vector<double> prior_;
};

}  // namespace kiln
