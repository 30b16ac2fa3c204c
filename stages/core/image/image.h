// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kiln {

/// Pixel buffer, channels interleaved, row 0 at the BOTTOM (as uv has it; files are flipped when read and written).
template <class T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, int channels, T value = T{})
      : width_(width),
        height_(height),
        channels_(channels),
        values_(static_cast<std::size_t>(width) * height * channels, value) {}

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }

  T& at(int i, int j, int channel = 0) { return values_[offset(i, j) + channel]; }
  const T& at(int i, int j, int channel = 0) const { return values_[offset(i, j) + channel]; }

  /// Returns all channels of one pixel.
  std::span<T> pixel(int i, int j) { return {values_.data() + offset(i, j), static_cast<std::size_t>(channels_)}; }
  std::span<const T> pixel(int i, int j) const {
    return {values_.data() + offset(i, j), static_cast<std::size_t>(channels_)};
  }

  std::vector<T>& values() { return values_; }
  const std::vector<T>& values() const { return values_; }

 private:
  std::size_t offset(int i, int j) const { return (static_cast<std::size_t>(j) * width_ + i) * channels_; }

  int width_ = 0;
  int height_ = 0;
  int channels_ = 0;
  std::vector<T> values_;
};

}  // namespace kiln
