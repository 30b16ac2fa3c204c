// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "runtime/decode/plane_weights.h"

namespace kiln {

/// What surfaces show of functions of light, linear RGB, by their linear sRGB albedo: of function k, `products[k]`
/// times the albedo, plus an entry of the function's table, interpolated. So the tables hold only what products are
/// wrong by. A table has `side` entries along each of red, green and blue, evenly in sRGB's encoding from 0 to 1; one
/// with a side of 1 is of one surface.
struct ColorTable {
  int side = 1;
  std::vector<Eigen::Matrix3f> products = {};
  std::vector<float> colors = {};  ///< ((k * side + blue) * side + green) * side + red, then R, G and B

  int functions() const { return static_cast<int>(products.size()); }
};

/// Surface of an asset under light that is a sum of functions: its surface matrices [Peercy 1995], read by a sensor.
struct SurfaceColors {
  /// For each channel of the transfer, 3 x functions, where the surface is the same everywhere or within the transfer;
  /// then transfer is drawn as that of RGB is. Empty where the surface differs by its albedo.
  LightReaders readers = {};
  ColorTable table = {};  ///< for shading without transfer, and where there are no readers
  /// 3 x functions, of each of the asset's materials that were measured (PrtAlbedo::reflectances), in place of the
  /// table.
  LightReaders measured = {};
  Eigen::MatrixXf highlight = {};  ///< 3 x functions: of white, for highlights
  bool is_known = true;            ///< whether the asset knows its surface; else a look's grey counts

  int functions() const { return table.functions(); }
};

}  // namespace kiln
