// SPDX-License-Identifier: MIT
#include "maps/detail_maps.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/asset_layout.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "image/gutter.h"
#include "image/image_file.h"
#include "image/resize.h"
#include "image/srgb.h"
#include "mesh/tangent_space.h"

namespace kiln {

namespace {

constexpr float full_scale = 65535;

using Pixel = Eigen::Map<Eigen::Vector3f>;

Pixel pixel(Image<float>& image, int i, int j) { return Pixel(image.pixel(i, j).data()); }

/// Normalises vectors: means of unit vectors are shorter than one. Means of opposite ones may vanish and become
/// `substitute`.
void normalise(Image<float>& image, const Eigen::Vector3f& substitute) {
  for (int j = 0; j < image.height(); ++j)
    for (int i = 0; i < image.width(); ++i) {
      const float length = pixel(image, i, j).norm();
      if (length > 1e-6f)
        pixel(image, i, j) /= length;
      else
        pixel(image, i, j) = substitute;
    }
}

void require_raster_of(const UvRaster& raster, int width, int height, int channels) {
  if (raster.width != width || raster.height != height || channels != 3)
    throw std::invalid_argument("a normal map of three channels and the raster's size is needed");
}

/// Calls convert(low normal, frame, pixel) for every covered texel.
template <class Convert>
void convert_covered(Image<float>& image, const TriangleMesh& atlas, const UvRaster& raster, const Convert& convert) {
  const std::vector<TangentFrame> frames = tangent_frames(atlas);
  for (int j = 0; j < raster.height; ++j)
    for (int i = 0; i < raster.width; ++i) {
      const TexelSource& source = raster.at(i, j);
      if (!source.covered()) continue;
      const Eigen::Vector3f value = pixel(image, i, j);
      pixel(image, i, j) =
          convert(value, interpolate(atlas, atlas.normals, source), interpolate(atlas, frames, source)).normalized();
    }
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& found, const std::string& expected) {
  throw BadInput(file.string(), found, expected, "run kiln-normals on this atlas again");
}

NormalSpace read_space(const std::filesystem::path& file, const Json& result) {
  const std::string expected = "the result of kiln-normals";
  if (!result.is_object() || !result.contains("settings") || !result["settings"].is_object() ||
      !result["settings"].contains("space"))
    refuse(file, "no settings.space in it", expected);
  const Json& space = result["settings"]["space"];
  if (space == "object") return NormalSpace::object;
  if (space == "tangent") return NormalSpace::tangent;
  refuse(file, "space " + space.dump(), "object or tangent");
}

template <class T>
std::string size_text(const Image<T>& image) {
  return std::to_string(image.width()) + " x " + std::to_string(image.height()) + " texels of " +
         std::to_string(image.channels()) + (image.channels() == 1 ? " channel" : " channels");
}

/// Reads the albedo map, or the constant in the record: three linear values. Records of older versions of kiln-normals
/// have neither; the surface is white then.
void read_albedo(const std::filesystem::path& folder, const Json& record, DetailMaps& maps) {
  const Json albedo = record.value("albedo", Json::object());
  if (!albedo.is_object() || (!albedo.empty() && !albedo.contains("source")))
    refuse(layout::record_in(folder, "normals"), "albedo " + albedo.dump(), "the result of kiln-normals");
  if (albedo.empty()) return;
  maps.albedo_known = albedo["source"] != "none";
  if (albedo.contains("constant")) {
    const Json& values = albedo["constant"];
    const auto is_share = [](const Json& v) { return v.is_number() && v >= 0 && v <= 1; };
    if (!values.is_array() || values.size() != 3 || !std::all_of(values.begin(), values.end(), is_share))
      refuse(layout::record_in(folder, "normals"), "a constant albedo of " + values.dump(), "three numbers of 0 to 1");
    for (int c = 0; c < 3; ++c) maps.constant_albedo[c] = values[static_cast<std::size_t>(c)];
    return;
  }
  const Image<std::uint8_t> encoded = read_png8(folder / layout::albedo_map);
  const int width = albedo.value("width", maps.width), height = albedo.value("height", maps.height);
  if (encoded.width() != width || encoded.height() != height || encoded.channels() != 3)
    refuse(folder / layout::albedo_map, size_text(encoded),
           std::to_string(width) + " x " + std::to_string(height) + " texels of 3 channels");
  maps.albedo_width = encoded.width();
  maps.albedo_height = encoded.height();
  maps.albedo = resized(linear_from_srgb_bytes(encoded), maps.width, maps.height);
}

}  // namespace

Eigen::Vector3f DetailMaps::albedo_at(int i, int j) const {
  return albedo.values().empty() ? constant_albedo : Eigen::Map<const Eigen::Vector3f>(albedo.pixel(i, j).data());
}

std::vector<std::uint8_t> coverage_of(const UvRaster& raster) {
  std::vector<std::uint8_t> covered(raster.texels.size());
  std::transform(raster.texels.begin(), raster.texels.end(), covered.begin(),
                 [](const TexelSource& source) { return source.covered() ? 1 : 0; });
  return covered;
}

Image<float> normal_map(const Image<float>& normal_object, NormalSpace space, const TriangleMesh& atlas,
                        const UvRaster& raster) {
  require_raster_of(raster, normal_object.width(), normal_object.height(), normal_object.channels());
  Image<float> map = normal_object;
  if (space == NormalSpace::tangent) convert_covered(map, atlas, raster, to_tangent_space);
  fill_gutters(map, coverage_of(raster));
  normalise(map, space);
  return map;
}

void normalise(Image<float>& map, NormalSpace space) {
  normalise(map, space == NormalSpace::tangent ? Eigen::Vector3f::UnitZ() : Eigen::Vector3f::UnitY());
}

Image<std::uint16_t> quantise_normals(const Image<float>& map) {
  Image<std::uint16_t> encoded(map.width(), map.height(), 3);
  std::transform(map.values().begin(), map.values().end(), encoded.values().begin(), [](float value) {
    return static_cast<std::uint16_t>(std::lround((std::clamp(value, -1.0f, 1.0f) * 0.5f + 0.5f) * full_scale));
  });
  return encoded;
}

Image<float> dequantise_normals(const Image<std::uint16_t>& encoded) {
  Image<float> map(encoded.width(), encoded.height(), 3);
  std::transform(encoded.values().begin(), encoded.values().end(), map.values().begin(),
                 [](std::uint16_t value) { return static_cast<float>(value) / full_scale * 2 - 1; });
  normalise(map, NormalSpace::object);
  return map;
}

Image<float> decode_normals(const Image<std::uint16_t>& encoded, NormalSpace space, const TriangleMesh& atlas,
                            const UvRaster& raster) {
  require_raster_of(raster, encoded.width(), encoded.height(), encoded.channels());
  Image<float> map = dequantise_normals(encoded);
  if (space == NormalSpace::tangent) {
    convert_covered(map, atlas, raster, to_object_space);
    // Outside the charts there is no frame to convert with.
    fill_gutters(map, coverage_of(raster));
    normalise(map, NormalSpace::object);
  }
  return map;
}

DetailMaps load_detail_maps(const std::filesystem::path& folder, const TriangleMesh& atlas) {
  if (!std::filesystem::is_directory(folder))
    throw BadInput(folder.string(), "no such folder", "the output folder of kiln-normals", "check the path");
  const std::filesystem::path record_file = layout::record_in(folder, "normals");
  const Json record = Json::parse(read_text(record_file), nullptr, false);
  const NormalSpace space = read_space(record_file, record);
  const Image<std::uint8_t> coverage = read_png8(folder / layout::coverage_map);
  const Image<std::uint16_t> encoded = read_png16(folder / layout::normal_map);
  DetailMaps maps;
  maps.position = read_float_image(folder / layout::position_map);
  maps.width = coverage.width();
  maps.height = coverage.height();

  // One size for all.
  if (coverage.channels() != 1) refuse(folder / layout::coverage_map, size_text(coverage), "a grey picture");
  const std::string expected = std::to_string(maps.width) + " x " + std::to_string(maps.height) +
                               " texels of 3 channels, as coverage.png has texels";
  if (encoded.width() != maps.width || encoded.height() != maps.height || encoded.channels() != 3)
    refuse(folder / layout::normal_map, size_text(encoded), expected);
  if (maps.position.width() != maps.width || maps.position.height() != maps.height || maps.position.channels() != 3)
    refuse(folder / layout::position_map, size_text(maps.position), expected);

  maps.normal_space = space;
  read_albedo(folder, record, maps);
  maps.has_opacity = record.contains("opacity");
  if (const Json own = record.value("own_normal", Json::object()); own.is_object() && !own.empty()) {
    maps.own_normal_width = own.value("width", 0);
    maps.own_normal_height = own.value("height", 0);
  }

  // Check that the maps were made from this very atlas.
  if (atlas.normals.size() != atlas.positions.size() || atlas.uvs.size() != atlas.positions.size())
    throw std::invalid_argument("load_detail_maps: the atlas mesh needs normals and uvs");
  const UvRaster raster = rasterise_uvs(atlas, maps.width, maps.height);
  maps.covered = coverage_of(raster);
  for (std::size_t k = 0; k < maps.covered.size(); ++k)
    if ((coverage.values()[k] != 0) != (maps.covered[k] != 0))
      refuse(folder / layout::coverage_map, "a coverage that is not the atlas mesh's", "maps made from the same atlas");

  maps.normal_object = decode_normals(encoded, space, atlas, raster);
  if (atlas.frame.exponent != 0)
    for (float& value : maps.position.values()) value = static_cast<float>(value / atlas.frame.unit());
  if (!std::all_of(maps.position.values().begin(), maps.position.values().end(),
                   [](float v) { return std::isfinite(v); }))
    refuse(folder / layout::position_map, "positions that are not finite", "finite positions");
  return maps;
}

}  // namespace kiln
