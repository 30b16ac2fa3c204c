// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "image/image.h"

namespace kiln {

/// Difference of two pictures of one size, in 8-bit display levels, over the pixels where either differs from its
/// background.
struct PictureChange {
  double mean_shift = 0;  ///< mean of (now - was): what drift looks like
  double sigma = 0;       ///< standard deviation: what noise looks like
  int largest = 0;
  bool is_drift = false;  ///< the shift is larger than noise of this sigma explains

  bool is_same() const { return largest == 0; }
};

/// Where a cropped picture lies in the whole one: left and bottom pixel, width, height.
using PicturePlace = std::array<int, 4>;

/// Puts a picture into the box of `place` that contains its own; black without alpha around it.
Image<std::uint8_t> enlarged_to(const Image<std::uint8_t>& picture, const PicturePlace& own, const PicturePlace& place);

/// Returns the smallest box around both.
PicturePlace box_around(const PicturePlace& a, const PicturePlace& b);

/// Measures the change. Drift is a shift of at least a twentieth of a level that exceeds four standard errors; those
/// are taken from the means of blocks of 8 x 8 pixels, because neighbouring pixels of a bake err alike. Both pictures
/// have the same size and channels.
PictureChange measure_change(const Image<std::uint8_t>& was, const Image<std::uint8_t>& now);

/// Draws the differences eight times enlarged, as grey on white.
Image<std::uint8_t> enlarged_difference(const Image<std::uint8_t>& was, const Image<std::uint8_t>& now);

}  // namespace kiln
