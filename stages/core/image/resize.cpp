// SPDX-License-Identifier: MIT
#include "image/resize.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace kiln {

namespace {

/// Pixel along one axis, and its share of a pixel of another size.
struct Share {
  int from = 0;
  float weight = 0;
};

/// Finds the shares that make up pixel `to` of `to_count` pixels in place of `from_count`.
std::vector<Share> shares_of(int to, int to_count, int from_count) {
  const double scale = static_cast<double>(from_count) / to_count;
  std::vector<Share> shares;
  if (to_count < from_count) {
    const double begin = to * scale, end = begin + scale;
    const int last = std::min(from_count - 1, static_cast<int>(std::ceil(end)) - 1);
    for (int from = static_cast<int>(begin); from <= last; ++from) {
      const double covered = std::min(end, from + 1.0) - std::max(begin, static_cast<double>(from));
      if (covered > 0) shares.push_back({from, static_cast<float>(covered / scale)});
    }
    return shares;
  }
  const double place = std::clamp((to + 0.5) * scale - 0.5, 0.0, from_count - 1.0);
  const int below = static_cast<int>(place), above = std::min(below + 1, from_count - 1);
  const auto weight = static_cast<float>(place - below);
  return {{below, 1 - weight}, {above, weight}};
}

Image<float> resized_across(const Image<float>& image, int width) {
  Image<float> result(width, image.height(), image.channels());
  for (int i = 0; i < width; ++i)
    for (const Share& share : shares_of(i, width, image.width()))
      for (int j = 0; j < image.height(); ++j)
        for (int c = 0; c < image.channels(); ++c) result.at(i, j, c) += share.weight * image.at(share.from, j, c);
  return result;
}

Image<float> resized_upwards(const Image<float>& image, int height) {
  Image<float> result(image.width(), height, image.channels());
  for (int j = 0; j < height; ++j)
    for (const Share& share : shares_of(j, height, image.height()))
      for (int i = 0; i < image.width(); ++i)
        for (int c = 0; c < image.channels(); ++c) result.at(i, j, c) += share.weight * image.at(i, share.from, c);
  return result;
}

}  // namespace

Image<float> resized(const Image<float>& image, int width, int height) {
  if (image.width() == width && image.height() == height) return image;
  return resized_across(resized_upwards(image, height), width);
}

}  // namespace kiln
