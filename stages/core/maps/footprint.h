// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "image/image.h"

namespace kiln {

/// The four texels that a bilinear lookup weighs (clamped to the texture's edge), as j * width + i, and their weights.
struct Footprint {
  std::array<std::uint32_t, 4> texels{};
  std::array<float, 4> weights{};

  Footprint() = default;
  Footprint(const Eigen::Vector2f& uv, int width, int height);

  /// Looks up one channel of `image`.
  double lookup(const Image<float>& image, int channel) const;
};

}  // namespace kiln
