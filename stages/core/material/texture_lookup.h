// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "import/source_mesh.h"

namespace kiln {

/// Maps a texel outside a picture of `texels` in this direction to one inside.
inline int wrapped_texel(int i, int texels, SourceTexture::Wrap wrap) {
  if (wrap == SourceTexture::Wrap::clamp) return std::clamp(i, 0, texels - 1);
  const int period = wrap == SourceTexture::Wrap::mirror ? 2 * texels : texels;
  const int within = (i % period + period) % period;
  return within < texels ? within : period - 1 - within;
}

/// Four texels of a bilinear lookup, as columns and rows inside the picture, and the weights of the second ones.
struct BilinearTexels {
  int column[2], row[2];
  float weight_u, weight_v;

  /// Makes the lookup at `uv` in a picture; (0, 0) is its lower left corner.
  BilinearTexels(const Eigen::Vector2f& uv, int width, int height, SourceTexture::Wrap wrap_u,
                 SourceTexture::Wrap wrap_v) {
    place(static_cast<double>(uv.x()), width, wrap_u, column, weight_u);
    place(static_cast<double>(uv.y()), height, wrap_v, row, weight_v);
  }

  /// Interpolates values of texels, which `texel` returns by column and row.
  template <class TexelFunction>
  auto interpolate(const TexelFunction& texel) const -> decltype(texel(0, 0)) {
    using Value = decltype(texel(0, 0));
    const Value lower = (1 - weight_u) * texel(column[0], row[0]) + weight_u * texel(column[1], row[0]);
    const Value upper = (1 - weight_u) * texel(column[0], row[1]) + weight_u * texel(column[1], row[1]);
    return (1 - weight_v) * lower + weight_v * upper;
  }

 private:
  /// Finds the two texels between whose centres a point lies. In double precision: coordinates far outside the unit
  /// interval would lose the fraction of a texel.
  static void place(double coordinate, int texels, SourceTexture::Wrap wrap, int (&between)[2], float& weight) {
    const double within = wrap == SourceTexture::Wrap::clamp
                              ? std::clamp(coordinate, 0.0, 1.0)
                              : coordinate - 2 * std::floor(coordinate / 2);  // two periods
    const double at = within * texels - 0.5, below = std::floor(at);
    between[0] = wrapped_texel(static_cast<int>(below), texels, wrap);
    between[1] = wrapped_texel(static_cast<int>(below) + 1, texels, wrap);
    weight = static_cast<float>(at - below);
  }
};

}  // namespace kiln
