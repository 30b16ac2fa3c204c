// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/color_texture.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "image/image_file.h"
#include "image/srgb.h"
#include "material/texture_lookup.h"

namespace kiln {

namespace {

/// Conversion of stored values to linear ones.
struct Decoding {
  ColorEncoding encoding;
  float base, gain;

  float operator()(float stored) const {
    const float value = base + gain * stored;
    return encoding == ColorEncoding::srgb ? linear_from_srgb(value) : value;
  }
};

}  // namespace

ColorTexture::ColorTexture(const std::filesystem::path& file, ColorEncoding encoding)
    : ColorTexture(SourcePicture{file, nullptr, file.string()}, encoding) {}

ColorTexture::ColorTexture(const SourcePicture& source, ColorEncoding encoding, float base, float gain) {
  Picture picture =
      colors_of(source.bytes != nullptr ? read_picture(*source.bytes, source.name) : read_picture(source.file));
  const Decoding decode{encoding, base, gain};
  for (int byte = 0; byte < 256; ++byte)
    linear_of_byte_[static_cast<std::size_t>(byte)] = std::clamp(decode(static_cast<float>(byte) / 255), 0.f, 1.f);
  if (auto* floats = std::get_if<Image<float>>(&picture.pixels)) {
    for (std::size_t pixel = 0; 3 * pixel < floats->values().size(); ++pixel) {
      bool clamped = false;
      for (std::size_t k = 3 * pixel; k < 3 * pixel + 3; ++k) {
        float& value = floats->values()[k];
        if (!std::isfinite(value))
          throw BadInput(source.name, "has a pixel that is not a finite number", "colours of 0 to 1",
                         "mend the picture, or give --albedo a number");
        const float found = picture.is_float ? base + gain * value : decode(value);
        value = std::clamp(found, 0.f, 1.f);
        clamped = clamped || value != found;
      }
      clamped_pixels_ += clamped;
    }
  }
  pixels_ = std::move(picture.pixels);
  std::visit(
      [&](const auto& pixels) {
        width_ = pixels.width();
        height_ = pixels.height();
        const auto& values = pixels.values();
        for (std::size_t k = 0; k < values.size() && is_grey_; k += 3)
          is_grey_ = values[k] == values[k + 1] && values[k] == values[k + 2];
      },
      pixels_);
}

Eigen::Vector3f ColorTexture::texel(int i, int j) const {
  if (const auto* bytes = std::get_if<Image<std::uint8_t>>(&pixels_)) {
    const auto pixel = bytes->pixel(i, j);
    return {linear_of_byte_[pixel[0]], linear_of_byte_[pixel[1]], linear_of_byte_[pixel[2]]};
  }
  return Eigen::Map<const Eigen::Vector3f>(std::get_if<Image<float>>(&pixels_)->pixel(i, j).data());
}

Eigen::Vector3f ColorTexture::at(const Eigen::Vector2f& uv, Wrap wrap_u, Wrap wrap_v) const {
  return BilinearTexels(uv, width_, height_, wrap_u, wrap_v).interpolate([this](int i, int j) { return texel(i, j); });
}

}  // namespace kiln
