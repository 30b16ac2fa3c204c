#include "material/color_texture.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "image/image_file.h"
#include "image/srgb.h"

namespace kiln {

ColorTexture::ColorTexture(const std::filesystem::path& file, ColorEncoding encoding) {
  ColorPicture picture = read_color_picture(file);
  const auto decode = [&](float value) { return encoding == ColorEncoding::srgb ? linear_from_srgb(value) : value; };
  for (int byte = 0; byte < 256; ++byte) linear_of_byte_[static_cast<std::size_t>(byte)] = decode(byte / 255.f);
  if (auto* floats = std::get_if<Image<float>>(&picture.pixels)) {
    for (std::size_t pixel = 0; 3 * pixel < floats->values().size(); ++pixel) {
      bool clamped = false;
      for (std::size_t k = 3 * pixel; k < 3 * pixel + 3; ++k) {
        float& value = floats->values()[k];
        if (!std::isfinite(value))
          throw BadInput(file.string(), "has a pixel that is not a finite number", "colours of 0 to 1",
                         "mend the picture, or give --albedo a number");
        clamped = clamped || value < 0 || value > 1;
        value = std::clamp(value, 0.f, 1.f);
        if (!picture.is_float) value = decode(value);
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

Eigen::Vector3f ColorTexture::at(const Eigen::Vector2f& uv, bool clamp) const {
  // Per axis the two texels whose centres the point lies between, and the second one's weight. In double precision:
  // uvs far outside the unit square would lose texels' fractions.
  struct Between {
    int first, second;
    float weight;
  };
  const auto between = [&](double coordinate, int texels) {
    const double place =
        (clamp ? std::clamp(coordinate, 0.0, 1.0) : coordinate - std::floor(coordinate)) * texels - 0.5;
    const double below = std::floor(place);
    const int first = static_cast<int>(below);
    const auto wrapped = [&](int i) { return clamp ? std::clamp(i, 0, texels - 1) : (i + texels) % texels; };
    return Between{wrapped(first), wrapped(first + 1), static_cast<float>(place - below)};
  };
  const Between x = between(uv.x(), width_), y = between(uv.y(), height_);
  const Eigen::Vector3f lower = (1 - x.weight) * texel(x.first, y.first) + x.weight * texel(x.second, y.first);
  const Eigen::Vector3f upper = (1 - x.weight) * texel(x.first, y.second) + x.weight * texel(x.second, y.second);
  return (1 - y.weight) * lower + y.weight * upper;
}

}  // namespace kiln
