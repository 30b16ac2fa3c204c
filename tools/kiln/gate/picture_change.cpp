// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/gate/picture_change.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

namespace kiln {

namespace {

constexpr int block_size = 8;

/// Sums for means and standard deviations.
struct Moments {
  double count = 0, sum = 0, squares = 0;

  void add(double value) {
    ++count;
    sum += value;
    squares += value * value;
  }
  double mean() const { return count > 0 ? sum / count : 0; }
  double deviation() const { return count > 1 ? std::sqrt(std::max(0.0, squares / count - mean() * mean())) : 0; }
};

int color_channels(const Image<std::uint8_t>& image) { return std::min(image.channels(), 3); }

/// Tells whether a pixel shows anything: its alpha, or, without one, that it differs from the corner's.
bool shows(const Image<std::uint8_t>& image, int i, int j) {
  if (image.channels() == 4) return image.at(i, j, 3) != 0;
  for (int c = 0; c < image.channels(); ++c)
    if (image.at(i, j, c) != image.at(0, 0, c)) return true;
  return false;
}

}  // namespace

PictureChange measure_change(const Image<std::uint8_t>& was, const Image<std::uint8_t>& now) {
  PictureChange change;
  Moments pixels;
  std::map<std::pair<int, int>, Moments> blocks;
  for (int j = 0; j < now.height(); ++j)
    for (int i = 0; i < now.width(); ++i) {
      if (!shows(was, i, j) && !shows(now, i, j)) continue;
      for (int c = 0; c < color_channels(now); ++c) {
        const int difference = int{now.at(i, j, c)} - int{was.at(i, j, c)};
        change.largest = std::max(change.largest, std::abs(difference));
        pixels.add(difference);
        blocks[{i / block_size, j / block_size}].add(difference);
      }
    }
  Moments means;
  for (const auto& [place, block] : blocks) means.add(block.mean());
  change.mean_shift = pixels.mean();
  change.sigma = pixels.deviation();
  const double standard_error = means.count > 1 ? means.deviation() / std::sqrt(means.count - 1) : 0;
  constexpr double least_shift = 0.05, most_errors = 4;
  change.is_drift =
      std::abs(change.mean_shift) >= least_shift && std::abs(change.mean_shift) > most_errors * standard_error;
  return change;
}

Image<std::uint8_t> enlarged_to(const Image<std::uint8_t>& picture, const PicturePlace& own,
                                const PicturePlace& place) {
  Image<std::uint8_t> larger(place[2], place[3], picture.channels());
  for (int j = 0; j < picture.height(); ++j)
    for (int i = 0; i < picture.width(); ++i)
      std::ranges::copy(picture.pixel(i, j), larger.pixel(own[0] - place[0] + i, own[1] - place[1] + j).begin());
  return larger;
}

PicturePlace box_around(const PicturePlace& a, const PicturePlace& b) {
  const int left = std::min(a[0], b[0]), bottom = std::min(a[1], b[1]);
  return {left, bottom, std::max(a[0] + a[2], b[0] + b[2]) - left, std::max(a[1] + a[3], b[1] + b[3]) - bottom};
}

Image<std::uint8_t> enlarged_difference(const Image<std::uint8_t>& was, const Image<std::uint8_t>& now) {
  constexpr int gain = 8;
  Image<std::uint8_t> picture(now.width(), now.height(), 3, 255);
  for (int j = 0; j < now.height(); ++j)
    for (int i = 0; i < now.width(); ++i)
      for (int c = 0; c < 3; ++c) {
        const int channel = std::min(c, color_channels(now) - 1);
        const int difference = std::abs(int{now.at(i, j, channel)} - int{was.at(i, j, channel)});
        picture.at(i, j, c) = static_cast<std::uint8_t>(255 - std::min(255, gain * difference));
      }
  return picture;
}

}  // namespace kiln
