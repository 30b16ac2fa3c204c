// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "image/image.h"

namespace kiln {

/// Two estimates of one picture, by independent directions and paths: alike but for their noise.
using PictureEstimates = std::array<Image<float>, 2>;

Image<float> mean_of(const PictureEstimates& estimates);

/// Difference of a picture from a reference, over the pixels that both cover wholly: elsewhere the background would be
/// compared.
struct PictureDifference {
  double root_mean_square = 0;
  double largest = 0;
  double relative_l2 = 0;              ///< length of the difference over the reference's
  double relative_l2_uncertainty = 0;  ///< by which the reference's noise may make that too small; 95 % confidence
  double reference_noise = 0;          ///< relative L2 of the noise in the mean of the reference's estimates
  std::size_t pixels = 0;
};

/// Compares two pictures, RGBA.
PictureDifference compare_pictures(const Image<float>& picture, const Image<float>& reference);

/// Compares a picture with two estimates of its reference. The square of the difference is the sum of products of the
/// differences from either, so that the noise of the estimates, which are independent, has no bias in it; 0 where noise
/// is all there is. What is left of the noise is the uncertainty, for noise that is one and the same in all of a block
/// of 8 x 8 pixels and independent between blocks. `largest` is the difference from their mean, noise and all.
PictureDifference compare_pictures(const Image<float>& picture, const PictureEstimates& reference);

/// Returns the share of the pixels in either silhouette that lie, by half or more, in only one.
double silhouette_difference(const Image<float>& picture, const Image<float>& reference);

}  // namespace kiln
