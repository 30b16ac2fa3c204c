// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "image/image.h"
#include "import/source_mesh.h"

namespace kiln {

/// One channel of a picture as a texture of values from 0 to 1. May be used by several threads at once.
class ChannelTexture {
 public:
  using Wrap = SourceTexture::Wrap;
  using Channel = SourceShare::Channel;

  /// Reads a picture that a mesh names or holds; stored values v become base + gain * v, without decoding, and are
  /// clamped to 0 .. 1. Green, blue and alpha of a picture without them are its grey, its grey, and 1. Throws BadInput,
  /// also for values that are not numbers.
  ChannelTexture(const SourcePicture& picture, Channel channel, float base = 0, float gain = 1);

  /// Interpolates bilinearly. uv (0, 0) is the picture's lower left corner.
  float at(const Eigen::Vector2f& uv, Wrap wrap_u, Wrap wrap_v) const;

  /// Returns the value of a texel; columns and rows outside the picture are wrapped.
  float texel(int column, int row, Wrap wrap_u, Wrap wrap_v) const;

  int width() const { return values_.width(); }
  int height() const { return values_.height(); }
  float lowest() const { return lowest_; }
  float highest() const { return highest_; }

 private:
  static constexpr float largest = 65535;
  float value(int i, int j) const { return static_cast<float>(values_.at(i, j)) / largest; }

  Image<std::uint16_t> values_;
  float lowest_ = 1, highest_ = 0;
};

}  // namespace kiln
