// SPDX-License-Identifier: MIT
#pragma once

#include "image/image.h"

namespace kiln {

/// Difference of two pictures of the same size, over all channels.
struct ImageDifference {
  double root_mean_square = 0;
  double largest = 0;
  double relative_l2 = 0;  ///< ||a - b|| / ||b||
};

/// Compares `a` with the reference `b`. Throws std::invalid_argument where the sizes differ.
ImageDifference compare_images(const Image<float>& a, const Image<float>& b);

}  // namespace kiln
