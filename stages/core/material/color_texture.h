// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <variant>

#include "image/image.h"
#include "import/source_mesh.h"
#include "material/material_settings.h"

namespace kiln {

/// Picture as a texture of linear colours, each 0 to 1.
class ColorTexture {
 public:
  /// Reads PNG, JPEG, EXR and other formats that OpenImageIO reads. `encoding` is that of integers; floating-point
  /// pictures are linear and are clamped to 0 .. 1. Throws BadInput, also for values that are not numbers.
  ColorTexture(const std::filesystem::path& file, ColorEncoding encoding);

  /// Reads a picture that a mesh names or holds; stored values v become base + gain * v before they are decoded.
  ColorTexture(const SourcePicture& picture, ColorEncoding encoding, float base = 0, float gain = 1);

  using Wrap = SourceTexture::Wrap;

  /// Interpolates bilinearly between linear values. Outside the unit square the picture repeats, mirrors, or continues
  /// its edge. uv (0, 0) is the picture's lower left corner.
  Eigen::Vector3f at(const Eigen::Vector2f& uv, Wrap wrap_u = Wrap::repeat, Wrap wrap_v = Wrap::repeat) const;

  int width() const { return width_; }
  int height() const { return height_; }

  /// Tells whether all pixels are grey.
  bool is_grey() const { return is_grey_; }

  /// Counts the pixels that had to be clamped.
  std::size_t clamped_pixels() const { return clamped_pixels_; }

 private:
  Eigen::Vector3f texel(int i, int j) const;

  int width_ = 0, height_ = 0;
  bool is_grey_ = true;
  std::size_t clamped_pixels_ = 0;
  std::array<float, 256> linear_of_byte_{};
  std::variant<Image<std::uint8_t>, Image<float>> pixels_;
};

}  // namespace kiln
