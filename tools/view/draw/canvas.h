// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "runtime/draw/frame.h"

namespace kiln {

/// Framebuffers for the window's pictures, supersampled; those that are rarely needed are made on first use.
class Canvas {
 public:
  /// Makes a canvas for a window of width x height pixels, with `supersample` samples per pixel along each axis, or
  /// fewer if the framebuffers would be too large.
  Canvas(int width, int height, int supersample);

  int width() const { return width_; }
  int height() const { return height_; }
  int supersample() const { return supersample_; }

  const Frame& picture() const { return picture_; }
  const Frame& reference();
  const Frame& edges();
  const AppearanceFrame& appearance();

 private:
  int width_, height_, supersample_;
  Frame picture_;
  std::optional<Frame> reference_, edges_;
  std::optional<AppearanceFrame> appearance_;
};

}  // namespace kiln
