// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/output/picture.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "image/image_file.h"
#include "image/srgb.h"

namespace kiln {

namespace {

/// Puts a colour behind radiance that is multiplied by coverage.
Image<float> composite(const Image<float>& radiance, const std::array<float, 3>& background) {
  Image<float> opaque = radiance;
  for (int j = 0; j < opaque.height(); ++j)
    for (int i = 0; i < opaque.width(); ++i) {
      float& coverage = opaque.at(i, j, 3);
      for (int c = 0; c < 3; ++c) opaque.at(i, j, c) += (1 - coverage) * background[c];
      coverage = 1;
    }
  return opaque;
}

}  // namespace

Image<std::uint8_t> picture_from_radiance(const Image<float>& radiance, const PictureSettings& settings) {
  Image<std::uint8_t> picture(radiance.width(), radiance.height(), settings.background ? 3 : 4);
  const auto exposure = static_cast<float>(std::exp2(settings.exposure_stops));
  for (int j = 0; j < radiance.height(); ++j)
    for (int i = 0; i < radiance.width(); ++i) {
      const float coverage = radiance.at(i, j, 3);
      for (int c = 0; c < 3; ++c) {
        float value = exposure * radiance.at(i, j, c);
        if (settings.background)
          value = std::max(value, 0.f) + (1 - coverage) * (*settings.background)[c];
        else if (coverage > 0)
          value /= coverage;
        picture.at(i, j, c) = byte_from_unit(settings.tone == ToneCurve::srgb ? srgb_from_linear(value) : value);
      }
      if (!settings.background) picture.at(i, j, 3) = byte_from_unit(coverage);
    }
  return picture;
}

void require_picture_name(const std::filesystem::path& file) {
  if (file.extension() != ".png" && file.extension() != ".exr")
    throw WrongUsage("output: found '" + file.string() + "'; expected a name that ends in .png or .exr");
}

void write_picture(const std::filesystem::path& file, const Image<float>& radiance, const PictureSettings& settings) {
  require_picture_name(file);
  if (file.extension() == ".png") return write_png(file, picture_from_radiance(radiance, settings));
  write_exr(file, settings.background ? composite(radiance, *settings.background) : radiance);
}

}  // namespace kiln
