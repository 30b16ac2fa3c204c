// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/surface_textures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <optional>

#include "asset/read_description.h"
#include "asset/read_parts.h"
#include "base/errors.h"
#include "base/files.h"
#include "image/image_file.h"
#include "image/png_file.h"
#include "image/resize.h"
#include "image/srgb.h"
#include "maps/detail_maps.h"
#include "mesh/uv_raster.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

Image<float> unit_values(const Image<std::uint8_t>& bytes) {
  Image<float> values(bytes.width(), bytes.height(), bytes.channels());
  std::ranges::transform(bytes.values(), values.values().begin(),
                         [](std::uint8_t byte) { return static_cast<float>(byte) / 255; });
  return values;
}

/// Returns a picture at another size; at its own, as it is.
Image<std::uint8_t> fitted(const Image<std::uint8_t>& picture, int width, int height, bool is_srgb) {
  if (picture.width() == width && picture.height() == height) return picture;
  if (is_srgb) return srgb_bytes(resized(linear_from_srgb_bytes(picture), width, height));
  const Image<float> values = resized(unit_values(picture), width, height);
  Image<std::uint8_t> bytes(width, height, picture.channels());
  std::ranges::transform(values.values(), bytes.values().begin(), byte_from_unit);
  return bytes;
}

const PrtMap* find_map(const PrtAsset& asset, const std::string& name) {
  const auto found = std::ranges::find(asset.maps, name, &PrtMap::name);
  return found == asset.maps.end() ? nullptr : &*found;
}

/// Reads a further map as values of 0 to 1; its red where it has several channels.
Image<float> read_map(const fs::path& folder, const PrtMap& map, int channels) {
  const Picture picture = read_picture(folder / map.file);
  Image<float> values = std::holds_alternative<Image<float>>(picture.pixels)
                            ? std::get<Image<float>>(picture.pixels)
                            : unit_values(std::get<Image<std::uint8_t>>(picture.pixels));
  if (values.channels() < channels)
    throw BadInput((folder / map.file).string(), fmt::format("has {} channels", values.channels()),
                   fmt::format("{} or more in a map of {}", channels, map.name),
                   "run kiln-normals and kiln-bake again, or bake without --ship maps");
  if (map.range)
    for (float& value : values.values())
      value = static_cast<float>(map.range->lowest + static_cast<double>(value) * map.range->width());
  return values;
}

}  // namespace

PngBytes png_of(const Image<std::uint8_t>& picture) {
  return encode_png({picture.width(), picture.height(), picture.channels()}, SampleType::uint8,
                    picture.values().data());
}

PngBytes base_color_picture(const fs::path& folder, const PrtAsset& asset,
                            const Image<std::uint8_t>& color_of_transfer) {
  const Image<std::uint8_t>& color = color_of_transfer.values().empty() ? asset.albedo.picture : color_of_transfer;
  const Image<std::uint8_t>& opacity = asset.opacity;
  if (opacity.values().empty()) {
    if (!color_of_transfer.values().empty()) return png_of(color_of_transfer);
    return color.values().empty() ? PngBytes() : read_text(folder / asset.albedo.file);
  }
  const int width = std::max(color.width(), opacity.width()), height = std::max(color.height(), opacity.height());
  const Image<std::uint8_t> alpha = fitted(opacity, width, height, false);
  const Image<std::uint8_t> rgb =
      color.values().empty() ? Image<std::uint8_t>(width, height, 3, 255) : fitted(color, width, height, true);
  Image<std::uint8_t> both(width, height, 4);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      std::ranges::copy(rgb.pixel(i, j), both.pixel(i, j).begin());
      both.at(i, j, 3) = alpha.at(i, j);
    }
  return png_of(both);
}

PngBytes tangent_normal_picture(const fs::path& folder, const PrtAsset& asset) {
  if (asset.normals_file.empty()) return {};
  const fs::path file = folder / asset.normals_file;
  int bits = 0;
  const Image<std::uint16_t> stored = read_png_as16(file, &bits);
  const bool has_own_size = asset.normal_width > 0;
  require_picture(stored, file, has_own_size ? asset.normal_width : asset.width,
                  has_own_size ? asset.normal_height : asset.height, 3, remedy_for(asset));
  if (asset.normal_space == NormalSpace::tangent && bits == 8) return read_text(file);

  Image<float> map = dequantise_normals(stored);
  if (asset.normal_space == NormalSpace::object)
    map = normal_map(map, NormalSpace::tangent, asset.mesh, rasterise_uvs(asset.mesh, map.width(), map.height()));
  Image<std::uint8_t> bytes(map.width(), map.height(), 3);
  std::ranges::transform(map.values(), bytes.values().begin(),
                         [](float value) { return byte_from_unit(value * 0.5f + 0.5f); });
  return png_of(bytes);
}

PngBytes roughness_picture(const fs::path& folder, const PrtAsset& asset) {
  if (const PrtMap* orm = find_map(asset, "orm")) {
    const Image<std::uint8_t> picture = read_png8(folder / orm->file);
    require_picture(picture, folder / orm->file, picture.width(), picture.height(), 3, remedy_for(asset));
    return read_text(folder / orm->file);
  }
  const PrtMap *roughness = find_map(asset, "roughness"), *metalness = find_map(asset, "metalness");
  if (roughness == nullptr && metalness == nullptr) return {};
  Image<float> rough, metal;
  if (roughness != nullptr) rough = read_map(folder, *roughness, 1);
  if (metalness != nullptr) metal = read_map(folder, *metalness, 1);
  const int width = std::max(rough.width(), metal.width()), height = std::max(rough.height(), metal.height());
  if (roughness != nullptr) rough = resized(rough, width, height);
  if (metalness != nullptr) metal = resized(metal, width, height);
  Image<std::uint8_t> picture(width, height, 3, 255);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      if (roughness != nullptr) picture.at(i, j, 1) = byte_from_unit(rough.at(i, j));
      picture.at(i, j, 2) = metalness != nullptr ? byte_from_unit(metal.at(i, j)) : std::uint8_t{0};
    }
  return png_of(picture);
}

}  // namespace kiln
