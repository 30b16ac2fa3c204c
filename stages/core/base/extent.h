// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace kiln {

/// Width and height of a texture, texels. One number is a square.
struct Extent {
  int width = 0;
  int height = 0;

  Extent() = default;
  Extent(int side) : width(side), height(side) {}  // NOLINT: a number is a square
  Extent(int across, int up) : width(across), height(up) {}
  bool operator==(const Extent&) const = default;

  /// Writes "512" or "1024x512".
  std::string text() const {
    return width == height ? std::to_string(width) : std::to_string(width) + "x" + std::to_string(height);
  }
};

}  // namespace kiln
