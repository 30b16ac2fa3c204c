// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/picture_difference.h"

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "report/pictures.h"

namespace kiln {

namespace {

/// Variance of a sum of squared differences that the noise of two estimates leaves, block of pixels after block. With d
/// the difference from the estimates' mean and h half of theirs from each other, which is noise alone and as large as
/// that of the mean, the sum is of d^2 - h^2.
class NoiseVariance {
 public:
  explicit NoiseVariance(int width) : blocks_across_((width + block - 1) / block) {}

  void add(int i, int j, double d, double h) {
    const auto at = static_cast<std::size_t>(j / block * blocks_across_ + i / block);
    if (at >= products_.size()) {
      products_.resize(at + 1);
      squares_.resize(at + 1);
    }
    products_[at] += d * h;
    squares_[at] += h * h;
  }

  double sum() const {
    double variance = 0;
    // Noise that is alike in a block: the square of a normal variable has two thirds of its mean square as variance,
    // and there are two such, those of the mean and of the half difference.
    for (std::size_t k = 0; k < products_.size(); ++k)
      variance += 4 * products_[k] * products_[k] + 4.0 / 3 * squares_[k] * squares_[k];
    return variance;
  }

 private:
  static constexpr int block = 8;
  int blocks_across_;
  std::vector<double> products_, squares_;
};

}  // namespace

Image<float> mean_of(const PictureEstimates& estimates) {
  Image<float> mean = estimates[0];
  for (std::size_t k = 0; k < mean.values().size(); ++k)
    mean.values()[k] = (mean.values()[k] + estimates[1].values()[k]) / 2;
  return mean;
}

PictureDifference compare_pictures(const Image<float>& picture, const Image<float>& reference) {
  return compare_pictures(picture, PictureEstimates{reference, reference});
}

PictureDifference compare_pictures(const Image<float>& picture, const PictureEstimates& reference) {
  PictureDifference result;
  double squared_error = 0, squared_reference = 0, squared_noise = 0;
  NoiseVariance variance(picture.width());
  for (int j = 0; j < picture.height(); ++j)
    for (int i = 0; i < picture.width(); ++i) {
      const std::span<const float> pixel = picture.pixel(i, j), first = reference[0].pixel(i, j),
                                   second = reference[1].pixel(i, j);
      if (!is_wholly_covered(pixel[3]) || !is_wholly_covered(first[3])) continue;
      ++result.pixels;
      for (std::size_t c = 0; c < 3; ++c) {
        const double a = first[c], b = second[c], x = pixel[c];
        squared_error += (x - a) * (x - b);
        squared_reference += a * b;
        squared_noise += (a - b) * (a - b) / 4;
        variance.add(i, j, x - (a + b) / 2, (a - b) / 2);
        // Keep a NaN once met: nothing compares greater than it.
        const double error = std::abs(x - (a + b) / 2);
        if (std::isnan(error) || error > result.largest) result.largest = error;
      }
    }
  if (result.pixels == 0) return result;
  if (squared_error < 0) squared_error = 0;  // less than its noise
  result.root_mean_square = std::sqrt(squared_error / static_cast<double>(3 * result.pixels));
  if (squared_reference > 0) {
    result.relative_l2 = std::sqrt(squared_error / squared_reference);
    result.reference_noise = std::sqrt(squared_noise / squared_reference);
    const double largest = squared_error + 1.96 * std::sqrt(variance.sum());
    result.relative_l2_uncertainty = std::sqrt(largest / squared_reference) - result.relative_l2;
  } else if (squared_error != 0) {
    result.relative_l2 = std::numeric_limits<double>::infinity();
  }
  return result;
}

double silhouette_difference(const Image<float>& picture, const Image<float>& reference) {
  std::size_t either = 0, one = 0;
  for (std::size_t k = 3; k < picture.values().size(); k += 4) {
    const bool in_picture = picture.values()[k] >= 0.5f, in_reference = reference.values()[k] >= 0.5f;
    either += in_picture || in_reference;
    one += in_picture != in_reference;
  }
  return either == 0 ? 0 : static_cast<double>(one) / static_cast<double>(either);
}

}  // namespace kiln
