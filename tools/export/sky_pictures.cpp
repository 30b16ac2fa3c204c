// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/sky_pictures.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "image/srgb.h"
#include "sh/basis.h"

namespace kiln {

namespace {

/// Luminance of linear sRGB (ITU-R BT.709).
constexpr std::array<float, 3> luminance = {0.2126f, 0.7152f, 0.0722f};

constexpr float largest_byte = 255;

}  // namespace

SkyTransfer sky_transfer(const PrtAsset& asset) {
  const auto bands = clamped_cosine_bands(2);
  // What an open surface has that faces the axis: A_l / pi times the basis function there.
  const ShBasis basis(2);
  std::array<float, 4> at_z{};
  basis.evaluate<float>(Eigen::Vector3f::UnitZ(), at_z);
  const auto open_0 = static_cast<float>(bands[0] / M_PI * at_z[0]),
             open_1 = static_cast<float>(bands[1] / M_PI * at_z[2]);

  SkyTransfer sky;
  for (Image<float>* image : {&sky.open, &sky.x, &sky.y, &sky.z})
    *image = Image<float>(asset.width, asset.height, asset.channels);
  const auto width = static_cast<std::size_t>(asset.width), channels = static_cast<std::size_t>(asset.channels);
  const std::size_t length = asset.vector_length(), coefficients = length / channels;
  std::vector<std::uint32_t> row(width);
  std::vector<float> vectors(width * length);
  for (std::size_t j = 0; j < static_cast<std::size_t>(asset.height); ++j) {
    std::iota(row.begin(), row.end(), static_cast<std::uint32_t>(j * width));
    decode_transfer(asset, row, vectors);
    for (std::size_t i = 0; i < width; ++i)
      for (std::size_t c = 0; c < channels; ++c) {
        const float* t = vectors.data() + i * length + c * coefficients;
        const std::size_t at = (j * width + i) * channels + c;
        sky.open.values()[at] = t[0] / open_0;
        if (coefficients < 4) continue;
        sky.y.values()[at] = t[1] / open_1;
        sky.z.values()[at] = t[2] / open_1;
        sky.x.values()[at] = t[3] / open_1;
      }
  }
  return sky;
}

Image<std::uint8_t> occlusion_picture(const SkyTransfer& sky) {
  const Image<float>& open = sky.open;
  Image<std::uint8_t> picture(open.width(), open.height(), 1);
  for (int j = 0; j < open.height(); ++j)
    for (int i = 0; i < open.width(); ++i) {
      const std::span<const float> texel = open.pixel(i, j);
      picture.at(i, j) = byte_from_unit(
          texel.size() == 3 ? std::inner_product(texel.begin(), texel.end(), luminance.begin(), 0.0f) : texel[0]);
    }
  return picture;
}

Image<std::uint8_t> color_under_sky(const SkyTransfer& sky) {
  return sky.open.channels() == 3 ? srgb_bytes(sky.open) : Image<std::uint8_t>();
}

SkyPictures sky_pictures(const SkyTransfer& sky) {
  SkyPictures result;
  const std::array<const Image<float>*, 4> sources = {&sky.open, &sky.x, &sky.y, &sky.z};
  std::vector<std::uint8_t> clamped(static_cast<std::size_t>(sky.open.width()) *
                                    static_cast<std::size_t>(sky.open.height()));
  for (std::size_t k = 0; k < sources.size(); ++k) {
    const Image<float>& source = *sources[k];
    Image<std::uint8_t>& picture = result.pictures[k] =
        Image<std::uint8_t>(source.width(), source.height(), source.channels());
    for (std::size_t at = 0; at < source.values().size(); ++at) {
      const float share = k == 0 ? source.values()[at] : source.values()[at] * 0.5f + 0.5f;
      picture.values()[at] = byte_from_unit(share);
      if (std::abs(share - 0.5f) > 0.5f + 1 / largest_byte)
        clamped[at / static_cast<std::size_t>(source.channels())] = 1;
    }
  }
  result.clamped_texels = static_cast<std::size_t>(std::ranges::count(clamped, 1));
  return result;
}

std::array<std::string, 4> sky_picture_names(const std::string& stem) {
  std::array<std::string, 4> names;
  constexpr std::array axes = {"w", "x", "y", "z"};
  for (std::size_t k = 0; k < names.size(); ++k) names[k] = stem + "_sh1_" + axes[k] + ".png";
  return names;
}

}  // namespace kiln
