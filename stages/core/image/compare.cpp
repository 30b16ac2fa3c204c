// SPDX-License-Identifier: MIT
#include "image/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace kiln {

ImageDifference compare_images(const Image<float>& a, const Image<float>& b) {
  if (a.width() != b.width() || a.height() != b.height() || a.channels() != b.channels())
    throw std::invalid_argument("compare_images: pictures of different sizes");
  ImageDifference difference;
  if (b.values().empty()) return difference;
  double squared_error = 0, squared_reference = 0;
  for (std::size_t k = 0; k < b.values().size(); ++k) {
    const double reference = b.values()[k];
    const double error = a.values()[k] - reference;
    squared_error += error * error;
    squared_reference += reference * reference;
    // Keep a NaN once met: nothing compares greater than it.
    if (std::isnan(error) || std::abs(error) > difference.largest) difference.largest = std::abs(error);
  }
  difference.root_mean_square = std::sqrt(squared_error / static_cast<double>(b.values().size()));
  if (squared_reference > 0)
    difference.relative_l2 = std::sqrt(squared_error / squared_reference);
  else if (squared_error != 0)
    difference.relative_l2 = std::numeric_limits<double>::infinity();
  return difference;
}

}  // namespace kiln
